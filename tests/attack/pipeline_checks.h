// What the results of compare, diagnose and history must fulfil whatever was measured.
#pragma once

#include <vector>

#include "tests/attack/pipeline_run.h"
#include "validation/json/json_text.h"

namespace deflect::attack {

/// p-values and shares lie between 0 and 1, sizes are not negative, findings are there where something is missing.
void check_comparison(const Json&, std::vector<Contradiction>&);

/// Probabilities sum to one, the verdict is what missing, ties and the remainder say, what was found has values within
/// its interval and its bounds, and the misfit falls. `numbers`: how many were measured.
void check_diagnosis(const Json&, const subject::Subject&, double numbers, std::vector<Contradiction>&);

/// The device with what was found is as good as the diagnosis said. `noise_is_told`: by the data or the description.
void check_history(const Json& history, const Json& diagnosis, double numbers, bool noise_is_told,
                   std::vector<Contradiction>&);

}  // namespace deflect::attack
