// Residuals reading by reading and pose by pose, and what they would look like with nothing missing, as data of a page.
#pragma once

#include "validation/compare/comparison.h"
#include "validation/json/json_text.h"

namespace deflect::page {

/// {"device", "result": compare_json, "unit": "mm" (or "rad" where only rotations were measured),
///  "poses": [{"label", "at_mm", "rmse", "bias": [3], "with_nothing_missing": [three rmse]}],
///  "readings": [{"line", "pose", "sequence", "load_N_Nmm", "measured", "predicted", "residual", "notes"}],
///  "readings_left_out", "note_columns", "curves": [{"site", "rotation", "force", "elongation", "deviation"}]}
/// in mm, rad, N, Nmm, base axes; curves in N and mm or Nmm and rad. A residual with nothing missing is drawn by lot
/// from noise, tolerances and the error of loads: the same three draws every time. Of more than
/// `most_readings` the first.
Json residuals_json(const compare::Comparison&, std::size_t most_readings);

}  // namespace deflect::page
