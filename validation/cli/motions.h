// Drawings of the free motions of structures that cannot stand.
#pragma once

#include <functional>
#include <string>

namespace deflect::cli {

/// Runs a command. If its structure cannot stand and `out` names a folder, draws each free motion there as motion-1.vtu
/// and motion-1.msh, … and rethrows the error with the names of the files.
void drawing_motions(const std::string& out, const std::function<void()>& run);

}  // namespace deflect::cli
