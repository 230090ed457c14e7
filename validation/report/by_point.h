// Rows of a validation gathered by point, as figures and tables show them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "validation/studies/validate.h"

namespace deflect::report {

inline constexpr const char* axis_names[] = {"x", "y", "z"};

/// One point and its row for a load in x, y, z; null where the validation has none.
struct PointRows {
  const studies::ValidationPoint* point = nullptr;
  std::array<const studies::ValidationRow*, 3> rows = {nullptr, nullptr, nullptr};
};

/// In the order of the rows; a label that comes again later, or an axis that comes twice, starts a new point.
/// The result points into `validation`. Throws std::invalid_argument when there are no rows or an axis is not
/// 0, 1, 2.
std::vector<PointRows> by_point(const studies::Validation& validation);

/// "50 N", or "20 … 50 N" where the rows differ.
std::string load_text(const studies::Validation& validation);

/// "errata passive-joints, tcp-transfer" for the set as_printed, "all errata of the paper" for all of them.
std::string errata_text(const studies::Validation& validation);

/// Whether any row carries the theory as printed.
bool has_as_printed(const studies::Validation& validation);

}  // namespace deflect::report
