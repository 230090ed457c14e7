// Poses and loads to be measured: from text, as read_plan() of a file, and with what is to be read.
#pragma once

#include <filesystem>
#include <string>

#include "validation/measurement/measurements.h"

namespace deflect::measurement {

/// `origin` takes the place of the file's name in messages.
Measurements parse_plan(std::string text, const std::string& origin, const Instruments& known = {});

/// The same with its channels: a displacement or sensor of which the file has a column, filled in or not, reads 0 in
/// every row; no other does.
Measurements parse_campaign(std::string text, const std::string& origin, const Instruments& known = {});
Measurements read_campaign(const std::filesystem::path&, const Instruments& known = {});

}  // namespace deflect::measurement
