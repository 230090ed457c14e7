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
    r.load = c.load.of(r.load);
    r.on_platform = c.load.of(r.on_platform);
    r.load.tail<3>() += c.acts_at.cross(Vector3(r.load.head<3>()));
  }
  if (c.pose)
    for (measurement::PoseGroup& group : out.poses) c.pose(group);
  if (c.readings) c.readings(out);
  return out;
}

}  // namespace deflect::recording
