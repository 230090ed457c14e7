#include "validation/figures/plan_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/figures/sheet.h"
#include "validation/report/short_lists.h"
#include "validation/report/text.h"
#include "validation/report/verdict_words.h"

namespace deflect::figures {
namespace {

constexpr std::size_t most_effects = 40;  // rows of a matrix

double least_of(const plan::Step& s) {
  double out = INFINITY;
  for (const plan::Pair& p : s.pairs) out = std::min(out, p.separation);
  return out;
}

std::string names_of(const plan::Plan& p) {
  std::string out;
  for (const plan::Rival& r : p.rivals) out += (out.empty() ? "" : ", ") + report::placed_words(r.own());
  return out;
}

}  // namespace

Figure plan_figure(const plan::Plan& p, const FigureStyle& style) {
  Sheet s("plan", style, 120);
  double most = 1, readings = 1;
  std::string data = "$data << EOD\n";
  for (const plan::Step& step : p.steps) {
    data += fmt::format("{} {:.6g} {:.6g}\n", step.readings, step.probability, least_of(step));
    most = std::max(most, least_of(step));
    readings = std::max(readings, static_cast<double>(step.readings));
  }
  s.put("{}EOD\nset multiplot\nunset key", data);
  const double y = s.heading("What each further reading brings", {names_of(p)}) + 0.6 * s.line();
  const double height = std::clamp(0.3 * s.width(), 7 * s.line(), 45.0);
  const Tics across = s.tics(0, readings, s.width() - 8 * s.line()), up = s.tics(0, 1, height, true),
             other = s.tics(0, 1.05 * most, height, true);
  const double left = std::max(s.left_of(up), s.left_of(other)), w = s.width() - left - 4;
  s.put("set xrange [0:{}]\nset xtics {}", readings, across.step);
  s.panel(left, y, w, height);
  s.axis_names("", "expected probability", up);
  s.put("set yrange [0:1]\nset ytics {}\nset format x ''", up.step);
  s.plot(fmt::format("plot $data using 1:2 with linespoints pt 7 ps 0.4 lw 1.4 lc rgb '{}'", colours[0]));
  const double below = y + height + 0.8 * s.line();
  s.panel(left, below, w, height);
  s.axis_names("readings", s.narrow() ? "least λ²" : "least separation λ²", other);
  s.put("set yrange [0:{}]\nset ytics {}\nset format x '%g'", 1.05 * most, other.step);
  s.plot(fmt::format("plot $data using 1:3 with linespoints pt 5 ps 0.4 lw 1.4 lc rgb '{}'", colours[1]));
  s.put("unset multiplot");
  return s.figure(
      below + height + s.below(),
      fmt::format("Expected probability of the true effect among {}, and the smallest expected separation λ² between "
                  "two of them (2 ln of the ratio of likelihoods), over the number of readings planned for {}; mean "
                  "over parameters drawn from what the readings taken say of them.",
                  names_of(p), p.subject));
}

Figure foresight_figure(const plan::Foresight& f, const FigureStyle& style) {
  Sheet s("foresight", style, 170);
  const std::vector<diagnosis::Detectable>& all = f.given.detectable;
  std::vector<std::size_t> order(all.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  if (order.size() > most_effects) {  // those that are seen least
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return all[a].lambda_at_start < all[b].lambda_at_start; });
    order.resize(most_effects);
    std::sort(order.begin(), order.end());
  }
  const auto n = static_cast<double>(order.size());
  std::string data = "$cosines << EOD\n";
  std::size_t longest = 1, widest = 1;
  for (std::size_t row = 0; row < order.size(); ++row) {
    longest = std::max(longest, report::letters(f.given.names[order[row]]));
    widest = std::max(widest, report::letters(report::sizes_of(all[order[row]])));
    for (std::size_t column = 0; column < order.size(); ++column)
      data +=
          fmt::format("{} {} {:.4f}\n", column, row, f.given.cosines(as_index(order[row]), as_index(order[column])));
  }
  s.put("{}EOD\nset multiplot\nunset key", data);
  double y = s.heading("What this campaign cannot tell apart",
                       {fmt::format("{}, {}; right: smallest size that shows (λ = 4)", f.subject, f.campaign)}) +
             0.4 * s.line();
  const double small = 0.72, left = 4 + s.text_mm(std::min<std::size_t>(longest, 34), small),
               right = s.text_mm(std::min<std::size_t>(widest, 34), small) + 4;
  const double side = std::max(40.0, std::min(s.width() - left - right, n * 1.05 * s.line()));
  s.panel(left, y, side, side);
  s.put("set xrange [-0.5:{0}]\nset yrange [{0}:-0.5]\nunset xtics\nunset ytics\nunset grid", n - 0.5);
  s.put("set palette defined (0 '#ffffff', 0.7 '#cfe3f2', 0.9 '#56a0d3', 0.995 '#0072B2', 1 '#D55E00')");
  s.put("set cbrange [0:1]\nunset colorbox");
  for (std::size_t row = 0; row < order.size(); ++row) {
    const double at = y + side * (static_cast<double>(row) + 0.5) / n;
    s.label(report::clip(f.given.names[order[row]], 34), left - 1.5, at, "right " + s.font(small));
    s.label(report::clip(report::sizes_of(all[order[row]]), 34), left + side + 1.5, at, "left " + s.font(small));
  }
  s.plot("plot $cosines using 1:2:3 with image pixels");
  s.put("unset multiplot");
  return s.figure(
      y + side + 0.8 * s.line(),
      fmt::format("Cosines between the changes that effects make in the readings of {} ({} readings) of {}, weighed by "
                  "noise and tolerances: white 0, blue 0.995, orange 1: no data of this campaign tell such two apart. "
                  "Columns in the order of the rows. Right: the smallest size of each effect that shows, λ = 4.",
                  f.campaign, f.given.readings.readings.size(), f.subject));
}

}  // namespace deflect::figures
