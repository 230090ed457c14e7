// The file of a changed device or frame that a command writes.
#pragma once

#include <string>
#include <vector>

#include "validation/subject/subject.h"

namespace deflect::cli {

/// Writes the changed subject whole or not at all. The name of the new one is its file's; what was done to `before`
/// ("with …") stands in its one line and, item by item, above all. What is written can be read, and stands.
void write_description(const subject::Subject& changed, const std::string& before, const std::string& done,
                       const std::vector<std::string>& items, const std::string& out);

}  // namespace deflect::cli
