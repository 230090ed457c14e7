#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tests/benchmark/scores.h"
#include "validation/figures/sheet.h"

namespace deflect::benchmark {
namespace {

using namespace figures;

std::string cell(double value) {
  return std::isnan(value) ? "" : fmt::format("{:.{}f}", value, value > 0 && value < 0.1 ? 3 : 2);
}

std::vector<double> seconds_of(const std::vector<Record>& all) {
  std::vector<double> out;
  for (const Record& r : all)
    if (r.skipped.empty()) out.push_back(r.seconds);
  std::sort(out.begin(), out.end());
  return out;
}

Json set_json(const Record& r) {
  const Case& c = r.order;
  Json out = {
      {"group", c.group}, {"index", c.index}, {"campaign", c.campaign}, {"variant", c.variant}, {"seed", c.seed}};
  if (!r.skipped.empty()) {
    out["effect"] = c.effect;
    out["skipped"] = r.skipped;
    return out;
  }
  out["truth"] = r.truth.effects;
  out["unknown"] = r.truth.unknown;
  if (!r.truth.tied.empty()) out["tied_with"] = r.truth.tied;
  out["hidden"] = Json::array();
  for (const HiddenEffect& e : r.hidden) {
    Json hidden = {{"effect", e.effect}, {"site", e.site}};
    for (const auto& [name, value] : e.values) hidden[name] = value;
    out["hidden"].push_back(hidden);
  }
  out["lambda"] = r.lambda;
  if (!r.hidden.empty() && !r.truth.unknown) out["separation"] = r.separation;
  if (r.truth.unknown) out["lambda_res"] = r.lambda_left;
  out["answers"] = Json::array();
  for (std::size_t i = 0; i < r.answers.size(); ++i) {
    const Answer& a = r.answers[i];
    out["answers"].push_back({{"method", method_names[i]},
                              {"outcome", outcome_names[static_cast<int>(judge(r.truth, a))]},
                              {"verdict", a.verdict},
                              {"missing", a.missing},
                              {"indistinguishable", a.groups},
                              {"first", a.first},
                              {"probability", a.probability}});
  }
  for (std::size_t i = 0; i < r.new_poses.size(); ++i)
    if (!std::isnan(r.new_poses[i])) out["error_at_new_poses_in_sigma"][method_names[i]] = r.new_poses[i];
  out["intervals"] = r.intervals;
  out["intervals_with_truth"] = r.covering;
  out["seconds"] = r.seconds;
  return out;
}

}  // namespace

std::string report(const std::vector<Record>& all) {
  std::string out = fmt::format("| score | goal | sets | {} |\n|---|---|---|", fmt::join(method_names, " | "));
  for (std::size_t i = 0; i < std::size(method_names); ++i) out += "---|";
  out += "\n";
  for (const Score& s : scores(all)) {
    if (s.sets == 0) continue;
    out += fmt::format("| {} | {} | {} |", s.name, s.goal, s.sets);
    for (const double value : s.values) out += fmt::format(" {} |", cell(value));
    out += "\n";
  }
  out += "\n| method | probability of the first candidate | mean | it is the truth | sets |\n|---|---|---|---|---|\n";
  for (const Reliability& r : reliability(all))
    out += fmt::format("| {} | {}–{} | {:.3f} | {:.3f} | {} |\n", r.method, r.low, r.high, r.mean, r.right, r.sets);
  if (const std::vector<double> seconds = seconds_of(all); !seconds.empty())
    out += fmt::format("\nSeconds per set: median {:.1f}, max {:.1f}; {} sets.\n", seconds[seconds.size() / 2],
                       seconds.back(), seconds.size());
  for (const Record& r : all)
    if (!r.skipped.empty()) out += fmt::format("Skipped: {} {}: {}.\n", r.order.group, r.order.index, r.skipped);
  return out;
}

// Wilson's interval of a share p of n, z = 1.96: (p + z²/2n ± z √(p(1 − p)/n + z²/4n²))/(1 + z²/n).
Figure reliability_figure(const std::vector<Record>& all, const FigureStyle& style) {
  constexpr struct {
    const char *method, *colour;
    int shape;
  } shown[] = {{"deflect", "#0072B2", 7}, {"BIC", "#D55E00", 5}};
  Sheet s("reliability", style, 100);
  std::string plots = "plot x with lines dt 2 lc rgb '#888888'";
  double y = s.heading("How often the first candidate is the truth", {}) + 0.7 * s.line(), x = 4;
  const auto key = [&](const std::string& name) {
    s.label(name, x + 6, y, "left");
    x += 9 + s.text_mm(name.size());
  };
  s.put("set arrow 1 from {} to {} nohead dt 2 lc rgb '#888888'", s.at(x, y).substr(3), s.at(x + 5, y).substr(3));
  key("calibrated");
  std::size_t sets = 0;
  for (const auto& each : shown) {
    s.put("${} << EOD", each.method);
    std::size_t own = 0;
    for (const Reliability& r : reliability(all)) {
      if (r.method != each.method) continue;
      const auto n = static_cast<double>(r.sets);
      const double z = 1.96, middle = (r.right + z * z / (2 * n)) / (1 + z * z / n),
                   half = z * std::sqrt(r.right * (1 - r.right) / n + z * z / (4 * n * n)) / (1 + z * z / n);
      s.put("{:.6g} {:.6g} {:.6g} {:.6g} {}", r.mean, r.right, middle - half, middle + half, r.sets);
      own += r.sets;
    }
    s.put("EOD");
    sets = std::max(sets, own);
    s.put("set label {} '' {} point pt {} ps 0.7 lc rgb '{}'", 50 + each.shape, s.at(x + 3.5, y), each.shape,
          each.colour);
    key(each.method);
    plots += fmt::format(
        ", ${0} using 1:2:3:4 with yerrorbars pt {1} ps 0.7 lw 1.2 lc rgb '{2}', '' using 1:4:5 with labels offset "
        "0,0.7 "
        "{3} textcolor rgb '{2}'",
        each.method, each.shape, each.colour, s.font(0.75));
  }
  y += 0.9 * s.line();
  const Tics tics{0.2, 3};
  const double left = s.left_of(tics), side = s.width() - left - 4;
  s.panel(left, y, side, side);
  s.axis_names("probability given to the first candidate (mean of the bin)", "how often it is the truth", tics);
  s.put("unset key\nset xrange [0:1]\nset yrange [0:1.1]\nset xtics 0.2\nset ytics 0.2");
  s.plot(plots);
  return s.figure(
      y + side + s.below(),
      fmt::format("How often the first candidate of a diagnosis is the truth, over the probability given to it, "
                  "both shares of 1, on {} simulated sets with at most one hidden effect: deflect and, beside it, BIC "
                  "with tolerances under their priors. Points: means of bins of the probability; bars: 95 % "
                  "intervals of the share (Wilson); numbers: sets in the bin; dashed: calibrated.",
                  sets));
}

Json report_json(const std::vector<Record>& all) {
  Json out;
  out["scores"] = Json::array();
  for (const Score& s : scores(all)) {
    Json row = {{"name", s.name}, {"goal", s.goal}, {"sets", s.sets}};
    for (std::size_t i = 0; i < s.values.size(); ++i)
      if (!std::isnan(s.values[i])) row[method_names[i]] = s.values[i];
    out["scores"].push_back(row);
  }
  out["reliability"] = Json::array();
  for (const Reliability& r : reliability(all))
    out["reliability"].push_back({{"method", r.method},
                                  {"low", r.low},
                                  {"high", r.high},
                                  {"mean_probability", r.mean},
                                  {"share_right", r.right},
                                  {"sets", r.sets}});
  out["sets"] = Json::array();
  for (const Record& r : all) out["sets"].push_back(set_json(r));
  return out;
}

}  // namespace deflect::benchmark
