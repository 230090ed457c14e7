#include "validation/figures/fig10.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "validation/figures/sheet.h"
#include "validation/report/by_point.h"
#include "validation/report/text.h"

namespace deflect {
namespace {

struct Look {
  const char* colour;  // Okabe–Ito, told apart with any colour vision
  const char* light;
  int filled, open;  // gnuplot's point types
};
constexpr Look looks[] = {{"#0072B2", "#8CC4E8", 7, 6}, {"#D55E00", "#F3B587", 5, 4}, {"#009E73", "#8ED6BF", 13, 12}};
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
double along(const ValidationRow& row, const Vector6& displacement) {
  const double value = displacement[row.axis];
  if (!std::isfinite(value))
    throw std::invalid_argument(
        fmt::format("point {}: deflection along {} is {}", row.point.label, axis_names[row.axis], value));
  return value;
}

/// Columns of the inline data: point's index, then analytic, MSA, as printed, residual (in `unit`) for x, y,
/// z.
enum class Series { analytic, msa, as_printed, residual };
int column(Series series, std::size_t axis) { return 2 + 3 * static_cast<int>(series) + static_cast<int>(axis); }

struct Data {
  std::string block;
  double low = 0, high = 0,
         residual = 0;  ///< extremes of the deflections with zero, mm; largest |residual|, mm
  Unit unit = units[0];
};

Data data_of(const std::vector<PointRows>& points) {
  Data data;
  for (const PointRows& p : points)
    for (const ValidationRow* row : p.rows) {
      if (!row) continue;
      const double analytic = along(*row, row->analytic), msa = along(*row, row->msa);
      data.residual = std::max(data.residual, std::abs(analytic - msa));
      data.low = std::min({data.low, analytic, msa});
      data.high = std::max({data.high, analytic, msa});
      if (!row->as_printed) continue;
      data.low = std::min(data.low, along(*row, *row->as_printed));
      data.high = std::max(data.high, along(*row, *row->as_printed));
    }
  const auto readable = [&](const Unit& unit) { return data.residual * unit.per_mm >= 1; };
  const auto found = std::find_if(std::begin(units), std::end(units), readable);
  data.unit = data.residual == 0 ? units[2] : found == std::end(units) ? *std::prev(found) : *found;

  data.block = "$data << EOD\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::string analytic, msa, as_printed, residual;
    for (const ValidationRow* row : points[i].rows) {
      const auto cell = [](bool there, double value) {
        return there ? fmt::format(" {}", value) : std::string(" NaN");
      };
      const double a = row ? along(*row, row->analytic) : 0, m = row ? along(*row, row->msa) : 0;
      analytic += cell(row, a);
      msa += cell(row, m);
      as_printed += cell(row && row->as_printed, row && row->as_printed ? along(*row, *row->as_printed) : 0);
      residual += cell(row, (a - m) * data.unit.per_mm);
    }
    data.block += fmt::format("{}{}{}{}{}\n", i, analytic, msa, as_printed, residual);
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

PointLabels labels_of(const std::vector<PointRows>& points, double room, const Sheet& s) {
  constexpr std::size_t most = 16;  // letters of a label
  std::size_t longest = 1;
  for (const PointRows& p : points) longest = std::max(longest, std::min(most, letters(p.point->label)));
  const double upright = s.text_mm(longest + 1);
  PointLabels l;
  l.turned = longest > 3 && upright > room;
  const auto every = static_cast<std::size_t>(std::max(1.0, std::ceil((l.turned ? s.line() : upright) / room)));
  for (std::size_t i = 0; i < points.size(); i += every) {
    l.labels += fmt::format("{}{} {}", i ? ", " : "", gnuplot_tic_label(clip(points[i].point->label, most)), i);
    l.bare += fmt::format("{}'' {}", i ? ", " : "", i);
  }
  l.height = l.turned ? s.text_mm(longest) : s.line();
  return l;
}

bool there(const std::vector<PointRows>& points, std::size_t axis, bool as_printed) {
  return std::any_of(points.begin(), points.end(),
                     [&](const PointRows& p) { return p.rows[axis] && (!as_printed || p.rows[axis]->as_printed); });
}

/// How a series is drawn.
struct Stroke {
  const char *colour, *name;
  int shape;
  double marker, width;
};

std::vector<Stroke> strokes_of(const std::vector<PointRows>& points, std::size_t axis) {
  const Look& look = looks[axis];
  std::vector<Stroke> out;
  if (there(points, axis, true)) out.push_back({look.light, "As printed", look.filled, 0.7, 0.8});
  if (!there(points, axis, false)) return out;
  out.push_back({look.colour, "Analytical", look.filled, 0.5, 0.8});
  out.push_back({look.colour, "MSA", look.open, 1.1, 0.8});
  return out;
}

/// A column for each axis, where the paper is too narrow a row for each, or all below each other; y below it.
double put_legend(Sheet& s, const std::vector<PointRows>& points, double top, double left) {
  const double line = s.line(), mark = 0.6 * line, entry = mark + 1 + 0.9 * s.text_mm(12) + 2;
  std::size_t most = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) most = std::max(most, strokes_of(points, axis).size());
  const double room = s.width() - left;
  const bool beside = 3 * entry <= room + 2, in_rows = !beside && static_cast<double>(most) * entry <= room + 2;
  double foot = top;
  std::size_t at = 0;
  int tag = 60;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<Stroke> strokes = strokes_of(points, axis);
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

std::string poses_text(const std::vector<PointRows>& points) {
  Vector6 low = points.front().point->pose_mm_deg, high = low;
  for (const PointRows& p : points)
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

std::string caption_of(const Validation& validation, const std::vector<PointRows>& points, const Data& data) {
  return fmt::format(
      "Linear deflection of the tool point of {} along a force of {} on it in x, y and z in turn (mm, base axes, "
      "positive "
      "along a positive force) at {} points of the workspace ({}), by the closed form (analytical) and by matrix "
      "structural analysis (MSA){}. Below: analytic − MSA along the force in {}, at most {:.2g} {}. Computed, no "
      "measurements and no noise.",
      validation.device, load_text(validation), points.size(), poses_text(points),
      has_as_printed(validation) ? ", and by the closed form with " + errata_text(validation) + " as printed" : "",
      data.unit.name, data.residual * data.unit.per_mm, data.unit.name);
}

}  // namespace

Figure fig10(const Validation& validation, const FigureStyle& style) {
  const std::vector<PointRows> points = by_point(validation);
  const Data data = data_of(points);
  const bool printed = has_as_printed(validation);
  Sheet s("fig10", style, 160);
  const double line = s.line(), panel_height = std::max(panel * s.width(), 10 * line),
               strip_height = std::max(strip * s.width(), 5.5 * line);

  // Two per cent of margin, so that no marker sits on the frame; whole steps at both ends.
  const double span = data.high > data.low ? data.high - data.low : 1;
  const double step = nice_below(span / 3.5);
  const double low = std::floor((data.low - 0.02 * span) / step), high = std::ceil((data.high + 0.02 * span) / step);
  const double residual = data.residual > 0 ? data.residual * data.unit.per_mm : 1;
  const double residual_step = nice_below(residual);
  Tics widest{step, 1};
  for (const double number : {low * step, high * step, -residual_step})
    widest.letters = std::max(widest.letters, letters(fmt::format("{:.6g}", number)));
  const double left = s.left_of(widest) + line;  // two lines name the strip's axis
  const double w = s.width() - left - right, room = w / static_cast<double>(points.size());
  const PointLabels tics = labels_of(points, room, s);

  // Markers shrink where points are many; x, y, z stand side by side, or those that coincide would hide each
  // other.
  const double marker = std::clamp(room / 8, 0.35, 1.0);
  const double aside = std::min(2.5 / room, 0.22);
  const auto place = [&](Series series, std::size_t axis) {
    return fmt::format("$data using ($1{:+.4f}):{}", aside * (static_cast<double>(axis) - 1), column(series, axis));
  };
  s.put("{}set multiplot\nunset key", data.block);
  s.put("set xrange [-0.5:{}]", static_cast<double>(points.size()) - 0.5);
  std::vector<std::string> notes = {"Force at the tool point, its displacement along the force, base axes"};
  if (printed) notes.push_back("As printed: analytic theory with " + errata_text(validation));
  const double keys = s.heading(
      fmt::format("{}: linear deflection under {} in x, y, z", clip(validation.device, 50), load_text(validation)),
      notes, s.narrow() ? 2 : left);

  const double top = put_legend(s, points, keys + 0.2 * line, s.narrow() ? 2 : left) + 0.6 * line;

  s.panel(left, top, w, panel_height);
  s.put("set yrange [{:.12g}:{:.12g}]\nset ytics {:.12g}", low * step, high * step, step);
  s.put("set xtics ({})", tics.bare);
  s.axis_names("", s.narrow() ? "deflection (mm)" : "deflection along the load (mm)", widest);
  std::vector<std::string> series;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::vector<Stroke> strokes = strokes_of(points, axis);
    for (std::size_t i = 0; i < strokes.size(); ++i) {
      const Stroke& stroke = strokes[i];
      const Series which = strokes.size() == 3 && i == 0 ? Series::as_printed
                           : i + 1 == strokes.size()     ? Series::msa
                                                         : Series::analytic;
      series.push_back(fmt::format("{} with points lc rgb '{}' pt {} ps {:.2f} lw {} notitle", place(which, axis),
                                   stroke.colour, stroke.shape, stroke.marker * marker, stroke.width));
    }
  }
  s.plot(fmt::format("plot {}", fmt::join(series, ", \\\n  ")));

  // Points of the workspace are no series: no line joins them. Residuals are stems.
  const double below = top + panel_height + 1.25 * line, foot = below + strip_height;
  for (int tag = 60; tag < 69; ++tag) s.put("unset label {}", tag);
  s.panel(left, below, w, strip_height);
  s.put("set yrange [{:.12g}:{:.12g}]\nset ytics {:.12g}", -1.15 * residual, 1.15 * residual, residual_step);
  s.put("set xtics ({}) {} noenhanced", tics.labels, tics.turned ? "rotate by 90 right" : "norotate");
  s.put("set xzeroaxis lt 1 lc rgb '#404040' lw 0.7");
  const double name = left - s.left_of(widest) - 0.4 * line;
  s.label("analytic − MSA", name, foot - strip_height / 2, "center rotate by 90");
  s.label(fmt::format("({})", data.unit.name), name + line, foot - strip_height / 2, "center rotate by 90");
  s.label("point of the workspace", left + w / 2, foot + 0.6 * line + tics.height + 0.6 * line, "center");
  std::vector<std::string> stems;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!there(points, axis, false)) continue;
    const std::string where = place(Series::residual, axis);
    stems.push_back(fmt::format("{} with impulses lc rgb '{}' lw {:.2f}", where, looks[axis].colour, 1.2 * marker));
    stems.push_back(fmt::format("{} with points lc rgb '{}' pt {} ps {:.2f}", where, looks[axis].colour,
                                looks[axis].filled, 0.5 * marker));
  }
  s.plot(fmt::format("plot {}", fmt::join(stems, ", \\\n  ")));
  s.put("unset multiplot");
  return s.figure(foot + 1.9 * line + tics.height, caption_of(validation, points, data));
}

}  // namespace deflect
