#include "validation/report/validity/validity_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/base/number_words.h"
#include "validation/json/json_text.h"
#include "validation/report/compare_words.h"
#include "validation/report/text.h"
#include "validation/report/validity/fit_results.h"

namespace deflect::report {
namespace {

using validity::ValidationStudy;

constexpr const char* formulas[] = {
    "E = S − D; u_val² = u_num² + u_input² + u_D²; the error of the model lies in E ± 2 u_val (ASME V&V 20-2009)",
    "u_num: elements of the MSA halved and halved again, extrapolated with the observed order, 1.25 |S − f*| / 1.15",
    "χ² = Eᵀ V⁻¹ E with the correlations that tolerances make; p: chance of so large a χ² where the model is right",
    "area: ∫|F_n(u) − u| du of u = F(D), 0 to 1/2 (Ferson, Oberkampf, Ginzburg 2008)",
    "bias δ, scatter σ_M of ln(S/D): the true value is S/δ (1 ± σ_M) (FDS Validation Guide; McGrattan, Toman 2011)",
};

std::string p_words(double p) { return p < 1e-16 ? "< 1e-16" : digits_of(p, 2); }

std::string channel_table(const ValidationStudy& s) {
  std::vector<std::vector<std::string>> rows = {{"quantity", "n", "mean E", "rms E", "u_num", "u_input", "u_D", "u_val",
                                                 "within 2 u_val", "p", "area", "bias δ", "σ_M"}};
  for (const validity::ChannelValidity& c : s.channels) {
    const double fine = fine_of(c.quantity);
    const auto number = [&](double x) { return with_minus(digits_of(fine * x, 3)); };
    rows.push_back({fmt::format("{} ({})", c.name, fine_unit(c.quantity)), std::to_string(c.numbers), number(c.mean_E),
                    number(c.rms_E), number(c.num), number(c.input), number(std::hypot(c.noise, c.load)), number(c.val),
                    fmt::format("{:.0f} %", 100 * c.within), p_words(c.agreement.p_value), digits_of(c.area, 2),
                    c.bias ? digits_of(c.bias->factor, 4) : "–",
                    c.bias ? fmt::format("{}{} %", c.bias->scatter_from_experiment ? "≤ " : "",
                                         digits_of(100 * c.bias->scatter, 2))
                           : "–"});
  }
  return aligned(rows);
}

std::string domain_table(const ValidationStudy& s) {
  std::vector<std::vector<std::string>> rows = {{"variable", "validated"}};
  if (s.use) rows.front().insert(rows.front().end(), {"used", ""});
  for (const validity::Range& r : s.domain) {
    const std::string unit = r.unit.empty() ? "" : " " + r.unit;
    rows.push_back({r.name, with_minus(fmt::format("{:.4g} … {:.4g}{}", r.low, r.high, unit))});
    if (!s.use) continue;
    rows.back().push_back(with_minus(fmt::format("{:.4g} … {:.4g}{}", r.use_low, r.use_high, unit)));
    rows.back().emplace_back(r.outside() ? "outside" : "");
  }
  return aligned(rows);
}

/// "at 25 mm outside the poses and 40 % outside the loads", or "inside the domain of validation".
std::string place_of(const ValidationStudy& s, const validity::UsePoint& p) {
  if (p.inside()) return "inside the domain of validation";
  const bool joints = s.use->predicted.plan.by_joints();
  std::string out;
  if (p.pose_distance > 0)
    out = joints ? fmt::format("{} of the joints' ranges outside the poses", digits_of(p.pose_distance, 2))
                 : fmt::format("{} mm outside the poses", digits_of(p.pose_distance, 2));
  if (p.load_distance > 0)
    out += fmt::format("{}{} % of the largest load outside the loads", out.empty() ? "" : ", ",
                       digits_of(100 * p.load_distance, 2));
  return out;
}

std::string use_text(const ValidationStudy& s) {
  if (!s.use) return "";
  const auto outside =
      std::count_if(s.use->points.begin(), s.use->points.end(), [](const auto& p) { return !p.inside(); });
  std::string out = fmt::format("\nUse: {} of {} points are outside the domain of validation{}\n", outside,
                                s.use->points.size(), outside ? "; there the intervals are an extrapolation." : ".");
  constexpr std::size_t most = 24;
  std::vector<std::vector<std::string>> rows = {{"line", "reading", "predicted", "95 % interval", "where"}};
  for (const fit::PredictedNumber& n : s.use->predicted.numbers) {
    if (rows.size() > most) break;
    const double fine = fine_of(n.quantity);
    rows.push_back({std::to_string(s.use->predicted.plan.readings[n.reading].line),
                    measurement::channel_name(s.use->predicted.plan, n.channel),
                    with_minus(fmt::format("{:.4g} {}", fine * n.value, fine_unit(n.quantity))),
                    with_minus(fmt::format("{:.4g} … {:.4g}", fine * n.low, fine * n.high)),
                    place_of(s, s.use->points[n.reading])});
  }
  out += aligned(rows);
  if (s.use->predicted.numbers.size() + 1 > rows.size())
    out += fmt::format("… and {} more: --json has all\n", s.use->predicted.numbers.size() + 1 - rows.size());
  return out;
}

std::string without_text(const ValidationStudy& s) {
  std::string out = "\nThe verdict without one group of readings:\n";
  std::size_t changes = 0;
  for (const validity::WithoutGroup& w : s.without) {
    if (!w.changes) continue;
    ++changes;
    out += fmt::format("  changes without {} {} ({}): p = {}\n", w.kind, w.name, counted(w.readings, "reading"),
                       p_words(w.agreement.p_value));
  }
  if (changes == 0)
    out +=
        fmt::format("  stays the same without any one of {} poses, load directions and sessions\n", s.without.size());
  return out;
}

std::string same_text(const ValidationStudy& s) {
  if (s.same.empty()) return "";
  std::vector<std::vector<std::string>> rows = {{"parameter", "the same at every", "groups", "p"}};
  for (const validity::Sameness& each : s.same)
    rows.push_back({each.parameter, each.kind, std::to_string(each.groups),
                    p_words(each.p_value) + (each.p_value < significant ? "  no" : "")});
  return "\n" + aligned(rows);
}

std::string calibration_text(const ValidationStudy& s) {
  if (!s.calibration)
    return s.calibrated ? ""
                        : "\nCalibration data: none given (--calibration). Data that a model was fitted to do not "
                          "validate it.\n";
  const double fine = error_unit(s.comparison).fine;
  return fmt::format("\nCalibration data: {}, {}, kept apart; rms E {} there, {} {} here{}\n", s.calibration->data,
                     counted(s.calibration->readings, "reading"), digits_of(fine * s.calibration->rms_E, 3),
                     digits_of(fine * s.calibration->validation_rms_E, 3), error_unit(s.comparison).micro,
                     s.calibration->poses_shared
                         ? fmt::format("; {} of its poses are poses of the validation too", s.calibration->poses_shared)
                         : "");
}

std::string maturity_text(const ValidationStudy& s) {
  std::string out = "\nMaturity: what this run knows; the levels are for a person to judge\n", scheme;
  for (const validity::MaturityRow& row : validity::maturity(s)) {
    if (scheme != row.scheme) out += fmt::format("  {}\n", scheme = row.scheme);
    const std::vector<std::string> lines =
        wrap(row.known.empty() ? "(a person's judgement)" : row.known, line_length - 46);
    for (std::size_t i = 0; i < lines.size(); ++i)
      out += fmt::format("    {:<40} {}\n", i ? "" : clip(row.element, 40), lines[i]);
  }
  return out;
}

Json agreement_json(const validity::Agreement& a) {
  return {{"chi2", json::json_number(a.chi2, "chi2")}, {"numbers", a.numbers}, {"p_value", a.p_value}};
}

Json channel_json(const validity::ChannelValidity& c) {
  const double coarse = measurement::row_of(c.quantity).coarse_per_SI;
  Json j = {{"name", c.name}, {"unit", measurement::row_of(c.quantity).coarse}, {"numbers", c.numbers}};
  const std::pair<const char*, double> sizes[] = {
      {"mean_E", c.mean_E}, {"rms_E", c.rms_E}, {"rms_D", c.rms_D}, {"u_num", c.num},           {"u_input", c.input},
      {"u_noise", c.noise}, {"u_load", c.load}, {"u_val", c.val},   {"area_in_unit", c.area_SI}};
  for (const auto& [name, x] : sizes) j[name] = json::json_number(coarse * x, name);
  j["u_D"] = coarse * std::hypot(c.noise, c.load);
  j["within_2_u_val"] = c.within;
  j["agreement"] = agreement_json(c.agreement);
  j["area"] = c.area;
  if (c.bias)
    j["bias"] = {{"factor", c.bias->factor},
                 {"scatter", c.bias->scatter},
                 {"experiment", c.bias->experiment},
                 {"scatter_from_experiment", c.bias->scatter_from_experiment},
                 {"pairs", c.bias->pairs}};
  return j;
}

/// Of many values as many as a curve needs, evenly by rank.
Json curve_json(const std::vector<double>& sorted) {
  constexpr std::size_t most = 400;
  Json out = Json::array();
  const std::size_t n = sorted.size(), shown = std::min(n, most);
  for (std::size_t i = 0; i < shown; ++i) {
    const std::size_t at = shown < n ? i * (n - 1) / (shown - 1) : i;
    out.push_back({{"u", sorted[at]}, {"F", static_cast<double>(at + 1) / static_cast<double>(n)}});
  }
  return out;
}

Json use_json(const ValidationStudy& s) {
  Json points = Json::array();
  for (const validity::UsePoint& p : s.use->points)
    points.push_back({{"line", s.use->predicted.plan.readings[p.reading].line},
                      {"inside", p.inside()},
                      {s.use->predicted.plan.by_joints() ? "pose_distance_share" : "pose_distance_mm", p.pose_distance},
                      {"load_distance_share", p.load_distance},
                      {"words", place_of(s, p)}});
  Json numbers = Json::array();
  for (const fit::PredictedNumber& n : s.use->predicted.numbers) {
    const measurement::QuantityRow& row = measurement::row_of(n.quantity);
    numbers.push_back({{"line", s.use->predicted.plan.readings[n.reading].line},
                       {"channel", measurement::channel_name(s.use->predicted.plan, n.channel)},
                       {"unit", row.coarse},
                       {"value", row.coarse_per_SI * n.value},
                       {"low95", row.coarse_per_SI * n.low},
                       {"high95", row.coarse_per_SI * n.high},
                       {"where", place_of(s, s.use->points[n.reading])}});
  }
  return {{"plan", s.use->predicted.plan.origin}, {"points", points}, {"numbers", numbers}};
}

}  // namespace

std::string validity_words(const ValidationStudy& s) {
  const ErrorUnit unit = error_unit(s.comparison);
  double squares = 0, validation = 0, n = 0;
  for (const validity::ChannelValidity& c : s.channels)
    if (c.quantity == unit.quantity) {
      const auto numbers = static_cast<double>(c.numbers);
      squares += numbers * c.rms_E * c.rms_E, validation += numbers * c.val * c.val, n += numbers;
    }
  const double rms = unit.fine * std::sqrt(squares / std::max(1.0, n)),
               u_val = unit.fine * std::sqrt(validation / std::max(1.0, n));
  return fmt::format(
      "{}: a right model, with its tolerances and the noise, has errors as large with a chance of p {}{}. The "
      "errors are {} {} rms; their uncertainty, as one standard deviation (u_val), is {} {}.",
      agrees(s.agreement) ? "These data cannot tell the error of the model from zero"
                          : "The model is in error at these readings",
      s.agreement.p_value < 1e-16 ? "" : "= ", p_words(s.agreement.p_value), digits_of(rms, 3), unit.micro,
      digits_of(u_val, 3), unit.micro);
}

std::string validity_report(const ValidationStudy& s) {
  std::string out =
      fmt::format("Validation of {} with {}: {}{}{}\n\n", s.device, s.data, counted(s.comparison.readings, "reading"),
                  poses_words(s.comparison),
                  s.comparison.set_aside.empty()
                      ? ""
                      : fmt::format(", {} set aside", counted(s.comparison.set_aside.size(), "gross outlier")));
  for (const std::string& line : wrap(validity_words(s), line_length)) out += line + "\n";
  out += "\n" + channel_table(s);
  out += fmt::format("all: χ² = {} of {} numbers; area {} (a right model with independent errors: {} on average)\n",
                     digits_of(s.agreement.chi2, 4), s.agreement.numbers, digits_of(s.area, 2),
                     digits_of(s.expected_area, 2));
  for (const char* formula : formulas)
    for (const std::string& line : wrap(formula, line_length - 2)) out += "  " + line + "\n";
  out += without_text(s) + same_text(s) + calibration_text(s);
  out += "\nDomain of validation" + std::string(s.use ? " and of use" : "") + ":\n" + domain_table(s);
  return out + use_text(s) + maturity_text(s);
}

std::string validity_json(const ValidationStudy& s) {
  Json j;
  j["kind"] = "validity";
  j["device"] = s.device;
  j["data"] = s.data;
  j["sentence"] = validity_words(s);
  j["readings"] = s.comparison.readings;
  j["poses"] = s.comparison.poses;
  j["set_aside_lines"] = s.comparison.set_aside;
  j["agrees"] = agrees(s.agreement);
  j["agreement"] = agreement_json(s.agreement);
  j["coverage_factor"] = validity::coverage_factor;
  j["channels"] = Json::array();
  for (const validity::ChannelValidity& c : s.channels) j["channels"].push_back(channel_json(c));
  j["area"] = s.area;
  j["expected_area"] = s.expected_area;
  j["u"] = curve_json(s.u);
  j["discrepancy"] = discrepancies_json(s.discrepancies);
  j["domain"] = Json::array();
  for (const validity::Range& r : s.domain) {
    Json range = {{"name", r.name}, {"unit", r.unit}, {"low", r.low}, {"high", r.high}};
    if (s.use) range["use_low"] = r.use_low, range["use_high"] = r.use_high, range["outside"] = r.outside();
    j["domain"].push_back(std::move(range));
  }
  j["without"] = Json::array();
  for (const validity::WithoutGroup& w : s.without)
    j["without"].push_back({{"kind", w.kind},
                            {"name", w.name},
                            {"readings", w.readings},
                            {"p_value", w.agreement.p_value},
                            {"changes", w.changes}});
  j["same"] = Json::array();
  for (const validity::Sameness& each : s.same)
    j["same"].push_back(
        {{"parameter", each.parameter}, {"kind", each.kind}, {"groups", each.groups}, {"p_value", each.p_value}});
  if (s.calibration)
    j["calibration"] = {{"data", s.calibration->data},
                        {"readings", s.calibration->readings},
                        {"poses_shared", s.calibration->poses_shared},
                        {"rms_E", error_unit(s.comparison).coarse * s.calibration->rms_E},
                        {"validation_rms_E", error_unit(s.comparison).coarse * s.calibration->validation_rms_E},
                        {"unit", error_unit(s.comparison).milli}};
  if (s.use) j["use"] = use_json(s);
  j["maturity"] = Json::array();
  for (const validity::MaturityRow& row : validity::maturity(s))
    j["maturity"].push_back({{"scheme", row.scheme}, {"element", row.element}, {"known", row.known}});
  j["formulas"] = formulas;
  return json::json_text(j);
}

std::string validity_csv(const ValidationStudy& s) {
  std::string out = "line,pose,channel,unit,S,D,E,u_num,u_input,u_noise,u_load,u_val\n";
  const measurement::Measurements& data = *s.comparison.study.data;
  for (std::size_t i = 0; i < s.errors.size(); ++i) {
    const measurement::MeasuredValue& v = s.comparison.study.values[i];
    const validity::ComparisonError& e = s.errors[i];
    const measurement::QuantityRow& row = measurement::row_of(v.quantity);
    const measurement::Reading& r = data.readings[v.reading];
    out += fmt::format("{},{},{},{}", r.line, csv_cell(data.poses[r.pose].label),
                       csv_cell(measurement::channel_name(data, v.channel)), row.unit);
    for (const double x : {e.S, e.D, e.E(), e.num, e.input, e.noise, e.load, e.u_val()})
      out += fmt::format(",{:.8g}", row.per_SI * x);
    out += "\n";
  }
  return out;
}

}  // namespace deflect::report
