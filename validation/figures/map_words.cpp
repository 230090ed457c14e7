#include "validation/figures/map_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "validation/report/by_point.h"
#include "validation/report/map_results.h"
#include "validation/report/text.h"

namespace deflect::figures {
namespace {

std::string theory_text(const studies::StiffnessMap& map) {
  std::string theory = fmt::format("{} theory", report::shown_theory(map).title);
  if (const theories::Theories& all = map.options.theories; all.size() > 1) {
    double largest = 1e-15;
    for (const studies::MapPose& p : map.poses) largest = std::max(largest, p.relative_difference);
    const std::string others = theories::titles_of(theories::Theories(all.begin() + 1, all.end()));
    theory += fmt::format(", {} within {:.0e} of it", others, std::pow(10, std::ceil(std::log10(largest))));
  }
  return theory;
}

std::string tilt_text(const studies::StiffnessMap& map) {
  const Vector3& tilt = map.options.grid.tilt_deg;
  return fmt::format("roll, pitch, yaw {:g}°, {:g}°, {:g}°", tilt(0), tilt(1), tilt(2));
}

std::string kind_text(const studies::StiffnessMap& map) {
  return map.options.load_N_Nmm ? "tangent" : "secant from no load";
}

}  // namespace

double map_heading(Sheet& s, const studies::StiffnessMap& map, const std::string& title, const std::string& note,
                   double x) {
  return s.heading(
      fmt::format("{}: {}", report::clip(map.device, 40), title),
      {fmt::format("1/C_ii at the tool point, base axes, {}; {}", kind_text(map), report::map_load_text(map)),
       fmt::format("{}; {}{}", theory_text(map), tilt_text(map), note)},
      x);
}

std::string map_caption(const studies::StiffnessMap& map, const std::string& what) {
  const studies::MapGrid& g = map.options.grid;
  const auto reached =
      std::count_if(map.poses.begin(), map.poses.end(), [](const studies::MapPose& p) { return p.reached(); });
  std::string ranges;
  for (int axis = 0; axis < 3; ++axis)
    ranges += fmt::format("{}{} {:.4g} … {:.4g}", axis ? ", " : "", report::axis_names[axis], g.low_mm(axis) + 0.0,
                          g.high_mm(axis) + 0.0);
  return fmt::format(
      "{} Stiffness of the tool point of {} along a force on it, 1/C_ii in N/mm with rotations free, {}, under {}; "
      "base "
      "axes; positive where the tool point yields along the force. {} × {} × {} poses ({} mm; {}), {} of them in "
      "reach; {}. "
      "Computed, no measurements and no noise.",
      what, map.device, kind_text(map), report::map_load_text(map), g.counts[0], g.counts[1], g.counts[2], ranges,
      tilt_text(map), reached, theory_text(map));
}

}  // namespace deflect::figures
