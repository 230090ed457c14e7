#include "validation/prediction/instruments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "msa/base/error.h"
#include "msa/base/index.h"

namespace deflect::prediction {
namespace {

template <class T>
const T* named(const Named<T>& all, const std::string& name, const char* what, const Mechanism& m,
               const measurement::Measurements& data) {
  for (const auto& [known, each] : all)
    if (known == name) return &each;
  std::vector<std::string> there;
  for (const auto& [known, each] : all) there.push_back(known);
  throw InputError(fmt::format("{}: {} has no {} '{}'; {}", data.origin, m.name, what, name,
                               there.empty() ? fmt::format("the device file names none: say where it is, under {}",
                                                           std::string(what) == "sensor" ? "sensors" : "loads")
                                             : fmt::format("there is {}", fmt::join(there, ", "))));
}

bool on_the_platform(const std::string& body) { return body == "platform"; }

Configuration with_rigid_tool(Configuration c) {
  PlacedJoint rigid;
  rigid.part = c.tool.part;
  rigid.p_W = c.tool.p_W;
  rigid.R_WJ = c.tool.R_WJ;
  c.tool = std::move(rigid);
  return c;
}

/// Whether some part of it yields, base and tool included.
bool yields(const Configuration& c) {
  bool any = !c.base.rigid() || !c.tool.rigid();
  for_each_part(c.legs, [&](const auto& part) {
    if constexpr (requires { part.section; })
      any = true;
    else
      for (std::size_t i = 0; i < 6; ++i) any = any || part.elastic(i);
  });
  return any;
}

bool has_friction(const PlacedJoint& joint) {
  return std::any_of(joint.laws.begin(), joint.laws.end(), [](const std::vector<Law>& laws) {
    return std::any_of(laws.begin(), laws.end(), deflect::has_history);
  });
}

}  // namespace

Instruments::Instruments(const Mechanism& m, const measurement::Measurements& data) {
  for (const measurement::SensorChannel& s : data.instruments.sensors)
    sensors_.push_back(named(m.sensors, s.name, "sensor", m, data));
  for (const PointSensor* s : sensors_) parts_.push_back(inside_part(m, *s));
  for (const std::string& name : data.instruments.load_points)
    points_.push_back(named(m.loads, name, "point of load", m, data));
}

std::vector<Inside> Instruments::inside(const Configuration& c) const {
  std::vector<Inside> out;
  for (const std::optional<NamedPart>& part : parts_)
    if (part) out.push_back(placed(*part, c));
  return out;
}

bool Instruments::on_platform() const {
  const auto there = [](const auto* each) { return on_the_platform(each->body); };
  return std::any_of(sensors_.begin(), sensors_.end(), there) || std::any_of(points_.begin(), points_.end(), there);
}

Vector6 Instruments::form(const Configuration& c, std::size_t k) const {
  const PointSensor& s = *sensors_.at(k);
  Vector6 out = Vector6::Zero();
  if (parts_[k]) return out;
  if (s.rotation) {
    out.tail<3>() = s.axis;
  } else {
    const Vector3 arm = c.pose.R_WT * s.point;
    out << s.axis, arm.cross(s.axis);
  }
  return s.gain * out;
}

VectorX Instruments::readings(const Configuration& c, const Motion& motion, Geometry geometry) const {
  VectorX out(std::ssize(sensors_));
  std::size_t next = 0;
  for (std::size_t k = 0; k < sensors_.size(); ++k) {
    const PointSensor& s = *sensors_[k];
    if (!s.drive.empty()) {
      out(as_index(k)) = s.gain * motion.inside.at(next++)(0) + s.zero;
      continue;
    }
    const Vector6& d = parts_[k] ? motion.inside.at(next++) : on_the_platform(s.body) ? motion.platform : motion.tool;
    const Vector3 theta = d.tail<3>();
    Vector3 arm = c.pose.R_WT * s.point;
    if (parts_[k]) {
      const PartEnd end = end_of(placed(*parts_[k], c), c);
      arm = end.p_W + end.R_W * s.point - c.pose.p_WT;
    }
    double reading = s.rotation ? s.axis.dot(theta) : s.axis.dot(d.head<3>() + theta.cross(arm));
    if (geometry == Geometry::finite && !s.rotation)
      reading += s.axis.dot(rotation_from_vector(theta) * arm - arm - theta.cross(arm));
    out(as_index(k)) = s.gain * reading + s.zero;
  }
  return out;
}

LoadedMachine::LoadedMachine(const theories::Theory& theory, const theories::TheoryOptions& o, const Configuration& c,
                             const Instruments& instruments, const TrueLoads& loads)
    : loads_(loads) {
  theories::TheoryOptions asked = o;
  asked.inside = instruments.inside(c);
  machine_ = theory.at(c, asked);
  if (c.tool.rigid() || !instruments.on_platform()) return;
  if (has_friction(c.tool))
    throw InputError(
        fmt::format("{}: the tool joint has friction, and a sensor or a load is on the platform: say "
                    "'body: tool', or leave the friction out",
                    o.device));
  rigid_tool_ = with_rigid_tool(c);
  if (yields(*rigid_tool_)) locked_ = theory.at(*rigid_tool_, asked);
}

/// In the deformed shape loads at points move with the machine, whose motion they cause: the moments are found anew
/// until the rotation stays. Each round leaves the share k = |r × f| / (stiffness about T) of the error, far below 1
/// where the machine stands.
theories::Prediction LoadedMachine::predict(theories::TheoryAt& machine, const measurement::Reading& r,
                                            const Conditions& conditions) {
  const Vector6 F = loads_.at_T(r);
  theories::Prediction found = machine.predict(F, conditions);
  if (!loads_.any_turns() || conditions.geometry != Geometry::finite) return found;
  for (int round = 0; round < 50 && found.converged; ++round) {
    const Vector3 theta = found.displacement.tail<3>();
    found = machine.predict(F + loads_.turned(r, rotation_from_vector(theta)), conditions);
    if ((found.displacement.tail<3>() - theta).norm() <= 1e-13 + 1e-10 * theta.norm()) return found;
  }
  if (found.converged) found.reason = "the moments of loads that move with the machine do not settle";
  found.converged = false;
  return found;
}

Motion LoadedMachine::move(const measurement::Reading& r, const Conditions& conditions) {
  theories::Prediction moved{Vector6::Zero(), true};  // a platform that is held rigidly
  if (locked_ || !rigid_tool_) moved = predict(locked_ ? *locked_ : *machine_, r, conditions);
  Motion out{moved.displacement,      moved.displacement,      moved.converged,          std::move(moved.slips),
             std::move(moved.reason), std::move(moved.inside), std::move(moved.floating)};
  if (!rigid_tool_) return out;
  Conditions undeformed = conditions;
  if (loads_.any_turns()) undeformed = Conditions(Geometry::linear);
  const Vector6 F = loads_.through_tool(r);
  const theories::Prediction whole = machine_->predict(F, undeformed);
  if (!locked_ && !whole.inside.empty()) out.inside = machine_->predict(loads_.at_T(r), undeformed).inside;
  const theories::Prediction rigid =
      locked_ ? locked_->predict(F, undeformed) : theories::Prediction{Vector6::Zero(), true};
  out.tool += whole.displacement - rigid.displacement;
  out.floating.insert(out.floating.end(), whole.floating.begin(), whole.floating.end());
  if (!whole.converged || !rigid.converged) out.converged = false, out.reason = whole.reason + rigid.reason;
  return out;
}

}  // namespace deflect::prediction
