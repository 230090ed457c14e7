#include "validation/figures/load_curves.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/figures/sheet.h"
#include "validation/report/compare_words.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

constexpr double micro = 1e6;

/// Lines of load, measured, predicted for one component, blank lines between poses; ranges of both axes.
struct Curve {
  std::string data;
  double low_load = INFINITY, high_load = -INFINITY, low = INFINITY, high = -INFINITY;

  void add(double load, double measured, double predicted) {
    data += fmt::format("{} {} {}\n", load, measured, predicted);
    low_load = std::min(low_load, load), high_load = std::max(high_load, load);
    low = std::min({low, measured, predicted}), high = std::max({high, measured, predicted});
  }
  void widen() {
    const double x = std::max(0.05 * (high_load - low_load), 1e-9), y = std::max(0.06 * (high - low), 1e-9);
    low_load -= x, high_load += x, low -= y, high += y;
  }
};

struct Words {
  std::string name, title, up, short_up, caption;
  bool joined = false;  ///< measured points by a line
};

std::optional<Figure> panels(const compare::Comparison& c, std::array<Curve, 3> curves, const Words& words,
                             const FigureStyle& style) {
  const report::ErrorUnit unit = report::error_unit(c);
  std::vector<std::size_t> drawn;
  for (std::size_t k = 0; k < 3; ++k)
    if (curves[k].low_load < INFINITY) drawn.push_back(k);
  if (drawn.empty()) return std::nullopt;

  Sheet s(words.name, style, 160);
  const std::size_t columns = s.narrow() ? 1 : drawn.size();
  const auto n = static_cast<double>(columns);
  const double guess = s.width() / n - 5 * s.line();
  Tics across[3], up[3], widest;
  for (const std::size_t k : drawn) {
    curves[k].widen();
    s.put("$d{} << EOD\n{}EOD", k, curves[k].data);
    across[k] = s.tics(curves[k].low_load, curves[k].high_load, guess);
    up[k] = s.tics(curves[k].low, curves[k].high, s.narrow() ? 0.5 * guess : 50, true);
    widest.letters = std::max(widest.letters, up[k].letters);
  }
  const double left = s.left_of(widest), gap = s.text_mm(widest.letters) + 1.4 * s.line();
  const double w = (s.width() - left - 4 - gap * (n - 1)) / n, h = s.narrow() ? 0.5 * w : std::min(1.25 * w, 54.0);
  s.put("set multiplot\nunset key");
  double y = s.heading(words.title, {report::subjects(c)}) + 0.6 * s.line();
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    const std::size_t k = drawn[i];
    s.panel(left + static_cast<double>(i % columns) * (w + gap), y, w, h);
    s.axis_names(fmt::format("{} ({})", unit.loads[k], unit.load),
                 i % columns == 0 ? (s.narrow() ? words.short_up : words.up) : "", widest);
    s.put("set xrange [{}:{}]\nset xtics {}", curves[k].low_load, curves[k].high_load, across[k].step);
    s.put("set yrange [{}:{}]\nset ytics {}", curves[k].low, curves[k].high, up[k].step);
    s.plot(fmt::format(
        "plot $d{} using 1:3 with lines lc rgb '#808080' lw 0.9, '' using 1:2 with {} pt 7 ps 0.35 lw 0.8 lc "
        "rgb '{}'",
        k, words.joined ? "linespoints" : "points", colours[k]));
    if ((i + 1) % columns == 0) y += h + s.below() + (i + 1 < drawn.size() ? 0.5 * s.line() : 0);
  }
  s.put("unset multiplot");
  return s.figure(y, fmt::format("{} {} {} {}", words.caption, report::axes_sentence(c), report::data_sentence(c),
                                 report::noise_sentence(c)));
}

std::string displacement(const report::ErrorUnit& unit) { return unit.rotations ? "rotation" : "displacement"; }

}  // namespace

std::optional<Figure> secant(const compare::Comparison& c, const FigureStyle& style) {
  const report::ErrorUnit unit = report::error_unit(c);
  const std::vector<report::ReadingCells> cells = report::cells_of(c);
  std::array<Curve, 3> curves;
  for (int k = 0; k < 3; ++k)
    for (const measurement::PoseGroup& group : c.study.data->poses) {
      std::vector<std::size_t> order;
      for (const std::size_t i : group.readings)
        if (cells[i].pure && cells[i].load(k) != 0 && std::isfinite(cells[i].measured(k))) order.push_back(i);
      std::sort(order.begin(), order.end(),
                [&](std::size_t a, std::size_t b) { return cells[a].load(k) < cells[b].load(k); });
      for (const std::size_t i : order)
        nth(curves, k).add(cells[i].load(k), micro * cells[i].measured(k) / cells[i].load(k),
                           micro * cells[i].predicted(k) / cells[i].load(k));
      if (!order.empty()) nth(curves, k).data += "\n";
    }
  const std::string per = fmt::format("{}/{}", unit.micro, unit.load);
  return panels(
      c, curves,
      {"secant", fmt::format("Secant compliance along the load: measured (points) and predicted (lines)"),
       fmt::format("secant compliance ({})", per), fmt::format("compliance ({})", per),
       fmt::format("Secant compliance, {} along the load over the load ({}), over the load ({}); readings under one "
                   "component alone. Points: measured; grey lines: predicted, one for each pose.",
                   displacement(unit), per, unit.load),
       false},
      style);
}

std::optional<Figure> loops(const compare::Comparison& c, const FigureStyle& style) {
  const report::ErrorUnit unit = report::error_unit(c);
  const std::vector<report::ReadingCells> cells = report::cells_of(c);
  const auto worst =
      std::max_element(c.by_pose.begin(), c.by_pose.end(),
                       [](const compare::Errors& a, const compare::Errors& b) { return a.rmse < b.rmse; });
  const measurement::PoseGroup& group = nth(c.study.data->poses, worst - c.by_pose.begin());
  std::vector<std::size_t> order = group.readings;
  if (c.study.sequence)
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return c.study.data->readings[a].sequence < c.study.data->readings[b].sequence;
    });
  std::array<Curve, 3> curves;
  for (int k = 0; k < 3; ++k) {
    const auto loaded = [&](std::size_t i) { return cells[i].pure && cells[i].load(k) != 0; };
    if (std::none_of(order.begin(), order.end(),
                     [&](std::size_t i) { return loaded(i) && std::isfinite(cells[i].measured(k)); }))
      continue;
    for (const std::size_t i : order)
      if ((loaded(i) || (cells[i].pure && cells[i].load.isZero(0))) && std::isfinite(cells[i].measured(k)))
        nth(curves, k).add(cells[i].load(k), micro * cells[i].measured(k), micro * cells[i].predicted(k));
  }
  return panels(
      c, curves,
      {"loops",
       fmt::format("{} over load in the order taken, {}", unit.rotations ? "Rotation" : "Displacement", worst->group),
       fmt::format("{} along the load ({})", displacement(unit), unit.micro),
       fmt::format("{} ({})", displacement(unit), unit.micro),
       fmt::format("{} along the load ({}) over the load ({}) at {}, where the misfit is largest ({:.3g} {} "
                   "rms); readings under one component alone{}. Coloured: measured; grey: predicted.",
                   unit.rotations ? "Rotation" : "Displacement", unit.micro, unit.load, worst->group,
                   micro * worst->rmse, unit.micro, c.study.sequence ? ", in the order taken" : ""),
       c.study.sequence},
      style);
}

}  // namespace deflect::figures
