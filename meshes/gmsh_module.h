// The border between deflect and the module deflect_gmsh, which alone is linked with Gmsh. Both sides come from one
// build, which `interface` and `version` prove, so C++ types may cross; exceptions may not: failures come back as text.
#pragma once

#include <string>
#include <vector>

#include "meshes/line_mesh.h"

namespace deflect::gmsh {

struct Module {
  int interface;        ///< module_interface; first, so that it can be read whatever follows
  const char* version;  ///< of deflect

  /// Node positions as fractions of the lengths, which are given in element sizes; unchecked. Returns Gmsh's message,
  /// empty on success.
  std::string (*subdivide)(const std::vector<double>& lengths, std::vector<std::vector<double>>& positions) noexcept;

  /// Writes to `file`, whose name ends in .msh. Returns Gmsh's message, empty on success.
  std::string (*write_msh)(const std::string& file, const LineMesh&, const FieldData&) noexcept;
};

inline constexpr const char* module_file = "deflect_gmsh.so";
inline constexpr const char* module_symbol = "deflect_gmsh_module";  ///< const Module* (*)()
inline constexpr int module_interface = 1;                           ///< to be raised when Module changes

}  // namespace deflect::gmsh
