// A comparison, and the history of a device in versions, as a report for a person, JSON and tables.
#pragma once

#include <string>

#include "validation/compare/comparison.h"
#include "validation/compare/history.h"

namespace deflect::report {

/// Verdict, findings in sentences, errors by group, tests.
std::string compare_report(const compare::Comparison&);

/// {"device", "data", "readings", "poses", "baseline": {"rmse_mm", "held_out_rmse_mm", "chi2_per_dof", …},
/// "findings": […], "tests": […], "patterns": […], "errors": {…}, "looks_like": […], "set_aside_lines": […]}.
std::string compare_json(const compare::Comparison&);

/// Tables: a row per reading with measured, predicted, residual, its σ and the sites' forces; errors by group; tests.
std::string residuals_csv(const compare::Comparison&);
std::string errors_csv(const compare::Comparison&);
std::string tests_csv(const compare::Comparison&);

/// One row per device, in order: rms of fitted and held-out poses, χ², what noise and tolerances give, tests that fail,
/// findings, tolerances beyond two standard deviations.
std::string history_report(const compare::History&);
std::string history_json(const compare::History&);
std::string history_csv(const compare::History&);

}  // namespace deflect::report
