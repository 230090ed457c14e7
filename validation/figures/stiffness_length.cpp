#include "validation/figures/stiffness_length.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/figures/map_scale.h"
#include "validation/figures/map_words.h"
#include "validation/figures/sheet.h"
#include "validation/report/by_point.h"
#include "validation/report/map_correlation.h"
#include "validation/report/map_results.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

/// The poses that are reached, the shortest mean length first.
std::vector<const studies::MapPose*> by_length(const studies::StiffnessMap& map) {
  std::vector<const studies::MapPose*> poses;
  for (const studies::MapPose& p : map.poses)
    if (p.reached()) poses.push_back(&p);
  std::stable_sort(poses.begin(), poses.end(), [](const studies::MapPose* a, const studies::MapPose* b) {
    return a->slide_mean_mm < b->slide_mean_mm;
  });
  return poses;
}

std::string length_row(double length, const Vector3& k) {
  return fmt::format("{:.5g} {:.5g} {:.5g} {:.5g}\n", length, k(0), k(1), k(2));
}

/// Of many poses some, spread evenly by the golden ratio.
std::string point_rows(const std::vector<const studies::MapPose*>& poses) {
  constexpr double most = 1500;
  std::string rows;
  for (std::size_t i = 0; i < poses.size(); ++i)
    if (std::fmod(0.6180339887498949 * static_cast<double>(i), 1) * static_cast<double>(poses.size()) < most)
      rows += length_row(poses[i]->slide_mean_mm, report::shown(*poses[i])->stiffness_N_mm);
  return rows;
}

/// Medians of all poses in bins of equally many; nothing for a single bin.
std::string median_rows(const std::vector<const studies::MapPose*>& poses, std::size_t bins) {
  std::string rows;
  for (std::size_t b = 0; bins > 1 && b < bins; ++b) {
    const std::size_t from = b * poses.size() / bins, to = (b + 1) * poses.size() / bins;
    Vector3 median;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> values;
      for (std::size_t i = from; i < to; ++i) values.push_back(report::shown(*poses[i])->stiffness_N_mm(axis));
      const auto middle = values.begin() + as_index(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      median(axis) = *middle;
    }
    rows += length_row(poses[(from + to) / 2]->slide_mean_mm, median);
  }
  return rows;
}

/// Three panels in a row, one for each direction of the force; at least one pose is reached.
class LengthPanels {
 public:
  LengthPanels(const studies::StiffnessMap& map, const FigureStyle& style)
      : map_(map),
        e_(range_of_stiffness(map)),
        poses_(by_length(map)),
        bins_(std::clamp<std::size_t>(poses_.size() / 20, 1, 16)),
        s_("stiffness-vs-length", style, 170.5),
        line_(s_.line()),
        left_(1.8 * line_ + s_.text_mm(report::letters(fmt::format("{:.0f}", e_.high)))),
        gap_(s_.narrow() ? 3 : 4.5),
        room_((s_.width() - left_ - 5 - 2 * gap_) / 3),
        tall_(std::clamp(1.05 * room_, 8 * line_, 60.0)) {}

  Figure figure() {
    s_.put("$points << EOD\n{}EOD\n$median << EOD\n{}EOD", point_rows(poses_), median_rows(poses_, bins_));
    s_.put("set multiplot\nunset key");
    top_ = map_heading(s_, map_, "stiffness against the mean " + map_.slides.words, bins_ > 1 ? "; line: median" : "",
                       s_.narrow() ? 3 : left_) +
           2.6 * line_;
    put_axes();
    for (int axis = 0; axis < 3; ++axis) draw(axis);
    s_.put("unset multiplot");
    return s_.figure(
        top_ + tall_ + s_.below(),
        map_caption(map_, fmt::format("Stiffness at every pose over the mean {} there, by the direction of the force; "
                                      "ρ: Spearman’s rank correlation of the two{}.",
                                      map_.slides.words, bins_ > 1 ? "; line: median of poses of like length" : "")));
  }

 private:
  /// What all panels share.
  void put_axes() {
    const double shortest = poses_.front()->slide_mean_mm, longest = poses_.back()->slide_mean_mm;
    s_.put("set logscale y\nset mytics default");
    const double beside = 0.04 * std::max(longest - shortest, 1.0);
    s_.put("set xrange [{:.6g}:{:.6g}]\nset yrange [{:.6g}:{:.6g}]", shortest - beside, longest + beside, e_.low / 1.15,
           e_.high * 1.15);
    s_.put("set xtics ({}) offset 0,0.2", inner_tics(s_, shortest - beside, longest + beside, room_));
  }

  void draw(int axis) {
    const double x = left_ + axis * (room_ + gap_);
    s_.panel(x, top_, room_, tall_);
    if (axis == 0) name_axes();
    s_.label((s_.narrow() ? "force " : "force along ") + std::string(report::axis_names[axis]), x, top_ - 1.5 * line_,
             fmt::format("left {} textcolor rgb '{}'", s_.font(1, true), colours[axis]));
    s_.put("set ytics ({})", tics_in({e_.low / 1.15, e_.high * 1.15}, axis == 0));
    const double rho = report::with_slides(map_, axis).spearman;
    s_.label(fmt::format("{} = {}{:.2f}", s_.narrow() ? "ρ" : "Spearman’s ρ", rho < 0 ? "−" : "", std::abs(rho)), x,
             top_ - 0.55 * line_, "left textcolor rgb '#505050'");
    s_.plot(fmt::format(
        "plot $points using 1:{} with points lc rgb '#90{}' pt {} ps {:.2f}{}", axis + 2, colours[axis] + 1,
        shapes[axis], std::clamp(8 / std::sqrt(static_cast<double>(poses_.size())), 0.22, 0.6),
        bins_ > 1 ? fmt::format(", $median using 1:{0} with lines lc rgb '#ffffff' lw 3, $median using 1:{0} with "
                                "lines lc rgb '#202020' lw 1.4",
                                axis + 2)
                  : ""));
  }

  void name_axes() {
    s_.label(s_.narrow() ? "stiffness (N/mm)" : "stiffness along the force (N/mm)", 0.5 * line_, top_ + tall_ / 2,
             "center rotate by 90");
    s_.label(fmt::format("mean {} (mm)", map_.slides.words), (left_ + s_.width() - 5) / 2, top_ + tall_ + 2 * line_,
             "center");
  }

  const studies::StiffnessMap& map_;
  StiffnessRange e_;
  std::vector<const studies::MapPose*> poses_;
  std::size_t bins_;
  Sheet s_;
  double line_, left_, gap_, room_, tall_;  // mm; room_ and tall_ are a panel's
  double top_ = 0;                          // of the panels
};

}  // namespace

std::vector<Figure> stiffness_against_length(const studies::StiffnessMap& map, const FigureStyle& style) {
  if (range_of_stiffness(map).high == 0 || map.slides.key.empty()) return {};
  return {LengthPanels(map, style).figure()};
}

}  // namespace deflect::figures
