// Structures that cannot stand, drawn.
#pragma once

#include <functional>
#include <string>

namespace deflect::cli {

/// Runs a command; where its structure cannot stand and `out` names a folder, each free motion is drawn there as
/// motion-1.vtu and motion-1.msh, … and the error that goes on says so.
void drawing_motions(const std::string& out, const std::function<void()>& run);

}  // namespace deflect::cli
