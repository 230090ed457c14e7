#include "validation/figures/fig11.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "validation/figures/contours.h"
#include "validation/figures/map_words.h"
#include "validation/figures/sheet.h"
#include "validation/report/by_point.h"
#include "validation/report/map_correlation.h"
#include "validation/report/map_results.h"
#include "validation/report/text.h"

namespace deflect {
namespace {

constexpr double iso_text = 0.8;  // of the style's size
const double none = std::numeric_limits<double>::quiet_NaN();

/// Stiffness along x, y, z at the grid's poses; NaN out of reach. All are positive or the map would have no stiffness.
struct Extremes {
  double low = std::numeric_limits<double>::infinity(), high = 0;
};

Extremes extremes(const StiffnessMap& map) {
  Extremes e;
  for (const MapPose& p : map.poses)
    if (const MapValues* v = shown(p)) {
      e.low = std::min(e.low, v->stiffness_N_mm.minCoeff());
      e.high = std::max(e.high, v->stiffness_N_mm.maxCoeff());
    }
  return e;
}

/// A plane of the grid: `across` and `up` are axes, the third stands at `at`.
struct Slice {
  int across, up, at;
  int fixed() const { return 3 - across - up; }
};

std::vector<Slice> slices_of(const MapGrid& g) {
  const auto [nx, ny, nz] = g.counts;
  std::vector<Slice> list;
  if (nx > 1 && ny > 1) {
    if (nz > 1) list.push_back({0, 1, nz - 1});
    if (nz != 2) list.push_back({0, 1, (nz - 1) / 2});
    if (nz > 1) list.push_back({0, 1, 0});
  }
  if (nz > 1 && nx > 1)
    list.push_back({0, 2, (ny - 1) / 2});
  else if (nz > 1 && ny > 1)
    list.push_back({1, 2, (nx - 1) / 2});
  return list;
}

const MapPose& at(const StiffnessMap& map, const Slice& s, int i, int j) {
  std::array<int, 3> index{};
  index[static_cast<std::size_t>(s.across)] = i;
  index[static_cast<std::size_t>(s.up)] = j;
  index[static_cast<std::size_t>(s.fixed())] = s.at;
  return map.poses[map.options.grid.index(index[0], index[1], index[2])];
}

/// Interpolated bilinearly in the logarithm, with some steps between poses; NaN outside the cells whose four corners
/// are reached. Nothing where no cell is whole.
std::optional<GridField> surface(const StiffnessMap& map, const Slice& s, int axis) {
  const MapGrid& g = map.options.grid;
  const int n = g.counts[static_cast<std::size_t>(s.across)], m = g.counts[static_cast<std::size_t>(s.up)];
  const auto steps = [](int count) { return std::max(1, static_cast<int>(std::ceil(60.0 / (count - 1)))); };
  const int fine_x = steps(n), fine_y = steps(m);
  const auto log_value = [&](int i, int j) {
    const MapValues* v = shown(at(map, s, i, j));
    return v ? std::log(v->stiffness_N_mm(axis)) : none;
  };
  const auto in_cell = [&](int i, int j, double u, double v) {  // NaN where the cell is not whole or not there
    if (i < 0 || j < 0 || i + 1 >= n || j + 1 >= m) return none;
    return (1 - v) * ((1 - u) * log_value(i, j) + u * log_value(i + 1, j)) +
           v * ((1 - u) * log_value(i, j + 1) + u * log_value(i + 1, j + 1));
  };
  const auto place = [&](int where, int low, double t) {
    const double from = g.coordinate(where, low);
    return t == 0 ? from : from + t * (g.coordinate(where, low + 1) - from);
  };
  GridField field;
  for (int x = 0; x <= (n - 1) * fine_x; ++x)
    field.x.push_back(place(s.across, x / fine_x, static_cast<double>(x % fine_x) / fine_x));
  bool whole = false;
  for (int y = 0; y <= (m - 1) * fine_y; ++y) {
    const int j = y / fine_y;
    const double v = static_cast<double>(y % fine_y) / fine_y;
    for (int x = 0; x <= (n - 1) * fine_x; ++x) {
      const int i = x / fine_x;
      const double u = static_cast<double>(x % fine_x) / fine_x;
      double value = in_cell(i, j, u, v);  // a point on an edge belongs to the cells on both sides
      if (std::isnan(value) && u == 0) value = in_cell(i - 1, j, 1, v);
      if (std::isnan(value) && v == 0) value = in_cell(i, j - 1, u, 1);
      if (std::isnan(value) && u == 0 && v == 0) value = in_cell(i - 1, j - 1, 1, 1);
      field.values.push_back(std::exp(value));
      whole = whole || !std::isnan(value);
    }
    field.y.push_back(place(s.up, j, v));
  }
  return whole ? std::optional(field) : std::nullopt;
}

/// Tics of an axis of so many mm: whole steps, none of them so near to an end that its label would touch the next
/// panel's; where there is no room for all, the first and the last.
std::string inner_tics(const Sheet& s, double low, double high, double room_mm) {
  const double margin = 0.07 * (high - low);
  const Tics t = s.tics(low + margin, high - margin, room_mm);
  std::vector<double> numbers;
  for (double k = std::ceil((low + margin) / t.step); k * t.step <= high - margin; ++k)
    numbers.push_back(k * t.step + 0.0);
  if (numbers.size() > 2 && static_cast<double>(numbers.size()) * s.text_mm(t.letters + 1) > room_mm)
    numbers = {numbers.front(), numbers.back()};
  return fmt::format("{:.10g}", fmt::join(numbers, ", "));
}

/// Preferred numbers within the range: the coarsest series that has at least `wanted` of them, or the finest.
std::vector<double> levels(const Extremes& e, std::size_t wanted) {
  static const std::vector<std::vector<double>> series = {
      {1, 2, 5}, {1, 1.25, 1.6, 2, 2.5, 3.15, 4, 5, 6.3, 8}, {1,    1.12, 1.25, 1.4, 1.6, 1.8, 2,   2.24, 2.5, 2.8,
                                                              3.15, 3.55, 4,    4.5, 5,   5.6, 6.3, 7.1,  8,   9}};
  std::vector<double> list;
  for (const std::vector<double>& numbers : series) {
    list.clear();
    for (double power = std::pow(10, std::floor(std::log10(e.low))); power <= e.high; power *= 10)
      for (const double number : numbers)
        if (number * power > e.low && number * power < e.high) list.push_back(number * power);
    if (list.size() >= wanted) return list;
  }
  // Too narrow for preferred numbers: round values at even distance, the coarsest that are enough.
  for (double power = std::pow(10, std::floor(std::log10(e.high - e.low))); e.high > e.low && list.size() < wanted;
       power /= 10)
    for (const double step : {5 * power, 2 * power, power}) {
      list.clear();
      for (double n = std::floor(e.low / step) + 1; n * step < e.high; ++n) list.push_back(n * step);
      if (list.size() >= wanted) break;
    }
  return list;
}

std::string tics(const Extremes& e, bool named = true) {
  std::string list;
  for (const double level : levels(e, 4))
    list += fmt::format("{}'{}' {:g}", list.empty() ? "" : ", ", named ? fmt::format("{:g}", level) : "", level);
  return list;
}

/// The mean positions of the slides that occur in a slice; briefly for narrow paper.
std::string slide_text(const StiffnessMap& map, const Slice& s, bool brief) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int j = 0; j < map.options.grid.counts[static_cast<std::size_t>(s.up)]; ++j)
    for (int i = 0; i < map.options.grid.counts[static_cast<std::size_t>(s.across)]; ++i)
      if (const MapPose& p = at(map, s, i, j); p.reached()) {
        low = std::min(low, p.slide_mean_mm);
        high = std::max(high, p.slide_mean_mm);
      }
  if (low > high) return ": out of reach";
  return map.slides.key.empty()
             ? ""
             : fmt::format(": {}{} {:.0f}–{:.0f} mm", brief ? "" : "mean ", map.slides.words, low, high);
}

// Viridis, which grows evenly lighter for every colour vision.
constexpr const char* palette =
    "set palette defined (0 '#440154', 0.125 '#472d7b', 0.25 '#3b528b', 0.375 '#2c728e', 0.5 '#21918c', 0.625 "
    "'#28ae80', 0.75 '#5ec962', 0.875 '#addc30', 1 '#fde725')";

}  // namespace

std::vector<Figure> fig11(const StiffnessMap& map, const FigureStyle& style) {
  const MapGrid& g = map.options.grid;
  const std::vector<Slice> slices = slices_of(g);
  const Extremes e = extremes(map);
  if (slices.empty() || e.high == 0) return {};

  const bool all_reached =
      std::all_of(map.poses.begin(), map.poses.end(), [](const MapPose& p) { return p.reached(); });
  // Three panels in a row; the bar of colours beside them, on narrow paper below.
  Sheet script("fig11", style, 170.5);
  const double line = script.line(), width = script.width(), left = 3.5 * line;
  const bool below = script.narrow();
  const double gap = below ? 3 : 4.5, bar = 4, bar_room = below ? 3 : 4 + bar + script.text_mm(4) + 2.45 * line;
  const double panel = (width - left - 2 * gap - bar_room) / 3, row_title = 1.375 * line,
               row_foot = script.below() - 0.25 * line;
  const auto extent = [&](int axis) { return g.high_mm(axis) - g.low_mm(axis); };
  const auto panel_height = [&](const Slice& s) {
    return std::clamp(panel * extent(s.up) / extent(s.across), 0.5 * panel, 1.4 * panel);
  };

  const std::vector<double> iso = levels(e, below ? 8 : 14), index = levels(e, 4);
  const double light = std::exp(std::log(e.low) + 0.62 * std::log(e.high / e.low));
  std::vector<std::string> series;  // by row and axis
  std::vector<bool> whole;          // whether every value is there
  for (std::size_t r = 0; r < slices.size(); ++r)
    for (int axis = 0; axis < 3; ++axis) {
      series.emplace_back("plot '+' using 1:(NaN):(1) with points palette");
      const std::optional<GridField> field = surface(map, slices[r], axis);
      whole.push_back(field && std::none_of(field->values.begin(), field->values.end(),
                                            [](double value) { return std::isnan(value); }));
      if (!field) continue;
      const LabelledCurves curves(*field, panel, panel_height(slices[r]), script.text_mm(1, iso_text), iso_text * line);
      const CurveRows drawn = curve_rows(curves, iso, index, light);
      script.put("$s{}{} << EOD\n{}EOD", r, axis, matrix_rows(*field));
      series.back() = fmt::format("plot $s{}{} {} with image", r, axis, matrix_columns(*field));
      const auto over = [&](const char* name, const std::string& rows, const std::string& how) {
        if (rows.empty()) return;
        script.put("${}{}{} << EOD\n{}EOD", name, r, axis, rows);
        series.back() += fmt::format(", ${}{}{} using {}", name, r, axis, how);
      };
      over("thin", drawn.thin, "1:2:3 with lines lc rgb variable lw 0.3");
      over("heavy", drawn.heavy, "1:2:3 with lines lc rgb variable lw 0.9");
      over("values", drawn.values,
           fmt::format("1:2:(sprintf('%g',$3)):4 with labels {} textcolor rgb variable", script.font(iso_text)));
    }

  script.put("{}\nset logscale cb\nset cbrange [{:.6g}:{:.6g}]\nset cbtics ({}) scale 0.5", palette, e.low,
             std::max(e.high, e.low * 1.001), tics(e));
  script.put("set multiplot\nunset key\nunset grid\nset border 15 lc rgb '#404040' lw 0.7");
  double y = map_heading(script, map, "stiffness over the workspace", all_reached ? "" : "; hatched: out of reach",
                         below ? 3 : left) +
             1.3 * line;
  const double top = y + row_title;
  double foot = top;
  for (const Slice& s : slices) foot += panel_height(s) + row_foot + row_title;
  foot -= row_foot + row_title;
  for (std::size_t r = 0; r < slices.size(); ++r) {
    const Slice& s = slices[r];
    y += row_title;
    const double h = panel_height(s);
    const bool last_row = r + 1 == slices.size();
    for (int axis = 0; axis < 3; ++axis) {
      const double x = left + axis * (panel + gap);
      script.panel(x, y, panel, h);
      script.put("set xrange [{:.8g}:{:.8g}]\nset yrange [{:.8g}:{:.8g}]", g.low_mm(s.across), g.high_mm(s.across),
                 g.low_mm(s.up), g.high_mm(s.up));
      // Hatching costs more than all the rest of a picture: only where it shows.
      if (whole[3 * r + static_cast<std::size_t>(axis)])
        script.put("unset object");
      else
        script.put(
            "set object 1 rect from graph 0,0 to graph 1,1 behind fc rgb '#f4f4f4' fs solid noborder\n"
            "set object 2 rect from graph 0,0 to graph 1,1 behind fc rgb '#b0b0b0' fs pattern 4 noborder");
      script.put("set xtics ({}) offset 0,0.4\nset ytics ({}) offset 0.6,0\nset format y '{}'",
                 inner_tics(script, g.low_mm(s.across), g.high_mm(s.across), panel),
                 inner_tics(script, g.low_mm(s.up), g.high_mm(s.up), h), axis == 0 ? "%g" : "");
      if (axis == 0) {
        script.label(fmt::format("{} (mm)", axis_names[s.up]), 0.65 * line, y + h / 2, "center rotate by 90");
        script.label(fmt::format("{} = {:.4g} mm{}", axis_names[s.fixed()], g.coordinate(s.fixed(), s.at),
                                 slide_text(map, s, below)),
                     below ? 3 : left, y - 0.6 * line, "left textcolor rgb '#202020'");
      }
      script.label(fmt::format("{} (mm)", axis_names[s.across]), x + panel / 2, y + h + 1.65 * line, "center");
      if (r == 0)
        script.label((below ? "force " : "force along ") + std::string(axis_names[axis]), x + panel, y - 1.6 * line,
                     fmt::format("right {} textcolor rgb '{}'", script.font(1, true), colours[axis]));
      if (below && last_row && axis == 2) {
        const double bar_top = foot + row_foot + 0.3 * line, bar_width = width - left - 6;
        script.put("set colorbox horizontal user origin {} size screen {:.5f},{:.5f}/H",
                   script.at(left, bar_top + bar).substr(3), bar_width / width, bar);
        script.label("stiffness along the force (N/mm)", left + bar_width / 2, bar_top + bar + 2.2 * line, "center");
      } else if (!below && r == 0 && axis == 2) {
        script.put("set colorbox vertical user origin {} size screen {:.5f},{:.5f}/H",
                   script.at(width - bar_room + 4, foot).substr(3), bar / width, foot - top);
        script.label("stiffness along the force (N/mm)", width - 0.55 * line, (top + foot) / 2, "center rotate by 90");
      } else {
        script.put("unset colorbox");
      }
      script.plot(series[3 * r + static_cast<std::size_t>(axis)]);
    }
    y += h + row_foot;
  }
  script.put("unset multiplot");
  return {script.figure(y + (below ? bar + 3.2 * line : 0),
                        map_caption(map, fmt::format("Slices of the workspace, by the direction of the force, on one "
                                                     "logarithmic scale of colours ({:.4g} … {:.4g} N/mm) with "
                                                     "iso-curves{}.",
                                                     e.low, e.high, all_reached ? "" : "; hatched: out of reach")))};
}

std::vector<Figure> stiffness_against_length(const StiffnessMap& map, const FigureStyle& style) {
  const Extremes e = extremes(map);
  if (e.high == 0 || map.slides.key.empty()) return {};
  std::vector<const MapPose*> poses;
  for (const MapPose& p : map.poses)
    if (p.reached()) poses.push_back(&p);
  std::stable_sort(poses.begin(), poses.end(),
                   [](const MapPose* a, const MapPose* b) { return a->slide_mean_mm < b->slide_mean_mm; });
  const double shortest = poses.front()->slide_mean_mm, longest = poses.back()->slide_mean_mm;
  const auto row = [](double length, const Vector3& k) {
    return fmt::format("{:.5g} {:.5g} {:.5g} {:.5g}\n", length, k(0), k(1), k(2));
  };

  // Of many poses some are drawn, spread evenly by the golden ratio; the median is that of all.
  constexpr double most = 1500;
  std::string points, medians;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (std::fmod(0.6180339887498949 * static_cast<double>(i), 1) * static_cast<double>(poses.size()) < most)
      points += row(poses[i]->slide_mean_mm, shown(*poses[i])->stiffness_N_mm);
  const std::size_t bins = std::clamp<std::size_t>(poses.size() / 20, 1, 16);
  for (std::size_t b = 0; bins > 1 && b < bins; ++b) {  // equally many poses in each
    const std::size_t from = b * poses.size() / bins, to = (b + 1) * poses.size() / bins;
    Vector3 median;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> values;
      for (std::size_t i = from; i < to; ++i) values.push_back(shown(*poses[i])->stiffness_N_mm(axis));
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      median(axis) = *middle;
    }
    medians += row(poses[(from + to) / 2]->slide_mean_mm, median);
  }

  Sheet script("stiffness-vs-length", style, 170.5);
  const double line = script.line(), width = script.width(),
               from_left = 1.8 * line + script.text_mm(letters(fmt::format("{:.0f}", e.high))),
               gap = script.narrow() ? 3 : 4.5, room = (width - from_left - 5 - 2 * gap) / 3,
               tall = std::clamp(1.05 * room, 8 * line, 60.0);
  script.put("$points << EOD\n{}EOD\n$median << EOD\n{}EOD", points, medians);
  script.put("set multiplot\nunset key");
  const double top = map_heading(script, map, "stiffness against the mean " + map.slides.words,
                                 bins > 1 ? "; line: median" : "", script.narrow() ? 3 : from_left) +
                     2.6 * line;
  script.put("set logscale y\nset mytics default");
  const double beside = 0.04 * std::max(longest - shortest, 1.0);
  script.put("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]", shortest - beside, longest + beside,
             e.low / 1.15, e.high * 1.15);
  script.put("set xtics ({}) offset 0,0.2", inner_tics(script, shortest - beside, longest + beside, room));
  for (int axis = 0; axis < 3; ++axis) {
    const double x = from_left + axis * (room + gap);
    script.panel(x, top, room, tall);
    if (axis == 0) {
      script.label(script.narrow() ? "stiffness (N/mm)" : "stiffness along the force (N/mm)", 0.5 * line,
                   top + tall / 2, "center rotate by 90");
      script.label(fmt::format("mean {} (mm)", map.slides.words), (from_left + width - 5) / 2, top + tall + 2 * line,
                   "center");
    }
    script.label((script.narrow() ? "force " : "force along ") + std::string(axis_names[axis]), x, top - 1.5 * line,
                 fmt::format("left {} textcolor rgb '{}'", script.font(1, true), colours[axis]));
    script.put("set ytics ({})", tics({e.low / 1.15, e.high * 1.15}, axis == 0));
    const double rho = with_slides(map, axis).spearman;
    script.label(
        fmt::format("{} = {}{:.2f}", script.narrow() ? "ρ" : "Spearman’s ρ", rho < 0 ? "−" : "", std::abs(rho)), x,
        top - 0.55 * line, "left textcolor rgb '#505050'");
    script.plot(fmt::format(
        "plot $points using 1:{} with points lc rgb '#90{}' pt {} ps {:.2f}{}", axis + 2, colours[axis] + 1,
        shapes[axis], std::clamp(8 / std::sqrt(static_cast<double>(poses.size())), 0.22, 0.6),
        bins > 1 ? fmt::format(", $median using 1:{0} with lines lc rgb '#ffffff' lw 3, $median using 1:{0} with "
                               "lines lc rgb '#202020' lw 1.4",
                               axis + 2)
                 : ""));
  }
  script.put("unset multiplot");
  return {script.figure(
      top + tall + script.below(),
      map_caption(map, fmt::format("Stiffness at every pose over the mean {} there, by the direction of the force; ρ: "
                                   "Spearman’s rank correlation of the two{}.",
                                   map.slides.words, bins > 1 ? "; line: median of poses of like length" : "")))};
}

}  // namespace deflect
