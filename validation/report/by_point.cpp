#include "validation/report/by_point.h"
#include "msa/base/index.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace deflect::report {

std::vector<PointRows> by_point(const studies::Validation& validation) {
  if (validation.rows.empty()) throw std::invalid_argument("a validation without rows cannot be shown");
  std::vector<PointRows> points;
  for (const studies::ValidationRow& row : validation.rows) {
    if (row.axis < 0 || row.axis > 2)
      throw std::invalid_argument(fmt::format("point {}: load axis {} is not 0, 1 or 2", row.point.label, row.axis));
    const auto axis = as_size(row.axis);
    const bool same = !points.empty() && points.back().point->label == row.point.label && !points.back().rows[axis];
    if (!same) points.push_back({&row.point, {}});
    points.back().rows[axis] = &row;
  }
  return points;
}

std::string load_text(const studies::Validation& validation) {
  const auto& rows = validation.rows;
  const auto [low, high] =
      std::minmax_element(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.load_N < b.load_N; });
  if (low == rows.end()) return "no load";
  if (low->load_N == high->load_N) return fmt::format("{} N", low->load_N);
  return fmt::format("{} … {} N", low->load_N, high->load_N);
}

std::string errata_text(const studies::Validation& validation) {
  if (validation.as_printed.size() == errata().size()) return "all errata of the paper";
  std::string list;
  for (const Erratum erratum : validation.as_printed)
    list += (list.empty() ? "errata " : ", ") + std::string(info(erratum).name);
  return list.empty() ? "errata" : list;
}

bool has_as_printed(const studies::Validation& validation) {
  return std::any_of(validation.rows.begin(), validation.rows.end(),
                     [](const studies::ValidationRow& row) { return row.as_printed.has_value(); });
}

}  // namespace deflect::report
