// Modules: parts of the program that are loaded on first use, because their libraries cost time and memory at every
// start or are not installed on every machine.
#pragma once

#include <filesystem>
#include <vector>

namespace deflect {

/// The head of a module's table of functions. It is checked that module and program are from the same build, so C++
/// types may be passed between them; exceptions may not.
struct ModuleHead {
  int interface;        ///< first member, so that it can always be read
  const char* version;  ///< of deflect
};

struct ModuleKind {
  const char* file;    ///< "deflect_gmsh.so"
  const char* symbol;  ///< name of the function that returns the table: const ModuleHead* (*)()
  int interface;       ///< the version that the program expects
};

/// Folders in which modules are searched, in order: the folder in the environment variable DEFLECT_PLUGIN_DIR, the
/// program's own folder, the library folder of the installation that the program belongs to, the one chosen when
/// deflect was configured, the folder above the program's (for tests in a build tree), and, where this code is in a
/// shared library (the package for Python), the folders above it and their library folders.
std::vector<std::filesystem::path> module_folders();

/// Loads the module from the first folder that has a matching one; it stays loaded. Throws ModelError with what was
/// found in each folder.
const ModuleHead& load_module(const ModuleKind&, const std::vector<std::filesystem::path>& folders = module_folders());

}  // namespace deflect
