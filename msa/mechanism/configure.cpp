#include <fmt/format.h>

#include <cmath>
#include <map>

#include "msa/base/error.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/six_psu.h"

namespace deflect {
namespace {

/// The named points and axes of one leg at one pose, and what its laws take from the pose.
struct LegFrames {
  std::map<std::string, Vector3> points;
  std::map<std::string, Matrix3> axes;
  Vector3 reference;  ///< members' local y lies in the plane of their axis and this direction
  double actuator = 0;
};

/// The direction itself, or the vertical where the direction is too close to the axis to define a plane.
Vector3 transverse(const Vector3& axis, const Vector3& direction) {
  return std::abs(axis.normalized().dot(direction)) < 0.999 ? direction : Vector3::UnitZ();
}

/// Right-handed axes with the given z, x in the plane of z and `reference`.
Matrix3 axes_along_z(const Vector3& z, const Vector3& reference) {
  const Matrix3 R = axes_along_x(z, reference);  // columns z, x, y of the axes wanted
  Matrix3 turned;
  turned << R.col(1), R.col(2), R.col(0);
  return turned;
}

LegFrames frames(const SixPsu& k, int leg, const Pose& pose) {
  const SixPsuLeg g = leg_at(k, leg, pose);
  const Vector3 along = g.p_WC - g.p_WB;
  return {{{"A", g.p_WA}, {"B", g.p_WB}, {"C", g.p_WC}},
          {{"base", Matrix3::Identity()},
           {"guide", axes_along_z(Vector3::UnitZ(), g.radial)},
           {"link", axes_along_z(along, transverse(along, g.radial))},
           {"platform", pose.R_WT}},
          g.radial,
          g.slider};
}

template <class T>
const T& look_up(const Named<T>& list, const std::string& name, const char* what) {
  if (const T* found = find(list, name)) return *found;
  throw InputError(fmt::format("there is no {} '{}'", what, name));
}

template <class T>
const T& look_up(const std::map<std::string, T>& list, const std::string& name, const char* what) {
  if (const auto found = list.find(name); found != list.end()) return found->second;
  throw InputError(fmt::format("there is no {} '{}'", what, name));
}

Law resolved(Law law, const Mechanism& m, double actuator) {
  std::visit(
      [&](auto& l) {
        if constexpr (requires { l.solid; }) l.solid = look_up(m.materials, l.material, "material");
        if constexpr (std::is_same_v<std::decay_t<decltype(l)>, CableLaw>)
          if (!l.length) l.length = actuator;
      },
      law);
  return law;
}

PlacedJoint placed(const Joint& joint, const std::string& part, const Vector3& p, const Matrix3& R, const Mechanism& m,
                   double actuator) {
  const JointType* type = find_joint_type(joint.type);
  if (!type) throw InputError(fmt::format("{}: there is no joint type '{}'", part, joint.type));
  PlacedJoint j{part, p, R, freedoms_of(*type), {}};
  for (std::size_t i = 0; i < 6; ++i)
    for (const Law& law : joint.laws[i]) j.laws[i].push_back(resolved(law, m, actuator));
  return j;
}

PlacedMember placed(const Member& member, const std::string& part, const LegFrames& f, const Mechanism& m) {
  const Material& material = look_up(m.materials, member.material, "material");
  PlacedMember out;
  out.part = part;
  out.p_W_start = look_up(f.points, member.from, "point");
  out.p_W_end = look_up(f.points, member.to, "point");
  const Vector3 along = out.p_W_end - out.p_W_start;
  if (!(along.norm() > 1e-9)) throw ModelError(fmt::format("{}: the member has no length", part));
  out.R_WM = axes_along_x(along, transverse(along, f.reference));
  out.section = properties(look_up(m.sections, member.section, "section"), material.poisson());
  out.section.Iy *= member.bending_factor;
  out.section.Iz *= member.bending_factor;
  out.E = material.E;
  out.G = material.shear_modulus();
  out.beam = member.beam;
  return out;
}

PlacedPart placed(const Part& part, const std::string& name, const LegFrames& f, const Mechanism& m) {
  if (const auto* member = std::get_if<Member>(&part)) return placed(*member, name, f, m);
  const Joint& joint = std::get<Joint>(part);
  return placed(joint, name, look_up(f.points, joint.at, "point"), look_up(f.axes, joint.axes, "set of axes"), m,
                f.actuator);
}

PlacedLeg placed_leg(const Mechanism& m, const Named<Part>& parts, int leg, const Pose& pose) {
  const LegFrames f = std::visit([&](const auto& k) { return frames(k, leg, pose); }, m.kinematics);
  PlacedLeg out{fmt::format("leg {}", leg), {}, f.actuator};
  for (const auto& [name, part] : parts) try {
      out.parts.push_back(placed(part, name, f, m));
    } catch (const InputError& e) {
      throw InputError(fmt::format("{}: leg.{}: {}", m.name, name, e.what()));
    } catch (const ModelError& e) {
      throw ModelError(fmt::format("leg {}: {}", leg, e.what()));
    }
  return out;
}

}  // namespace

Configuration configure(const Mechanism& m, const Pose& pose) try {
  Configuration c;
  c.pose = pose;
  c.base = placed(m.base, "base", Vector3::Zero(), Matrix3::Identity(), m, 0);
  c.tool = placed(m.tool, "tool", pose.p_WT, pose.R_WT, m, 0);
  for (int leg = 1; leg <= 6; ++leg)
    c.legs.push_back(placed_leg(m, m.variations.empty() ? m.leg : leg_parts(m, leg), leg, pose));
  return c;
} catch (const ModelError& e) {
  const Vector3 p = 1e3 * pose.p_WT, a = rpy_from_rotation(pose.R_WT) * 180 / pi;
  throw ModelError(fmt::format("{} at ({:.6g}, {:.6g}, {:.6g}) mm, ({:.6g}, {:.6g}, {:.6g}) deg: {}", m.name, p.x(),
                               p.y(), p.z(), a.x(), a.y(), a.z(), e.what()));
}

}  // namespace deflect
