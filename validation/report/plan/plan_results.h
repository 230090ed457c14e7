// Plans of measurements as a report for a person, JSON and a table.
#pragma once

#include <string>

#include "validation/json/json_text.h"
#include "validation/plan/next_readings.h"

namespace deflect::report {

/// The readings that tell the effects of a tie apart, what they promise, and what no reading can tell.
std::string plan_report(const plan::Plan&);
/// {"kind": "plan", "rivals": […], "readings": […], "steps": […], "inseparable": […], …}.
std::string plan_json(const plan::Plan&);
/// [{"pose", "at", "load", "how"}, …]: readings to be taken, in words.
Json planned_readings_json(const measurement::Measurements&);
/// Number of readings, expected probability, expected separations.
std::string plan_csv(const plan::Plan&);

}  // namespace deflect::report
