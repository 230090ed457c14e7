// What finer elements change: the theories against each other as members are divided into shorter ones.
#pragma once

#include <vector>

#include "validation/studies/validate.h"

namespace deflect::studies {

struct MeshStudyRow {
  double size_mm = 0;              ///< of the elements
  std::size_t elements = 0;        ///< of one leg
  double relative_difference = 0;  ///< the largest of the two theories, see Validation
};

/// With elements of 200 mm down to 2 mm, at the points under `load_N` along x, y and z. Throws as validate() does;
/// ModelError where the module with Gmsh cannot be loaded.
std::vector<MeshStudyRow> mesh_study(const Mechanism&, const std::vector<ValidationPoint>&, double load_N);

}  // namespace deflect::studies
