// The border between deflect and the module deflect_gmsh, which alone is linked with Gmsh. Failures come back as text.
#pragma once

#include <string>
#include <vector>

#include "meshes/line_mesh.h"
#include "msa/base/module.h"

namespace deflect::gmsh {

struct Module : ModuleHead {
  /// Node positions as fractions of the lengths, which are given in element sizes; unchecked. Returns Gmsh's message,
  /// empty on success.
  std::string (*subdivide)(const std::vector<double>& lengths, std::vector<std::vector<double>>& positions) noexcept;

  /// Writes to `file`, whose name ends in .msh. Returns Gmsh's message, empty on success.
  std::string (*write_msh)(const std::string& file, const LineMesh&, const FieldData&) noexcept;
};

/// Its interface is to be raised when Module changes.
inline constexpr ModuleKind module_kind = {"deflect_gmsh.so", "deflect_gmsh_module", 1};

}  // namespace deflect::gmsh
