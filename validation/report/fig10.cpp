#include "validation/report/fig10.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

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

constexpr double width = 160, left = 19, right = 3;  // mm
constexpr double panel = 62, gap = 5, strip = 22;    // mm
constexpr double line = 4;                           // mm from one line of text to the next, 8 points
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
struct Tics {
  std::string labels, bare;  ///< the list with the labels and with empty ones
  bool turned = false;
  double height = line;  ///< mm
};

Tics tics_of(const std::vector<PointRows>& points, double room) {
  constexpr std::size_t most = 16;   // letters of a label
  constexpr double letter_mm = 1.8;  // digits and capitals
  std::size_t longest = 1;
  for (const PointRows& p : points) longest = std::max(longest, std::min(most, letters(p.point->label)));
  const double upright = static_cast<double>(longest + 1) * letter_mm;
  Tics tics;
  tics.turned = longest > 3 && upright > room;
  const auto every = static_cast<std::size_t>(std::max(1.0, std::ceil((tics.turned ? line : upright) / room)));
  for (std::size_t i = 0; i < points.size(); i += every) {
    tics.labels += fmt::format("{}{} {}", i ? ", " : "", gnuplot_tic_label(clip(points[i].point->label, most)), i);
    tics.bare += fmt::format("{}'' {}", i ? ", " : "", i);
  }
  if (tics.turned) tics.height = static_cast<double>(longest) * letter_mm;
  return tics;
}

struct Text {
  std::string text, style;
};

std::vector<Text> heading(const Validation& validation) {
  const std::string title =
      fmt::format("{}: linear deflection under {} in x, y, z", clip(validation.device, 50), load_text(validation));
  const double size = std::clamp(9.5 * 70 / static_cast<double>(letters(title)), 7.0, 9.5);
  std::vector<Text> lines = {{title, fmt::format("font 'DejaVu Sans:Bold,{:.1f}'", size)}};
  const std::string small = "textcolor rgb '#505050'";
  lines.push_back({"Force at the tool point, its displacement along the force, base axes", small});
  if (has_as_printed(validation))
    for (const std::string& l : wrap("As printed: analytic theory with " + errata_text(validation), 88))
      lines.push_back({l, small});
  return lines;
}

/// Commands one by one.
class Script {
 public:
  std::string text;

  template <class... T>
  void put(fmt::format_string<T...> format, T&&... values) {
    text += fmt::format(format, std::forward<T>(values)...) + "\n";
  }
  void plot(const std::vector<std::string>& series) { put("plot {}", fmt::join(series, ", \\\n  ")); }
};

}  // namespace

Figure fig10(const Validation& validation) {
  const std::vector<PointRows> points = by_point(validation);
  const Data data = data_of(points);
  const double room = (width - left - right) / static_cast<double>(points.size());
  const Tics tics = tics_of(points, room);
  const std::vector<Text> lines = heading(validation);
  const bool printed = has_as_printed(validation);

  // From the top, mm: heading, legend, panel, gap, strip, labels, name of the axis.
  const double legend = 3.5 + line * static_cast<double>(lines.size());
  const double top = legend + line * (printed ? 3 : 2) + 3;
  const double foot = top + panel + gap + strip;
  const double height = foot + 2.5 + tics.height + 5;
  const auto across = [](double mm) { return mm / width; };
  const auto up = [&](double mm_from_top) { return 1 - mm_from_top / height; };

  // Markers shrink where points are many; x, y, z stand side by side, or those that coincide would hide each
  // other.
  const double marker = std::clamp(room / 8, 0.35, 1.0);
  const double aside = std::min(2.5 / room, 0.22);
  const auto place = [&](Series series, std::size_t axis) {
    return fmt::format("$data using ($1{:+.4f}):{}", aside * (static_cast<double>(axis) - 1), column(series, axis));
  };
  const auto there = [&](std::size_t axis, bool as_printed) {
    return std::any_of(points.begin(), points.end(),
                       [&](const PointRows& p) { return p.rows[axis] && (!as_printed || p.rows[axis]->as_printed); });
  };

  Script script;
  script.text = data.block;
  script.put("set multiplot");
  script.put("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}", across(left), across(width - right));
  script.put("set xrange [-0.5:{}]", static_cast<double>(points.size()) - 0.5);

  // Upper panel. Two per cent of margin, so that no marker sits on the frame; whole steps at both ends.
  const double span = data.high > data.low ? data.high - data.low : 1;
  const double step = nice_below(span / 3.5);
  const double low = std::floor((data.low - 0.02 * span) / step), high = std::ceil((data.high + 0.02 * span) / step);
  script.put("set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}", up(top), up(top + panel));
  script.put("set yrange [{:.12g}:{:.12g}]\nset ytics {:.12g}", low * step, high * step, step);
  script.put("set xtics ({})", tics.bare);
  for (std::size_t i = 0; i < lines.size(); ++i)
    script.put("set label {} {} at screen {:.5f},{:.5f} left {} noenhanced", i + 1, gnuplot_quote(lines[i].text),
               across(left), up((i == 0 ? 3.5 : 4.2) + line * static_cast<double>(i)), lines[i].style);
  const char* const axis_name = "set label {} {} at screen {:.5f},{:.5f} center rotate by 90";
  script.put(fmt::runtime(axis_name), 20, "'deflection along the load (mm)'", across(3), up(top + panel / 2));
  script.put(
      "set key at screen {:.5f},{:.5f} left top vertical maxrows {} Left reverse samplen 2.5 spacing 1.2 "
      "width 3",
      across(left - 2), up(legend), printed ? 3 : 2);
  std::vector<std::string> series;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Look& look = looks[axis];
    const auto add = [&](Series which, const char* colour, int shape, double size, const char* style,
                         const char* name) {
      series.push_back(fmt::format("{} with linespoints lc rgb '{}' pt {} ps {:.2f} {} title '{}-{}'",
                                   place(which, axis), colour, shape, size * marker, style, capitals[axis], name));
    };
    if (there(axis, true)) add(Series::as_printed, look.light, look.filled, 0.5, "lw 1.1 dt 2", "As printed");
    if (!there(axis, false)) continue;
    add(Series::analytic, look.colour, look.filled, 0.5, "lw 1.1", "Analytical");
    add(Series::msa, look.colour, look.open, 1.1, "lw 0.8 dt 3", "MSA");
  }
  script.plot(series);

  // Residuals as stems.
  for (std::size_t tag = 1; tag <= lines.size(); ++tag) script.put("unset label {}", tag);
  script.put("unset label 20\nunset key");
  const double residual = data.residual > 0 ? data.residual * data.unit.per_mm : 1;
  script.put("set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}", up(foot - strip), up(foot));
  script.put("set yrange [{:.12g}:{:.12g}]\nset ytics {:.12g}", -1.15 * residual, 1.15 * residual,
             nice_below(residual));
  script.put("set xtics ({}) {} noenhanced", tics.labels, tics.turned ? "rotate by 90 right" : "norotate");
  script.put("set xzeroaxis lt 1 lc rgb '#404040' lw 0.7");
  script.put(fmt::runtime(axis_name), 20, "'analytic − MSA'", across(3), up(foot - strip / 2));
  script.put(fmt::runtime(axis_name), 21, fmt::format("'({})'", data.unit.name), across(3 + line),
             up(foot - strip / 2));
  script.put("set label 22 'point of the workspace' at screen {:.5f},{:.5f} center", across((left + width - right) / 2),
             up(height - 2.5));
  std::vector<std::string> stems;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!there(axis, false)) continue;
    const std::string where = place(Series::residual, axis);
    stems.push_back(fmt::format("{} with impulses lc rgb '{}' lw {:.2f}", where, looks[axis].colour, 1.2 * marker));
    stems.push_back(fmt::format("{} with points lc rgb '{}' pt {} ps {:.2f}", where, looks[axis].colour,
                                looks[axis].filled, 0.5 * marker));
  }
  script.plot(stems);
  script.text += "unset multiplot";
  return {"fig10", script.text, width, height};
}

}  // namespace deflect
