#include "validation/figures/compare_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "msa/base/index.h"
#include "validation/figures/channels.h"
#include "validation/figures/load_curves.h"
#include "validation/figures/residual_map.h"
#include "validation/figures/sheet.h"
#include "validation/report/compare_words.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

/// By reading in the order taken, x y z apart, with the band of ±2 standard deviations of what noise and tolerances
/// give; colour by axis.
std::optional<Figure> residuals(const compare::Comparison& c, const FigureStyle& style) {
  const report::ErrorUnit unit = report::error_unit(c);
  const std::vector<report::ReadingCells> cells = report::cells_of(c);
  Sheet s("residuals", style, 160);
  std::string data = "$data << EOD\n";
  const double band = 2 * report::um * c.noise_and_tolerances;
  Vector3 low = Vector3::Constant(-band), high = -low;
  std::array<bool, 3> measured = {};
  double last = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double at = c.study.sequence ? *c.study.data->readings[i].sequence : static_cast<double>(i);
    last = std::max(last, at);
    data += fmt::format("{}", at);
    for (int k = 0; k < 3; ++k) {
      const double r = report::um * cells[i].residual(k);
      data += fmt::format(" {}", r);
      if (!std::isfinite(r)) continue;
      nth(measured, k) = true;
      low(k) = std::min(low(k), r), high(k) = std::max(high(k), r);
    }
    data += "\n";
  }
  s.put("{}EOD\nset multiplot\nunset key", data);
  const std::string order = c.study.sequence ? "in the order taken" : "in the order of the file";
  double y = s.heading("Residuals " + order, {report::subjects(c)}) + 0.6 * s.line();
  const double height = std::max(5.2 * s.line(), 0.165 * s.width()), gap = 1.1 * s.line();
  std::array<Tics, 3> tics;
  Tics widest;
  for (int k = 0; k < 3; ++k) {
    const double room = 0.06 * std::max(high(k) - low(k), 1e-6);
    low(k) -= room, high(k) += room;
    nth(tics, k) = s.tics(low(k), high(k), height, true);
    widest.letters = std::max(widest.letters, nth(tics, k).letters);
  }
  const double left = s.left_of(widest), w = s.width() - left - 4;
  s.put("set xrange [0:{}]\nset xtics {}\nset xzeroaxis lt 1 lc rgb '#404040' lw 0.7", 1.01 * std::max(last, 1.0),
        s.tics(0, last, w).step);
  const auto below =
      static_cast<int>(std::find(measured.rbegin(), measured.rend(), true).base() - measured.begin()) - 1;
  for (int k = 0; k < 3; ++k) {
    if (!nth(measured, k)) continue;
    s.panel(left, y, w, height);
    s.axis_names(k == below ? "reading" : "", fmt::format("{} ({})", unit.components[k], unit.micro), widest);
    s.put("set object 1 rectangle from graph 0,first {} to graph 1,first {} fc rgb '#E8E8E8' fs solid noborder behind",
          -band, band);
    s.put("set yrange [{}:{}]\nset ytics {}\nset format x '{}'", low(k), high(k), nth(tics, k).step,
          k == below ? "%g" : "");
    s.plot(fmt::format("plot $data using 1:{} with points pt 7 ps 0.3 lc rgb '{}'", k + 2, colours[k]));
    y += height + gap;
  }
  s.put("unset multiplot");
  return s.figure(
      y - gap + s.below(),
      fmt::format("Residuals of every reading {}, component by component, in {}. Grey: ±2 standard deviations "
                  "({:.3g} {}) of what noise and tolerances give with nothing missing. {} {} {}",
                  order, unit.micro, band, unit.micro, report::axes_sentence(c), report::data_sentence(c),
                  report::noise_sentence(c)));
}

/// Rms by axis, direction, magnitude, heading against what noise and tolerances give.
std::optional<Figure> groups(const compare::Comparison& c, const FigureStyle& style) {
  const report::ErrorUnit unit = report::error_unit(c);
  Sheet s("groups", style, 160);
  std::string labels, data = "$data << EOD\n";
  int at = 0;
  std::size_t longest = 1;
  const double floor = unit.fine * c.noise_and_tolerances;
  double most = floor;
  for (const auto* list : {&c.by_axis, &c.by_direction, &c.by_magnitude, &c.by_heading}) {
    if (list->empty()) continue;
    for (const compare::Errors& e : *list) {
      if (e.quantity != unit.quantity) continue;
      data += fmt::format("{} {:.5g}\n", at, unit.fine * e.rmse);
      labels += fmt::format("{}{} {}", labels.empty() ? "" : ", ", gnuplot_tic_label(e.group), at);
      longest = std::max(longest, report::letters(e.group));
      most = std::max(most, unit.fine * e.rmse);
      ++at;
    }
    ++at;
  }
  s.put("{}EOD", data);
  const double y = s.heading("Residual by group: root mean square", {report::subjects(c)}) + 1.2 * s.line();
  const double left = s.text_mm(longest) + 3, w = s.width() - left - 5, height = 1.25 * s.line() * at;
  s.panel(left, y, w, height);
  s.axis_names(fmt::format("rms of measured − predicted ({})", unit.micro), "", {});
  s.put("unset key\nset ytics ({}) noenhanced\nset yrange [{}:-1]\nset xrange [0:{}]\nset xtics {}", labels, at - 1,
        1.08 * most, s.tics(0, most, w).step);
  s.put("set arrow 1 from {0},graph 0 to {0},graph 1 nohead dt 2 lc rgb '#D55E00' front", floor);
  const bool on_left = floor > 0.6 * most;
  s.label("noise and tolerances", left + w * floor / (1.08 * most) + (on_left ? -1 : 1), y - 0.4 * s.line(),
          fmt::format("{} textcolor rgb '#D55E00' {}", on_left ? "right" : "left", s.font(0.9)));
  s.plot("plot $data using (0):1:2:(0) with vectors nohead lw 5 lc rgb '#0072B2'");
  return s.figure(
      y + height + s.below(),
      fmt::format("Root mean square of the residual by component, direction of the load, its size{}, in {}. "
                  "Dashed: what noise and tolerances give with nothing missing. {} {} {}",
                  c.by_heading.empty() ? "" : ", loading or unloading", unit.micro, report::axes_sentence(c),
                  report::data_sentence(c), report::noise_sentence(c)));
}

/// Range of the curves of one kind.
struct CurveRange {
  double low_force = 0, high_force = 0, low = 0, high = 0;
};

/// A panel for each site's curve with its band of one standard deviation. Curves of a kind, forces or moments, share
/// their range; where both are there every panel has numbers of its own.
class ElongationPanels {
 public:
  ElongationPanels(const compare::Comparison& c, const FigureStyle& style)
      : c_(c), s_("elongation", style, 160), columns_(std::min<std::size_t>(s_.narrow() ? 2 : 3, c.curves.size())) {}

  Figure figure() {
    for (std::size_t k = 0; k < c_.curves.size(); ++k) put_curve(k);
    mixed_ = there_[0] && there_[1];
    measure();
    s_.put("set multiplot\nunset key");
    top_ = s_.heading("Force–elongation of the sites beyond the model", {report::subjects(c_)}) + 0.6 * s_.line();
    s_.put("set xzeroaxis lt 1 lc rgb '#808080' lw 0.6\nset yzeroaxis lt 1 lc rgb '#808080' lw 0.6");
    for (std::size_t k = 0; k < c_.curves.size(); ++k) draw(k);
    s_.put("unset multiplot");
    const std::size_t rows = (c_.curves.size() + columns_ - 1) / columns_;
    const double height = top_ + static_cast<double>(rows) * row_ + (mixed_ ? 0 : s_.below() - 1.1 * s_.line());
    return s_.figure(height, caption());
  }

 private:
  /// The data of a curve; its kind's range grows with it.
  void put_curve(std::size_t k) {
    const compare::ElongationCurve& curve = c_.curves[k];
    CurveRange& r = ranges_[curve.rotation];
    there_[curve.rotation] = true;
    s_.put("$c{} << EOD", k);
    for (std::size_t i = 0; i < curve.force.size(); ++i) {
      const double e = report::um * curve.elongation[i], deviation = report::um * curve.deviation[i];
      s_.put("{} {} {}", curve.force[i], e, deviation);
      r.low_force = std::min(r.low_force, curve.force[i]), r.high_force = std::max(r.high_force, curve.force[i]);
      r.low = std::min(r.low, e - deviation), r.high = std::max(r.high, e + deviation);
    }
    s_.put("EOD");
  }

  /// Room around the curves, tics and the size of a panel.
  void measure() {
    const double n = static_cast<double>(columns_), guess = s_.width() / n - 4 * s_.line();
    for (const int kind : {0, 1}) {
      CurveRange& r = ranges_[kind];
      const double x = std::max(0.05 * (r.high_force - r.low_force), 1e-6), z = std::max(0.06 * (r.high - r.low), 1e-6);
      r.low_force -= x, r.high_force += x, r.low -= z, r.high += z;
      across_[kind] = s_.tics(r.low_force, r.high_force, guess);
      up_[kind] = s_.tics(r.low, r.high, std::min(guess, 45.0), true);
    }
    widest_ = {1, std::max(there_[0] ? up_[0].letters : 1, there_[1] ? up_[1].letters : 1)};
    left_ = s_.left_of(widest_), gap_ = mixed_ ? left_ : 1.2 * s_.line();
    w_ = (s_.width() - left_ - 4 - gap_ * (n - 1)) / n, h_ = std::clamp(0.97 * w_, 6 * s_.line(), 45.0);
    row_ = h_ + (mixed_ ? s_.below() : 0) + 1.1 * s_.line();
  }

  void draw(std::size_t k) {
    const bool turn = c_.curves[k].rotation, bottom = mixed_ || k + columns_ >= c_.curves.size(),
               first = mixed_ || k % columns_ == 0;
    s_.panel(left_ + static_cast<double>(k % columns_) * (w_ + gap_), top_ + static_cast<double>(k / columns_) * row_,
             w_, h_);
    s_.axis_names(bottom ? (turn ? "moment (Nm)" : "force (N)") : "",
                  first ? (turn ? "turn (µrad)" : "elongation (µm)") : "", widest_);
    s_.put("set xrange [{}:{}]\nset xtics {}", ranges_[turn].low_force, ranges_[turn].high_force, across_[turn].step);
    s_.put("set yrange [{}:{}]\nset ytics {}", ranges_[turn].low, ranges_[turn].high, up_[turn].step);
    s_.put("set format x '{}'\nset format y '{}'", bottom ? "%g" : "", first ? "%g" : "");
    s_.put("set label 50 {} at graph 0.04,0.92 noenhanced", gnuplot_quote(c_.curves[k].site));
    s_.plot(fmt::format(
        "plot $c{0} using 1:($2-$3):($2+$3) with filledcurves fc rgb '#C6DBEF', '' using 1:2 with linespoints "
        "pt 7 ps 0.4 lw 1.4 lc rgb '#0072B2'",
        k));
  }

  std::string caption() const {
    const std::string what =
        !there_[1]   ? "elongation (µm, positive where pulled longer) over the force (N, positive where it pulls)"
        : !there_[0] ? "turn (µrad) over the moment (Nm), both positive about the joint's axis"
                     : "elongation (µm) over the force (N), or turn (µrad) over the moment (Nm)";
    const std::string sites =
        c_.study.standing->has_tool_point()
            ? fmt::format("What the sites ({} to {}) yield beyond the model", c_.curves.front().site,
                          c_.curves.back().site)
            : "What a member or support would have to yield beyond the model if all that is missing were there, of "
              "those that explain most; its force follows from statics alone or is as the model shares it out. Curves";
    return fmt::format("{}, read off the residuals without a law: {}. Band: one standard deviation. {} {} {}", sites,
                       what, report::axes_sentence(c_), report::data_sentence(c_), report::noise_sentence(c_));
  }

  const compare::Comparison& c_;
  Sheet s_;
  std::size_t columns_;
  CurveRange ranges_[2];  // of forces and of moments, as all pairs below
  bool there_[2] = {false, false}, mixed_ = false;
  Tics across_[2], up_[2], widest_;
  double left_ = 0, gap_ = 0, w_ = 0, h_ = 0, top_ = 0, row_ = 0;  // mm
};

/// Force–elongation curves of the sites beyond the model.
std::optional<Figure> elongation(const compare::Comparison& c, const FigureStyle& style) {
  if (c.curves.empty()) return std::nullopt;
  return ElongationPanels(c, style).figure();
}

/// To add a figure: declare it here, give it a row, define it in a file of its own.
using Draw = std::optional<Figure> (*)(const compare::Comparison&, const FigureStyle&);
constexpr Draw compared[] = {residuals, residual_map, groups, secant, elongation, loops};
constexpr std::array<Draw, 3> of_channels = {channels, groups, elongation};

}  // namespace

std::vector<Figure> compare_figures(const compare::Comparison& c, const FigureStyle& style) {
  std::vector<Figure> out;
  for (const Draw draw : c.study.standing->has_tool_point() ? std::span<const Draw>(compared) : of_channels)
    if (std::optional<Figure> f = draw(c, style)) out.push_back(std::move(*f));
  return out;
}

}  // namespace deflect::figures
