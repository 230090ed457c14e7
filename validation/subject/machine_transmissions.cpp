#include "validation/subject/machine_transmissions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "analytic/model.h"
#include "msa/base/index.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/place.h"
#include "validation/measurement/in_order.h"
#include "validation/prediction/rig.h"

namespace deflect::subject {
namespace {

/// One freedom where it stands: the force f = gᵀF in it under a load F at T, and the displacement g of T when it gives
/// way by one unit (the principle of virtual forces). Of one that is free g is its motion under each unit load, and so
/// the displacement of T by one unit of force that drives it (Maxwell's theorem).
struct Freedom6 {
  std::array<Vector6, 6> g;
  std::array<bool, 6> there{}, free{};
  int leg = 0;  ///< 1-based; 0: in no leg
};
using ByPart = std::multimap<std::string, Freedom6>;

/// Lets every freedom that holds give way by a law, so that it is placed with axes of its own.
void yield_everywhere(Named<Part>& parts) {
  const auto all = [](Joint& joint) {
    const std::array<Freedom, 6> f = freedoms_of(joint);
    for (std::size_t i = 0; i < 6 && !joint.stiffness; ++i)
      if (joint.laws[i].empty() && f[i] != Freedom::free) joint.laws[i] = {LinearLaw{1}};
  };
  for (auto& [name, part] : parts)
    if (auto* joint = std::get_if<Joint>(&part)) {
      all(*joint);
    } else if (auto* member = std::get_if<Member>(&part)) {
      all(member->start);
      all(member->end);
    } else if (auto* group = std::get_if<Parallel>(&part)) {
      yield_everywhere(group->leg);
      for (Mount& mount : group->mounts) yield_everywhere(mount.leg);
    }
}

/// A member's end is placed as the joint "rod start", and is the part "rod.start" of the description.
std::string described(std::string part) {
  for (const char* end : {" start", " end"})
    if (part.ends_with(end)) part.replace(part.rfind(' '), 1, ".");
  return part;
}

/// What yields anywhere along a member by a linear law does so at these two sections alike: forces are linear along it,
/// and so is what a section's motion does at T (Gauss's rule with two points, exact to the third power).
std::array<PlacedJoint, 2> sections_of(const PlacedMember& member) {
  std::array<PlacedJoint, 2> out;
  const double apart = 0.5 / std::sqrt(3.0);
  for (std::size_t i = 0; i < 2; ++i) {
    out[i].part = member.part;
    out[i].p_W = member.p_W_start + (0.5 + (i == 0 ? -apart : apart)) * Vector3(member.p_W_end - member.p_W_start);
    out[i].R_WJ = member.R_WM;
    out[i].laws.fill({LinearLaw{1}});
  }
  return out;
}

class Forces {
 public:
  Forces(const Vector3& p_WT, ByPart& out) : p_WT_(p_WT), out_(out) {}

  /// Under each unit load. W: the wrench at T that the leg carries; D: the motion of its end relative to its start.
  void leg(const PlacedLeg& placed, const analytic::Chain& chain, const Matrix6& W, const Matrix6& D, int number,
           const std::vector<std::string>& nested) {
    Matrix6X passive(6, chain.J_q.cols());
    for (Eigen::Index i = 0; i < 6; ++i) passive.row(i) = chain.passive_motions(W.col(i), D.col(i), {}).transpose();
    std::size_t group = 0;
    Eigen::Index next = 0;
    const auto motions = [&](Eigen::Index count) {
      next += count;
      return Matrix6X(passive.middleCols(next - count, count));
    };
    for (const PlacedPart& part : placed.parts) {
      if (const auto* joint = std::get_if<PlacedJoint>(&part)) {
        Eigen::Index free = 0;
        for (std::size_t i = 0; i < 6; ++i) free += joint->free(i);
        add(*joint, W, number, nested, 1, motions(free));
      } else if (const auto* member = std::get_if<PlacedMember>(&part)) {
        for (const PlacedJoint& section : sections_of(*member)) add(section, W, number, nested, member->length() / 2);
      } else if (const auto* parallel = std::get_if<PlacedParallel>(&part)) {
        const analytic::Group& own = chain.groups.at(group++);
        branches(*parallel, own, W, motions(own.J.cols()), number, nested);
      }
    }
  }

  /// `compliance`: of each of its freedoms, times which a law's there counts. `motions`: of the free ones, under each
  /// unit load.
  void add(const PlacedJoint& joint, const Matrix6& W, int number, const std::vector<std::string>& nested,
           double compliance = 1, const Matrix6X& motions = Matrix6X(6, 0)) {
    Freedom6 here;
    here.leg = number;
    Eigen::Index next = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      here.there[i] = !joint.laws[i].empty();
      here.free[i] = joint.free(i);
      here.g[i] = here.free[i] ? Vector6(motions.col(next++))
                               : std::sqrt(compliance) * W.transpose() * analytic::freedom_twist(joint, i, p_WT_);
    }
    for (const std::string& before : nested) out_.emplace(before + described(joint.part), here);
  }

 private:
  void branches(const PlacedParallel& parallel, const analytic::Group& group, const Matrix6& W, const Matrix6X& motions,
                int number, const std::vector<std::string>& nested) {
    std::vector<Matrix6> own(parallel.branches.size());
    Matrix6 D;
    for (Eigen::Index i = 0; i < 6; ++i) {
      const analytic::Group::State state = group.solve(W.col(i), {});
      for (std::size_t b = 0; b < own.size(); ++b) own[b].col(i) = state.wrenches[b];
      D.col(i) = state.t + group.J * motions.row(i).transpose();
    }
    for (std::size_t b = 0; b < own.size(); ++b) {
      std::vector<std::string> inner = nested;
      if (!parallel.one_joint) {
        inner.clear();
        for (const std::string& before : nested) {
          inner.push_back(fmt::format("{}{}.", before, parallel.part));
          inner.push_back(fmt::format("{}{}.mounts.{}.", before, parallel.part, b));
        }
      }
      leg(parallel.branches[b], group.branches[b], own[b], D, number, inner);
    }
  }

  const Vector3& p_WT_;
  ByPart& out_;
};

ByPart forces_at(const Configuration& drawn, const Configuration& yielding) {
  ByPart out;
  const analytic::Group legs = analytic::legs_of(drawn);
  std::vector<Matrix6> W(drawn.legs.size(), Matrix6::Zero());
  Matrix6 D;
  for (Eigen::Index i = 0; i < 6; ++i) {
    const analytic::Group::State state = legs.solve(Vector6::Unit(i), {});
    for (std::size_t l = 0; l < W.size(); ++l) W[l].col(i) = state.wrenches[l];
    D.col(i) = state.t;
  }
  Forces forces(drawn.pose.p_WT, out);
  int number = 0;
  for (std::size_t l = 0; l < W.size(); ++l) {
    ++number;
    if (!drawn.legs[l].beside)
      forces.leg(yielding.legs[l], legs.branches[l], W[l], D, number, {"", fmt::format("mounts.{}.", l)});
  }
  for (PlacedJoint fixture : {drawn.base, drawn.tool}) {
    for (auto& laws : fixture.laws) laws = {LinearLaw{1}};
    forces.add(fixture, Matrix6::Identity(), 0, {""});
  }
  return out;
}

/// Whether a load, though not zero, is no load of a freedom: play there floats (analytic/steps.h). `size`: of the
/// machine, m.
bool floats(const Vector6& g, const Vector6& F, double size) {
  constexpr double rounding = 1e-9;
  const double force = std::abs(g.dot(F));
  const auto square = [](const Vector6& v, double length) {
    return v.head<3>().squaredNorm() + length * length * v.tail<3>().squaredNorm();
  };
  // (a + b)² is 2 (a² + b²) at most: without a root for most.
  if (force * force > 4 * rounding * rounding * square(g, size) * square(F, 1 / size)) return false;
  const double largest =
      (g.head<3>().norm() + size * g.tail<3>().norm()) * (F.head<3>().norm() + F.tail<3>().norm() / size);
  return largest > 0 && force <= rounding * largest;
}

/// Translations of the base come before all that turns: in every shape they carry the load as it is, and play that it
/// leaves open stays where it is.
bool carries_the_load_itself(const Place& place) {
  return place.kind == PlaceKind::base &&
         std::all_of(place.freedoms.begin(), place.freedoms.end(), [](std::size_t i) { return i < 3; });
}

/// Of a law that starts at rest under no force.
double deflection_of(const Law& law, double force) {
  if (const auto* play = std::get_if<ClearanceLaw>(&law)) return force > 0 ? play->gap : force < 0 ? -play->gap : 0;
  if (const auto* sided = std::get_if<OneSidedLaw>(&law))
    return force * (force > 0 ? sided->pull : sided->push).value_or(0);
  return analytic::deflection(law, force);
}

struct Rig {
  prediction::TrueLoads loads;
  prediction::RecordedMotion sensor;
};

class MachineTransmissions final : public Transmissions {
 public:
  MachineTransmissions(std::vector<ByPart> by_pose, std::vector<Rig> rigs, double size)
      : by_pose_(std::move(by_pose)), rigs_(std::move(rigs)), size_(size) {}

  std::optional<Change> change(const Place& place, std::optional<int> leg, const Law& law,
                               const measurement::Measurements& data) const override {
    const bool moved_by_shape = std::holds_alternative<ClearanceLaw>(law) && !carries_the_load_itself(place);
    std::vector<bool> floating(data.readings.size(), false);
    auto readings = changed(place, leg, in_series, data, [&](Here here, const Vector6& g, const Vector6& F) {
      if (moved_by_shape && floats(g, F, size_)) floating[here.reading] = true;
      return deflection_of(law, g.dot(F));
    });
    if (!readings) return std::nullopt;
    return Change{std::move(*readings), std::move(floating)};
  }

  std::optional<std::vector<Vector6>> change(const Place& place, std::optional<int> leg, const Curve& curve,
                                             const measurement::Measurements& data) const override {
    return changed(place, leg, in_series, data,
                   [&](Here, const Vector6& g, const Vector6& F) { return curve(floats(g, F, size_) ? 0 : g.dot(F)); });
  }

  std::optional<std::vector<Vector6>> change_beside(const Place& place, std::optional<int> leg,
                                                    const std::function<Curve()>& at_rest,
                                                    const measurement::Measurements& data) const override {
    if (place.freedoms.size() != 1 || !place.others.empty()) return std::nullopt;
    std::vector<Curve> curves;  // by freedom, at one pose after the other
    std::size_t pose = 0;
    return changed(place, leg, side_by_side, data, [&](Here here, const Vector6& g, const Vector6& F) {
      if (here.pose != pose) curves.clear();
      pose = here.pose;
      while (curves.size() <= here.freedom) curves.push_back(at_rest());
      return curves[here.freedom](floats(g, F, size_) ? 0 : g.dot(F));
    });
  }

 private:
  /// In the order of the readings at a pose.
  struct Here {
    std::size_t pose, reading, freedom;
  };
  enum Kind { in_series, side_by_side };

  /// `deflection(here, g, F)`: of a freedom, under the load F.
  template <class Deflection>
  std::optional<std::vector<Vector6>> changed(const Place& place, std::optional<int> leg, Kind kind,
                                              const measurement::Measurements& data,
                                              const Deflection& deflection) const {
    std::vector<Vector6> out(data.readings.size(), Vector6::Zero());
    for (std::size_t p = 0; p < data.poses.size(); ++p) {
      const std::vector<Vector6> all = freedoms(p, place, leg, kind);
      if (all.empty()) return std::nullopt;
      for (const std::size_t i : measurement::in_order(data.poses[p], data)) {
        const measurement::Reading& r = data.readings[i];
        const Vector6 F = place.kind == PlaceKind::tool ? rigs_[p].loads.through_tool(r) : rigs_[p].loads.at_T(r);
        Vector6 d = Vector6::Zero();
        for (std::size_t k = 0; k < all.size(); ++k) d += all[k] * deflection({p, i, k}, all[k], F);
        out[i] = rigs_[p].sensor.of(d, Geometry::linear);
      }
    }
    return out;
  }

  std::vector<Vector6> freedoms(std::size_t pose, const Place& place, std::optional<int> leg, Kind kind) const {
    std::vector<Vector6> out;
    const auto add = [&](const std::string& part, const std::vector<std::size_t>& freedoms) {
      const auto [first, last] = by_pose_[pose].equal_range(part);
      for (auto at = first; at != last; ++at) {
        const auto& [g, there, free, number] = at->second;
        for (const std::size_t i : freedoms)
          if ((there[i] || (kind == side_by_side && free[i])) && (!leg || number == *leg)) out.push_back(g[i]);
      }
    };
    add(place.part, place.freedoms);
    for (const OtherPart& other : place.others) add(other.part, other.freedoms);
    return out;
  }

  std::vector<ByPart> by_pose_;
  std::vector<Rig> rigs_;  // by pose
  double size_;
};

/// A spring in place of every law that is not linear, each one softer than the one before it by `differ`.
Configuration with_springs(Configuration c, double differ) {
  double softness = 1e-6;  // m/N, rad/Nm
  for_each_law(c, [&](Law& law) {
    if (!is_linear(law)) law = LinearLaw{1 / (softness *= differ)};
  });
  return c;
}

bool same_forces(const ByPart& a, const ByPart& b) {
  constexpr double rounding = 1e-8;
  double largest = 0, apart = 0;
  for (auto x = a.begin(), y = b.begin(); x != a.end(); ++x, ++y)
    for (std::size_t i = 0; i < 6; ++i) {
      largest = std::max(largest, x->second.g[i].norm());
      apart = std::max(apart, (x->second.g[i] - y->second.g[i]).norm());
    }
  return apart <= rounding * largest;
}

/// Nothing where forces hang on a law that is not linear. In a determinate machine they do not, but motions do: then
/// those of free joints are not told.
std::optional<ByPart> proportional_forces_at(const Configuration& drawn, const Configuration& yielding) {
  if (all_linear(drawn)) return forces_at(drawn, yielding);
  const auto without_motions = [](ByPart forces) {
    for (auto& [part, freedoms] : forces) {
      for (std::size_t i = 0; i < 6; ++i)
        if (freedoms.free[i]) freedoms.g[i].setZero();
      freedoms.free.fill(false);
    }
    return forces;
  };
  ByPart out = without_motions(forces_at(with_springs(drawn, 1), yielding));
  if (!same_forces(out, without_motions(forces_at(with_springs(drawn, 1.2), yielding)))) return std::nullopt;
  return out;
}

bool may_be_proportional(const Configuration& c) {
  bool preloaded = false, jump = false;
  for_each_law(c, [&](const Law& law) { jump = jump || jumps(law); });
  for_each_part(c.legs, [&](const auto& part) {
    if constexpr (requires { part.preload; })
      preloaded = preloaded || std::any_of(part.preload.begin(), part.preload.end(), [](double f) { return f != 0; });
  });
  return !preloaded && !jump && c.weight.isZero(0) &&
         std::all_of(c.legs.begin(), c.legs.end(), [](const PlacedLeg& leg) { return leg.misfit.isZero(0); });
}

}  // namespace

std::unique_ptr<const Transmissions> transmissions_of(const Mechanism& m, const std::vector<Configuration>& drawn) {
  if (drawn.empty() || !may_be_proportional(drawn.front())) return nullptr;
  Mechanism yielding = m.legs.empty() ? resolved(m) : m;
  for (Named<Part>& leg : yielding.legs) yield_everywhere(leg);
  std::vector<ByPart> by_pose;
  std::vector<Rig> rigs;
  for (const Configuration& c : drawn) {
    std::optional<ByPart> forces = proportional_forces_at(c, configure(yielding, c.pose));
    if (!forces) return nullptr;
    by_pose.push_back(std::move(*forces));
    rigs.push_back({{m.load_cell, c.pose.R_WT}, {m.sensor, c.pose.R_WT}});
  }
  return std::make_unique<MachineTransmissions>(std::move(by_pose), std::move(rigs), drawn.front().size);
}

}  // namespace deflect::subject
