#include "validation/python/mechanism.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/units.h"
#include "validation/python/bindings.h"

namespace deflect::python {
namespace {

Stand stand_at_joints(const Mechanism& m, const std::vector<double>& joints, double slides_per_m) {
  const std::vector<Actuator> actuators = actuators_of(m);
  if (joints.size() != actuators.size())
    throw InputError(
        fmt::format("joints: {} coordinates, but {} has {} actuators", joints.size(), m.name, actuators.size()));
  VectorX q(std::ssize(joints));
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!std::isfinite(joints[i])) throw InputError(fmt::format("joints: {} is no finite number", joints[i]));
    q(as_index(i)) = actuators[i].rotation ? joints[i] : joints[i] / slides_per_m;
    if (actuators[i].rotation) require_digits_of_angle(joints[i], fmt::format("{:g} rad", joints[i]));
  }
  Configuration c = configure_joints(m, q);
  const Vector6 reached = mm_deg_from(c.pose);
  return {reached, std::move(c)};
}

}  // namespace

const Mechanism& machine_of(const subject::Subject& s) {
  if (!s.machine())
    throw InputError(s.name() + " is a frame, not a machine: it has no poses; solve() gives its answers");
  return *s.machine();
}

Stand stand_of(const Mechanism& m, const Asked& at) {
  if (!at.pose.empty() && !at.joints.empty()) throw InputError("give either pose or joints");
  if (!at.joints.empty()) return stand_at_joints(m, at.joints, at.slides_per_m);
  if (at.pose.empty()) return stand(m, mm_deg_from(home_pose(m)));
  const Vector6 pose = six("pose", at.pose);
  for (const double deg : pose.tail<3>()) require_digits_of_angle(deg * pi / 180, fmt::format("{:g} deg", deg));
  return stand(m, pose);
}

Geometry geometry_of(const std::string& text) {
  for (std::size_t i = 0; i < std::size(geometry_names); ++i)
    if (text == geometry_names[i]) return static_cast<Geometry>(i);
  throw InputError(fmt::format("geometry '{}': write {}", text, fmt::join(geometry_names, ", ")));
}

}  // namespace deflect::python
