#include "validation/report/plan/foresight_results.h"

#include <fmt/format.h>

#include "msa/base/index.h"
#include "validation/json/json_text.h"
#include "validation/report/plan/plan_results.h"
#include "validation/report/short_lists.h"
#include "validation/report/text.h"

namespace deflect::report {
namespace {

constexpr double alike = 0.995;  // cosine, above which no data of this campaign tell two effects apart

/// Effects at places that show within the bounds of their parameters, and pairs of different effects that look alike.
std::size_t that_show(const plan::Insight& i) {
  std::size_t out = 0;
  for (const diagnosis::Detectable& d : i.detectable) out += d.lambda_at_start > 0 && !d.smallest.empty() ? 1 : 0;
  return out;
}

std::size_t pairs_alike(const plan::Insight& i) {
  std::size_t out = 0;
  for (Eigen::Index a = 0; a < i.cosines.rows(); ++a)
    for (Eigen::Index b = a + 1; b < i.cosines.rows(); ++b)
      if (nth(i.detectable, a).effect.effect != nth(i.detectable, b).effect.effect && i.cosines(a, b) > alike) ++out;
  return out;
}

std::string indices_table(const plan::Foresight& f) {
  struct Row {
    std::string name;
    double given, better;
    const char* form;
  };
  const plan::Observability &a = f.given.observability, &b = f.better.observability;
  const auto count = [](std::size_t n) { return static_cast<double>(n); };
  const plan::Confusion here = plan::confusion(f.given, f.given), there = plan::confusion(f.better, f.given);
  std::vector<Row> all = {
      {"readings", count(f.given.readings.readings.size()), count(f.better.readings.readings.size()), "{:.0f}"},
      {"poses", count(f.given.readings.poses.size()), count(f.better.readings.poses.size()), "{:.0f}"},
      {"effects that show within their bounds", count(that_show(f.given)), count(that_show(f.better)), "{:.0f}"},
      {"pairs of effects alike (cosine > 0.995)", count(pairs_alike(f.given)), count(pairs_alike(f.better)), "{:.0f}"},
      {fmt::format("of {} pairs told apart at λ = 8, wrong in less than 5 %", here.pairs), count(here.told),
       count(there.told), "{:.0f}"},
      {"chance of taking the wrong one of two, mean, %", 100 * here.mean, 100 * there.mean, "{:.2f}"},
      {"error in use before fitting, µm rms", um * f.given.error_before, um * f.better.error_before, "{:.3g}"},
      {"error in use after fitting, µm rms (test poses)", um * f.given.error_after, um * f.better.error_after,
       "{:.3g}"}};
  const char* sources[] = {"Borm, Menq 1991", "Driels, Pathre 1990", "Nahvi, Hollerbach, Hayward 1994",
                           "Nahvi, Hollerbach 1996", "Sun, Hollerbach 2008"};
  for (std::size_t i = 0; i < 5; ++i)
    all.push_back({fmt::format("O{} ({})", i + 1, sources[i]), a.O[i], b.O[i], "{:.3g}"});
  all.push_back({"D-gain, nats (Lindley 1956)", a.D_gain, b.D_gain, "{:.1f}"});
  std::vector<std::vector<std::string>> rows = {
      {"", "this campaign",
       f.allowed ? fmt::format("better, for {}", nth(plan::toward_names, f.toward)) : "within the limits"}};
  for (const Row& r : all)
    rows.push_back(
        {"  " + r.name, fmt::format(fmt::runtime(r.form), r.given), fmt::format(fmt::runtime(r.form), r.better)});
  if (!f.found)
    for (std::vector<std::string>& row : rows) row.pop_back();
  std::string out = aligned(rows);
  if (a.O[0] == 0 || b.O[0] == 0)
    out += "  O1 to O5 are 0 where some tolerance, or several together, leave no trace in the readings\n";
  return out;
}

/// As many as a curve needs, the last among them.
Json gain_json(const std::vector<plan::Gain>& gain, plan::Toward toward) {
  constexpr std::size_t most = 60;
  const std::size_t n = gain.size(), shown = std::min(n, most);
  const double times = toward == plan::Toward::precision ? um : 1;
  Json out = Json::array();
  for (std::size_t i = 0; i < shown; ++i) {
    const plan::Gain& g = gain[shown < n ? i * (n - 1) / (shown - 1) : i];
    out.push_back({{"readings", g.readings}, {"value", json::json_number(times * g.value, "gain")}});
  }
  return out;
}

/// Where the readings are taken: of a machine.
Json stands_json(const measurement::Measurements& m) {
  Json out = Json::array();
  for (const measurement::PoseGroup& pose : m.poses) {
    if (m.instruments.stationary || m.by_joints()) break;
    out.push_back({{"pose", pose.label},
                   {"pose_mm_deg", std::vector<double>(pose.pose_mm_deg.begin(), pose.pose_mm_deg.end())},
                   {"readings", pose.readings.size()}});
  }
  return out;
}

Json insight_json(const plan::Insight& i, const plan::Foresight& f) {
  Json j;
  j["readings"] = i.readings.readings.size();
  j["poses"] = i.readings.poses.size();
  j["parameters"] = i.parameters;
  j["numbers"] = i.numbers;
  j["effects_that_show"] = that_show(i);
  j["pairs_alike"] = pairs_alike(i);
  const plan::Confusion c = plan::confusion(i, f.given);
  j["pairs"] = c.pairs;
  j["pairs_told_apart"] = c.told;
  j["chance_of_confusion"] = json::json_number(c.mean, "chance of confusion");
  j["error_before_um"] = json::json_number(um * i.error_before, "error");
  j["error_after_um"] = json::json_number(um * i.error_after, "error");
  for (std::size_t k = 0; k < 5; ++k)
    j[fmt::format("O{}", k + 1)] = json::json_number(i.observability.O[k], "observability index");
  j["D_gain"] = json::json_number(i.observability.D_gain, "D-gain");
  j["detectable"] = Json::array();
  for (std::size_t k = 0; k < i.detectable.size(); ++k) {
    const diagnosis::Detectable& d = i.detectable[k];
    Json names = Json::array();
    for (const effects::EffectParameter& p : d.effect.effect->parameters) names.push_back(p.name);
    j["detectable"].push_back({{"effect", i.names[k]},
                               {"parameters", names},
                               {"smallest", d.smallest},
                               {"lambda_at_start", json::json_number(d.lambda_at_start, "lambda")},
                               {"mistaken_for", d.mistaken_for},
                               {"cosine", json::json_number(d.cosine, "cosine")}});
  }
  j["cosines"] = rows_json(i.cosines, "cosine");
  j["chances"] = rows_json(i.separations.unaryExpr(&plan::chance_of_confusion), "chance of confusion");
  j["gain"] = gain_json(i.gain, f.toward);
  j["stands"] = stands_json(i.readings);
  j["left_out"] = left_out_json(i.left_out);
  return j;
}

}  // namespace

std::string no_better_words(const plan::Foresight& f) {
  if (!f.allowed)
    return fmt::format("The given campaign goes beyond the limits. The one written keeps to them{}.",
                       f.tells_more ? "" : ", and tells less");
  return fmt::format("No better campaign of {} readings was found for {}.", f.given.readings.readings.size(),
                     nth(plan::toward_names, f.toward));
}

std::string foresight_report(const plan::Foresight& f) {
  return fmt::format("{}: what {} will be able to tell (a calibration would fit {} tolerance{})\n\n", f.subject,
                     f.campaign, f.given.parameters, f.given.parameters == 1 ? "" : "s") +
         (f.tells_more && f.allowed ? "" : no_better_words(f) + "\n\n") + indices_table(f) + "\n" +
         detectable_table(f.given.detectable) + left_out_words(f.given.left_out);
}

std::string foresight_json(const plan::Foresight& f) {
  Json j;
  j["kind"] = "foresight";
  j["subject"] = f.subject;
  j["campaign"] = f.campaign;
  j["toward"] = nth(plan::toward_names, f.toward);
  j["better_found"] = f.found;
  j["given_within_limits"] = f.allowed;
  j["gain_in"] = f.toward == plan::Toward::precision ? "um" : "chance";
  j["given"] = insight_json(f.given, f);
  j["better"] = insight_json(f.better, f);
  j["readings"] = planned_readings_json(f.better.readings);
  return json::json_text(j);
}

std::string foresight_csv(const plan::Foresight& f) {
  std::string out = "effect,smallest";
  for (const std::string& name : f.given.names) out += "," + csv_cell(name);
  out += "\n";
  for (std::size_t a = 0; a < f.given.names.size(); ++a) {
    out += csv_cell(f.given.names[a]) + "," + csv_cell(sizes_of(f.given.detectable[a]));
    for (Eigen::Index b = 0; b < f.given.cosines.cols(); ++b)
      out += fmt::format(",{:.4f}", f.given.cosines(as_index(a), b));
    out += "\n";
  }
  return out;
}

}  // namespace deflect::report
