#include "validation/report/history_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "validation/compare/placebo.h"
#include "validation/report/json_text.h"
#include "validation/report/text.h"

namespace deflect {
namespace {

constexpr double um = 1e6, mm = 1e3, significant = 1e-3;

std::vector<std::string> failing(const Comparison& c) {
  std::vector<std::string> out;
  for (const ContrastTest& t : c.contrasts)
    if (t.contrasts > 0 && t.p_value < significant) out.push_back(t.id);
  return out;
}

std::vector<std::string> found(const Comparison& c) {
  std::vector<std::string> out;
  for (const Finding& f : c.findings) out.push_back(f.pattern);
  return out;
}

/// Of a version but the first: what a placebo in its place would have reached, m.
std::optional<double> placebo(const std::vector<Comparison>& all, std::size_t i) {
  if (i == 0) return std::nullopt;
  return placebo_rmse(all[i - 1], all[i]);
}

}  // namespace

std::string history_report(const std::vector<Comparison>& all) {
  std::vector<std::vector<std::string>> rows = {{"device", "rms µm", "placebo", "held-out", "chi2/n",
                                                 "noise and tolerances", "strained", "tests that fail",
                                                 "patterns left"}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Comparison& c = all[i];
    const std::optional<double> wrong = placebo(all, i);
    const std::vector<std::string> tests = failing(c), patterns = found(c);
    rows.push_back({c.device, fmt::format("{:.2f}", um * c.all.rmse), wrong ? fmt::format("{:.2f}", um * *wrong) : "",
                    fmt::format("{:.2f}", um * c.held_out), fmt::format("{:.2f}", c.chi2_per_dof),
                    fmt::format("{:.2f}", um * c.noise_and_tolerances), std::to_string(c.strained.size()),
                    tests.empty() ? "none" : fmt::format("{}", fmt::join(tests, ", ")),
                    patterns.empty() ? "none" : fmt::format("{}", fmt::join(patterns, ", "))});
  }
  std::string out =
      fmt::format("{}: {} readings at {} poses\n\n", all.front().data, all.front().readings, all.front().poses) +
      aligned(rows);
  for (const Comparison& c : all) {
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

std::string history_json(const std::vector<Comparison>& all) {
  Json j;
  j["data"] = all.front().data;
  j["versions"] = Json::array();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Comparison& c = all[i];
    const std::optional<double> wrong = placebo(all, i);
    Json strained = Json::array();
    for (const auto& [name, eta] : c.strained) strained.push_back({{"name", name}, {"sigmas", eta}});
    j["versions"].push_back({{"device", c.device},
                             {"rmse_mm", json_number(mm * c.all.rmse, "rmse")},
                             {"placebo_rmse_mm", wrong ? json_number(mm * *wrong, "placebo") : Json()},
                             {"held_out_rmse_mm", json_number(mm * c.held_out, "held-out rmse")},
                             {"chi2_per_dof", json_number(c.chi2_per_dof, "chi2")},
                             {"noise_floor_mm", mm * c.noise_and_tolerances},
                             {"failing_tests", failing(c)},
                             {"patterns", found(c)},
                             {"strained_tolerances", strained}});
  }
  return json_text(j);
}

std::string history_csv(const std::vector<Comparison>& all) {
  std::string out = "device,rmse_um,placebo_rmse_um,held_out_rmse_um,chi2_per_dof,noise_and_tolerances_um,strained\n";
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Comparison& c = all[i];
    const std::optional<double> wrong = placebo(all, i);
    out += fmt::format("\"{}\",{:.6g},{},{:.6g},{:.6g},{:.6g},{}\n", c.device, um * c.all.rmse,
                       wrong ? fmt::format("{:.6g}", um * *wrong) : "", um * c.held_out, c.chi2_per_dof,
                       um * c.noise_and_tolerances, c.strained.size());
  }
  return out;
}

Figure history_figure(const std::vector<Comparison>& all) {
  std::string s = "$data << EOD\n", labels;
  double most = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::optional<double> wrong = placebo(all, i);
    s += fmt::format("{} {:.6g} {:.6g} {}\n", i, um * all[i].all.rmse, um * all[i].held_out,
                     wrong ? fmt::format("{:.6g}", um * *wrong) : "NaN");
    if (wrong) most = std::max(most, um * *wrong);
    labels += fmt::format("{}{} {}", i ? ", " : "", gnuplot_tic_label(clip(all[i].device, 28)), i);
    most = std::max({most, um * all[i].all.rmse, um * all[i].held_out});
  }
  const double floor = um * all.back().noise_and_tolerances;
  s += fmt::format(
      "EOD\nset label 100 'The error falling from version to version' at screen 0.02,0.955 left font 'DejaVu "
      "Sans:Bold,9'\n"
      "set lmargin at screen 0.11\nset rmargin at screen 0.97\nset tmargin at screen 0.86\nset bmargin at screen 0.14\n"
      "set xtics ({}) noenhanced\nset xrange [-0.6:{}]\nset yrange [0:{}]\nset ylabel 'rms of measured − predicted "
      "(µm)'\n"
      "set key at screen 0.97,0.925 right top horizontal Left reverse samplen 1.5 width -2 font 'DejaVu Sans,7'\nset "
      "boxwidth 0.24\nset style fill solid noborder\n"
      "plot $data using ($1-0.26):2 with boxes lc rgb '#0072B2' title 'all poses', "
      "'' using 1:3 with boxes lc rgb '#8CC4E8' title 'held-out poses', "
      "'' using ($1+0.26):4 with boxes lc rgb '#BBBBBB' title 'placebo in its place', "
      "{} with lines dt 2 lw 1.5 lc rgb '#D55E00' title 'noise and tolerances'",
      labels, static_cast<double>(all.size()) - 0.4, 1.1 * most, floor);
  return {"history", s, 160, 90};
}

}  // namespace deflect
