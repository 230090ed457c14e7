#include "validation/report/validity/predict_results.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/number_words.h"
#include "validation/json/json_text.h"
#include "validation/report/text.h"
#include "validation/report/theory_words.h"

namespace deflect::report {
namespace {

constexpr std::size_t most_rows = 40;

struct Share {
  const char* name;
  double fit::Shares::*size;
};
constexpr Share shares[] = {{"parameters", &fit::Shares::parameters},
                            {"tolerances", &fit::Shares::tolerances},
                            {"load", &fit::Shares::load},
                            {"discrepancy", &fit::Shares::discrepancy},
                            {"noise", &fit::Shares::noise}};

const measurement::QuantityRow& row_of(const fit::PredictedNumber& n) { return measurement::row_of(n.quantity); }

const std::string& pose_of(const fit::PredictedPlan& p, const fit::PredictedNumber& n) {
  return p.plan.poses[p.plan.readings[n.reading].pose].label;
}

/// "where" of a table: of one reading nothing.
std::string place_words(const fit::PredictedPlan& p, const fit::PredictedNumber& n) {
  if (p.plan.readings.size() == 1) return "";
  return p.plan.instruments.stationary
             ? fmt::format("line {}", p.plan.readings[n.reading].line)
             : fmt::format("pose {}, line {}", pose_of(p, n), p.plan.readings[n.reading].line);
}

double percent(double part, double whole) { return whole > 0 ? 100 * part * part / (whole * whole) : 0; }

}  // namespace

std::string predict_report(const fit::PredictedPlan& p) {
  std::vector<std::vector<std::string>> rows = {{"reading", "where", "predicted", "95 % interval"}};
  for (const theories::Theory* t : p.theories) rows.front().push_back(t->title);
  for (const Share& s : shares) rows.front().push_back(fmt::format("{} %", s.name));
  for (const fit::PredictedNumber& n : p.numbers) {
    if (rows.size() > most_rows) break;
    const double per = row_of(n).fine_per_SI;
    rows.push_back({measurement::channel_name(p.plan, n.channel), place_words(p, n),
                    with_minus(fmt::format("{:.4g} {}", per * n.value, row_of(n).fine)),
                    with_minus(fmt::format("{:.4g} … {:.4g}", per * n.low, per * n.high))});
    for (const double each : n.by_theory) rows.back().push_back(with_minus(fmt::format("{:.6g}", per * each)));
    for (const Share& s : shares)
      rows.back().push_back(fmt::format("{:.0f}", percent(n.deviation.*s.size, n.deviation.of_reading())));
  }
  std::string out =
      fmt::format("{}: {} reading{}\n\n", p.device, p.plan.readings.size(), p.plan.readings.size() == 1 ? "" : "s") +
      aligned(rows);
  if (p.numbers.size() > most_rows)
    out += fmt::format("… and {} more: --json and --out have all\n", p.numbers.size() - most_rows);
  out += "\nThe interval is that of one reading; shares are those of its variance.\n";
  if (!p.noise_known)
    out += "The noise of some readings is not known (--sigma): their interval is that of the true value.\n";
  for (const measurement::Quantity q : p.discrepancy_of_others)
    out += fmt::format(
        "The fit read no {}: what the model lacks there is taken to be as large a share as of what it read.\n",
        measurement::row_of(q).what);
  const auto outside = [](const fit::PredictedNumber& n) {
    return std::any_of(n.by_theory.begin(), n.by_theory.end(), [&](double x) { return x < n.low || x > n.high; });
  };
  if (p.fitted && std::any_of(p.numbers.begin(), p.numbers.end(), outside))
    out +=
        "The theories' columns are the description's alone, some of them outside the interval: what is predicted also "
        "has what the fit learned of tolerances in it.\n";
  if (!p.fitted)
    out +=
        "Without --fit: tolerances as declared, no discrepancy. What measurements say about this model is not in these "
        "intervals.\n";
  return out;
}

std::string predict_json(const fit::PredictedPlan& p) {
  Json j;
  j["kind"] = "prediction";
  j["device"] = p.device;
  j["plan"] = p.plan.origin;
  j["theories"] = json_theories(p.theories);
  j["fitted"] = p.fitted;
  j["noise_known"] = p.noise_known;
  j["numbers"] = Json::array();
  for (const fit::PredictedNumber& n : p.numbers) {
    const double per = row_of(n).per_SI;
    Json number = {{"line", p.plan.readings[n.reading].line},
                   {"pose", pose_of(p, n)},
                   {"channel", measurement::channel_name(p.plan, n.channel)},
                   {"unit", row_of(n).unit},
                   {"value", json::json_number(per * n.value, "prediction")},
                   {"low95", json::json_number(per * n.low, "interval")},
                   {"high95", json::json_number(per * n.high, "interval")}};
    for (std::size_t i = 0; i < p.theories.size(); ++i) number[p.theories[i]->name] = per * n.by_theory[i];
    for (const Share& s : shares) number["deviation"][s.name] = per * n.deviation.*s.size;
    number["deviation"]["prediction"] = per * n.deviation.of_prediction();
    number["deviation"]["reading"] = per * n.deviation.of_reading();
    j["numbers"].push_back(std::move(number));
  }
  return json::json_text(j);
}

std::string predict_csv(const fit::PredictedPlan& p) {
  std::string out = "line,pose,channel,unit,value,low95,high95";
  for (const theories::Theory* t : p.theories) out += "," + t->name;
  for (const Share& s : shares) out += fmt::format(",deviation_{}", s.name);
  out += "\n";
  for (const fit::PredictedNumber& n : p.numbers) {
    const double per = row_of(n).per_SI;
    out += fmt::format("{},{},{},{},{:.9g},{:.9g},{:.9g}", p.plan.readings[n.reading].line, csv_cell(pose_of(p, n)),
                       csv_cell(measurement::channel_name(p.plan, n.channel)), row_of(n).unit, per * n.value,
                       per * n.low, per * n.high);
    for (const double each : n.by_theory) out += fmt::format(",{:.9g}", per * each);
    for (const Share& s : shares) out += fmt::format(",{:.6g}", per * n.deviation.*s.size);
    out += "\n";
  }
  return out;
}

}  // namespace deflect::report
