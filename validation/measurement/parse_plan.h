// Poses and loads to be measured, from text: as read_plan() of a file.
#pragma once

#include <string>

#include "validation/measurement/measurements.h"

namespace deflect::measurement {

/// `origin` takes the place of the file's name in messages.
Measurements parse_plan(std::string text, const std::string& origin, const Instruments& known = {});

}  // namespace deflect::measurement
