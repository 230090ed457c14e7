#include "validation/figures/history_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "validation/compare/placebo.h"
#include "validation/figures/sheet.h"
#include "validation/report/compare_words.h"
#include "validation/report/json_text.h"
#include "validation/report/text.h"

namespace deflect {
namespace {

constexpr double significant = 1e-3;

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

}  // namespace

History history(const std::vector<Comparison>& versions) {
  History h{versions, {std::nullopt}};
  for (std::size_t i = 1; i < versions.size(); ++i) h.placebo.emplace_back(placebo_rmse(versions[i - 1], versions[i]));
  return h;
}

std::string history_report(const History& h) {
  const std::vector<Comparison>& all = h.versions;
  std::vector<std::vector<std::string>> rows = {{"device", fmt::format("rms {}", error_unit(all.front()).micro),
                                                 "placebo", "held-out", "chi2/n", "noise and tolerances", "strained",
                                                 "tests that fail", "patterns left"}};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Comparison& c = all[i];
    const std::optional<double> wrong = h.placebo[i];
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

std::string history_json(const History& h) {
  const std::vector<Comparison>& all = h.versions;
  Json j;
  j["kind"] = "history";
  j["data"] = all.front().data;
  j["unit"] = error_unit(all.front()).milli;  // of what ends with _mm
  j["versions"] = Json::array();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Comparison& c = all[i];
    const std::optional<double> wrong = h.placebo[i];
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

std::string history_csv(const History& h) {
  const std::vector<Comparison>& all = h.versions;
  std::string out =
      fmt::format("device,rmse_{0},placebo_rmse_{0},held_out_rmse_{0},chi2_per_dof,noise_and_tolerances_{0},strained\n",
                  error_unit(all.front()).column);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Comparison& c = all[i];
    const std::optional<double> wrong = h.placebo[i];
    out += fmt::format("\"{}\",{:.6g},{},{:.6g},{:.6g},{:.6g},{}\n", c.device, um * c.all.rmse,
                       wrong ? fmt::format("{:.6g}", um * *wrong) : "", um * c.held_out, c.chi2_per_dof,
                       um * c.noise_and_tolerances, c.strained.size());
  }
  return out;
}

Figure history_figure(const History& h, const FigureStyle& style) {
  const std::vector<Comparison>& all = h.versions;
  const ErrorUnit unit = error_unit(all.front());
  const auto n = static_cast<double>(all.size());
  Sheet s("history", style, 160);
  double most = um * all.back().noise_and_tolerances;
  std::string data = "$data << EOD\n";
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double wrong = h.placebo[i] ? um * *h.placebo[i] : NAN;
    data += fmt::format("{} {:.6g} {:.6g} {:.6g}\n", i, um * all[i].all.rmse, um * all[i].held_out, wrong);
    for (const double x : {um * all[i].all.rmse, um * all[i].held_out, wrong})
      if (std::isfinite(x)) most = std::max(most, x);
  }
  s.put("{}EOD\nset multiplot\nunset key", data);

  // Legend: beside each other as far as the paper goes.
  constexpr struct {
    const char *name, *colour;
  } keys[] = {{"all poses", "#0072B2"}, {"held-out poses", "#8CC4E8"}, {"placebo in its place", "#BBBBBB"}};
  const char* floor_name = "noise and tolerances";
  double y =
      s.heading("The error falling from version to version",
                {fmt::format("measurements {}", all.front().data.substr(all.front().data.find_last_of('/') + 1))}) +
      0.7 * s.line();
  double x = 3;
  const auto key = [&](const char* name, const std::string& mark) {
    const double room = 7 + s.text_mm(letters(name)) + 2;
    if (x > 3 && x + room > s.width()) x = 3, y += 1.1 * s.line();
    s.put("{}", fmt::format(fmt::runtime(mark), fmt::format("{:.4f},1-{:.4f}/H", x / s.width(), y),
                            fmt::format("{:.4f},1-{:.4f}/H", (x + 5) / s.width(), y)));
    s.label(name, x + 6.5, y, "left");
    x += room;
  };
  int tag = 0;
  for (const auto& k : keys) {
    ++tag;
    key(k.name, fmt::format("set arrow {} from screen {{}} to screen {{}} nohead lw 7 lc rgb '{}'", tag, k.colour));
  }
  key(floor_name, "set arrow 4 from screen {} to screen {} nohead dt 2 lw 1.5 lc rgb '#D55E00'");
  y += 1.2 * s.line();

  const double height = std::clamp(0.4 * s.width(), 8 * s.line(), 75.0);
  const Tics tics = s.tics(0, 1.08 * most, height, true);
  const double left = s.left_of(tics), w = s.width() - left - 4;
  s.panel(left, y, w, height);
  s.axis_names(
      "",
      fmt::format(s.narrow() ? fmt::runtime("rms residual ({})") : fmt::runtime("rms of measured − predicted ({})"),
                  unit.micro),
      tics);
  // Names under the bars, in as many lines as they need.
  std::size_t lines = 1;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::string name = clip(all[i].device, 40);
    const std::size_t most_letters = s.letters_in(w / n - 2);
    std::vector<std::string> parts;
    while (letters(name) > most_letters && parts.size() < 4) {
      std::size_t cut = name.find_last_of("-_ ", most_letters);
      cut = cut == std::string::npos || cut == 0 ? most_letters : cut + 1;
      parts.push_back(name.substr(0, cut));
      name.erase(0, cut);
    }
    parts.push_back(name);
    lines = std::max(lines, parts.size());
    for (std::size_t k = 0; k < parts.size(); ++k)
      s.label(parts[k], left + w * (static_cast<double>(i) + 0.6) / (n + 0.2),
              y + height + (1.1 + static_cast<double>(k)) * s.line(), "center");
  }
  s.put("set format x ''\nset xtics 1\nset xrange [-0.6:{}]\nset yrange [0:{}]\nset ytics {}", n - 0.4, 1.08 * most,
        tics.step);
  s.put("set boxwidth 0.24\nset style fill solid noborder");
  s.plot(
      fmt::format("plot $data using ($1-0.26):2 with boxes lc rgb '{}', '' using 1:3 with boxes lc rgb '{}', '' using "
                  "($1+0.26):4 with boxes lc rgb '{}', {} with lines dt 2 lw 1.5 lc rgb '#D55E00'",
                  keys[0].colour, keys[1].colour, keys[2].colour, um * all.back().noise_and_tolerances));
  s.put("unset multiplot");
  std::string names;
  for (const Comparison& c : all) names += (names.empty() ? "" : ", ") + c.device;
  return s.figure(
      y + height + (static_cast<double>(lines) + 0.9) * s.line(),
      fmt::format("Root mean square of measured − predicted in {} for the versions {}, over all poses and at held-out "
                  "poses, to which tolerances were bent by what the other poses say; placebo: the same change of the "
                  "predictions with its sign drawn by lot at every pose. Dashed: what noise and tolerances give with "
                  "nothing missing, {:.3g} {}. {} {} {}",
                  unit.micro, names, um * all.back().noise_and_tolerances, unit.micro, axes_sentence(all.front()),
                  data_sentence(all.front()), noise_sentence(all.front())));
}

}  // namespace deflect
