// What deflect asks of Gmsh. The Gmsh library (92 shared libraries, 70 ms to start) is loaded at the first call, from
// the module deflect_gmsh beside the program or the library; a program that never calls does not pay.
#pragma once

#include <filesystem>
#include <vector>

#include "meshes/line_mesh.h"

namespace deflect::gmsh {

/// Subdivides straight members of the given lengths (m) with Gmsh's 1D mesher at the given element size (m).
/// Returns for every member the positions of its nodes as fractions of its length, 0 first and 1 last, ascending.
/// Throws InputError on a size that is not positive, ModelError naming Gmsh's message when meshing fails or the module
/// cannot be loaded.
std::vector<std::vector<double>> subdivide(const std::vector<double>& lengths, double element_size);

/// Writes mesh and fields as MSH 4.1, lengths in mm, one physical group per group, one view per field. The file is
/// written whole or not at all. Opens in Gmsh.
void write_msh(const std::filesystem::path&, const LineMesh&, const FieldData&);

}  // namespace deflect::gmsh
