// A diagnosis as a report for a person and as the JSON of the contract.
#pragma once

#include <string>

#include "validation/diagnosis/diagnosis.h"

namespace deflect::report {

/// Verdict in a sentence, candidates, what would change it, what this campaign cannot see.
std::string diagnosis_report(const diagnosis::Diagnosis&, const std::string& device, const std::string& data);

/// The candidates, a row for each of their values, then nothing and something unknown; an empty upper limit is none.
std::string candidates_csv(const diagnosis::Diagnosis&);

/// The smallest sizes that this campaign shows (λ = 4).
std::string detectable_csv(const diagnosis::Diagnosis&);

/// {"verdict", "missing", "candidates": [{"effect", "site", "leg" (where it is one), "probability", "parameters":
/// [{"name", "value", "low95", "high95", "at_least": true where there is no upper limit, high95 then being the
/// parameter's bound}], "rmse_mm", "held_out_rmse_mm", "chi2_per_dof"}], "indistinguishable", "baseline", "final",
/// "noise_floor_mm", "unit" (of what ends with _mm: mrad where rotations alone were measured), "unexplained":
/// {"significant", "share_of_misfit", "pattern"}, …}
std::string diagnosis_json(const diagnosis::Diagnosis&);

}  // namespace deflect::report
