// Predicted readings with intervals as a report for a person, JSON and a table.
#pragma once

#include <string>

#include "validation/fit/predicted.h"

namespace deflect::report {

/// Each number with its 95 % interval, every theory's value and the shares of the interval; of more than forty numbers
/// the first.
std::string predict_report(const fit::PredictedPlan&);

/// {"kind": "prediction", "device", "theories", "fitted", "noise_known", "numbers": [{"line", "pose", "channel",
/// "unit", "value", "low95", "high95", "analytic", "msa", "deviation": {"parameters", "tolerances", "load",
/// "discrepancy", "noise", "prediction", "reading"}}]}; numbers in "unit".
std::string predict_json(const fit::PredictedPlan&);

std::string predict_csv(const fit::PredictedPlan&);

}  // namespace deflect::report
