#include "validation/report/fig11.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "validation/report/by_point.h"
#include "validation/report/map_results.h"
#include "validation/report/text.h"

namespace deflect {
namespace {

constexpr const char* colours[] = {"#0072B2", "#D55E00", "#009E73"};  // Okabe–Ito, as in Fig. 10
constexpr int shapes[] = {7, 5, 13};

// mm on paper
constexpr double left = 14, panel = 41, gap = 4, bar_gap = 4, bar = 4, bar_text = 13;
constexpr double width = left + 3 * panel + 2 * gap + bar_gap + bar + bar_text;
constexpr double line = 4, row_title = 5.5, tic_room = 5.5;

const double none = std::numeric_limits<double>::quiet_NaN();

/// Commands one by one.
struct Script {
  std::string text;
  template <class... T>
  void put(fmt::format_string<T...> format, T&&... values) {
    text += fmt::format(format, std::forward<T>(values)...) + "\n";
  }
};

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

/// Interpolated bilinearly in the logarithm, with `fine` steps between poses; NaN where a pose that it would take part
/// in is out of reach. Lines of gnuplot's grid format, x fastest.
std::string surface(const StiffnessMap& map, const Slice& s, int axis) {
  const MapGrid& g = map.options.grid;
  const int n = g.counts[static_cast<std::size_t>(s.across)], m = g.counts[static_cast<std::size_t>(s.up)];
  const auto steps = [](int count) { return std::max(1, static_cast<int>(std::ceil(72.0 / (count - 1)))); };
  const int fine_x = steps(n), fine_y = steps(m);
  const auto value = [&](int i, int j) {
    const MapValues* v = shown(at(map, s, i, j));
    return v ? std::log(v->stiffness_N_mm(axis)) : none;
  };
  const auto between = [](double a, double b, double t) { return t == 0 ? a : a + t * (b - a); };
  std::string text;
  for (int y = 0; y <= (m - 1) * fine_y; ++y) {
    const int j = y / fine_y, j1 = std::min(j + 1, m - 1);
    const double v = static_cast<double>(y % fine_y) / fine_y;
    const double py = between(g.coordinate(s.up, j), g.coordinate(s.up, j1), v);
    for (int x = 0; x <= (n - 1) * fine_x; ++x) {
      const int i = x / fine_x, i1 = std::min(i + 1, n - 1);
      const double u = static_cast<double>(x % fine_x) / fine_x;
      const double lower = between(value(i, j), value(i1, j), u);
      const double log = v == 0 ? lower : between(lower, between(value(i, j1), value(i1, j1), u), v);
      const double px = between(g.coordinate(s.across, i), g.coordinate(s.across, i1), u);
      text += fmt::format("{:.6g} {:.6g} {:.6g}\n", px, py, std::exp(log));
    }
    text += "\n";
  }
  return text;
}

/// Levels from a series of preferred numbers so fine that the whole range has some twenty of them.
std::vector<double> levels(const Extremes& e) {
  static const std::vector<std::vector<double>> series = {
      {1, 2, 5},
      {1, 1.6, 2.5, 4, 6.3},
      {1, 1.25, 1.6, 2, 2.5, 3.15, 4, 5, 6.3, 8},
      {1, 1.12, 1.25, 1.4, 1.6, 1.8, 2, 2.24, 2.5, 2.8, 3.15, 3.55, 4, 4.5, 5, 5.6, 6.3, 7.1, 8, 9}};
  std::vector<double> list;
  for (const std::vector<double>& numbers : series) {
    list.clear();
    for (double power = std::pow(10, std::floor(std::log10(e.low))); power <= e.high; power *= 10)
      for (const double number : numbers)
        if (number * power > e.low && number * power < e.high) list.push_back(number * power);
    if (list.size() >= 14) break;
  }
  return list;
}

std::string tics(const Extremes& e) {
  std::string list;
  const double range = std::log10(e.high / e.low);
  for (double power = std::pow(10, std::floor(std::log10(e.low))); power <= e.high; power *= 10)
    for (const double number : {1.0, 1.5, 2.0, 3.0, 5.0, 7.0}) {
      const bool coarse = number == 1 || number == 2 || number == 5;
      if (!(range < 1 || coarse) || number * power < e.low || number * power > e.high) continue;
      list += fmt::format("{}'{:g}' {:g}", list.empty() ? "" : ", ", number * power, number * power);
    }
  return list;
}

/// The mean lengths of the guideways that occur in a slice.
std::string guide_text(const StiffnessMap& map, const Slice& s) {
  double low = std::numeric_limits<double>::infinity(), high = 0;
  for (int j = 0; j < map.options.grid.counts[static_cast<std::size_t>(s.up)]; ++j)
    for (int i = 0; i < map.options.grid.counts[static_cast<std::size_t>(s.across)]; ++i)
      if (const MapPose& p = at(map, s, i, j); p.reached()) {
        low = std::min(low, p.guide_mean_mm);
        high = std::max(high, p.guide_mean_mm);
      }
  return high > 0 ? fmt::format("mean guideway length {:.0f}–{:.0f} mm", low, high) : "out of reach";
}

std::vector<std::string> heading(const StiffnessMap& map) {
  const Vector3& tilt = map.options.grid.tilt_deg;
  return {fmt::format("{}: stiffness along the force at the tool point", clip(map.device, 50)),
          fmt::format("1/C_ii, {}, {}, base axes", map.options.load_N_Nmm ? "tangent" : "secant", map_load_text(map)),
          fmt::format("{}; roll, pitch, yaw {:g}°, {:g}°, {:g}°",
                      map.options.analytic && map.options.msa ? "analytic theory (the MSA agrees)"
                                                              : fmt::format("{} theory", shown_theory(map)),
                      tilt(0), tilt(1), tilt(2))};
}

void put_heading(Script& script, const StiffnessMap& map, double height) {
  const std::vector<std::string> lines = heading(map);
  for (std::size_t i = 0; i < lines.size(); ++i)
    script.put("set label {} {} at screen {:.5f},{:.5f} left noenhanced {}", i + 1, gnuplot_quote(lines[i]),
               left / width, 1 - (3.5 + line * static_cast<double>(i)) / height,
               i == 0 ? "font 'DejaVu Sans:Bold,9.5'" : "textcolor rgb '#505050'");
}

// Viridis, which grows evenly lighter for every colour vision.
constexpr const char* palette =
    "set palette defined (0 '#440154', 0.125 '#472d7b', 0.25 '#3b528b', 0.375 '#2c728e', 0.5 '#21918c', 0.625 "
    "'#28ae80', 0.75 '#5ec962', 0.875 '#addc30', 1 '#fde725')";

}  // namespace

std::vector<Figure> fig11(const StiffnessMap& map) {
  const MapGrid& g = map.options.grid;
  const std::vector<Slice> slices = slices_of(g);
  const Extremes e = extremes(map);
  if (slices.empty() || e.high == 0) return {};

  const auto extent = [&](int axis) { return g.high_mm(axis) - g.low_mm(axis); };
  const auto panel_height = [&](const Slice& s) {
    return std::clamp(panel * extent(s.up) / extent(s.across), 0.5 * panel, 1.4 * panel);
  };
  const double top = 3.5 + 3 * line + 4;
  double height = top;
  for (const Slice& s : slices) height += row_title + panel_height(s) + tic_room + 4.5;
  const double foot = height;
  const auto across = [](double mm) { return mm / width; };
  const auto up = [&](double mm_from_top) { return 1 - mm_from_top / height; };

  Script script;
  for (std::size_t r = 0; r < slices.size(); ++r)
    for (int axis = 0; axis < 3; ++axis) script.put("$s{}{} << EOD\n{}EOD", r, axis, surface(map, slices[r], axis));
  // Iso-curves as tables, made before there is a plot to disturb.
  const std::vector<double> iso = levels(e);
  if (!iso.empty()) {
    script.put("set contour base\nunset surface\nset cntrparam linear\nset cntrparam levels discrete {:g}",
               fmt::join(iso, ","));
    for (std::size_t r = 0; r < slices.size(); ++r)
      for (int axis = 0; axis < 3; ++axis)
        script.put("set table $c{0}{1}\nsplot $s{0}{1} using 1:2:3\nunset table", r, axis);
    script.put("unset contour\nset surface");
  }

  script.put("{}\nset logscale cb\nset cbrange [{:.6g}:{:.6g}]\nset cbtics ({}) scale 0.5", palette, e.low,
             std::max(e.high, e.low * 1.001), tics(e));
  script.put("set multiplot\nunset key\nunset grid\nset border 15 lc rgb '#404040' lw 0.7");
  script.put("set style textbox opaque noborder");
  put_heading(script, map, height);
  const double light = std::exp(std::log(e.low) + 0.62 * std::log(e.high / e.low));  // dark lines on light colours
  const std::string ink = fmt::format("($3 < {:.6g} ? 0xFFFFFF : 0x000000)", light);
  double y = top;
  for (std::size_t r = 0; r < slices.size(); ++r) {
    const Slice& s = slices[r];
    y += row_title;
    const double h = panel_height(s);
    for (int axis = 0; axis < 3; ++axis) {
      const double x = left + axis * (panel + gap);
      script.put("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}", across(x), across(x + panel));
      script.put("set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}", up(y), up(y + h));
      script.put("set xrange [{:.8g}:{:.8g}]\nset yrange [{:.8g}:{:.8g}]", g.low_mm(s.across), g.high_mm(s.across),
                 g.low_mm(s.up), g.high_mm(s.up));
      script.put("set object 1 rect from graph 0,0 to graph 1,1 behind fc rgb '#f4f4f4' fs solid noborder");
      script.put("set object 2 rect from graph 0,0 to graph 1,1 behind fc rgb '#b0b0b0' fs pattern 4 noborder");
      script.put("set xtics auto offset 0,0.4\nset ytics auto offset 0.6,0{}", axis == 0 ? "" : "\nset format y ''");
      if (axis == 0) {
        script.put("set format y '%g'");
        script.put("set label 10 '{} (mm)' at screen {:.5f},{:.5f} center rotate by 90", axis_names[s.up], across(2.5),
                   up(y + h / 2));
        script.put("set label 11 {} at screen {:.5f},{:.5f} left textcolor rgb '#202020'",
                   gnuplot_quote(fmt::format("{} = {:.4g} mm: {}", axis_names[s.fixed()], g.coordinate(s.fixed(), s.at),
                                             guide_text(map, s))),
                   across(left), up(y - 2));
      }
      script.put("set label 12 '{} (mm)' at screen {:.5f},{:.5f} center", axis_names[s.across], across(x + panel / 2),
                 up(y + h + tic_room + 1));
      if (r == 0)
        script.put(
            "set label 13 'force along {}' at screen {:.5f},{:.5f} right font 'DejaVu Sans:Bold,8' "
            "textcolor rgb '{}'",
            axis_names[axis], across(x + panel), up(y - 5.5), colours[axis]);
      if (r == 0 && axis == 2)
        script.put(
            "set colorbox vertical user origin screen {:.5f},{:.5f} size screen {:.5f},{:.5f}\n"
            "set label 14 'stiffness along the force (N/mm)' at screen {:.5f},{:.5f} center rotate by 90",
            across(left + 3 * panel + 2 * gap + bar_gap), up(foot - tic_room - 4.5), across(bar),
            (foot - tic_room - 4.5 - y) / height, across(width - 2), up((y + foot - tic_room - 4.5) / 2));
      else
        script.put("unset colorbox");
      std::string curves;
      if (!iso.empty())
        curves = fmt::format(
            ", $c{0}{1} using 1:2:{2} with lines lc rgb variable lw 0.5, $c{0}{1} using 1:2:(sprintf('%g',$3)):{2} "
            "every ::24::24 with labels font 'DejaVu Sans,5.5' textcolor rgb variable",
            r, axis, ink);
      script.put("plot $s{}{} using 1:2:3 with image{}", r, axis, curves);
      for (const int tag : {1, 2, 3, 10, 11, 12, 13, 14}) script.put("unset label {}", tag);
    }
    y += h + tic_room + 4.5;
  }
  script.text += "unset multiplot";
  return {{"fig11", script.text, width, height}};
}

std::vector<Figure> stiffness_against_length(const StiffnessMap& map) {
  const Extremes e = extremes(map);
  if (e.high == 0) return {};
  double shortest = std::numeric_limits<double>::infinity(), longest = 0;
  std::size_t count = 0;
  for (const MapPose& p : map.poses) {
    if (!p.reached()) continue;
    shortest = std::min(shortest, p.guide_mean_mm);
    longest = std::max(longest, p.guide_mean_mm);
    ++count;
  }
  const std::size_t bins = std::clamp<std::size_t>(count / 20, 1, 16);
  const double step = std::max(longest - shortest, 1e-9) / static_cast<double>(bins);

  Script script;
  std::vector<std::string> series;
  script.text = "$data << EOD\n";
  std::array<std::vector<std::vector<double>>, 3> binned;
  std::vector<std::vector<double>> lengths(bins);
  binned.fill(std::vector<std::vector<double>>(bins));
  for (const MapPose& p : map.poses)
    if (const MapValues* v = shown(p)) {
      script.put("{:.6g} {:.6g} {:.6g} {:.6g}", p.guide_mean_mm, v->stiffness_N_mm(0), v->stiffness_N_mm(1),
                 v->stiffness_N_mm(2));
      const auto bin = std::min(bins - 1, static_cast<std::size_t>((p.guide_mean_mm - shortest) / step));
      lengths[bin].push_back(p.guide_mean_mm);
      for (std::size_t axis = 0; axis < 3; ++axis)
        binned[axis][bin].push_back(v->stiffness_N_mm(static_cast<Eigen::Index>(axis)));
    }
  script.text += "EOD\n$median << EOD\n";
  const auto median = [](std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  for (std::size_t b = 0; b < bins; ++b)
    if (!lengths[b].empty())
      script.put("{:.6g} {:.6g} {:.6g} {:.6g}", median(lengths[b]), median(binned[0][b]), median(binned[1][b]),
                 median(binned[2][b]));
  script.text += "EOD\n";

  constexpr double height = 92;
  put_heading(script, map, height);
  script.put("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}", (left + 2) / width, (width - 4) / width);
  script.put("set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}", 1 - 25 / height, 11 / height);
  script.put("set logscale y\nset ytics ({})", tics({e.low / 1.15, e.high * 1.15}));
  script.put("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]", shortest - 0.03 * (longest - shortest + 1),
             longest + 0.03 * (longest - shortest + 1), e.low / 1.15, e.high * 1.15);
  script.put("set xlabel 'mean length of the guideways (mm)' offset 0,0.3");
  script.put("set label 10 'stiffness along the force (N/mm)' at screen {:.5f},{:.5f} center rotate by 90", 3 / width,
             (11 + (height - 36) / 2) / height);
  script.put("set key at screen {:.5f},{:.5f} left top horizontal maxrows 1 Left reverse samplen 1.5 width 2",
             (left - 1) / width, 1 - 16.5 / height);
  const double size = std::clamp(8 / std::sqrt(static_cast<double>(count)), 0.12, 0.5);
  for (int axis = 0; axis < 3; ++axis)
    series.push_back(fmt::format("$data using 1:{} with points lc rgb '#A0{}' pt {} ps {:.2f} notitle", axis + 2,
                                 colours[axis] + 1, shapes[axis], size));
  for (int axis = 0; axis < 3; ++axis)
    series.push_back(
        fmt::format("$median using 1:{} with linespoints lc rgb '{}' pt {} ps 0.6 lw 1.4 title '{} "
                    "(Spearman {:.2f})'",
                    axis + 2, colours[axis], shapes[axis], axis_names[axis], with_guide_length(map, axis).spearman));
  script.put("plot {}", fmt::join(series, ", \\\n  "));
  return {{"stiffness-vs-length", script.text, width, height}};
}

}  // namespace deflect
