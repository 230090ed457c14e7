#include "tests/attack/random_device.h"

#include <fmt/format.h>

#include <cmath>

#include "msa/mechanism/walk.h"
#include "tests/attack/random_frame.h"

namespace deflect::attack {
namespace {

class DeviceDice {
 public:
  explicit DeviceDice(unsigned seed) : dice_(seed + 0x5EED00000000ull) {
    out_.seed = seed;
    out_.kind = static_cast<DeviceKind>(seed % std::size(device_kind_names));
    aligned_ = out_.kind == DeviceKind::aligned;
    unit_ = out_.unit = dice_.chance(0.3) ? 1 : dice_.power_of_ten(-3, 2.5);
  }

  RandomDevice roll() {
    m().name = fmt::format("{} {}", device_kind_names[static_cast<int>(out_.kind)], out_.seed);
    m().workspace.shape = CubeSpace{0.01 * unit_};
    materials();
    const Placement home{place(), aligned_ ? Vector3::Zero().eval() : turn()};
    m().kinematics = Chains{home, {}};
    const int legs = out_.kind == DeviceKind::serial || out_.kind == DeviceKind::nested ? 1 : dice_.whole(1, 6);
    for (int i = 0; i < legs; ++i) {
      Mount mount;
      mount.base = {place(), turn()};
      mount.leg = parts(legs == 1 ? dice_.whole(2, 7) : dice_.whole(1, 6), legs == 1 ? 0.04 : legs < 4 ? 0.35 : 0.5);
      if (out_.kind == DeviceKind::nested) {
        auto inner = group();
        mount.leg.insert(mount.leg.begin() + dice_.whole(0, 1), {"group", std::move(inner)});
      }
      if (i > 0 && dice_.chance(0.3)) mount.leg = m().mounts.front().leg;  // like the first
      close(mount, frame_of(home));
      m().mounts.push_back(mount);
    }
    if (legs > 1 && dice_.chance(0.15)) misfit(legs);
    for (Eigen::Index i = 0; i < 6; ++i)
      out_.load(i) = dice_.chance(0.7) ? dice_.real(-100, 100) * (i < 3 ? unit_ * unit_ : unit_ * unit_ * unit_) : 0;
    if (out_.load.isZero(0)) out_.load(2) = 100 * unit_ * unit_;
    return out_;
  }

 private:
  Mechanism& m() { return out_.mechanism; }

  void materials() {
    const bool extreme = out_.kind == DeviceKind::stiff_and_soft;
    m().materials = {{"hard", {210e9, 0.3, {}}},
                     {"soft", {extreme ? 210e9 * dice_.power_of_ten(-12, 0) : 70e9, 0.33, {}}}};
    const double d = unit_ * dice_.real(0.02, 0.15);
    m().sections = {{"round", {RoundSection{d}}},
                    {"tube", {TubeSection{d, 0.8 * d}}},
                    {"flat", {RectangleSection{d, d * dice_.power_of_ten(-1, 0)}}}};
  }

  Vector3 place() {
    if (aligned_) return unit_ * 0.25 * dice_.wholes(-2, 2);
    return unit_ * dice_.reals(-1, 1);
  }

  Vector3 turn() {
    const double z = aligned_ ? dice_.whole(0, 2) : dice_.real(-3, 3);
    const double y = aligned_ ? 0 : dice_.real(-1.4, 1.4), x = aligned_ ? dice_.whole(0, 2) : dice_.real(-3, 3);
    return (aligned_ ? pi / 2 : 1) * Vector3(x, y, z);
  }

  Vector3 direction() {
    if (aligned_) return Vector3::Unit(dice_.whole(0, 2));
    return dice_.reals(-1, 1).normalized();
  }

  /// Of a member: N/m, or Nm/rad on a rotation, and around it.
  double stiffness(std::size_t freedom) {
    const double span = out_.kind == DeviceKind::stiff_and_soft ? 6 : 1.5;
    return 1e7 * unit_ * dice_.power_of_ten(-span, span) * (freedom < 3 ? 1 : 0.03 * unit_ * unit_);
  }

  /// Of the joints the share `passive` is of types that move freely. Nine in ten have a member, so that something
  /// yields.
  Named<Part> parts(int count, double passive) {
    Named<Part> out;
    const int member_at = dice_.chance(0.9) ? dice_.whole(0, count - 1) : -1;
    for (int i = 0; i < count; ++i) {
      const double which = i == member_at ? 0 : dice_.real(0, 1);
      out.emplace_back(fmt::format("p{}", i + 1), which < 0.25 ? member() : which < 0.4 ? offset() : joint(passive));
    }
    return out;
  }

  Part member() {
    Member out;
    out.section = m().sections[static_cast<std::size_t>(dice_.whole(0, 2))].first;
    out.material = m().materials[dice_.chance(0.7) ? 0 : 1].first;
    out.beam = static_cast<BeamTheory>(dice_.whole(0, 1));
    do out.along = place();
    while (out.along->norm() < 0.1 * unit_);
    if (dice_.chance(0.2)) out.bending_factor = dice_.real(0.3, 1);
    return out;
  }

  Part offset() {
    Offset out;
    out.shift = place(), out.turn = turn();
    return out;
  }

  Part joint(double passive) {
    static constexpr const char* free[] = {"revolute",  "slider", "cylindrical",   "universal",
                                           "universal", "ball",   "parallelogram", "custom"};
    static constexpr const char* held[] = {"motor", "prismatic", "fixed", "custom"};
    Joint out;
    const bool moves = dice_.chance(passive);
    out.type = moves ? free[dice_.bits() % 8] : held[dice_.bits() % 4];
    if (out.type == "custom")
      for (int i = 0; i < 6; ++i) out.freedoms += (moves ? "rrrfa" : "rrra")[dice_.bits() % (moves ? 5 : 4)];
    out.axis = direction();
    out.axes = dice_.chance(0.5) ? "before" : "after";
    if (out.type == "parallelogram") out.bar = 0.3 * unit_ * direction().cross(Vector3(0.3, 0.5, 0.7));
    const std::array<Freedom, 6> freedoms = freedoms_of(out.type == "custom" ? out.freedoms : letters(out.type));
    if (out.type == "fixed" && dice_.chance(0.4)) {
      out.stiffness = coupled();
      return out;
    }
    const bool yields = out.type == "fixed";
    for (std::size_t i = 0; i < 6; ++i) {
      const double p = freedoms[i] == Freedom::actuated ? 0.9
                       : yields                         ? 0.7
                       : freedoms[i] == Freedom::free   ? 0.05
                                                        : 0.12;
      if (dice_.chance(p)) out.laws[i] = {LinearLaw{stiffness(i)}};
      if (movable(freedoms[i]) && !aligned_ && out.type != "parallelogram")
        out.home[i] = i < 3 ? dice_.real(-0.2, 0.2) * unit_ : dice_.real(-0.8, 0.8);
    }
    return out;
  }

  static std::string letters(const std::string& type) { return find_joint_type(type)->letters; }

  Matrix6 coupled() {
    Matrix6 A;
    for (Eigen::Index i = 0; i < 36; ++i) A(i) = dice_.real(-1, 1);
    Vector6 size;
    for (Eigen::Index i = 0; i < 6; ++i) size(i) = std::sqrt(stiffness(static_cast<std::size_t>(i)));
    const Matrix6 K = size.asDiagonal() * (A * A.transpose() + Matrix6::Identity()) * size.asDiagonal();
    return (K + K.transpose()) / 2;
  }

  /// Two or three branches that leave from one frame and meet in another.
  Part group() {
    Parallel out;
    const Frame end = frame_of({place(), turn()});
    for (int i = dice_.whole(2, 3); i > 0; --i) {
      Mount mount;
      mount.base = {0.5 * place(), turn()};
      mount.leg = parts(dice_.whole(1, 4), 0.35);
      close(mount, end);
      out.mounts.push_back(mount);
    }
    return out;
  }

  /// Puts the mount on the platform where the walk ends while the platform stands at `target`.
  static void close(Mount& mount, const Frame& target) {
    mount.platform = {};
    const LegParts leg{mount, mount.leg};
    const Frame seat = target.inverse() * walk(one(leg), home_states(one(leg))).legs[0].end;
    mount.platform = {seat.p, rpy_from_rotation(seat.R)};
  }

  void misfit(int legs) {
    Misfit out;
    out.leg = dice_.whole(1, legs);
    out.platform.shift = 1e-4 * place();
    m().misfits.push_back(out);
  }

  Dice dice_;
  RandomDevice out_;
  bool aligned_ = false;
  double unit_ = 1;
};

void scale(Placement& p, double s) { p.shift *= s; }

void scale(Named<Part>& parts, double s);

void scale(std::vector<Mount>& mounts, double s) {
  for (Mount& mount : mounts) {
    scale(mount.base, s), scale(mount.platform, s);
    scale(mount.leg, s);
  }
}

void scale(Joint& j, double s) {
  j.bar *= s;
  for (std::size_t i = 0; i < 3; ++i) j.home[i] *= s;
  for (std::size_t i = 0; i < 6; ++i)
    for (Law& law : j.laws[i])
      if (auto* linear = std::get_if<LinearLaw>(&law)) linear->stiffness *= i < 3 ? s : s * s * s;
  if (!j.stiffness) return;
  Vector6 w = Vector6::Constant(std::sqrt(s));
  w.tail<3>() *= s;
  j.stiffness = w.asDiagonal() * *j.stiffness * w.asDiagonal();
}

void scale(Named<Part>& parts, double s) {
  for (auto& [name, part] : parts) {
    if (auto* joint = std::get_if<Joint>(&part)) scale(*joint, s);
    if (auto* member = std::get_if<Member>(&part)) *member->along *= s;
    if (auto* offset = std::get_if<Offset>(&part)) offset->shift *= s;
    if (auto* group = std::get_if<Parallel>(&part)) scale(group->mounts, s);
  }
}

void scale(Section& section, double s) {
  if (auto* round = std::get_if<RoundSection>(&section.shape)) round->diameter *= s;
  if (auto* tube = std::get_if<TubeSection>(&section.shape)) tube->outer_diameter *= s, tube->inner_diameter *= s;
  if (auto* flat = std::get_if<RectangleSection>(&section.shape)) flat->width_y *= s, flat->height_z *= s;
}

void harden(Named<Part>& parts, double c) {
  for (auto& [name, part] : parts) {
    if (auto* joint = std::get_if<Joint>(&part)) {
      for (auto& laws : joint->laws)
        for (Law& law : laws)
          if (auto* linear = std::get_if<LinearLaw>(&law)) linear->stiffness *= c;
      if (joint->stiffness) *joint->stiffness *= c;
    }
    if (auto* group = std::get_if<Parallel>(&part))
      for (Mount& mount : group->mounts) harden(mount.leg, c);
  }
}

/// `level`: the force or moment to be expected; k: the linear stiffness.
std::vector<Law> nonlinear(double k, double level, Dice& dice) {
  const double deflection = level / k;
  switch (dice.whole(0, 4)) {
    case 0:
      return {PowerLaw{deflection, level, dice.real(0.3, 1)}};
    case 1:
      return {HardeningLaw{k, deflection * dice.power_of_ten(-1, 1)}};
    case 2:
      return {OneSidedLaw{1 / k, dice.chance(0.5) ? std::optional(dice.real(0, 1) / k) : std::nullopt}};
    case 3:
      return {LinearLaw{k}, ClearanceLaw{deflection * dice.power_of_ten(-2, 2)}};
    default:
      return {LinearLaw{k}, FrictionLaw{level * dice.power_of_ten(0, 2), k}};
  }
}

void make_nonlinear(Named<Part>& parts, double force, double unit, Dice& dice) {
  for (auto& [name, part] : parts) {
    if (auto* group = std::get_if<Parallel>(&part))
      for (Mount& mount : group->mounts) make_nonlinear(mount.leg, force, unit, dice);
    auto* joint = std::get_if<Joint>(&part);
    if (!joint) continue;
    for (std::size_t i = 0; i < 6; ++i)
      if (!joint->laws[i].empty() && dice.chance(0.5))
        joint->laws[i] =
            nonlinear(std::get<LinearLaw>(joint->laws[i][0]).stiffness, i < 3 ? force : force * unit, dice);
  }
}

}  // namespace

RandomDevice random_device(unsigned seed) { return DeviceDice(seed).roll(); }

RandomDevice with_nonlinear_laws(RandomDevice d) {
  Dice dice(d.seed + 99);
  const double force = std::max(d.load.head<3>().norm(), d.load.tail<3>().norm() / d.unit);
  for (Mount& mount : d.mechanism.mounts) make_nonlinear(mount.leg, force, d.unit, dice);
  return d;
}

RandomDevice scaled(RandomDevice d, double s) {
  Mechanism& m = d.mechanism;
  scale(*std::get<Chains>(m.kinematics).home, s);
  scale(m.mounts, s);
  for (auto& [name, section] : m.sections) scale(section, s);
  for (Misfit& misfit : m.misfits) scale(misfit.base, s), scale(misfit.platform, s);
  std::get<CubeSpace>(m.workspace.shape).edge *= s;
  d.load.head<3>() *= s * s, d.load.tail<3>() *= s * s * s;
  d.unit *= s;
  return d;
}

RandomDevice in_force_unit(RandomDevice d, double c) {
  for (auto& [name, material] : d.mechanism.materials) material.E *= c;
  for (Mount& mount : d.mechanism.mounts) harden(mount.leg, c);
  d.load *= c;
  return d;
}

RandomDevice reordered(RandomDevice d) {
  std::reverse(d.mechanism.mounts.begin(), d.mechanism.mounts.end());
  const auto legs = static_cast<int>(d.mechanism.mounts.size());
  for (Misfit& misfit : d.mechanism.misfits) misfit.leg = legs + 1 - misfit.leg;
  return d;
}

RandomDevice turned(RandomDevice d, const Matrix3& R) {
  const Frame turn{Vector3::Zero(), R};
  const auto turn_placement = [&](Placement& p) {
    const Frame f = turn * frame_of(p);
    p = {f.p, rpy_from_rotation(f.R)};
  };
  turn_placement(*std::get<Chains>(d.mechanism.kinematics).home);
  for (Mount& mount : d.mechanism.mounts) turn_placement(mount.base);
  for (Misfit& misfit : d.mechanism.misfits) misfit.base.shift = R * misfit.base.shift;
  d.load << R * d.load.head<3>(), R * d.load.tail<3>();
  return d;
}

}  // namespace deflect::attack
