#include "validation/report/validation_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "msa/base/error.h"
#include "validation/json/json_text.h"
#include "validation/measurement/column_names.h"
#include "validation/report/by_point.h"
#include "validation/report/text.h"
#include "validation/report/theory_words.h"

namespace deflect::report {
namespace {

/// 7 for "7"; text for "P7", "007" and "+7", which an integer would not give back.
Json json_label(const std::string& label) {
  long long number = 0;
  const auto [end, error] = std::from_chars(label.data(), label.data() + label.size(), number);
  if (error == std::errc() && end == label.data() + label.size() && std::to_string(number) == label) return number;
  return label;
}

std::string csv_text(const std::string& text) {
  if (!text.empty() && text.find_first_of(",;\"\r\n") == std::string::npos && text.front() != ' ' && text.back() != ' ')
    return text;
  return csv_cell(text);
}

std::string csv_number(double value, const std::string& what) {
  if (!std::isfinite(value)) throw NumericalError(fmt::format("result '{}' is {}, not a number to write", what, value));
  return fmt::format("{}", value);
}

std::string row_name(const studies::ValidationRow& row) {
  return fmt::format("point {}, load along {}", row.point.label, axis_names[row.axis]);
}

std::string millimetres(const studies::ValidationRow* row, std::size_t theory) {
  return row ? fmt::format("{:.6f}", row->displacements[theory][row->axis]) : "–";
}

std::string difference(double value) { return fmt::format("{:.1e}", value); }

std::vector<std::vector<std::string>> by_theory(const studies::Validation& validation,
                                                const std::vector<PointRows>& points) {
  const bool several = validation.theories.size() > 1;
  std::vector<std::vector<std::string>> lines = {{"point"}};
  for (const theories::Theory* theory : validation.theories)
    for (const char* axis : axis_names) lines.front().push_back(fmt::format("{} {}", theory->title, axis));
  if (several) lines.front().push_back("difference");
  for (const PointRows& p : points) {
    std::vector<std::string> line = {p.point->label};
    for (std::size_t t = 0; t < validation.theories.size(); ++t)
      for (const studies::ValidationRow* row : p.rows) line.push_back(millimetres(row, t));
    double largest = 0;
    for (const studies::ValidationRow* row : p.rows)
      if (row && (std::isnan(row->relative_difference) || row->relative_difference > largest))
        largest = row->relative_difference;  // nothing is larger than a NaN, so it stays
    if (several) line.push_back(difference(largest));
    lines.push_back(line);
  }
  return lines;
}

std::vector<std::vector<std::string>> with_printed(const studies::Validation& validation,
                                                   const std::vector<PointRows>& points) {
  const std::size_t corrected = theories::place_of(validation.theories, "analytic");
  const bool several = validation.theories.size() > 1;
  std::vector<std::vector<std::string>> lines = {{"point", "load", "as printed"}};
  for (std::size_t t = 0; t < validation.theories.size(); ++t)
    lines.front().push_back(t == corrected ? "corrected" : validation.theories[t]->title);
  lines.front().push_back("corrected/printed");
  if (several) lines.front().push_back("difference");
  for (const PointRows& p : points)
    for (const studies::ValidationRow* row : p.rows) {
      if (!row) continue;
      const double printed = row->as_printed ? (*row->as_printed)[row->axis] : 0;
      std::vector<std::string> line = {p.point->label, axis_names[row->axis],
                                       row->as_printed ? fmt::format("{:.6f}", printed) : "–"};
      for (std::size_t t = 0; t < validation.theories.size(); ++t) line.push_back(millimetres(row, t));
      line.push_back(printed != 0 ? fmt::format("{:.3f}", row->displacements[corrected][row->axis] / printed) : "–");
      if (several) line.push_back(difference(row->relative_difference));
      lines.push_back(line);
    }
  return lines;
}

}  // namespace

std::string validation_json(const studies::Validation& validation, const std::vector<studies::ErratumPrice>& prices,
                            const std::vector<studies::MeshStudyRow>& mesh) {
  Json points = Json::array();
  for (const studies::ValidationRow& row : validation.rows) {
    const std::string name = row_name(row);
    Json entry;
    entry["point"] = json_label(row.point.label);
    entry["pose"] = json::json_numbers(row.point.pose_mm_deg, name + ", pose");
    entry["load_axis"] = axis_names[row.axis];
    entry["load_N"] = json::json_number(row.load_N, name + ", load_N");
    for (std::size_t t = 0; t < row.displacements.size(); ++t) {
      const std::string& theory = validation.theories[t]->name;
      entry[theory] = json::json_numbers(row.displacements[t], name + ", " + theory);
    }
    if (row.as_printed) entry["as_printed"] = json::json_numbers(*row.as_printed, name + ", as_printed");
    points.push_back(std::move(entry));
  }
  Json result;
  result["kind"] = "validation";
  result["device"] = validation.device;
  result["theories"] = json_theories(validation.theories);
  result["points"] = std::move(points);
  if (validation.theories.size() > 1) {
    result["max_relative_difference"] =
        json::json_number(validation.max_relative_difference, "max_relative_difference");
    result["rms_relative_difference"] =
        json::json_number(validation.rms_relative_difference, "rms_relative_difference");
  }
  for (const studies::ErratumPrice& p : prices) {
    Json price = {{"erratum", info(p.erratum).name}, {"equations", info(p.erratum).equations}};
    for (int axis = 0; axis < 3 && p.refused.empty(); ++axis) {
      price["smallest"].push_back(std::isfinite(p.smallest(axis)) ? Json(p.smallest(axis)) : Json());
      price["largest"].push_back(std::isfinite(p.largest(axis)) ? Json(p.largest(axis)) : Json());
    }
    if (!p.refused.empty()) price["refused"] = p.refused;
    price["failed_check"] = p.failed_check;
    result["errata"].push_back(std::move(price));
  }
  for (const studies::MeshStudyRow& row : mesh)
    result["mesh_study"].push_back(
        {{"element_mm", row.size_mm},
         {"elements_per_leg", row.elements},
         {"max_relative_difference", json::json_number(row.relative_difference, "mesh study")}});
  return json::json_text(result);
}

std::string validation_csv(const studies::Validation& validation) {
  const bool printed = has_as_printed(validation);
  std::string text = fmt::format("point,{},load_axis,load_N", fmt::join(measurement::pose_columns, ","));
  const bool several = validation.theories.size() > 1;
  std::vector<std::string> names;
  for (const theories::Theory* theory : validation.theories) names.push_back(theory->name);
  if (printed) names.push_back("as_printed");
  for (const std::string& name : names)
    for (const std::string& column : measurement::displacement_columns) text += fmt::format(",{}_{}", name, column);
  text += several ? ",relative_difference\n" : "\n";

  for (const studies::ValidationRow& row : validation.rows) {
    const std::string name = row_name(row);
    const auto numbers = [&](const Vector6& values, const std::string& what) {
      for (const double value : values) text.append(",").append(csv_number(value, name + ", " + what));
    };
    text += csv_text(row.point.label);
    numbers(row.point.pose_mm_deg, "pose");
    text += fmt::format(",{},{}", axis_names[row.axis], csv_number(row.load_N, name + ", load_N"));
    for (std::size_t t = 0; t < row.displacements.size(); ++t) numbers(row.displacements[t], names[t]);
    if (row.as_printed)
      numbers(*row.as_printed, "as_printed");
    else if (printed)
      text.append(6, ',');
    if (several) text += "," + csv_number(row.relative_difference, name + ", relative_difference");
    text += "\n";
  }
  return text;
}

std::string mesh_study_table(const std::vector<studies::MeshStudyRow>& rows) {
  std::string text = "Mesh: largest relative difference of the two theories as the elements shrink.\n";
  text += fmt::format("{:>12}  {:>16}  {:>10}\n", "element", "elements per leg", "difference");
  for (const studies::MeshStudyRow& row : rows)
    text += fmt::format("{:>9} mm  {:>16}  {:>10.2g}\n", row.size_mm, row.elements, row.relative_difference);
  return text;
}

std::string validation_table(const studies::Validation& validation) {
  const std::vector<PointRows> points = by_point(validation);
  const bool printed = has_as_printed(validation);
  std::string text = fmt::format("{}: deflection of the tool point along a load of {} in x, y, z (mm, base axes)\n",
                                 validation.device, load_text(validation));
  if (printed)
    text += fmt::format(
        "as printed: analytic theory with {}\n"
        "corrected/printed: how many times too stiff the theory is as printed\n",
        errata_text(validation));
  text.append("\n").append(aligned(printed ? with_printed(validation, points) : by_theory(validation, points)));
  if (validation.theories.size() < 2) return text;
  return text + fmt::format("\n{}, relative: largest {:.1e}, rms {:.1e}, {} cases\n", against_text(validation.theories),
                            validation.max_relative_difference, validation.rms_relative_difference,
                            validation.rows.size());
}

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
