#include "msa/base/module.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <system_error>

#include "msa/base/error.h"

namespace deflect {
namespace fs = std::filesystem;
namespace {

/// The module, or null and why not.
const ModuleHead* try_load(const ModuleKind& kind, const fs::path& file, std::string& reason) {
  std::error_code error;
  if (!fs::exists(file, error)) {
    reason = error ? error.message() : "no such file";
    return nullptr;
  }
  void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const said = ::dlerror();
    reason = said != nullptr ? said : "cannot be loaded";
    return nullptr;
  }
  using Entry = const ModuleHead* (*)();
  const auto entry = reinterpret_cast<Entry>(::dlsym(library, kind.symbol));
  const ModuleHead* const module = entry != nullptr ? entry() : nullptr;
  if (module != nullptr && module->interface == kind.interface && module->version == std::string(DEFLECT_VERSION))
    return module;
  reason = module == nullptr ? "is not a module of deflect" : "belongs to another version of deflect";
  ::dlclose(library);
  return nullptr;
}

/// Folders above the shared library that this code is part of, if any: a package for Python may lie below the build
/// tree or below a prefix that the interpreter does not.
std::vector<fs::path> above_the_library(const fs::path& program) {
  Dl_info here{};
  std::error_code error;
  if (::dladdr(reinterpret_cast<void*>(&try_load), &here) == 0 || here.dli_fname == nullptr) return {};
  const std::string name = here.dli_fname;  // of a program as it was called, maybe without its folder
  const fs::path library = fs::absolute(name, error);
  if (error || name.find('/') == name.npos || fs::equivalent(library, program, error) || error) return {};
  std::vector<fs::path> folders;
  for (fs::path each = library.parent_path(); each != each.root_path(); each = each.parent_path())
    for (const fs::path& folder : {each, each / DEFLECT_LIBDIR / "deflect"})
      if (fs::exists(folder, error)) folders.push_back(folder);
  return folders;
}

}  // namespace

std::vector<fs::path> module_folders() {
  std::vector<fs::path> folders;
  std::error_code error;
  if (const char* const chosen = std::getenv("DEFLECT_PLUGIN_DIR"); chosen != nullptr && *chosen != 0)
    folders.push_back(fs::absolute(chosen, error));
  const fs::path program = fs::read_symlink("/proc/self/exe", error), own = program.parent_path();
  if (!own.empty()) {
    folders.push_back(own);
    folders.push_back((own.parent_path() / DEFLECT_LIBDIR / "deflect").lexically_normal());
  }
  folders.emplace_back(fs::path(DEFLECT_FULL_LIBDIR) / "deflect");
  if (!own.empty()) folders.push_back(own.parent_path());
  for (fs::path& folder : above_the_library(program)) folders.push_back(std::move(folder));
  return folders;
}

const ModuleHead& load_module(const ModuleKind& kind, const std::vector<fs::path>& folders) {
  std::string tried;
  for (const fs::path& folder : folders) {
    std::string reason;
    if (const ModuleHead* const module = try_load(kind, folder / kind.file, reason)) return *module;
    tried += fmt::format("\n  {}: {}", (folder / kind.file).string(), reason);
  }
  throw ModelError(
      fmt::format("the module {} cannot be loaded; set DEFLECT_PLUGIN_DIR to its folder, or install deflect again "
                  "together with the libraries it needs. Looked at:{}",
                  kind.file, tried.empty() ? " no folder" : tried));
}

}  // namespace deflect
