// Finding and loading the module deflect_gmsh.
#pragma once

#include <filesystem>
#include <vector>

#include "meshes/gmsh_module.h"

namespace deflect::gmsh {

/// Where the module may be, the first one first: the folder in the environment's DEFLECT_PLUGIN_DIR, the program's own
/// folder, the library folder of the installation that the program belongs to, the one chosen when deflect was
/// configured, and the folder above the program's, which is where a build tree's tests find it.
std::vector<std::filesystem::path> module_folders();

/// Loads the module from the first folder that has a fitting one; it stays loaded. Throws ModelError naming
/// what was found in every folder.
const Module& load_module(const std::vector<std::filesystem::path>& folders);

}  // namespace deflect::gmsh
