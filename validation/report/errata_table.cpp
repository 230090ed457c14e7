#include "validation/report/errata_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "validation/report/text.h"

namespace deflect::report {
namespace {

std::string range_text(double low, double high) {
  const std::string a = fmt::format("{:.4g}", low), b = fmt::format("{:.4g}", high);
  return a == b ? a : a + " ... " + b;
}

std::string in_a_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

std::string remark(const studies::ErratumPrice& p) {
  if (!p.refused.empty()) return "no solution";
  return p.failed_check.empty() ? "-" : p.failed_check.substr(0, p.failed_check.find(':'));
}

}  // namespace

std::string errata_table(const std::vector<studies::ErratumPrice>& prices) {
  std::vector<std::vector<std::string>> rows{{"erratum", "equations", "x", "y", "z", "check that fails"}};
  for (const studies::ErratumPrice& p : prices) {
    std::vector<std::string> row{info(p.erratum).name, info(p.erratum).equations};
    for (int axis = 0; axis < 3; ++axis)
      row.push_back(p.refused.empty() ? range_text(p.smallest(axis), p.largest(axis)) : "-");
    row.push_back(remark(p));
    rows.push_back(std::move(row));
  }
  std::string text =
      "Price of each erratum: deflection along the load as printed / corrected, smallest ... largest of "
      "the points.\n" +
      aligned(rows);
  for (const studies::ErratumPrice& p : prices)
    if (!p.refused.empty()) text += fmt::format("{}: {}\n", info(p.erratum).name, p.refused);
  return text;
}

std::string errata_csv(const std::vector<studies::ErratumPrice>& prices) {
  std::string csv = "erratum,equations";
  for (const char axis : {'x', 'y', 'z'}) csv += fmt::format(",ratio_{0}_min,ratio_{0}_max", axis);
  csv += ",failed_check,refused\n";
  for (const studies::ErratumPrice& p : prices) {
    csv += fmt::format("{},{}", info(p.erratum).name, csv_cell(info(p.erratum).equations));
    for (int axis = 0; axis < 3; ++axis)
      csv += p.refused.empty() ? fmt::format(",{},{}", p.smallest(axis), p.largest(axis)) : ",,";
    csv += fmt::format(",{},{}\n", csv_cell(in_a_line(p.failed_check)), csv_cell(in_a_line(p.refused)));
  }
  return csv;
}

}  // namespace deflect::report
