#include "validation/report/plan/plan_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "msa/base/index.h"
#include "validation/json/json_text.h"
#include "validation/report/text.h"
#include "validation/report/verdict_words.h"

namespace deflect::report {
namespace {

std::string rival_words(const plan::Rival& r) { return placed_words(r.own()); }

std::string pair_words(const plan::Plan& p, const plan::Pair& pair) {
  return fmt::format("{} and {}", rival_words(p.rivals[pair.a]), rival_words(p.rivals[pair.b]));
}

/// "load.snow = 1", "node.B.fz = -500 N", "fx = 50 N": what is not zero.
std::string load_words(const measurement::Measurements& m, const measurement::Reading& r) {
  std::string out;
  const auto add = [&](const std::string& name, double value, const char* unit) {
    if (value != 0) out += fmt::format("{}{} = {:.6g}{}", out.empty() ? "" : ", ", name, value, unit);
  };
  for (std::size_t k = 0; k < r.factors.size(); ++k) add("load." + m.instruments.load_cases[k], r.factors[k], "");
  const char* names[] = {"fx", "fy", "fz", "mx", "my", "mz"};
  const auto add_wrench = [&](const std::string& at, const Vector6& w) {
    for (Eigen::Index i = 0; i < 6; ++i) add(at + nth(names, i), (i < 3 ? 1 : mm) * w(i), i < 3 ? " N" : " Nmm");
  };
  if (m.instruments.stationary)
    for (std::size_t p = 0; p < r.at_points.size(); ++p) add_wrench(m.instruments.load_points[p] + ".", r.at_points[p]);
  add_wrench("", r.load);
  return out.empty() ? "no load" : out;
}

std::string pose_words(const measurement::Measurements& m, const measurement::PoseGroup& pose) {
  if (m.instruments.stationary) return "";
  std::string out;
  if (m.by_joints())
    for (Eigen::Index i = 0; i < pose.joints.size(); ++i)
      out += fmt::format("{}{:.4g}", i ? ", " : "", (nth(m.joint_rotates, i) ? 1 : mm) * pose.joints(i));
  else
    for (Eigen::Index i = 0; i < 6; ++i) out += fmt::format("{}{:.4g}", i ? ", " : "", pose.pose_mm_deg(i));
  return out;
}

/// Readings one after the other that are alike share a line: "1 … 24".
std::string readings_table(const measurement::Measurements& m) {
  const bool stands = !m.instruments.stationary;
  std::vector<std::vector<std::string>> rows = {{"readings"}};
  if (stands) rows[0].insert(rows[0].end(), {"pose", m.by_joints() ? "joints" : "x y z mm, angles deg"});
  rows[0].insert(rows[0].end(), {"load", "how"});
  constexpr std::size_t shown = 24;  // lines
  std::size_t first = 0, told = 0;
  for (std::size_t i = 0; i < m.readings.size(); ++i) {
    const measurement::Reading& r = m.readings[i];
    std::vector<std::string> row = {""};
    if (stands) row.insert(row.end(), {m.poses[r.pose].label, pose_words(m, m.poses[r.pose])});
    row.insert(row.end(), {load_words(m, r), r.notes.front()});
    const bool again = rows.size() > 1 && std::equal(row.begin() + 1, row.end(), rows.back().begin() + 1);
    if (!again && rows.size() > shown) break;
    if (!again) rows.push_back(std::move(row)), first = i + 1;
    rows.back().front() = first == i + 1 ? fmt::format("  {}", first) : fmt::format("  {} … {}", first, i + 1);
    told = i + 1;
  }
  std::string out = aligned(rows);
  if (m.readings.size() > told) out += fmt::format("  … and {} more (in the file)\n", m.readings.size() - told);
  return out;
}

std::string steps_table(const plan::Plan& p) {
  const bool several = p.rivals.size() > 2;
  std::vector<std::vector<std::string>> rows = {
      {"readings", "probability", several ? "least separation λ²" : "separation λ²", several ? "of" : ""}};
  const std::size_t every = std::max<std::size_t>(1, p.steps.size() / 12);
  for (std::size_t i = 0; i < p.steps.size(); ++i) {
    if (i % every != 0 && i + 1 != p.steps.size()) continue;
    const plan::Step& s = p.steps[i];
    const auto least = std::min_element(s.pairs.begin(), s.pairs.end(), [](const plan::Pair& a, const plan::Pair& b) {
      return a.separation < b.separation;
    });
    rows.push_back({fmt::format("  {}", s.readings), fmt::format("{:.3f}", s.probability),
                    fmt::format("{:.1f}", least->separation), several ? pair_words(p, *least) : ""});
  }
  return aligned(rows);
}

/// "{node: B, direction: uz, sigma: 0.02 mm}".
std::string entry_of(const subject::PossibleSensor& s) {
  const bool length = s.quantity == measurement::Quantity::length;
  return fmt::format("{{{}, sigma: {:.3g} {}}}", s.entry, length ? mm * s.sigma : s.sigma,
                     length                                       ? "mm"
                     : s.quantity == measurement::Quantity::angle ? "rad"
                                                                  : "N");
}

std::string inseparable_words(const plan::Plan& p) {
  std::string out;
  for (const plan::Inseparable& i : p.inseparable) {
    out += fmt::format(
        "No reading within these limits tells {} apart: all {} possible ones together would give "
        "λ² = {:.2g}. What would:\n",
        pair_words(p, i.pair), p.possible, i.pair.separation);
    for (const std::string& sentence : i.instead) {
      for (const std::string& line : wrap(sentence, line_length - 2)) out += "  " + line + "\n";
    }
    out += "\n";
  }
  return out;
}

/// "2: 27, 3": how many readings are enough, and which.
std::string enough_words(const plan::NewSensor& n) {
  if (n.enough.empty()) return "more";
  constexpr std::size_t most = 4;
  std::string out = fmt::format("{}: {}", n.enough.size(), n.enough.front() + 1);
  for (std::size_t i = 1; i < std::min(most, n.enough.size()); ++i) out += fmt::format(", {}", n.enough[i] + 1);
  return out + (n.enough.size() > most ? " …" : "");
}

std::string sensors_table(const plan::Plan& p) {
  if (p.sensors.empty()) return "";
  std::vector<std::vector<std::string>> rows = {
      {"a further instrument", "enough", "by all", "its line in the description"}};
  for (const plan::NewSensor& n : p.sensors)
    rows.push_back({"  " + n.sensor.name, enough_words(n), fmt::format("{:.3f}", n.probability), entry_of(n.sensor)});
  const std::size_t all = p.readings.readings.empty() ? p.taken : p.readings.readings.size();
  return fmt::format(
             "\nInstruments that would help most, beside the others in these readings{}: how many of the {} would be "
             "enough and which, and the expected probability by all of them\n\n",
             p.readings.readings.empty() ? " (those of the data, taken again)" : "", all) +
         aligned(rows);
}

Json numbers_from_1(const std::vector<std::size_t>& all) {
  Json out = Json::array();
  for (const std::size_t i : all) out.push_back(i + 1);
  return out;
}

Json sensors_json(const plan::Plan& p) {
  Json out = Json::array();
  for (const plan::NewSensor& n : p.sensors)
    out.push_back({{"name", n.sensor.name},
                   {"entry", entry_of(n.sensor)},
                   {"enough", numbers_from_1(n.enough)},
                   {"probability", n.probability},
                   {"lambda_squared", json::json_number(n.separation, "separation")}});
  return out;
}

Json pairs_json(const plan::Plan& p, const std::vector<plan::Pair>& pairs) {
  Json out = Json::array();
  for (const plan::Pair& each : pairs)
    out.push_back({{"between", {rival_words(p.rivals[each.a]), rival_words(p.rivals[each.b])}},
                   {"lambda_squared", json::json_number(each.separation, "separation")},
                   {"least_lambda_squared", json::json_number(each.least, "separation")},
                   {"log_bayes_factor", json::json_number(each.separation / 2, "log Bayes factor")}});
  return out;
}

}  // namespace

Json planned_readings_json(const measurement::Measurements& m) {
  Json out = Json::array();
  for (const measurement::Reading& r : m.readings)
    out.push_back({{"pose", m.poses[r.pose].label},
                   {"at", pose_words(m, m.poses[r.pose])},
                   {"load", load_words(m, r)},
                   {"how", r.notes.empty() ? "" : r.notes.front()}});
  return out;
}

/// What the readings in the order planned tell of each pair; of many, those that are told worst.
std::string pairs_table(const plan::Plan& p) {
  constexpr std::size_t shown = 8;
  std::vector<plan::Pair> pairs = p.as_planned;
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const plan::Pair& a, const plan::Pair& b) { return a.separation < b.separation; });
  std::vector<std::vector<std::string>> rows = {{"after all of them", "λ²", "or more", "ln Bayes factor"}};
  for (std::size_t i = 0; i < std::min(shown, pairs.size()); ++i)
    rows.push_back({"  " + pair_words(p, pairs[i]), fmt::format("{:.1f}", pairs[i].separation),
                    fmt::format("{:.1f}", pairs[i].least), fmt::format("{:.1f}", pairs[i].separation / 2)});
  std::string out = aligned(rows);
  if (pairs.size() > shown)
    out += fmt::format("  and {} more that are told better: --json has all\n", pairs.size() - shown);
  return out;
}

std::string plan_report(const plan::Plan& p) {
  std::string names;
  for (const plan::Rival& r : p.rivals) names += (names.empty() ? "" : ", ") + rival_words(r);
  std::string out =
      fmt::format("{} after {} ({}): {} are tied\n\n", p.subject, p.data, counted(p.taken, "reading"), names);
  out += inseparable_words(p);
  if (p.readings.readings.empty()) return out + sensors_table(p);
  const bool stands = !p.readings.instruments.stationary;
  out += fmt::format("{}{} {} them apart with an expected probability of {:.3f} (before: {:.3f})",
                     counted(p.readings.readings.size(), "reading"),
                     stands ? " at " + counted(p.readings.poses.size(), "pose") : "",
                     p.readings.readings.size() == 1 ? "tells" : "tell", p.probability, p.steps.front().probability);
  if (p.at_random > 0)
    out += fmt::format("; drawn by lot from the same {}loads, {}{} would do as well", stands ? "poses and " : "",
                       p.at_random_is_more ? "more than " : "", counted(p.at_random, "reading"));
  out += ".\n\n" + readings_table(p.readings) + "\n" + steps_table(p);
  out += "\n" + pairs_table(p);
  return out + sensors_table(p);
}

std::string plan_json(const plan::Plan& p) {
  Json j;
  j["kind"] = "plan";
  j["subject"] = p.subject;
  j["data"] = p.data;
  j["taken"] = p.taken;
  j["possible"] = p.possible;
  j["rivals"] = Json::array();
  for (const plan::Rival& r : p.rivals) {
    Json parameters = Json::array();
    const auto all = diagnosis::parameters_of(r.hypothesis);
    for (std::size_t i = 0; i < all.size(); ++i)
      parameters.push_back({{"name", all[i]->name}, {"value", r.values(as_index(i))}});
    j["rivals"].push_back({{"effect", rival_words(r)}, {"probability", r.probability}, {"parameters", parameters}});
  }
  j["readings"] = planned_readings_json(p.readings);
  j["probability"] = p.probability;
  j["separations"] = pairs_json(p, p.as_planned);
  j["at_random"] = p.at_random;
  j["at_random_is_more"] = p.at_random_is_more;
  j["steps"] = Json::array();
  for (const plan::Step& s : p.steps)
    j["steps"].push_back(
        {{"readings", s.readings}, {"probability", s.probability}, {"separations", pairs_json(p, s.pairs)}});
  j["inseparable"] = Json::array();
  for (const plan::Inseparable& i : p.inseparable)
    j["inseparable"].push_back({{"between", {rival_words(p.rivals[i.pair.a]), rival_words(p.rivals[i.pair.b])}},
                                {"lambda_squared", json::json_number(i.pair.separation, "separation")},
                                {"instead", i.instead}});
  j["new_sensors"] = sensors_json(p);
  return json::json_text(j);
}

std::string plan_csv(const plan::Plan& p) {
  std::string out = "readings,probability";
  for (const plan::Pair& pair : p.steps.front().pairs) out += "," + csv_cell("lambda_squared " + pair_words(p, pair));
  out += "\n";
  for (const plan::Step& s : p.steps) {
    out += fmt::format("{},{:.6g}", s.readings, s.probability);
    for (const plan::Pair& pair : s.pairs) out += fmt::format(",{:.6g}", pair.separation);
    out += "\n";
  }
  return out;
}

}  // namespace deflect::report
