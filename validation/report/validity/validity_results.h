// A validation study as a report for a person, JSON and a table of single readings.
#pragma once

#include <string>

#include "validation/validity/validation.h"

namespace deflect::report {

/// The verdict in words: how large the errors and their uncertainty are, and whether a right model has such errors.
std::string validity_words(const validity::ValidationStudy&);

std::string validity_report(const validity::ValidationStudy&);

/// {"kind": "validity", "sentence", "agreement", "channels": [{"name", "unit", "rms_E", "u_num", …, "u", "bias"}],
/// "area", "domain", "without", "same", "calibration", "use", "maturity": [{"scheme", "element", "known"}],
/// "formulas"}.
std::string validity_json(const validity::ValidationStudy&);

/// A row for each measured number: S, D, E and its uncertainties.
std::string validity_csv(const validity::ValidationStudy&);

}  // namespace deflect::report
