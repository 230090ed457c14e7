// A comparison as a report for a person, JSON and tables.
#pragma once

#include <string>

#include "validation/compare/comparison.h"

namespace deflect::report {

/// Verdict, findings in sentences, errors by group, tests.
std::string compare_report(const compare::Comparison&);

/// {"device", "data", "readings", "poses", "baseline": {"rmse_mm", "held_out_rmse_mm", "chi2_per_dof", …},
/// "findings": […], "tests": […], "patterns": […], "errors": {…}, "looks_like": […], "set_aside_lines": […], "in_play":
/// …}.
std::string compare_json(const compare::Comparison&);

/// Tables: a row per reading with measured, predicted, residual, its σ and the sites' forces; errors by group; tests.
std::string residuals_csv(const compare::Comparison&);
std::string errors_csv(const compare::Comparison&);
std::string tests_csv(const compare::Comparison&);

}  // namespace deflect::report
