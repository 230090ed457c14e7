#include "validation/figures/fig10.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "validation/figures/sheet.h"
#include "validation/report/by_point.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

struct Look {
  const char* colour;  // Okabe–Ito, told apart with any colour vision
  const char* light;
  int filled, open;  // gnuplot's point types
};
constexpr Look looks[] = {{"#0072B2", "#8CC4E8", 7, 6}, {"#D55E00", "#F3B587", 5, 4}, {"#009E73", "#8ED6BF", 13, 12}};
constexpr int further_shapes[] = {2, 1, 3};  // of the third theory and those after it: crosses, alike on all axes
constexpr const char* capitals[] = {"X", "Y", "Z"};

constexpr double right = 3, panel = 0.3875, strip = 0.1375;  // mm; heights in widths of the figure

struct Unit {
  const char* name;
  double per_mm;
};
constexpr Unit units[] = {{"mm", 1}, {"µm", 1e3}, {"nm", 1e6}, {"pm", 1e9}, {"fm", 1e12}};

/// 1, 2 or 5 times a power of ten, the largest that is not above x > 0.
double nice_below(double x) {
  const double power = std::pow(10, std::floor(std::log10(x)));
  const double lead = x / power;
  return (lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power;
}

/// The component along the load, mm.
double along(const studies::ValidationRow& row, const Vector6& displacement) {
  const double value = displacement[row.axis];
  if (!std::isfinite(value))
    throw std::invalid_argument(
        fmt::format("point {}: deflection along {} is {}", row.point.label, report::axis_names[row.axis], value));
  return value;
}

/// Columns of the inline data for x, y, z each: point's index, then every theory, as printed, and the residuals of the
/// first theory against each other one (in `unit`).
struct Columns {
  std::size_t theories;
  std::size_t as_printed() const { return theories; }
  std::size_t residual(std::size_t theory) const { return theories + theory; }
  int number(std::size_t series, std::size_t axis) const { return static_cast<int>(2 + 3 * series + axis); }
};

struct Data {
  std::string block;
  double low = 0, high = 0,
         residual = 0;  ///< extremes of the deflections with zero, mm; largest |residual|, mm
  Unit unit = units[0];
};

void widen(Data& data, const studies::ValidationRow& row) {
  const double first = along(row, row.displacements.front());
  for (const Vector6& displacement : row.displacements) {
    const double value = along(row, displacement);
    data.residual = std::max(data.residual, std::abs(first - value));
    data.low = std::min(data.low, value);
    data.high = std::max(data.high, value);
  }
  if (!row.as_printed) return;
  data.low = std::min(data.low, along(row, *row.as_printed));
  data.high = std::max(data.high, along(row, *row.as_printed));
}

/// The cells of one series at one point; NaN where there is no row, or the series has no number.
template <class Value>
std::string cells(const report::PointRows& p, const Value& value) {
  std::string text;
  for (const studies::ValidationRow* row : p.rows) {
    const std::optional<double> v = row ? value(*row) : std::nullopt;
    text += v ? fmt::format(" {}", *v) : " NaN";
  }
  return text;
}

Data data_of(const std::vector<report::PointRows>& points, std::size_t theories) {
  Data data;
  for (const report::PointRows& p : points)
    for (const studies::ValidationRow* row : p.rows)
      if (row) widen(data, *row);
  const auto readable = [&](const Unit& unit) { return data.residual * unit.per_mm >= 1; };
  const auto found = std::find_if(std::begin(units), std::end(units), readable);
  data.unit = data.residual == 0 ? units[2] : found == std::end(units) ? *std::prev(found) : *found;

  using Value = std::optional<double>;
  data.block = "$data << EOD\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    data.block += fmt::format("{}", i);
    for (std::size_t t = 0; t < theories; ++t)
      data.block +=
          cells(points[i], [&](const studies::ValidationRow& r) -> Value { return along(r, r.displacements[t]); });
    data.block += cells(points[i], [&](const studies::ValidationRow& r) -> Value {
      return r.as_printed ? Value(along(r, *r.as_printed)) : std::nullopt;
    });
    for (std::size_t t = 1; t < theories; ++t)
      data.block += cells(points[i], [&](const studies::ValidationRow& r) -> Value {
        return (along(r, r.displacements[0]) - along(r, r.displacements[t])) * data.unit.per_mm;
      });
    data.block += "\n";
  }
  data.block += "EOD\n";
  return data;
}

/// Labels under the points: upright or, where they would touch, turned, and then as many as fit.
struct PointLabels {
  std::string labels, bare;  ///< the list with the labels and with empty ones
  bool turned = false;
  double height = 0;  ///< mm
};

PointLabels labels_of(const std::vector<report::PointRows>& points, double room, const Sheet& s) {
  constexpr std::size_t most = 16;  // letters of a label
  std::size_t longest = 1;
  for (const report::PointRows& p : points)
    longest = std::max(longest, std::min(most, report::letters(p.point->label)));
  const double upright = s.text_mm(longest + 1);
  PointLabels l;
  l.turned = longest > 3 && upright > room;
  const auto every = static_cast<std::size_t>(std::max(1.0, std::ceil((l.turned ? s.line() : upright) / room)));
  for (std::size_t i = 0; i < points.size(); i += every) {
    l.labels += fmt::format("{}{} {}", i ? ", " : "", gnuplot_tic_label(report::clip(points[i].point->label, most)), i);
    l.bare += fmt::format("{}'' {}", i ? ", " : "", i);
  }
  l.height = l.turned ? s.text_mm(longest) : s.line();
  return l;
}

bool there(const std::vector<report::PointRows>& points, std::size_t axis, bool as_printed) {
  return std::any_of(points.begin(), points.end(), [&](const report::PointRows& p) {
    return p.rows[axis] && (!as_printed || p.rows[axis]->as_printed);
  });
}

/// How a series is drawn.
struct Stroke {
  std::size_t series;  ///< of Columns
  const char* colour;
  std::string name;
  int shape;
  double marker, width;
};

std::vector<Stroke> strokes_of(const theories::Theories& theories, const std::vector<report::PointRows>& points,
                               std::size_t axis) {
  const Look& look = looks[axis];
  std::vector<Stroke> out;
  if (there(points, axis, true))
    out.push_back({Columns{theories.size()}.as_printed(), look.light, "As printed", look.filled, 0.7, 0.8});
  if (!there(points, axis, false)) return out;
  for (std::size_t t = 0; t < theories.size(); ++t) {
    const int shape = t == 0 ? look.filled : t == 1 ? look.open : further_shapes[(t - 2) % std::size(further_shapes)];
    out.push_back({t, look.colour, theories[t]->legend, shape, t == 0 ? 0.5 : 1.1, 0.8});
  }
  return out;
}

/// A column for each axis, where the paper is too narrow a row for each, or all below each other; y below it.
double put_legend(Sheet& s, const theories::Theories& theories, const std::vector<report::PointRows>& points,
                  double top, double left) {
  const double line = s.line(), mark = 0.6 * line, entry = mark + 1 + 0.9 * s.text_mm(12) + 2;
  std::size_t most = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) most = std::max(most, strokes_of(theories, points, axis).size());
  const double room = s.width() - left;
  const bool beside = 3 * entry <= room + 2, in_rows = !beside && static_cast<double>(most) * entry <= room + 2;
  double foot = top;
  std::size_t at = 0;
  int tag = 60;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<Stroke> strokes = strokes_of(theories, points, axis);
    for (std::size_t i = 0; i < strokes.size(); ++i, ++at, ++tag) {
      const std::size_t column = beside ? axis : in_rows ? i : 0, row = beside ? i : in_rows ? axis : at;
      const double x = left + static_cast<double>(column) * entry,
                   y = top + (static_cast<double>(row) + 0.5) * 1.05 * line;
      const Stroke& stroke = strokes[i];
      s.put("set label {} '' {} point pt {} ps {} lw {} lc rgb '{}'", tag, s.at(x + mark / 2, y), stroke.shape,
            stroke.marker, stroke.width, stroke.colour);
      s.label(fmt::format("{}-{}", capitals[axis], stroke.name), x + mark + 1, y, "left");
      foot = std::max(foot, y + 0.55 * line);
    }
  }
  return foot;
}

std::string poses_text(const std::vector<report::PointRows>& points) {
  Vector6 low = points.front().point->pose_mm_deg, high = low;
  for (const report::PointRows& p : points)
    low = low.cwiseMin(p.point->pose_mm_deg), high = high.cwiseMax(p.point->pose_mm_deg);
  constexpr const char* names[] = {"x", "y", "z", "roll", "pitch", "yaw"};
  std::string out;
  for (int i = 0; i < 6; ++i) {
    if (i >= 3 && low(i) == 0 && high(i) == 0) continue;
    out += fmt::format("{}{} {:.4g}{}{}", out.empty() ? "" : ", ", names[i], low(i) + 0.0,
                       low(i) == high(i) ? "" : fmt::format(" … {:.4g}", high(i) + 0.0), i < 3 ? " mm" : "°");
  }
  return out;
}

/// "analytic − MSA", "analytic − others".
std::string residual_name(const theories::Theories& theories) {
  return theories[0]->title + " − " + (theories.size() == 2 ? theories[1]->title : "others");
}

std::string caption_of(const studies::Validation& validation, const std::vector<report::PointRows>& points,
                       const Data& data) {
  std::vector<std::string> captions;
  for (const theories::Theory* theory : validation.theories) captions.push_back(theory->caption);
  const std::string below =
      validation.theories.size() < 2
          ? ""
          : fmt::format("Below: {} along the force in {}, at most {:.2g} {}. ", residual_name(validation.theories),
                        data.unit.name, data.residual * data.unit.per_mm, data.unit.name);
  return fmt::format(
      "Linear deflection of the tool point of {} along a force of {} on it in x, y and z in turn (mm, base axes, "
      "positive "
      "along a positive force) at {} points of the workspace ({}), by {}{}. {}Computed, no measurements and no noise.",
      validation.device, report::load_text(validation), points.size(), poses_text(points),
      fmt::join(captions, " and by "),
      report::has_as_printed(validation)
          ? ", and by the closed form with " + report::errata_text(validation) + " as printed"
          : "",
      below);
}

/// The deflections above, what the theories differ by below.
class Fig10 {
 public:
  Fig10(const studies::Validation& v, const FigureStyle& style)
      : v_(v), points_(report::by_point(v)), data_(data_of(points_, v.theories.size())), s_("fig10", style, 160) {}

  Figure draw() {
    const double line = s_.line();
    measure();
    s_.put("{}set multiplot\nunset key", data_.block);
    s_.put("set xrange [-0.5:{}]", static_cast<double>(points_.size()) - 0.5);
    std::vector<std::string> notes = {"Force at the tool point, its displacement along the force, base axes"};
    if (report::has_as_printed(v_)) notes.push_back("As printed: analytic theory with " + report::errata_text(v_));
    const double x = s_.narrow() ? 2 : left_;
    const double keys = s_.heading(
        fmt::format("{}: linear deflection under {} in x, y, z", report::clip(v_.device, 50), report::load_text(v_)),
        notes, x);
    const double top = put_legend(s_, v_.theories, points_, keys + 0.2 * line, x) + 0.6 * line;
    double foot = top + std::max(panel * s_.width(), 10 * line);
    deflections(top, foot - top);
    for (int tag = 60; tag < 90; ++tag) s_.put("unset label {}", tag);
    if (v_.theories.size() > 1) {
      const double below = foot + 1.25 * line, height = std::max(strip * s_.width(), 5.5 * line);
      residuals(below, height);
      foot = below + height;
    }
    s_.put("unset multiplot");
    return s_.figure(foot + 1.9 * line + tics_.height, caption_of(v_, points_, data_));
  }

 private:
  /// Two per cent of margin, so that no marker sits on the frame; whole steps at both ends.
  void measure() {
    const double span = data_.high > data_.low ? data_.high - data_.low : 1;
    step_ = nice_below(span / 3.5);
    low_ = std::floor((data_.low - 0.02 * span) / step_) * step_;
    high_ = std::ceil((data_.high + 0.02 * span) / step_) * step_;
    residual_ = data_.residual > 0 ? data_.residual * data_.unit.per_mm : 1;
    widest_ = {step_, 1};
    for (const double number : {low_, high_, -nice_below(residual_)})
      widest_.letters = std::max(widest_.letters, report::letters(fmt::format("{:.6g}", number)));
    left_ = s_.left_of(widest_) + s_.line();  // two lines name the strip's axis
    w_ = s_.width() - left_ - right;
    const double room = w_ / static_cast<double>(points_.size());
    tics_ = labels_of(points_, room, s_);
    // Markers shrink where points are many; x, y, z stand side by side, or those that coincide would hide each other.
    marker_ = std::clamp(room / 8, 0.35, 1.0);
    aside_ = std::min(2.5 / room, 0.22);
  }

  std::string place(std::size_t series, std::size_t axis) const {
    return fmt::format("$data using ($1{:+.4f}):{}", aside_ * (static_cast<double>(axis) - 1),
                       columns().number(series, axis));
  }

  Columns columns() const { return {v_.theories.size()}; }

  void deflections(double top, double height) {
    const bool alone = v_.theories.size() < 2;
    s_.panel(left_, top, w_, height);
    s_.put("set yrange [{:.12g}:{:.12g}]\nset ytics {:.12g}", low_, high_, step_);
    s_.put("set xtics ({})", alone ? tics_.labels : tics_.bare);
    s_.axis_names("", s_.narrow() ? "deflection (mm)" : "deflection along the load (mm)", widest_);
    if (alone) name_points(top + height);
    std::vector<std::string> series;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const Stroke& stroke : strokes_of(v_.theories, points_, axis))
        series.push_back(fmt::format("{} with points lc rgb '{}' pt {} ps {:.2f} lw {} notitle",
                                     place(stroke.series, axis), stroke.colour, stroke.shape, stroke.marker * marker_,
                                     stroke.width));
    s_.plot(fmt::format("plot {}", fmt::join(series, ", \\\n  ")));
  }

  void name_points(double foot) {
    s_.label("point of the workspace", left_ + w_ / 2, foot + 1.2 * s_.line() + tics_.height, "center");
  }

  /// Points of the workspace are no series: no line joins them. Residuals are stems.
  void residuals(double top, double height) {
    const double line = s_.line(), foot = top + height;
    s_.panel(left_, top, w_, height);
    s_.put("set yrange [{:.12g}:{:.12g}]\nset ytics {:.12g}", -1.15 * residual_, 1.15 * residual_,
           nice_below(residual_));
    s_.put("set xtics ({}) {} noenhanced", tics_.labels, tics_.turned ? "rotate by 90 right" : "norotate");
    s_.put("set xzeroaxis lt 1 lc rgb '#404040' lw 0.7");
    const double name = left_ - s_.left_of(widest_) - 0.4 * line;
    s_.label(residual_name(v_.theories), name, foot - height / 2, "center rotate by 90");
    s_.label(fmt::format("({})", data_.unit.name), name + line, foot - height / 2, "center rotate by 90");
    name_points(foot);
    std::vector<std::string> stems;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!there(points_, axis, false)) continue;
      for (std::size_t t = 1; t < v_.theories.size(); ++t) {
        const std::string where = place(columns().residual(t), axis);
        const int shape = t == 1 ? looks[axis].filled : further_shapes[(t - 2) % std::size(further_shapes)];
        stems.push_back(
            fmt::format("{} with impulses lc rgb '{}' lw {:.2f}", where, looks[axis].colour, 1.2 * marker_));
        stems.push_back(
            fmt::format("{} with points lc rgb '{}' pt {} ps {:.2f}", where, looks[axis].colour, shape, 0.5 * marker_));
      }
    }
    s_.plot(fmt::format("plot {}", fmt::join(stems, ", \\\n  ")));
  }

  const studies::Validation& v_;
  std::vector<report::PointRows> points_;
  Data data_;
  Sheet s_;
  PointLabels tics_;
  Tics widest_;
  double step_ = 1, low_ = 0, high_ = 1, residual_ = 1, left_ = 0, w_ = 0, marker_ = 1, aside_ = 0;
};

}  // namespace

Figure fig10(const studies::Validation& validation, const FigureStyle& style) {
  return Fig10(validation, style).draw();
}

}  // namespace deflect::figures
