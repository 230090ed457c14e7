// Modules: parts of the program that are loaded when they are first needed, because the libraries behind them cost time
// and memory at every start, or are not there on every machine.
#pragma once

#include <filesystem>
#include <vector>

namespace deflect {

/// What a module's table of functions begins with. Module and program come from one build, which the two prove, so C++
/// types may cross the border; exceptions may not.
struct ModuleHead {
  int interface;        ///< first, so that it can be read whatever follows
  const char* version;  ///< of deflect
};

struct ModuleKind {
  const char* file;    ///< "deflect_gmsh.so"
  const char* symbol;  ///< of the function that returns the table: const ModuleHead* (*)()
  int interface;       ///< that the program knows
};

/// Where modules may be, the first one first: the folder in the environment's DEFLECT_PLUGIN_DIR, the program's own
/// folder, the library folder of the installation that the program belongs to, the one chosen when deflect was
/// configured, and the folder above the program's, which is where a build tree's tests find it.
std::vector<std::filesystem::path> module_folders();

/// Loads the module from the first folder that has a fitting one; it stays loaded. Throws ModelError naming what was
/// found in every folder.
const ModuleHead& load_module(const ModuleKind&, const std::vector<std::filesystem::path>& folders = module_folders());

}  // namespace deflect
