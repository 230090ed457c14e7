#include "validation/report/compare_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "msa/base/index.h"
#include "validation/json/json_text.h"
#include "validation/report/compare_words.h"
#include "validation/report/inner_sites_results.h"
#include "validation/report/short_lists.h"
#include "validation/report/text.h"
#include "validation/report/verdict_words.h"

namespace deflect::report {
namespace {

constexpr std::size_t most_poses = 12, poses_of_many = 10;  // in the report

std::string p_text(double p) { return p < 1e-16 ? "< 1e-16" : fmt::format("{:.2g}", p); }

std::string findings_text(const compare::Comparison& c) {
  const char* unit = error_unit(c).micro;
  const double fine = error_unit(c).fine;
  std::string out;
  int number = 0;
  for (const compare::Finding& f : c.findings) {
    out += fmt::format("  {}. {}.\n", ++number, f.sentence);
    out += fmt::format("     {:.2f} {} rms of the readings, {:.0f} % of the misfit beyond noise, p {}{}\n",
                       fine * f.size, unit, 100 * f.share, p_text(f.p_value),
                       f.instead.empty() ? "" : fmt::format("; nearly as well: {}", fmt::join(f.instead, ", ")));
  }
  if (!c.findings.empty())
    out += fmt::format(
        "  After that the misfit is {:.2f} times what noise and tolerances give (chi2 per degree of freedom).\n",
        c.unexplained_chi2_per_dof);
  if (c.deformed_shape_fit && c.deformed_shape > 0.02 * c.sigma_u)
    out += fmt::format(
        "  Equilibrium in the deformed shape, which this linear device leaves out, is taken into account: {:.2f} {} "
        "rms; the data ask for {:.2f} ± {:.2f} times that.\n",
        fine * c.deformed_shape, unit, c.deformed_shape_fit->amplitude(0),
        std::sqrt(c.deformed_shape_fit->covariance(0, 0)));
  return out;
}

/// In the unit of the table; those of another quantity with their own.
void add_rows(std::vector<std::vector<std::string>>& rows, const std::vector<compare::Errors>& groups,
              measurement::Quantity quantity) {
  for (const compare::Errors& e : groups) {
    const double fine = fine_of(e.quantity);
    rows.push_back({e.quantity == quantity ? "  " + e.group : fmt::format("  {} ({})", e.group, fine_unit(e.quantity)),
                    std::to_string(e.readings), fmt::format("{:.2f}", fine * e.rmse)});
    for (std::size_t k = 0; k < 3; ++k)
      rows.back().push_back(e.measured_along[k] ? fmt::format("{:.2f}", fine * e.bias(as_index(k))) : "–");
    rows.back().push_back(fmt::format("{:.2f}", fine * e.worst));
    rows.back().push_back(std::to_string(e.worst_line));
  }
}

/// Of more poses than a person reads, the worst in descending order.
std::vector<compare::Errors> poses_shown(const std::vector<compare::Errors>& by_pose) {
  if (by_pose.size() <= most_poses) return by_pose;
  std::vector<compare::Errors> worst = by_pose;
  std::stable_sort(worst.begin(), worst.end(),
                   [](const compare::Errors& a, const compare::Errors& b) { return a.rmse > b.rmse; });
  worst.resize(poses_of_many);
  return worst;
}

std::string errors_table(const compare::Comparison& c) {
  std::vector<std::vector<std::string>> rows = {{fmt::format("measured − predicted, {}", error_unit(c).micro),
                                                 "readings", "rms", "mean x", "mean y", "mean z", "worst", "in line"}};
  compare::Errors all = c.all;
  all.group = "all";
  const measurement::Quantity quantity = error_unit(c).quantity;
  add_rows(rows, {all}, quantity);
  for (const auto* groups : {&c.by_axis, &c.by_direction, &c.by_magnitude, &c.by_heading})
    add_rows(rows, *groups, quantity);
  const std::vector<compare::Errors> shown = poses_shown(c.by_pose);
  if (c.study.standing->has_tool_point() || shown.size() > 1) add_rows(rows, shown, quantity);
  std::string out = aligned(rows);
  if (shown.size() < c.by_pose.size())
    out += fmt::format("  these poses are the worst; {} more are in the files of --json and --out\n",
                       c.by_pose.size() - shown.size());
  return out;
}

std::string tests_table(const compare::Comparison& c) {
  const char* unit = error_unit(c).micro;
  const double fine = error_unit(c).fine;
  std::vector<std::vector<std::string>> rows = {{"tests without a model of what is missing", "numbers", unit, "p"}};
  for (const compare::ContrastTest& t : c.contrasts)
    rows.push_back(
        t.contrasts == 0
            ? std::vector<std::string>{fmt::format("  {}: {}", t.id, t.question), "0", "–", "needs " + t.missing}
            : std::vector<std::string>{fmt::format("  {}: {}", t.id, t.question), std::to_string(t.contrasts),
                                       fmt::format("{:.2f}", fine * t.size),
                                       p_text(t.p_value) + (t.p_value < significant ? " *" : "")});
  rows.push_back({"patterns, each alone", "columns", unit, "p"});
  for (const compare::PatternTest& t : c.patterns)
    rows.push_back({fmt::format("  {}: {}", t.pattern, t.title), std::to_string(t.alone.freedoms),
                    fmt::format("{:.2f}", fine * t.size),
                    p_text(t.alone.p_value) + (t.alone.p_value < significant ? " *" : "")});
  return aligned(rows);
}

Json errors_json(const std::vector<compare::Errors>& groups) {
  Json out = Json::array();
  for (const compare::Errors& e : groups) {
    const double coarse = measurement::row_of(e.quantity).coarse_per_SI;
    out.push_back({{"group", e.group},
                   {"readings", e.readings},
                   {"unit", measurement::row_of(e.quantity).coarse},
                   {"rmse_mm", json::json_number(coarse * e.rmse, "rmse")},
                   {"bias_mm", {coarse * e.bias.x(), coarse * e.bias.y(), coarse * e.bias.z()}},
                   {"worst_mm", json::json_number(coarse * e.worst, "worst")},
                   {"worst_line", e.worst_line}});
  }
  return out;
}

std::vector<double> list_of(const VectorX& x) { return {x.data(), x.data() + x.size()}; }

Json baseline_json(const compare::Comparison& c) {
  const double coarse = error_unit(c).coarse;
  return {{"rmse_mm", json::json_number(coarse * c.all.rmse, "rmse")},
          {"held_out_rmse_mm", json::json_number(coarse * c.held_out, "held-out rmse")},
          {"chi2_per_dof", json::json_number(c.chi2_per_dof, "chi2")},
          {"p_value", c.p_value},
          {"measured_rms_mm", coarse * c.all.measured},
          {"worst_mm", coarse * c.all.worst}};
}

Json findings_json(const std::vector<compare::Finding>& findings, double coarse) {
  Json out = Json::array();
  for (const compare::Finding& f : findings)
    out.push_back({{"pattern", f.pattern},
                   {"sentence", f.sentence},
                   {"columns", f.columns},
                   {"amplitude_SI", list_of(f.amplitude)},
                   {"deviation_SI", list_of(f.deviation)},
                   {"unit_SI", f.unit},
                   {"size_mm", coarse * f.size},
                   {"share_of_misfit", f.share},
                   {"chi2_gain", f.gain},
                   {"p_value", f.p_value},
                   {"instead", f.instead}});
  return out;
}

Json contrasts_json(const std::vector<compare::ContrastTest>& tests, double coarse) {
  Json out = Json::array();
  for (const compare::ContrastTest& t : tests) {
    Json test = {{"test", t.id}, {"question", t.question}, {"numbers", t.contrasts}};
    if (t.contrasts > 0)
      test["size_mm"] = coarse * t.size, test["p_value"] = t.p_value;
    else
      test["needs"] = t.missing;
    out.push_back(test);
  }
  return out;
}

Json patterns_json(const std::vector<compare::PatternTest>& tests, double coarse) {
  Json out = Json::array();
  for (const compare::PatternTest& t : tests)
    out.push_back({{"pattern", t.pattern},
                   {"title", t.title},
                   {"size_mm", coarse * t.size},
                   {"chi2_gain", t.alone.gain},
                   {"columns", t.alone.freedoms},
                   {"p_value", t.alone.p_value}});
  return out;
}

/// By how much one standard deviation of a tolerance moves the readings, root mean square over those of the quantity of
/// errors, SI: those of all poses, the largest first.
std::vector<std::pair<std::string, double>> sizes_of_tolerances(const compare::Comparison& c) {
  const measurement::Quantity quantity = error_unit(c).quantity;
  const MatrixX& A = c.tolerances.A.shared;
  std::vector<std::pair<std::string, double>> out;
  for (Eigen::Index k = 0; k < A.cols(); ++k) {
    const subject::Tolerance& tolerance = nth(c.tolerances.nuisances, k);
    if (tolerance.zero) continue;
    double square = 0, count = 0;
    for (Eigen::Index i = 0; i < A.rows(); ++i)
      if (nth(c.study.values, i).quantity == quantity) square += A(i, k) * A(i, k), ++count;
    out.emplace_back(tolerance.name, std::sqrt(square / std::max(1.0, count)));
  }
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return out;
}

/// "leg 2 motor rz stiffness 1.20 µm, modulus 0.84 µm": the largest.
std::string tolerances_that_matter(const compare::Comparison& c) {
  const double fine = error_unit(c).fine;
  std::string out;
  const auto all = sizes_of_tolerances(c);
  for (std::size_t i = 0; i < std::min<std::size_t>(3, all.size()); ++i)
    out += fmt::format("{}{} {:.2f} {}", i > 0 ? ", " : "", all[i].first, fine * all[i].second, error_unit(c).micro);
  return out;
}

Json tolerances_json(const compare::Comparison& c) {
  const double coarse = error_unit(c).coarse;
  Json out = Json::array();
  for (const auto& [name, rms] : sizes_of_tolerances(c))
    out.push_back({{"name", name}, {"rms_mm", json::json_number(coarse * rms, "tolerance")}});
  return out;
}

/// Of a channel whose σ nobody tells.
struct EstimatedNoise {
  std::string channel;
  double sigma = 0;  // SI
  const measurement::QuantityRow* row = nullptr;
};

std::vector<EstimatedNoise> estimated_noise(const compare::Comparison& c) {
  std::vector<EstimatedNoise> out;
  std::set<std::string> named;
  for (std::size_t i = 0; i < c.study.values.size(); ++i) {
    const measurement::MeasuredValue& v = c.study.values[i];
    if (!c.estimated[i]) continue;
    const measurement::QuantityRow& row = measurement::row_of(v.quantity);
    std::string name = v.of_tool_point() ? row.what : measurement::channel_name(*c.study.data, v.channel);
    if (named.insert(name).second) out.push_back({std::move(name), c.sigma[i], &row});
  }
  return out;
}

}  // namespace

std::string compare_report(const compare::Comparison& c) {
  const char* unit = error_unit(c).micro;
  const double fine = error_unit(c).fine;
  std::string out = fmt::format("{} against {}: {}{}\n\n{}\n", c.device, c.data, counted(c.readings, "reading"),
                                poses_words(c), verdict_words(c));
  const std::string found = findings_text(c);
  if (!found.empty()) out += "\n" + found;
  for (std::size_t i = compare::is_mistaken(c) ? 1 : 0; i < c.mistakes.size(); ++i)  // the headline has been said
    out += fmt::format("\n  {}\n", c.mistakes[i].sentence);
  out += how_read_text(c.study.data->how_read);
  out += fmt::format(
      "\nresidual {:.2f} {} rms (held-out poses {:.2f}), σ of a reading {:.2f} {}{}, noise and tolerances {:.2f} {}, "
      "chi2 per degree of freedom {:.2f}\n",
      fine * c.all.rmse, unit, fine * c.held_out, fine * c.sigma_u, unit,
      c.sigma_from_residuals ? " (from the residuals: neither σ nor replicates in the file)" : "",
      fine * c.noise_and_tolerances, unit, c.chi2_per_dof);
  if (const std::vector<EstimatedNoise> all = estimated_noise(c); !all.empty()) {
    std::vector<std::string> words;
    for (const EstimatedNoise& each : all)
      words.push_back(fmt::format("{} {:.3g} {}", each.channel, each.sigma * each.row->fine_per_SI, each.row->fine));
    out += fmt::format("σ where nobody tells it, by what no pattern explains: {}\n", fmt::join(words, ", "));
  }
  if (c.pure_error)
    out += fmt::format("replicates scatter by {:.2f} {} ({} degrees of freedom)\n", fine * c.pure_error->sigma, unit,
                       c.pure_error->degrees_of_freedom);
  out += in_play_words(c.study.load_errors.readings_in_play(), c.readings);
  if (!c.set_aside.empty())
    out += fmt::format("set aside as gross outliers: {}, {} {}\n", counted(c.set_aside.size(), "reading"),
                       c.set_aside.size() == 1 ? "line" : "lines", fmt::join(c.set_aside, ", "));
  if (const std::string matter = tolerances_that_matter(c); !matter.empty())
    out += fmt::format("tolerances that matter most, by what one standard deviation moves: {}\n", matter);
  if (!c.strained.empty())
    out +=
        fmt::format("tolerances alone would have to be off, in standard deviations: {}\n", strained_words(c.strained));
  if (const std::string inside = inner_sites_text(c); !inside.empty()) out += "\n" + inside;
  return out + "\n" + tests_table(c) + "\n" + errors_table(c);
}

std::string compare_json(const compare::Comparison& c) {
  const double coarse = error_unit(c).coarse;
  Json j;
  j["kind"] = "comparison";
  j["device"] = c.device;
  j["data"] = c.data;
  j["readings"] = c.readings;
  j["poses"] = c.poses;
  j["unit"] = error_unit(c).milli;  // of what ends with _mm
  j["baseline"] = baseline_json(c);
  j["noise_floor_mm"] = json::json_number(coarse * c.noise_and_tolerances, "noise floor");
  j["sigma_u_mm"] = coarse * c.sigma_u;
  j["sigma_from_residuals"] = c.sigma_from_residuals;
  for (const EstimatedNoise& each : estimated_noise(c))
    j["noise_estimated"].push_back(
        {{"channel", each.channel}, {"sigma", each.sigma * each.row->per_SI}, {"unit", each.row->unit}});
  if (c.pure_error)
    j["pure_error"] = {{"sigma_mm", coarse * c.pure_error->sigma},
                       {"degrees_of_freedom", c.pure_error->degrees_of_freedom}};
  j["verdict"] = verdict_words(c);
  j["notes"] = c.study.data->how_read;
  j["findings"] = findings_json(c.findings, coarse);
  j["unexplained_chi2_per_dof"] = json::json_number(c.unexplained_chi2_per_dof, "unexplained chi2");
  if (c.deformed_shape_fit)
    j["deformed_shape"] = {{"size_mm", coarse * c.deformed_shape},
                           {"amplitude", c.deformed_shape_fit->amplitude(0)},
                           {"deviation", std::sqrt(c.deformed_shape_fit->covariance(0, 0))}};
  j["tests"] = contrasts_json(c.contrasts, coarse);
  j["patterns"] = patterns_json(c.patterns, coarse);
  j["errors"] = {{"by_axis", errors_json(c.by_axis)},
                 {"by_pose", errors_json(c.by_pose)},
                 {"by_direction", errors_json(c.by_direction)},
                 {"by_magnitude", errors_json(c.by_magnitude)},
                 {"by_heading", errors_json(c.by_heading)}};
  j["tolerances"] = tolerances_json(c);
  j["strained_tolerances"] = strained_json(c.strained);
  j["looks_like"] = Json::array();
  for (const compare::RecordingMistake& mistake : c.mistakes) j["looks_like"].push_back(mistake.sentence);
  j["mistakes"] = mistakes_json(c.mistakes);
  if (Json inside = inner_sites_json(c); !inside.is_null()) j["inside"] = std::move(inside);
  j["set_aside_lines"] = c.set_aside;
  j["in_play"] = c.study.load_errors.readings_in_play();
  return json::json_text(j);
}

std::string residuals_csv(const compare::Comparison& c) {
  const compare::ResidualStudy& s = c.study;
  std::string out = "line,pose,component,unit,measured,predicted,residual,sigma\n";
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    const measurement::MeasuredValue& v = s.values[i];
    const measurement::Reading& r = s.data->readings[v.reading];
    const measurement::QuantityRow& row = measurement::row_of(v.quantity);
    const double unit = row.per_SI;
    const double residual = c.residual(as_index(i));
    out += fmt::format("{},{},{},{},{:.9g},{:.9g},{:.9g},{:.4g}\n", r.line, csv_cell(s.data->poses[r.pose].label),
                       csv_cell(measurement::channel_name(*s.data, v.channel)), row.unit, unit * v.value,
                       unit * (v.value - residual), unit * residual, unit * c.sigma[i]);
  }
  return out;
}

std::string errors_csv(const compare::Comparison& c) {
  std::string out = fmt::format("group,readings,rmse_{0},mean_x_{0},mean_y_{0},mean_z_{0},worst_{0},worst_line\n",
                                error_unit(c).column);
  const measurement::Quantity quantity = error_unit(c).quantity;
  compare::Errors all = c.all;
  all.group = "all";
  std::vector<compare::Errors> rows = {all};
  for (const auto* groups : {&c.by_axis, &c.by_direction, &c.by_magnitude, &c.by_heading, &c.by_pose})
    rows.insert(rows.end(), groups->begin(), groups->end());
  for (const compare::Errors& e : rows) {
    const double fine = fine_of(e.quantity);
    const std::string name =
        e.quantity == quantity ? e.group : fmt::format("{} ({})", e.group, measurement::row_of(e.quantity).fine_column);
    out += fmt::format("{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{}\n", csv_cell(name), e.readings, fine * e.rmse,
                       fine * e.bias.x(), fine * e.bias.y(), fine * e.bias.z(), fine * e.worst, e.worst_line);
  }
  return out;
}

std::string tests_csv(const compare::Comparison& c) {
  const double fine = error_unit(c).fine;
  std::string out = fmt::format("kind,name,numbers,size_{},p_value\n", error_unit(c).column);
  for (const compare::ContrastTest& t : c.contrasts)
    out += fmt::format("contrast,{},{},{:.6g},{:.6g}\n", t.id, t.contrasts, fine * t.size, t.p_value);
  for (const compare::PatternTest& t : c.patterns)
    out += fmt::format("pattern,{},{},{:.6g},{:.6g}\n", t.pattern, t.alone.freedoms, fine * t.size, t.alone.p_value);
  return out;
}

}  // namespace deflect::report
