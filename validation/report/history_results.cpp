#include "validation/report/history_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "validation/json/json_text.h"
#include "validation/report/compare_words.h"
#include "validation/report/short_lists.h"
#include "validation/report/text.h"

namespace deflect::report {
namespace {

/// Of the contrasts, those that noise does not explain.
std::vector<std::string> failing_tests(const compare::Comparison& c) {
  std::vector<std::string> out;
  for (const compare::ContrastTest& t : c.contrasts)
    if (t.contrasts > 0 && t.p_value < significant) out.push_back(t.id);
  return out;
}

/// The patterns of the findings.
std::vector<std::string> found_patterns(const compare::Comparison& c) {
  std::vector<std::string> out;
  for (const compare::Finding& f : c.findings) out.push_back(f.pattern);
  return out;
}

/// Whether χ² of some version counts the deformed shape for a twentieth or more.
bool shape_matters(const std::vector<compare::Comparison>& all) {
  return std::any_of(all.begin(), all.end(), [](const compare::Comparison& c) {
    return std::abs(c.chi2_per_dof - c.chi2_beside_shape) > 0.05 * c.chi2_beside_shape;
  });
}

using Cells = std::vector<std::string>;

/// A row for each version. What is left beside the deformed shape and what is set aside have columns where they matter.
std::vector<Cells> versions_table(const compare::History& h, bool shape) {
  const std::vector<compare::Comparison>& all = h.versions;
  const bool aside = std::any_of(all.begin(), all.end(), [](const auto& c) { return !c.set_aside.empty(); });
  std::vector<Cells> rows;
  const auto add = [&](Cells row, const Cells& of_shape, const std::string& of_aside, const Cells& rest) {
    if (shape) row.insert(row.end(), of_shape.begin(), of_shape.end());
    if (aside) row.push_back(of_aside);
    row.insert(row.end(), rest.begin(), rest.end());
    rows.push_back(std::move(row));
  };
  add({"device", fmt::format("rms {}", error_unit(all.front()).micro), "placebo", "held-out", "chi2/n"},
      {"deformed shape", "rms beside it", "chi2/n beside it"}, "set aside",
      {"noise and tolerances", "strained", "tests that fail", "patterns left"});
  const auto error = [fine = error_unit(all.front()).fine](double e) { return fmt::format("{:.2f}", fine * e); };
  const auto words = [](const Cells& names) {
    return names.empty() ? std::string("none") : fmt::format("{}", fmt::join(names, ", "));
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const compare::Comparison& c = all[i];
    add({c.device, error(c.all.rmse), h.placebo[i] ? error(*h.placebo[i]) : "", error(c.held_out),
         fmt::format("{:.2f}", c.chi2_per_dof)},
        {error(c.deformed_shape), error(c.kept_rmse), fmt::format("{:.2f}", c.chi2_beside_shape)},
        std::to_string(c.set_aside.size()),
        {error(c.noise_and_tolerances), std::to_string(c.strained.size()), words(failing_tests(c)),
         words(found_patterns(c))});
  }
  return rows;
}

}  // namespace

std::string history_report(const compare::History& h) {
  const std::vector<compare::Comparison>& all = h.versions;
  const bool shape = shape_matters(all);
  std::string out = fmt::format("{}: {}{}\n\n", all.front().data, counted(all.front().readings, "reading"),
                                poses_words(all.front())) +
                    aligned(versions_table(h, shape));
  if (shape)
    out +=
        "Linear devices leave out equilibrium in the deformed shape. It is known and no missing effect: what is left "
        "beside it is what diagnose explains.\n";
  for (const compare::Comparison& c : all) {
    std::vector<std::pair<std::string, double>> worst = c.strained;
    std::stable_sort(worst.begin(), worst.end(),
                     [](const auto& a, const auto& b) { return std::abs(a.second) > std::abs(b.second); });
    if (worst.empty()) continue;
    out += fmt::format("{}: beyond two standard deviations by itself:", c.device);
    for (std::size_t i = 0; i < std::min<std::size_t>(5, worst.size()); ++i)
      out += fmt::format("{} {} {:+.1f}", i ? "," : "", worst[i].first, worst[i].second);
    out += worst.size() > 5 ? fmt::format(" and {} more\n", worst.size() - 5) : "\n";
  }
  return out;
}

std::string history_json(const compare::History& h) {
  const std::vector<compare::Comparison>& all = h.versions;
  const double coarse = error_unit(all.front()).coarse;
  Json j;
  j["kind"] = "history";
  j["data"] = all.front().data;
  j["unit"] = error_unit(all.front()).milli;  // of what ends with _mm
  j["versions"] = Json::array();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const compare::Comparison& c = all[i];
    const std::optional<double> wrong = h.placebo[i];
    j["versions"].push_back({{"device", c.device},
                             {"rmse_mm", json::json_number(coarse * c.all.rmse, "rmse")},
                             {"placebo_rmse_mm", wrong ? json::json_number(coarse * *wrong, "placebo") : Json()},
                             {"held_out_rmse_mm", json::json_number(coarse * c.held_out, "held-out rmse")},
                             {"chi2_per_dof", json::json_number(c.chi2_per_dof, "chi2")},
                             {"deformed_shape_mm", json::json_number(coarse * c.deformed_shape, "deformed shape")},
                             {"kept_rmse_mm", json::json_number(coarse * c.kept_rmse, "rmse of what is kept")},
                             {"chi2_beside_deformed_shape", json::json_number(c.chi2_beside_shape, "chi2")},
                             {"set_aside_lines", c.set_aside},
                             {"noise_floor_mm", coarse * c.noise_and_tolerances},
                             {"failing_tests", failing_tests(c)},
                             {"patterns", found_patterns(c)},
                             {"strained_tolerances", strained_json(c.strained)}});
  }
  return json::json_text(j);
}

std::string history_csv(const compare::History& h) {
  const std::vector<compare::Comparison>& all = h.versions;
  const double fine = error_unit(all.front()).fine;
  std::string out = fmt::format(
      "device,rmse_{0},placebo_rmse_{0},held_out_rmse_{0},chi2_per_dof,noise_and_tolerances_{0},strained,"
      "deformed_shape_{0},kept_rmse_{0},chi2_beside_deformed_shape,set_aside\n",
      error_unit(all.front()).column);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const compare::Comparison& c = all[i];
    const std::optional<double> wrong = h.placebo[i];
    out += fmt::format("{},{:.6g},{},{:.6g},{:.6g},{:.6g},{},{:.6g},{:.6g},{:.6g},{}\n", csv_cell(c.device),
                       fine * c.all.rmse, wrong ? fmt::format("{:.6g}", fine * *wrong) : "", fine * c.held_out,
                       c.chi2_per_dof, fine * c.noise_and_tolerances, c.strained.size(), fine * c.deformed_shape,
                       fine * c.kept_rmse, c.chi2_beside_shape, c.set_aside.size());
  }
  return out;
}

}  // namespace deflect::report
