#include "validation/figures/residual_map.h"
#include "validation/report/text.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "validation/figures/sheet.h"
#include "validation/report/compare_words.h"

namespace deflect {
namespace {

constexpr double depth_x = 0.42, depth_z = 0.26;  // of a step along y, into the page

// Blue, white, red of ColorBrewer's RdBu, told apart with any colour vision.
constexpr const char* diverging_palette =
    "set palette defined (-1 '#053061', -0.75 '#2166AC', -0.5 '#4393C3', -0.25 '#92C5DE', 0 '#F7F7F7', 0.25 '#F4A582', "
    "0.5 '#D6604D', 0.75 '#B2182B', 1 '#67001F')";

/// Where poses lie, mm; as wide as a tenth of the largest extent at least.
struct Box {
  Vector3 low, high;
  double across(const Vector3& p) const { return p.x() + depth_x * (p.y() - low.y()); }
  double up(const Vector3& p) const { return p.z() + depth_z * (p.y() - low.y()); }
};

Box box_of(const Comparison& c) {
  Vector3 low = Vector3::Constant(INFINITY), high = -low;
  for (const Configuration& machine : c.study.machines) {
    low = low.cwiseMin(mm * machine.pose.p_WT);
    high = high.cwiseMax(mm * machine.pose.p_WT);
  }
  const double least = std::max(0.1 * (high - low).maxCoeff(), 1.0);
  for (int k = 0; k < 3; ++k) {
    const double middle = (low(k) + high(k)) / 2, half = std::max((high(k) - low(k)) / 2, least / 2) * 1.12;
    low(k) = middle - half, high(k) = middle + half;
  }
  return {low, high};
}

/// Edges of the box, and each pose's foot on its floor.
std::string frame_of(const Box& box) {
  std::string out = "$box << EOD\n";
  const auto corner = [&](int i) {
    return Vector3(i & 1 ? box.high.x() : box.low.x(), i & 2 ? box.high.y() : box.low.y(),
                   i & 4 ? box.high.z() : box.low.z());
  };
  for (int i = 0; i < 8; ++i)
    for (const int bit : {1, 2, 4})
      if (!(i & bit)) {
        for (const Vector3& p : {corner(i), corner(i | bit)})
          out += fmt::format("{:.5g} {:.5g}\n", box.across(p), box.up(p));
        out += "\n";
      }
  return out + "EOD\n";
}

}  // namespace

std::vector<SignedResidual> signed_residuals(const Comparison& c) {
  const std::vector<ReadingCells> cells = cells_of(c);
  std::vector<SignedResidual> out;
  for (const PoseGroup& pose : c.study.data->poses) {
    Vector3 moved = Vector3::Zero(), load = moved, sum = moved, count = moved;
    for (const std::size_t i : pose.readings) {
      if (cells[i].set_aside) continue;
      for (int k = 0; k < 3; ++k) {
        const double r = cells[i].residual(k), F = cells[i].load(k);
        if (!std::isfinite(r)) continue;
        moved(k) += F * r, load(k) += std::abs(F), sum(k) += r, count(k) += 1;
      }
    }
    SignedResidual s;
    for (int k = 0; k < 3; ++k) {
      s.along(k) = load(k) > 0 ? moved(k) / load(k) : NAN;
      s.mean(k) = count(k) > 0 ? sum(k) / count(k) : NAN;
    }
    out.push_back(s);
  }
  return out;
}

Figure residual_map(const Comparison& c, const FigureStyle& style) {
  const ErrorUnit unit = error_unit(c);
  const std::vector<SignedResidual> values = signed_residuals(c);
  const Box box = box_of(c);
  Sheet s("residual-map", style, 160);

  // What there is to draw, and its scale.
  double most = 0;
  bool any[2][3] = {};
  for (const SignedResidual& v : values)
    for (int k = 0; k < 3; ++k)
      for (const int kind : {0, 1}) {
        const double x = (kind == 0 ? v.along : v.mean)(k);
        if (!std::isfinite(x)) continue;
        any[kind][k] = true;
        most = std::max(most, um * std::abs(x));
      }
  most = std::max(most, 1e-3);
  std::vector<int> kinds, components;
  for (const int kind : {0, 1})
    if (any[kind][0] || any[kind][1] || any[kind][2]) kinds.push_back(kind);
  for (int k = 0; k < 3; ++k)
    if (any[0][k] || any[1][k]) components.push_back(k);

  // From behind to the front.
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return c.study.machines[a].pose.p_WT.y() > c.study.machines[b].pose.p_WT.y();
  });
  s.put("{}$data << EOD", frame_of(box));
  for (const std::size_t p : order) {
    const Vector3 at = mm * c.study.machines[p].pose.p_WT, foot(at.x(), at.y(), box.low.z());
    std::string row = fmt::format("{:.5g} {:.5g} {:.5g}", box.across(at), box.up(at), box.up(foot));
    for (const Vector3& v : {values[p].along, values[p].mean})
      for (int k = 0; k < 3; ++k) row += fmt::format(" {:.5g}", um * v(k));
    s.put("{}", row);
  }
  s.put("EOD\nset multiplot\nunset key\nunset border\nunset tics\n{}\nset cbrange [{}:{}]", diverging_palette, -most,
        most);

  // One row for each quantity, or on narrow paper one column.
  const bool upright = s.narrow();
  const std::size_t columns = upright ? kinds.size() : components.size(),
                    rows = upright ? components.size() : kinds.size();
  const double margin = 3, gap = 3, bar = upright ? 0 : 6 + s.text_mm(5) + 1.5 * s.line();
  const double w = std::min(
      (s.width() - 2 * margin - bar - gap * static_cast<double>(columns - 1)) / static_cast<double>(columns), 60.0);
  const Vector3 extent = box.high - box.low;
  const double wide = extent.x() + depth_x * extent.y(), tall = extent.z() + depth_z * extent.y();
  const double h = std::clamp(w * tall / wide, 0.45 * w, 1.3 * w);
  const double room = 1.03 * std::max(tall / h, wide / w);  // mm of the machine for one on paper
  s.put("set xrange [{}:{}]\nset yrange [{}:{}]", box.low.x() + wide / 2 - room * w / 2,
        box.low.x() + wide / 2 + room * w / 2, box.low.z() + tall / 2 - room * h / 2,
        box.low.z() + tall / 2 + room * h / 2);

  const auto range = [&](int k) {
    double low = INFINITY, high = -INFINITY;
    for (const Configuration& m : c.study.machines)
      low = std::min(low, mm * m.pose.p_WT(k)), high = std::max(high, mm * m.pose.p_WT(k));
    return low == high ? fmt::format("{:.4g}", low + 0.0) : fmt::format("{:.4g} … {:.4g}", low + 0.0, high + 0.0);
  };
  const std::string seen =
      fmt::format("x to the right {}, y into the page {}, z up {} mm", range(0), range(1), range(2));
  const double top = s.heading("Signed residual by pose", {subjects(c), seen + "; circles > 0, squares < 0"});
  const double row = h + 1.9 * s.line(),
               marker =
                   std::clamp(0.048 * w / std::sqrt(std::max(1.0, static_cast<double>(values.size()) / 12)), 0.5, 2.0);
  for (std::size_t i = 0; i < rows * columns; ++i) {
    const int kind = kinds[upright ? i % columns : i / columns], k = components[upright ? i / columns : i % columns];
    const double x = margin + static_cast<double>(i % columns) * (w + gap),
                 y = top + static_cast<double>(i / columns) * row + 1.6 * s.line();
    s.panel(x, y, w, h);
    s.label(kind == 0 ? fmt::format("{} in the sense of {}", unit.components[k], unit.loads[k])
                      : fmt::format("{}, mean", unit.components[k]),
            x + w / 2, y - 0.6 * s.line(), "center");
    const bool last = i + 1 == rows * columns;
    const Tics tics = s.tics(-most, most, upright ? 0.7 * s.width() : 40, !upright);
    if (last && upright)
      s.put("set colorbox horizontal user {} size screen {:.4f},{:.4f}/H\nset cbtics {} scale 0.4",
            "origin " + s.at(0.15 * s.width(), y + h + 1.2 * s.line() + 3).substr(3), 0.7, 3.0, tics.step);
    else if (last)
      s.put("set colorbox vertical user {} size screen {:.4f},{:.4f}/H\nset cbtics {} scale 0.4",
            "origin " + s.at(s.width() - bar, y + h).substr(3), 3.5 / s.width(), y + h - top - 1.6 * s.line(),
            tics.step);
    else
      s.put("unset colorbox");
    if (last && upright)
      s.label(unit.micro, 0.85 * s.width() + 2, y + h + 1.2 * s.line() + 1.5, "left");
    else if (last)
      s.label(fmt::format("measured − predicted ({})", unit.micro), s.width() - 0.6 * s.line(),
              (top + 1.6 * s.line() + y + h) / 2, "center rotate by 90");
    const int column = 4 + 3 * kind + k;
    const std::string some = fmt::format("'' using (${0}>=0?$1:NaN):2", column),
                      less = fmt::format("'' using (${0}<0?$1:NaN):2", column);
    s.plot(fmt::format(
        "plot $box with lines lc rgb '#B0B0B0' lw 0.5, $data using 1:2:(0):($3-$2) with vectors nohead lc rgb "
        "'#B0B0B0' "
        "lw 0.5, {0} with points pt 7 ps {2:.3f} lc rgb '#404040', {0}:{4} with points pt 7 ps {3:.3f} lc palette, "
        "{1} with points pt 5 ps {2:.3f} lc rgb '#404040', {1}:{4} with points pt 5 ps {3:.3f} lc palette",
        some, less, marker, 0.86 * marker, column));
  }
  s.put("unset multiplot");
  const double height = top + static_cast<double>(rows) * row + (upright ? 3.2 * s.line() : 0.5 * s.line());
  std::string meaning;
  if (any[0][0] || any[0][1] || any[0][2])
    meaning = fmt::format(
        "In the sense of {0}: the mean of the residual with the sign of the load's component ({1}), weighed by its "
        "size, "
        "so that positive means that the machine yields more than predicted. ",
        unit.loads[0] + std::string(", ") + unit.loads[1] + ", " + unit.loads[2], unit.load);
  return s.figure(
      height,
      fmt::format("Signed residual of each component at every pose, in {0}, on one scale of ±{1:.3g} {0} "
                  "(blue and squares negative, red and circles positive). {2}Mean: over all readings of the "
                  "pose, what does not change its sign with the load.{3} The workspace is seen obliquely, {4}. "
                  "{5} {6} {7}",
                  unit.micro, most, meaning,
                  c.set_aside.empty() ? "" : fmt::format(" {} gross outliers are left out.", c.set_aside.size()), seen,
                  axes_sentence(c), data_sentence(c), noise_sentence(c)));
}

}  // namespace deflect
