// A fit of chosen parameters as a report for a person and as JSON.
#pragma once

#include <string>
#include <vector>

#include "validation/fit/fit.h"
#include "validation/json/json_text.h"

namespace deflect::report {

/// Values with intervals, priors and what the data do not determine; how the error fell, and what is left.
std::string fit_report(const fit::FitResult&);

/// A row for each parameter; an empty limit is none.
std::string parameters_csv(const fit::FitResult&);

/// {"kind": "fit", "device", "data", "parameters": [{"path", "unit", "value", "low95", "high95", "before", …}],
/// "correlation": [[…]], "undetermined": [{"sentence", "deviation"}], "before", "after": {"rmse_mm",
/// "held_out_rmse_mm", "chi2_per_dof"}, "posterior": {"names", "mean", "covariance"}, "discrepancy", "noise", …}: what
/// fit_file.h reads.
std::string fit_json(const fit::FitResult&);

/// "materials.steel.E = 201.3 (198.9 … 203.7) GPa" for each parameter: heads of the new file.
std::vector<std::string> fitted_words(const fit::FitResult&);

/// What a person should know before trusting the values: far from priors, misfit left, search not ended.
std::vector<std::string> fit_warnings(const fit::FitResult&);

/// [{"quantity", "share"}, …].
Json discrepancies_json(const std::vector<fit::Discrepancy>&);

}  // namespace deflect::report
