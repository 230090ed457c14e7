// The history of a device or frame in versions as a report for a person, JSON and a table.
#pragma once

#include <string>

#include "validation/compare/history.h"

namespace deflect::report {

/// One row per device, in order: rms of fitted and held-out poses, χ², what noise and tolerances give, tests that fail,
/// findings, tolerances beyond two standard deviations. The deformed shape that linear devices leave out, and readings
/// set aside, have columns where they matter.
std::string history_report(const compare::History&);
std::string history_json(const compare::History&);
std::string history_csv(const compare::History&);

}  // namespace deflect::report
