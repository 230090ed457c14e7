#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/family.h"
#include "msa/mechanism/law.h"
#include "msa/mechanism/place.h"

namespace deflect {
namespace {

constexpr double standard_gravity = 9.80665;  // m/s², CGPM 1901

/// Distance of the farthest joint or member's end from p.
double extent(const std::vector<PlacedLeg>& legs, const Vector3& p) {
  double square = 0;
  for_each_part(legs, [&](const auto& part) {
    if constexpr (requires { part.p_W; })
      square = std::max(square, (part.p_W - p).squaredNorm());
    else
      square = std::max({square, (part.p_W_start - p).squaredNorm(), (part.p_W_end - p).squaredNorm()});
  });
  return std::sqrt(square);
}

/// How far a rigid body moves at T when its frame at p is displaced as the placement says, in axes R.
Vector6 twist_at(const Vector3& p_WT, const Placement& displaced, const Vector3& p, const Matrix3& R) {
  Vector6 d;
  d << R * displaced.shift, R * displaced.turn;
  return shift_twist(p_WT - p) * d;
}

/// What follows from where the legs stand.
void complete(Configuration& c, const std::vector<Seats>& seats, const Mechanism& m) {
  c.tool.p_W = c.pose.p_WT;
  c.tool.R_WJ = c.pose.R_WT;
  c.size = extent(c.legs, c.pose.p_WT);
  if (!(c.size > 0)) c.size = 1;
  for (const Misfit& misfit : m.misfits) nth(c.legs, misfit.leg - 1).misfit.setZero();
  for (const Misfit& misfit : m.misfits) {
    const auto leg = as_size(misfit.leg - 1);
    const Seats& s = seats.at(leg);
    c.legs[leg].misfit += twist_at(c.pose.p_WT, misfit.base, s.p_W_base, Matrix3::Identity()) -
                          twist_at(c.pose.p_WT, misfit.platform, s.p_W_platform, c.pose.R_WT);
  }
}

/// Takes legs and actuators out of what was placed.
Configuration completed(PlacedMechanism& placed, const Mechanism& m) {
  Configuration c;
  c.pose = placed.pose;
  c.legs = std::move(placed.legs);
  c.actuators = std::move(placed.actuators);
  c.assembly = std::move(placed.assembly);
  c.base = deflect::placed(m.base, "base", {Vector3::Zero(), Matrix3::Identity()}, m);
  c.tool = deflect::placed(m.tool, "tool", {c.pose.p_WT, c.pose.R_WT}, m);
  c.weight = -m.payload * standard_gravity * Vector3::UnitZ();
  complete(c, placed.seats, m);
  return c;
}

std::string at_pose(const Mechanism& m, const Pose& pose) {
  const Vector3 p = 1e3 * pose.p_WT, a = rpy_from_rotation(pose.R_WT) * 180 / pi;
  return fmt::format("{} at ({:.6g}, {:.6g}, {:.6g}) mm, ({:.6g}, {:.6g}, {:.6g}) deg: ", m.name, p.x(), p.y(), p.z(),
                     a.x(), a.y(), a.z());
}

}  // namespace

const PlacedJoint* joint_of(const PlacedPart& part) {
  if (const auto* group = std::get_if<PlacedParallel>(&part))
    return group->one_joint ? std::get_if<PlacedJoint>(&group->branches.front().parts.front()) : nullptr;
  return std::get_if<PlacedJoint>(&part);
}

bool all_linear(const Configuration& c) {
  bool all = true;
  for_each_law(c, [&](const Law& law) { all = all && is_linear(law); });
  return all;
}

bool any_history(const Configuration& c) {
  bool any = false;
  for_each_law(c, [&](const Law& law) { any = any || has_history(law); });
  return any;
}

int number_slips(Configuration& c) {
  int count = 0;
  for_each_law(c, [&](Law& law) {
    if (auto* friction = std::get_if<FrictionLaw>(&law)) friction->number = count++;
    if (auto* table = std::get_if<TableLaw>(&law); table && table->remembers()) {
      table->number = count;
      count += 2;
    }
  });
  return count;
}

int leg_count(const Mechanism& m) {
  if (std::holds_alternative<SixPsu>(m.kinematics)) return 6;
  return std::max(1, static_cast<int>(m.mounts.size()));
}

Configuration configure(const Mechanism& m, const Pose& pose, const Configuration* known) {
  const ChainAssembly* assembly = known ? known->assembly.get() : nullptr;
  return told_at<ModelError>([&] { return at_pose(m, pose); },
                             [&] {
                               PlacedMechanism placed =
                                   std::visit([&](const auto& k) { return place(k, m, pose, assembly); }, m.kinematics);
                               return completed(placed, m);
                             });
}

struct Posing::Impl {
  const Mechanism& mechanism;
  std::optional<SixPsuMoves> moves;
  std::vector<Seats> seats;
  Configuration configuration;
};

Posing::Posing(const Mechanism& m) : impl_(new Impl{m, {}, {}, {}}) {}
Posing::~Posing() = default;

const Configuration& Posing::at(const Pose& pose) {
  const Mechanism& m = impl_->mechanism;
  Configuration& c = impl_->configuration;
  const auto* k = std::get_if<SixPsu>(&m.kinematics);
  if (!k) return c = configure(m, pose);
  told_at<ModelError>([&] { return at_pose(m, pose); },
                      [&] {
                        if (impl_->moves) {
                          impl_->moves->move(*k, pose, c.legs, c.actuators, impl_->seats);
                          c.pose = pose;
                          return complete(c, impl_->seats, m);
                        }
                        PlacedMechanism placed = place(*k, m, pose, nullptr);
                        c = completed(placed, m);
                        impl_->seats = std::move(placed.seats);
                        SixPsuMoves moves(*k, m);
                        if (moves.hold(c.legs)) impl_->moves = std::move(moves);
                      });
  return c;
}

void require_count(const Mechanism& m, Eigen::Index has, const VectorX& given) {
  if (given.size() != has)
    throw InputError(fmt::format("{} has {} joint coordinates, {} are given", m.name, has, given.size()));
}

Configuration configure_joints(const Mechanism& m, const VectorX& q, const Configuration* known) {
  const ChainAssembly* assembly = known ? known->assembly.get() : nullptr;
  const auto at_coordinates = [&] {
    return fmt::format("{} at joint coordinates ({:.6g}) (m, rad): ", m.name,
                       fmt::join(q.data(), q.data() + q.size(), ", "));
  };
  return told_at<ModelError>(at_coordinates, [&] {
    PlacedMechanism placed = std::visit([&](const auto& k) { return place_joints(k, m, q, assembly); }, m.kinematics);
    return completed(placed, m);
  });
}

Pose home_pose(const Mechanism& m) {
  return std::visit([&](const auto& k) { return home_pose(k, m); }, m.kinematics);
}

std::vector<Actuator> actuators_of(const Mechanism& m) {
  return std::visit([&](const auto& k) { return actuators_of(k, m); }, m.kinematics);
}

}  // namespace deflect
