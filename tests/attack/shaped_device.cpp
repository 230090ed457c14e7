#include "tests/attack/shaped_device.h"

#include <cmath>
#include <stdexcept>

#include "analytic/model.h"
#include "msa/base/index.h"
#include "tests/attack/random_frame.h"

namespace deflect::attack {
namespace {

/// 1 N/m or 1 Nm/rad in a machine of this unit, as random_device() draws them.
double stiffness(std::size_t freedom, double unit, Dice& dice) {
  return 1e7 * unit * dice.power_of_ten(-1.5, 1.5) * (freedom < 3 ? 1 : 0.03 * unit * unit);
}

Matrix6 six_together(double unit, Dice& dice) {
  Matrix6 A;
  for (Eigen::Index i = 0; i < 36; ++i) A(i) = dice.real(-1, 1);
  Vector6 size;
  for (Eigen::Index i = 0; i < 6; ++i) size(i) = std::sqrt(stiffness(as_size(i), unit, dice));
  const Matrix6 K = size.asDiagonal() * (A * A.transpose() + Matrix6::Identity()) * size.asDiagonal();
  return (K + K.transpose()) / 2;
}

/// Of base or tool.
void yield(Joint& joint, double unit, Dice& dice) {
  if (dice.chance(0.4)) {
    joint.stiffness = six_together(unit, dice);
    return;
  }
  for (std::size_t i = 0; i < 6; ++i)
    if (dice.chance(0.5)) joint.laws[i] = {LinearLaw{stiffness(i, unit, dice)}};
}

void couple(Named<Part>& parts, double unit, Dice& dice) {
  for (auto& [name, part] : parts) {
    if (auto* group = std::get_if<Parallel>(&part))
      for (Mount& mount : group->mounts) couple(mount.leg, unit, dice);
    auto* joint = std::get_if<Joint>(&part);
    const bool held = joint && (joint->type == "fixed" || joint->type == "motor" || joint->type == "prismatic");
    if (!held || joint->stiffness || !dice.chance(0.25)) continue;
    joint->laws = {};
    joint->stiffness = six_together(unit, dice);
  }
}

/// δ(f) through three points, each piece softer than the one before; the first as stiff as the spring was.
TableLaw softening(double k, double level, Dice& dice) {
  TableLaw out;
  double f = 0, delta = 0;
  out.points.push_back({f, delta});
  for (int i = 0; i < 3; ++i) {
    const double more = level * dice.power_of_ten(-1.5, 0);
    f += more, delta += more / k;
    k /= dice.real(1.2, 3);
    out.points.push_back({f, delta});
  }
  return out;
}

void soften(Named<Part>& parts, double force, double unit, Dice& dice) {
  for (auto& [name, part] : parts) {
    if (auto* group = std::get_if<Parallel>(&part))
      for (Mount& mount : group->mounts) soften(mount.leg, force, unit, dice);
    auto* joint = std::get_if<Joint>(&part);
    if (!joint) continue;
    for (std::size_t i = 0; i < 6; ++i) {
      std::vector<Law>& laws = joint->laws[i];
      if (laws.size() != 1 || !std::holds_alternative<LinearLaw>(laws[0]) || !dice.chance(0.3)) continue;
      laws = {softening(std::get<LinearLaw>(laws[0]).stiffness, i < 3 ? force : force * unit, dice)};
    }
  }
}

/// Away from home by a tenth of the unit or of a rad at most, where the loops close there.
void pose(ShapedDevice& out, Dice& dice) {
  const std::vector<Actuator> drives = actuators_of(out.random.mechanism);
  if (drives.empty() || !dice.chance(0.5)) return;
  VectorX q(std::ssize(drives));
  for (Eigen::Index i = 0; i < q.size(); ++i)
    q(i) = nth(drives, i).value + dice.real(-0.1, 0.1) * (nth(drives, i).rotation ? 1 : out.random.unit);
  try {
    const Configuration c = configure_joints(out.random.mechanism, q);
    out.at = {mm_deg_from(c.pose), c};
    out.posed = q;
  } catch (const std::runtime_error&) {  // it stays at home
  }
}

/// [δ; size · θ] of T in linear geometry, over the size; 0 where there is none.
double moved(const Configuration& c, const Vector6& F) {
  try {
    const analytic::AnalyticSolution s = analytic::AnalyticModel(c).solve(F);
    return s.converged ? std::hypot(s.displacement.head<3>().norm() / c.size, s.displacement.tail<3>().norm()) : 0;
  } catch (const std::runtime_error&) {
    return 0;
  }
}

}  // namespace

std::optional<ShapedDevice> shaped_device(unsigned seed, bool laws) {
  ShapedDevice out;
  RandomDevice& random = out.random = random_device(seed);
  Mechanism& m = random.mechanism;
  Dice dice(seed + 0xDEF0000000ull);
  const double unit = random.unit;
  for (Mount& mount : m.mounts) couple(mount.leg, unit, dice);
  if (dice.chance(0.3)) yield(m.base, unit, dice);
  if (dice.chance(0.2)) yield(m.tool, unit, dice);
  if (dice.chance(0.3)) {  // a force beside T
    const Vector3 beside = unit * dice.reals(-1, 1);
    random.load.tail<3>() = beside.cross(Vector3(random.load.head<3>()));
  }
  const double weighs = dice.chance(0.25) ? dice.real(0.1, 1) : 0;
  try {
    out.at = stand(m, mm_deg_from(home_pose(m)));
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
  pose(out, dice);
  const double linear = moved(out.at.configuration, random.load);
  if (!(linear > 0 && std::isfinite(linear))) return std::nullopt;
  out.share = dice.power_of_ten(-4, -1.5);
  random.load *= out.share / linear;
  m.payload = weighs * random.load.head<3>().norm() / 9.80665;
  if (laws) {
    random = with_nonlinear_laws(random);
    const double force = std::max(random.load.head<3>().norm(), random.load.tail<3>().norm() / unit);
    for (Mount& mount : random.mechanism.mounts) soften(mount.leg, force, unit, dice);
  }
  const Configuration c = out.posed.size() > 0 ? configure_joints(random.mechanism, out.posed)
                                               : configure(random.mechanism, home_pose(random.mechanism));
  out.at = {mm_deg_from(c.pose), c};
  return out;
}

}  // namespace deflect::attack
