#include "validation/figures/stiffness_length.h"

#include <algorithm>
#include <cmath>

#include "validation/figures/map_scale.h"
#include "validation/figures/map_words.h"
#include "validation/figures/sheet.h"
#include "validation/report/by_point.h"
#include "validation/report/map_correlation.h"
#include "validation/report/map_results.h"
#include "validation/report/text.h"

namespace deflect {

std::vector<Figure> stiffness_against_length(const StiffnessMap& map, const FigureStyle& style) {
  const StiffnessRange e = range_of_stiffness(map);
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
    script.put("set ytics ({})", tics_in({e.low / 1.15, e.high * 1.15}, axis == 0));
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
