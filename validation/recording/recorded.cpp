#include "validation/recording/recorded.h"
#include "msa/base/index.h"

#include <cmath>

namespace deflect::recording {

Vector6 Rewritten::of(const Vector6& x) const {
  Vector6 out;
  for (std::size_t k = 0; k < 6; ++k) out(as_index(k)) = factor[k] * x(as_index(from[k]));
  return out;
}

measurement::Measurements corrected(const measurement::Measurements& data, const Correction& c) {
  measurement::Measurements out = data;
  for (measurement::Reading& r : out.readings) {
    for (std::size_t k = 0; k < 6; ++k) {
      const std::optional<double>& recorded =
          nth(data.readings, &r - out.readings.data()).displacement[c.displacement.from[k]];
      r.displacement[k] = recorded ? std::optional(c.displacement.factor[k] * *recorded) : std::nullopt;
    }
    if (c.sigma_too && r.sigma_u) *r.sigma_u *= std::abs(c.displacement.factor[0]);
    if (c.sigma_too && r.sigma_th) *r.sigma_th *= std::abs(c.displacement.factor[3]);
    for (Vector6* load : {&r.load, &r.on_platform, &r.at_tool}) *load = c.load.of(*load);
    for (Vector6& load : r.at_points) load = c.load.of(load);
    const Vector3 moment = c.acts_at.cross(Vector3((r.at_points.empty() ? r.load : r.at_tool).head<3>()));
    r.load.tail<3>() += moment;
    r.at_tool.tail<3>() += moment;
  }
  if (c.pose)
    for (measurement::PoseGroup& group : out.poses) c.pose(group);
  if (c.readings) c.readings(out);
  return out;
}

}  // namespace deflect::recording
