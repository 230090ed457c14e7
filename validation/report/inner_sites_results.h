// The places inside a frame through which force passes, in reports: what statics alone determines and what the model
// shares out, and what each would have to yield.
#pragma once

#include <string>

#include "validation/compare/comparison.h"
#include "validation/json/json_text.h"

namespace deflect::report {

/// Empty for a subject without such places.
std::string inner_sites_text(const compare::Comparison&);

/// {"reading_line", "sites": [{"name", "determined_by": "statics" | "model", "redundancy", "largest_force",
/// "force_unit", "yields_per_force", "deviation", "yield_unit", "chi2_gain", "p_value", "share_of_misfit"}],
/// "residual_forces": [{"name", "predicted", "more_than_predicted", "unit"}]}: N and mm, Nmm and rad. Null without.
Json inner_sites_json(const compare::Comparison&);

}  // namespace deflect::report
