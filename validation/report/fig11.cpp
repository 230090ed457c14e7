#include "validation/report/fig11.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "validation/report/by_point.h"
#include "validation/report/map_correlation.h"
#include "validation/report/map_results.h"
#include "validation/report/text.h"

namespace deflect {
namespace {

constexpr const char* colours[] = {"#0072B2", "#D55E00", "#009E73"};  // Okabe–Ito, as in Fig. 10
constexpr int shapes[] = {7, 5, 13};

// mm on paper
constexpr double left = 14, panel = 41, gap = 4.5, bar_gap = 4, bar = 4, bar_text = 16.5;
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

/// Interpolated bilinearly in the logarithm, with some steps between poses; NaN outside the cells whose four corners
/// are reached. Lines of gnuplot's grid format, x fastest.
std::string surface(const StiffnessMap& map, const Slice& s, int axis) {
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
  std::string text;
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
      const auto place = [&](int where, int low, double t) {
        const double from = g.coordinate(where, low);
        return t == 0 ? from : from + t * (g.coordinate(where, low + 1) - from);
      };
      text += fmt::format("{:.6g} {:.6g} {:.5g}\n", place(s.across, i, u), place(s.up, j, v), std::exp(value));
    }
    text += "\n";
  }
  return text;
}

/// 1, 2 or 5 times a power of ten, the smallest that is not below x > 0.
double nice_above(double x) {
  const double power = std::pow(10, std::floor(std::log10(x))), lead = x / power;
  return (lead <= 1 ? 1 : lead <= 2 ? 2 : lead <= 5 ? 5 : 10) * power;
}

/// Tics of an axis: whole steps, none of them so near to an end that its label would touch the next panel's.
std::string inner_tics(double low, double high) {
  const double step = nice_above((high - low) / 7), margin = 0.07 * (high - low);
  std::string list;
  for (double k = std::ceil((low + margin) / step); k * step <= high - margin; ++k)
    list += fmt::format("{}{:.10g}", list.empty() ? "" : ", ", k * step + 0.0);
  return list;
}

/// Preferred numbers within the range: the coarsest series that has at least `wanted` of them, or the finest.
std::vector<double> levels(const Extremes& e, std::size_t wanted) {
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

/// The mean positions of the slides that occur in a slice.
std::string slide_text(const StiffnessMap& map, const Slice& s) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (int j = 0; j < map.options.grid.counts[static_cast<std::size_t>(s.up)]; ++j)
    for (int i = 0; i < map.options.grid.counts[static_cast<std::size_t>(s.across)]; ++i)
      if (const MapPose& p = at(map, s, i, j); p.reached()) {
        low = std::min(low, p.slide_mean_mm);
        high = std::max(high, p.slide_mean_mm);
      }
  if (low > high) return ": out of reach";
  return map.slides.key.empty() ? "" : fmt::format(": mean {} {:.0f}–{:.0f} mm", map.slides.words, low, high);
}

std::vector<std::string> heading(const StiffnessMap& map, const std::string& title, const char* note) {
  const Vector3& tilt = map.options.grid.tilt_deg;
  std::string theory = fmt::format("{} theory", shown_theory(map));
  if (map.options.analytic && map.options.msa) {
    double largest = 1e-15;
    for (const MapPose& p : map.poses) largest = std::max(largest, p.relative_difference);
    theory += fmt::format(", MSA within {:.0e} of it", std::pow(10, std::ceil(std::log10(largest))));
  }
  return {fmt::format("{}: {}", clip(map.device, 40), title),
          fmt::format("1/C_ii at the tool point, base axes, {}; {}",
                      map.options.load_N_Nmm ? "tangent" : "secant from no load", map_load_text(map)),
          fmt::format("{}; roll, pitch, yaw {:g}°, {:g}°, {:g}°{}", theory, tilt(0), tilt(1), tilt(2), note)};
}

void put_heading(Script& script, const StiffnessMap& map, const std::string& title, const char* note, double height) {
  const std::vector<std::string> lines = heading(map, title, note);
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

  const bool all_reached =
      std::all_of(map.poses.begin(), map.poses.end(), [](const MapPose& p) { return p.reached(); });
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
  const std::vector<double> iso = levels(e, 14), index = levels(e, 4);
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
  put_heading(script, map, "stiffness over the workspace", all_reached ? "" : "; hatched: out of reach", height);
  const double light = std::exp(std::log(e.low) + 0.62 * std::log(e.high / e.low));  // dark lines on light colours
  const std::string ink = fmt::format("($3 < {:.6g} ? 0xFFFFFF : 0x000000)", light);
  std::string is_index = "0";  // the iso-curves that are heavier and carry their number
  for (const double level : index) is_index += fmt::format("||abs($3/{:g}-1)<1e-3", level);
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
      script.put("set xtics ({}) offset 0,0.4\nset ytics ({}) offset 0.6,0\nset format y '{}'",
                 inner_tics(g.low_mm(s.across), g.high_mm(s.across)), inner_tics(g.low_mm(s.up), g.high_mm(s.up)),
                 axis == 0 ? "%g" : "");
      if (axis == 0) {
        script.put("set label 10 '{} (mm)' at screen {:.5f},{:.5f} center rotate by 90", axis_names[s.up], across(2.5),
                   up(y + h / 2));
        script.put("set label 11 {} at screen {:.5f},{:.5f} left textcolor rgb '#202020'",
                   gnuplot_quote(fmt::format("{} = {:.4g} mm{}", axis_names[s.fixed()], g.coordinate(s.fixed(), s.at),
                                             slide_text(map, s))),
                   across(left), up(y - 2.4));
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
      if (!iso.empty()) {
        const double margin_x = 0.1 * extent(s.across), margin_y = 0.06 * extent(s.up);
        const std::string inside =
            fmt::format("$1>{:.6g}&&$1<{:.6g}&&$2>{:.6g}&&$2<{:.6g}", g.low_mm(s.across) + margin_x,
                        g.high_mm(s.across) - margin_x, g.low_mm(s.up) + margin_y, g.high_mm(s.up) - margin_y);
        curves = fmt::format(
            ", $c{0}{1} using 1:2:{2} with lines lc rgb variable lw 0.3"
            ", $c{0}{1} using 1:({3} ? $2 : NaN):{2} with lines lc rgb variable lw 0.9"
            ", $c{0}{1} using 1:(({3})&&{4} ? $2 : NaN):(sprintf('%g',$3)):{2} every ::28::28 with labels font "
            "'DejaVu Sans,6' offset 0,0.35 textcolor rgb variable",
            r, axis, ink, is_index, inside);
      }
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

  constexpr double height = 82, top = 25, bottom = 11, from_left = left + 3,
                   room = (width - from_left - 5 - 2 * gap) / 3;
  Script script;
  script.put("$points << EOD\n{}EOD\n$median << EOD\n{}EOD", points, medians);
  script.put("set multiplot\nunset key");
  put_heading(script, map, "stiffness against the mean " + map.slides.words, bins > 1 ? "; line: median" : "", height);
  script.put("set tmargin at screen {:.5f}\nset bmargin at screen {:.5f}", 1 - top / height, bottom / height);
  script.put("set logscale y\nset mytics default");
  const double beside = 0.04 * std::max(longest - shortest, 1.0);
  script.put("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]", shortest - beside, longest + beside,
             e.low / 1.15, e.high * 1.15);
  script.put("set xtics ({}) offset 0,0.2", inner_tics(shortest - beside, longest + beside));
  script.put("set label 10 'stiffness along the force (N/mm)' at screen {:.5f},{:.5f} center rotate by 90", 3 / width,
             (bottom + (height - top - bottom) / 2) / height);
  script.put("set label 11 'mean {} (mm)' at screen {:.5f},{:.5f} center", map.slides.words,
             (from_left + width - 5) / 2 / width, 3 / height);
  for (int axis = 0; axis < 3; ++axis) {
    const double x = from_left + axis * (room + gap);
    script.put("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}", x / width, (x + room) / width);
    script.put(
        "set label 12 'force along {}' at screen {:.5f},{:.5f} left font 'DejaVu Sans:Bold,8' textcolor rgb '{}'",
        axis_names[axis], x / width, 1 - (top - 5.5) / height, colours[axis]);
    script.put("set ytics ({})", tics({e.low / 1.15, e.high * 1.15}, axis == 0));
    const double rho = with_slides(map, axis).spearman;
    script.put("set label 13 'Spearman’s ρ = {}{:.2f}' at screen {:.5f},{:.5f} left textcolor rgb '#505050'",
               rho < 0 ? "−" : "", std::abs(rho), x / width, 1 - (top - 2) / height);
    script.put("plot $points using 1:{} with points lc rgb '#90{}' pt {} ps {:.2f}{}", axis + 2, colours[axis] + 1,
               shapes[axis], std::clamp(8 / std::sqrt(static_cast<double>(poses.size())), 0.22, 0.6),
               bins > 1
                   ? fmt::format(", $median using 1:{0} with lines lc rgb '#ffffff' lw 3, $median using 1:{0} with "
                                 "lines lc rgb '#202020' lw 1.4",
                                 axis + 2)
                   : "");
    for (const int tag : {1, 2, 3, 10, 11, 12, 13}) script.put("unset label {}", tag);
  }
  script.text += "unset multiplot";
  return {{"stiffness-vs-length", script.text, width, height}};
}

}  // namespace deflect
