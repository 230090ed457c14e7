#include "validation/report/compare_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "validation/report/text.h"

namespace deflect {
namespace {

constexpr const char* colours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"};
constexpr const char* axis_letter[] = {"x", "y", "z"};
constexpr double um = 1e6;

struct Script {
  std::string text;
  template <class... T>
  void put(fmt::format_string<T...> format, T&&... values) {
    text += fmt::format(format, std::forward<T>(values)...) + "\n";
  }
};

void title(Script& s, const Comparison& c, const std::string& what, double height = 110) {
  s.put("set label 100 {} at screen 0.02,{:.4f} left noenhanced font 'DejaVu Sans:Bold,9'", gnuplot_quote(what),
        1 - 3.5 / height);
  s.put("set label 101 {} at screen 0.02,{:.4f} left noenhanced textcolor rgb '#505050' font 'DejaVu Sans,7.5'",
        gnuplot_quote(
            fmt::format("{} against {}", clip(c.device, 40), clip(c.data.substr(c.data.find_last_of('/') + 1), 40))),
        1 - 8 / height);
}

/// Of tics over a symmetric range: 1, 2 or 5 times a power of ten, two or three on each side.
double nice_step(const std::vector<double>& range) {
  double most = 1e-12;
  for (const double x : range) most = std::max(most, std::abs(x));
  const double power = std::pow(10, std::floor(std::log10(most))), lead = most / power;
  return power * (lead >= 5 ? 5 : lead >= 2 ? 2 : 1);
}

/// x, y, z of a reading: measured, predicted; NaN where not measured.
struct Cells {
  Vector3 measured = Vector3::Constant(NAN), predicted, residual = Vector3::Constant(NAN);
};

std::vector<Cells> cells_of(const Comparison& c) {
  std::vector<Cells> out(c.readings);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].predicted = c.study.predicted[i].head<3>();
  for (std::size_t i = 0; i < c.study.values.size(); ++i) {
    const MeasuredValue& v = c.study.values[i];
    if (v.component >= 3) continue;
    out[v.reading].measured(static_cast<Eigen::Index>(v.component)) = v.value;
    out[v.reading].residual(static_cast<Eigen::Index>(v.component)) = c.residual(static_cast<Eigen::Index>(i));
  }
  return out;
}

Figure residuals(const Comparison& c, const std::vector<Cells>& cells) {
  Script s;
  title(s, c, c.study.sequence ? "Residuals in the order of the readings" : "Residuals in the order of the file");
  s.put("$data << EOD");
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double at = c.study.sequence ? *c.study.data->readings[i].sequence : static_cast<double>(i);
    s.put("{} {} {} {}", at, um * cells[i].residual.x(), um * cells[i].residual.y(), um * cells[i].residual.z());
  }
  std::vector<std::size_t> measured;
  for (std::size_t k = 0; k < 3; ++k)
    if (std::any_of(c.study.values.begin(), c.study.values.end(),
                    [k](const MeasuredValue& v) { return static_cast<std::size_t>(v.component) == k; }))
      measured.push_back(k);
  s.put("EOD\nset multiplot layout {},1 margins 0.11,0.97,0.12,0.88 spacing 0.05", measured.size());
  const double band = 2 * um * c.noise_and_tolerances;
  for (const std::size_t k : measured) {
    s.put("set ylabel 'Δ{} (µm)'\nset xzeroaxis lt 1 lc rgb '#404040' lw 0.7", axis_letter[k]);
    s.put("set object 1 rectangle from graph 0,first {} to graph 1,first {} fc rgb '#E8E8E8' fs solid noborder behind",
          -band, band);
    const bool last = k == measured.back();
    s.put("{}", last ? "set xtics\nset xlabel 'reading'" : "set format x ''");
    if (last) s.put("set format x '%g'");
    s.put("plot $data using 1:{} with points pt 7 ps 0.3 lc rgb '{}' notitle", k + 2, colours[k]);
    s.put("unset label 100\nunset label 101");
  }
  s.put("unset multiplot");
  return {"residuals", s.text, 160, 110};
}

Figure residual_map(const Comparison& c) {
  Script s;
  title(s, c, "Residual by pose: root mean square (µm), the worst on top", 80);
  s.put("$data << EOD");
  double most = 0;
  std::vector<std::size_t> order(c.by_pose.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return c.by_pose[a].rmse < c.by_pose[b].rmse; });
  for (const std::size_t p : order) {
    const Vector3 at = 1e3 * c.study.machines[p].pose.p_WT;
    most = std::max(most, um * c.by_pose[p].rmse);
    s.put("{:.4f} {:.4f} {:.4f} {:.4f}", at.x(), at.y(), at.z(), um * c.by_pose[p].rmse);
  }
  s.put("EOD\nset multiplot layout 1,2 margins 0.1,0.84,0.16,0.86 spacing 0.12");
  s.put("set palette defined (0 '#F7FBFF', 0.35 '#9ECAE1', 0.7 '#3182BD', 1 '#08306B')\nset cbrange [0:{}]",
        std::max(most, 1e-3));
  s.put("set offsets graph 0.1, graph 0.1, graph 0.1, graph 0.1\nset size ratio -1\nset xlabel 'x (mm)'");
  for (int k = 0; k < 2; ++k) {
    s.put("set ylabel '{} (mm)'\n{}", k == 0 ? "y" : "z",
          k == 0 ? "unset colorbox" : "set colorbox user origin screen 0.88,0.16 size screen 0.02,0.7");
    s.put(
        "plot $data using 1:{} with points pt 7 ps 2.2 lc rgb '#404040' notitle, '' using 1:{}:4 with points pt 7 ps "
        "1.9 lc palette notitle",
        k + 2, k + 2);
    s.put("unset label 100\nunset label 101");
  }
  s.put("unset multiplot");
  return {"residual-map", s.text, 160, 80};
}

Figure groups(const Comparison& c) {
  Script s;
  std::string labels;
  s.put("$data << EOD");
  int at = 0;
  double most = um * c.noise_and_tolerances;
  for (const auto* list : {&c.by_axis, &c.by_direction, &c.by_magnitude, &c.by_heading}) {
    for (const Errors& e : *list) {
      s.put("{} {:.5g}", at, um * e.rmse);
      labels += fmt::format("{}{} {}", labels.empty() ? "" : ", ", gnuplot_tic_label(e.group), at);
      most = std::max(most, um * e.rmse);
      ++at;
    }
    ++at;
  }
  const double height = 20 + 5.0 * at;
  s.put("EOD");
  title(s, c, "Residual by group: root mean square", height);
  s.put("set lmargin at screen 0.2\nset rmargin at screen 0.96\nset tmargin at screen 0.9\nset bmargin at screen 0.11");
  s.put("set ytics ({})\nset yrange [{}:-1]\nset xrange [0:{}]\nset xlabel 'rms of measured − predicted (µm)'", labels,
        at, 1.08 * most);
  s.put("set arrow 1 from {0},graph 0 to {0},graph 1 nohead dt 2 lc rgb '#D55E00' front", um * c.noise_and_tolerances);
  s.put("set label 1 'noise and tolerances' at {},graph 0.98 offset 0.5,0 textcolor rgb '#D55E00' font 'DejaVu Sans,7'",
        um * c.noise_and_tolerances);
  s.put("plot $data using (0):1:2:(0) with vectors nohead lw 6 lc rgb '#0072B2' notitle");
  return {"groups", s.text, 160, height};
}

/// Readings under one force or moment component alone: axis 0 … 5.
std::optional<std::size_t> pure_axis(const Vector6& F) {
  std::optional<std::size_t> axis;
  for (std::size_t k = 0; k < 6; ++k)
    if (F(static_cast<Eigen::Index>(k)) != 0) {
      if (axis) return std::nullopt;
      axis = k;
    }
  return axis;
}

std::optional<Figure> secant(const Comparison& c, const std::vector<Cells>& cells) {
  Script s;
  title(s, c, "Displacement over load along the load: measured (points) and predicted (lines)", 80);
  std::vector<std::size_t> loaded;  // axes with points; gnuplot refuses a panel without
  for (std::size_t k = 0; k < 3; ++k) {
    bool any = false;
    std::string block = fmt::format("$d{} << EOD\n", k);
    for (const PoseGroup& group : c.study.data->poses) {
      std::vector<std::size_t> order;
      for (const std::size_t i : group.readings)
        if (pure_axis(c.study.data->readings[i].load) == k &&
            std::isfinite(cells[i].measured(static_cast<Eigen::Index>(k))))
          order.push_back(i);
      std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return c.study.data->readings[a].load(static_cast<Eigen::Index>(k)) <
               c.study.data->readings[b].load(static_cast<Eigen::Index>(k));
      });
      for (const std::size_t i : order) {
        const double F = c.study.data->readings[i].load(static_cast<Eigen::Index>(k));
        block += fmt::format("{} {} {} {}\n", F, um * cells[i].measured(static_cast<Eigen::Index>(k)) / F,
                             um * cells[i].predicted(static_cast<Eigen::Index>(k)) / F, group.label.empty() ? 0 : 1);
        any = true;
      }
      if (!order.empty()) block += "\n";
    }
    s.put("{}EOD", block);
    if (any) loaded.push_back(k);
  }
  if (loaded.empty()) return std::nullopt;
  s.put(
      "set multiplot layout 1,{} margins 0.09,0.97,0.17,0.84 spacing 0.08\nset offsets graph 0.05, graph 0.05, graph "
      "0.05, graph 0.05",
      loaded.size());
  for (const std::size_t k : loaded) {
    s.put("set xlabel 'f{} (N)'\nset ylabel {}", axis_letter[k],
          k == loaded.front() ? "'secant compliance (µm/N)'" : "''");
    s.put(
        "plot $d{} using 1:3 with lines lc rgb '#808080' lw 0.8 notitle, '' using 1:2 with points pt 7 ps 0.35 lc rgb "
        "'{}' notitle",
        k, colours[k]);
    s.put("unset label 100\nunset label 101");
  }
  s.put("unset multiplot");
  return Figure{"secant", s.text, 160, 80};
}

std::optional<Figure> elongation(const Comparison& c) {
  if (c.curves.empty()) return std::nullopt;
  Script s;
  const std::size_t columns = std::min<std::size_t>(3, c.curves.size()),
                    rows = (c.curves.size() + columns - 1) / columns;
  const double height = 25 + 45.0 * static_cast<double>(rows);
  title(s, c, "Force–elongation of the sites beyond the model", height);
  double low = 0, high = 0;
  for (std::size_t k = 0; k < c.curves.size(); ++k) {
    const ElongationCurve& curve = c.curves[k];
    s.put("$c{} << EOD", k);
    for (std::size_t i = 0; i < curve.force.size(); ++i) {
      s.put("{} {} {}", curve.force[i], um * curve.elongation[i], um * curve.deviation[i]);
      low = std::min(low, um * (curve.elongation[i] - curve.deviation[i]));
      high = std::max(high, um * (curve.elongation[i] + curve.deviation[i]));
    }
    s.put("EOD");
  }
  s.put("set multiplot layout {},{} margins 0.09,0.97,{},{} spacing 0.05,0.06", rows, columns, rows > 1 ? 0.11 : 0.17,
        rows > 1 ? 0.88 : 0.84);
  s.put("set yrange [{}:{}]\nset xzeroaxis lt 1 lc rgb '#808080' lw 0.6\nset yzeroaxis lt 1 lc rgb '#808080' lw 0.6",
        1.1 * low - 1e-3, 1.1 * high + 1e-3);
  for (std::size_t k = 0; k < c.curves.size(); ++k) {
    const bool bottom = k + columns >= c.curves.size(), left = k % columns == 0;
    s.put("set xtics {:.12g}", nice_step(c.curves[k].force));
    s.put("set xlabel {}\nset ylabel {}", bottom ? (c.curves[k].rotation ? "'moment (Nm)'" : "'force (N)'") : "''",
          left ? (c.curves[k].rotation ? "'µrad'" : "'elongation (µm)'") : "''");
    s.put("set label 1 {} at graph 0.04,0.92 noenhanced", gnuplot_quote(c.curves[k].site));
    s.put("set format x {}\nset format y {}", bottom ? "'%g'" : "''", left ? "'%g'" : "''");
    s.put(
        "plot $c{0} using 1:($2-$3):($2+$3) with filledcurves fc rgb '#C6DBEF' notitle, '' using 1:2 with linespoints "
        "pt 7 ps 0.4 lw 1.4 lc rgb '#0072B2' notitle",
        k);
    s.put("unset label 100\nunset label 101");
  }
  s.put("unset multiplot");
  return Figure{"elongation", s.text, 160, height};
}

std::optional<Figure> loops(const Comparison& c, const std::vector<Cells>& cells) {
  const auto worst = std::max_element(c.by_pose.begin(), c.by_pose.end(),
                                      [](const Errors& a, const Errors& b) { return a.rmse < b.rmse; });
  const PoseGroup& group = c.study.data->poses[static_cast<std::size_t>(worst - c.by_pose.begin())];
  Script s;
  title(s, c, fmt::format("Displacement over load in the order taken, {}", worst->group), 80);
  std::vector<std::size_t> loaded;
  std::vector<std::size_t> order = group.readings;
  if (c.study.sequence)
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return c.study.data->readings[a].sequence < c.study.data->readings[b].sequence;
    });
  for (std::size_t k = 0; k < 3; ++k) {
    std::string block = fmt::format("$d{} << EOD\n", k);
    const auto at = static_cast<Eigen::Index>(k);
    bool any = false;
    for (const std::size_t i : order) {
      const Vector6& F = c.study.data->readings[i].load;
      if (!F.isZero(0) && pure_axis(F) != k) continue;
      if (!std::isfinite(cells[i].measured(at))) continue;
      block += fmt::format("{} {} {}\n", F(at), um * cells[i].measured(at), um * cells[i].predicted(at));
      any = any || !F.isZero(0);
    }
    s.put("{}EOD", block);
    if (any) loaded.push_back(k);
  }
  if (loaded.empty()) return std::nullopt;
  s.put(
      "set multiplot layout 1,{} margins 0.09,0.97,0.17,0.84 spacing 0.08\nset offsets graph 0.05, graph 0.05, graph "
      "0.05, graph 0.05",
      loaded.size());
  for (const std::size_t k : loaded) {
    s.put("set xlabel 'f{} (N)'\nset ylabel {}", axis_letter[k],
          k == loaded.front() ? "'displacement along the load (µm)'" : "''");
    s.put(
        "plot $d{} using 1:3 with lines lc rgb '#808080' lw 0.9 notitle, '' using 1:2 with {} pt 7 ps 0.4 lw 0.8 lc "
        "rgb '{}' notitle",
        k, c.study.sequence ? "linespoints" : "points", colours[k]);
    s.put("unset label 100\nunset label 101");
  }
  s.put("unset multiplot");
  return Figure{"loops", s.text, 160, 80};
}

}  // namespace

std::vector<Figure> compare_figures(const Comparison& c) {
  const std::vector<Cells> cells = cells_of(c);
  std::vector<Figure> out;
  const bool translations =
      std::any_of(c.study.values.begin(), c.study.values.end(), [](const MeasuredValue& v) { return v.component < 3; });
  if (translations) out = {residuals(c, cells), residual_map(c), groups(c)};
  for (const std::optional<Figure>& f : {secant(c, cells), elongation(c), loops(c, cells)})
    if (f) out.push_back(*f);
  return out;
}

}  // namespace deflect
