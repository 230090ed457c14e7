#include "validation/report/validity/fit_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "msa/base/index.h"
#include "msa/base/number_words.h"
#include "validation/json/json_text.h"
#include "validation/report/short_lists.h"
#include "validation/report/text.h"
#include "validation/report/verdict_words.h"

namespace deflect::report {
namespace {

constexpr double far_off = 3;

std::string with_unit(const std::string& text, const fit::FreeParameter& p) {
  return p.common ? "× " + text : p.unit.empty() ? text : text + " " + p.unit;
}

std::string interval_of(const fit::FittedParameter& p) {
  return with_unit(interval_words(p.fitted / p.per_unit, p.low / p.per_unit, p.high / p.per_unit), p);
}

std::string prior_of(const fit::FittedParameter& p) {
  if (p.prior)
    return with_unit(fmt::format("{} ± {}", digits_of(p.prior->mean / p.per_unit, 4),
                                 digits_of(p.prior->deviation / p.per_unit, 2)),
                     p) +
           fmt::format(" ({}{:.1f} sd)", *p.pull < 0 ? "−" : "+", std::abs(*p.pull));
  return p.beyond_tolerance ? fmt::format("none ({}{:.1f} sd of its tolerance)", *p.beyond_tolerance < 0 ? "−" : "+",
                                          std::abs(*p.beyond_tolerance))
                            : "none";
}

std::string parameter_table(const fit::FitResult& r) {
  std::vector<std::vector<std::string>> rows = {{"parameter", "was", "fitted (95 %)", "prior"}};
  for (const fit::FittedParameter& p : r.parameters)
    rows.push_back({p.path, with_unit(digits_of(p.value / p.per_unit, 4), p), interval_of(p), prior_of(p)});
  return aligned(rows);
}

std::string correlation_table(const fit::FitResult& r) {
  if (r.parameters.size() < 2) return "";
  std::vector<std::vector<std::string>> rows = {{"correlation"}};
  for (std::size_t i = 0; i < r.parameters.size(); ++i) {
    rows.front().push_back(fmt::format("[{}]", i + 1));
    rows.push_back({fmt::format("[{}] {}", i + 1, r.parameters[i].path)});
    for (std::size_t k = 0; k <= i; ++k)
      rows.back().push_back(with_minus(fmt::format("{:.2f}", r.correlation(as_index(i), as_index(k)))));
  }
  return "\n" + aligned(rows);
}

std::string undetermined_text(const fit::FitResult& r) {
  if (r.undetermined.empty()) return "";
  std::string out = "\nNot determined by these data (priors apart):\n";
  for (const fit::Undetermined& u : r.undetermined) out += fmt::format("  {}\n", u.sentence);
  return out;
}

std::string quality_table(const fit::FitResult& r) {
  const measurement::QuantityRow& unit = measurement::row_of(r.quantity);
  const auto row = [&](const char* name, const diagnosis::Quality& q, double chi2) {
    return std::vector<std::string>{name, digits_of(unit.fine_per_SI * q.rmse, 3),
                                    digits_of(unit.fine_per_SI * q.held_out, 3), digits_of(chi2, 4),
                                    digits_of(q.chi2_per_dof, 3)};
  };
  return "\n" +
         aligned({{"", fmt::format("rms {}", unit.fine), "held-out", "chi2", "chi2/dof"},
                  row("before", r.before, r.chi2_before),
                  row("after", r.after, r.chi2_after)}) +
         fmt::format("noise and tolerances alone give {} {}\n", digits_of(unit.fine_per_SI * r.noise_and_tolerances, 3),
                     unit.fine);
}

/// JSON has no infinity.
Json finite_or_null(double x) { return std::isfinite(x) ? Json(x) : Json(); }

Json parameter_json(const fit::FittedParameter& p) {
  const double per = p.per_unit;
  Json j = {{"path", p.path},
            {"unit", p.unit},
            {"value", json::json_number(p.fitted / per, p.path)},
            {"low95", finite_or_null(p.low / per)},
            {"high95", finite_or_null(p.high / per)},
            {"before", p.value / per},
            {"scale", p.positive ? "log" : "linear"},
            {"deviation", p.positive ? p.deviation : p.deviation / per}};
  if (p.common) j["common_factor"] = true;
  if (p.of) {
    j["of"] = {{"effect", p.of->effect->name}};
    if (p.of->leg) j["of"]["leg"] = *p.of->leg;
  }
  j["first_number_SI"] = p.first;
  if (p.prior) j["prior"] = {{"mean", p.prior->mean / per}, {"deviation", p.prior->deviation / per}};
  if (p.pull) j["prior_deviations"] = *p.pull;
  if (p.beyond_tolerance) j["tolerance_deviations"] = *p.beyond_tolerance;
  return j;
}

Json numbers_json(const VectorX& v) {
  Json out = Json::array();
  for (const double x : v) out.push_back(json::json_number(x, "mean"));
  return out;
}

Json quality_json(const fit::FitResult& r, const diagnosis::Quality& q, double chi2) {
  const double coarse = measurement::row_of(r.quantity).coarse_per_SI;
  return {{"rmse_mm", json::json_number(coarse * q.rmse, "rmse")},
          {"held_out_rmse_mm", json::json_number(coarse * q.held_out, "held-out rmse")},
          {"chi2", json::json_number(chi2, "chi2")},
          {"chi2_per_dof", json::json_number(q.chi2_per_dof, "chi2")}};
}

Json posterior_json(const fit::FitResult& r) {
  Json names = Json::array();
  for (const fit::FittedParameter& p : r.parameters) names.push_back(p.path);
  for (const std::string& t : r.tolerances) names.push_back(t);
  return {{"names", names},
          {"mean", numbers_json(r.posterior.mean)},
          {"covariance", rows_json(r.posterior.covariance, "covariance")}};
}

}  // namespace

std::vector<std::string> fitted_words(const fit::FitResult& r) {
  std::vector<std::string> out;
  for (const fit::FittedParameter& p : r.parameters)
    out.push_back(fmt::format("{}{} {}", p.path, p.common ? "" : " =", interval_of(p)));
  return out;
}

std::vector<std::string> fit_warnings(const fit::FitResult& r) {
  std::vector<std::string> out;
  if (!r.converged)
    out.emplace_back("The search has not ended: the values are not yet the best ones. Fit again from the new file.");
  for (const fit::FittedParameter& p : r.parameters) {
    if (p.pull && std::abs(*p.pull) > far_off)
      out.push_back(
          fmt::format("{} is {:.1f} standard deviations of its prior off: something else may be missing, which "
                      "this parameter takes over. Run 'deflect diagnose'.",
                      p.path, std::abs(*p.pull)));
    if (p.beyond_tolerance && std::abs(*p.beyond_tolerance) > far_off)
      out.push_back(
          fmt::format("{} is {:.1f} standard deviations of its declared tolerance off: something else may be "
                      "missing, which this parameter takes over. Run 'deflect diagnose'.",
                      p.path, std::abs(*p.beyond_tolerance)));
  }
  if (r.p_value < fit::significant_misfit)
    out.push_back(
        fmt::format("The fit leaves a misfit beyond noise and tolerances (p = {}): run 'deflect diagnose' on the "
                    "new file.",
                    digits_of(r.p_value, 2)));
  return out;
}

Json discrepancies_json(const std::vector<fit::Discrepancy>& all) {
  Json out = Json::array();
  for (const fit::Discrepancy& d : all)
    out.push_back({{"quantity", measurement::row_of(d.quantity).what}, {"share", d.share}});
  return out;
}

std::string fit_report(const fit::FitResult& r) {
  std::string out = fmt::format("{} fitted to {}: {}, {}{}\n", r.device, r.data, counted(r.readings, "reading"),
                                counted(r.numbers, "number"),
                                r.set_aside ? fmt::format(", {} set aside", counted(r.set_aside, "reading")) : "");
  out += how_read_text(r.how_read) + "\n";
  out += parameter_table(r) + correlation_table(r) + undetermined_text(r) + quality_table(r);
  for (const std::string& warning : fit_warnings(r)) {
    out += "\n";
    for (const std::string& line : wrap(warning, line_length)) out += line + "\n";
  }
  if (!r.findings.empty()) {
    out += "\nPatterns left:\n";
    for (const std::string& f : r.findings)
      for (const std::string& line : wrap(f, line_length - 2)) out += "  " + line + "\n";
  }
  if (!r.strained.empty())
    out += fmt::format("\ntolerances beyond two standard deviations: {}\n", strained_words(r.strained));
  return out;
}

std::string fit_json(const fit::FitResult& r) {
  const measurement::QuantityRow& unit = measurement::row_of(r.quantity);
  Json j;
  j["kind"] = "fit";
  j["device"] = r.device;
  j["data"] = r.data;
  j["readings"] = r.readings;
  j["poses"] = r.poses;
  j["numbers"] = r.numbers;
  j["set_aside"] = r.set_aside;
  j["unit"] = unit.coarse;  // of what ends with _mm
  j["parameters"] = Json::array();
  for (const fit::FittedParameter& p : r.parameters) j["parameters"].push_back(parameter_json(p));
  j["correlation"] = rows_json(r.correlation, "correlation");
  j["undetermined"] = Json::array();
  for (const fit::Undetermined& u : r.undetermined)
    j["undetermined"].push_back({{"sentence", u.sentence},
                                 {"direction", numbers_json(u.direction)},
                                 {"deviation", finite_or_null(u.deviation)}});
  j["before"] = quality_json(r, r.before, r.chi2_before);
  j["after"] = quality_json(r, r.after, r.chi2_after);
  j["noise_floor_mm"] = unit.coarse_per_SI * r.noise_and_tolerances;
  j["p_value"] = r.p_value;
  j["converged"] = r.converged;
  j["warnings"] = fit_warnings(r);
  j["findings"] = r.findings;
  j["strained_tolerances"] = strained_json(r.strained);
  j["tolerance_scale"] = r.tolerance_scale;
  j["discrepancy"] = discrepancies_json(r.discrepancies);
  j["noise"] = Json::array();
  for (const auto& [quantity, sigma] : r.sigma)
    j["noise"].push_back({{"quantity", measurement::row_of(quantity).what}, {"sigma_SI", sigma}});
  j["posterior"] = posterior_json(r);
  return json::json_text(j);
}

std::string parameters_csv(const fit::FitResult& r) {
  std::string csv = "path,unit,value,low95,high95,before\n";
  const auto cell = [](double x) { return std::isfinite(x) ? fmt::format("{:.9g}", x) : std::string(); };
  for (const fit::FittedParameter& p : r.parameters)
    csv += fmt::format("{},{},{:.9g},{},{},{:.9g}\n", csv_cell(p.path), csv_cell(p.unit), p.fitted / p.per_unit,
                       cell(p.low / p.per_unit), cell(p.high / p.per_unit), p.value / p.per_unit);
  return csv;
}

}  // namespace deflect::report
