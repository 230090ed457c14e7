#include <Eigen/Geometry>
#include <algorithm>

#include "analytic/deformed.h"
#include "analytic/model.h"
#include "analytic/rotation_vector.h"
#include "msa/base/error.h"
#include "msa/base/index.h"

namespace deflect::analytic {
namespace {

/// The first parts of a chain: their compliance under the chain's wrench, and how many passive motions they have.
struct Begin {
  Chain yields;
  Eigen::Index passive = 0;
  std::size_t groups = 0;
};

Begin begin_of(const Chain& chain, const PlacedLeg& leg, std::size_t parts) {
  Begin out;
  std::size_t members = 0, freedoms = 0;
  for (std::size_t k = 0; k < parts; ++k) {
    if (std::holds_alternative<PlacedParallel>(leg.parts[k])) {
      const Group& g = chain.groups[out.groups++];
      out.yields.groups.push_back(g);
      out.passive += g.J.cols();
      continue;
    }
    const auto* joint = std::get_if<PlacedJoint>(&leg.parts[k]);
    if (!joint || joint->stiffness) {
      out.yields.C += chain.members[members++].C;
      if (joint) continue;
      const auto& member = std::get<PlacedMember>(leg.parts[k]);
      out.yields.expansion.head<3>() += member.expansion * (member.p_W_end - member.p_W_start);
      continue;
    }
    for (std::size_t i = 0; i < 6; ++i) {
      if (joint->free(i)) ++out.passive;
      if (joint->elastic(i)) out.yields.freedoms.push_back(chain.freedoms[freedoms++]);
    }
  }
  return out;
}

/// Motion at T, relative to the start of the chain, of the body behind the part; t: of the chain's end.
Vector6 motion_in(const Chain& chain, const PlacedLeg& leg, const Vector6& F, const Vector6& t, const Inside& at,
                  std::size_t depth, const ChainConditions& under) {
  const std::size_t k = at.parts[2 * depth];
  const bool within = 2 * depth + 1 < at.parts.size();
  const VectorX passive = chain.passive_motions(F, t, under);
  const auto moved = [&](const Begin& first) {
    Vector6 d = first.yields.deflection(F, under);
    if (first.passive > 0) d += chain.J_q.leftCols(first.passive) * passive.head(first.passive);
    return d;
  };
  if (!within) return moved(begin_of(chain, leg, k + 1));
  const Begin first = begin_of(chain, leg, k);
  const Group& group = chain.groups[first.groups];
  const Group::State state = group.solve(F, under);
  const Vector6 end = state.t + group.J * passive.segment(first.passive, group.J.cols());
  const std::size_t b = at.parts[2 * depth + 1];
  return moved(first) + motion_in(group.branches[b], std::get<PlacedParallel>(leg.parts[k]).branches[b],
                                  state.wrenches[b], end, at, depth + 1, under);
}

/// Force in a freedom of a joint, of the wrench F on the chain that contains it.
double force_in(const Chain& chain, const PlacedLeg& leg, const Vector6& F, const Inside& at, std::size_t depth,
                const Vector3& p_WT, const ChainConditions& under) {
  const std::size_t k = at.parts[2 * depth];
  if (2 * depth + 1 >= at.parts.size()) return freedom_twist(*joint_of(leg.parts[k]), *at.freedom, p_WT).dot(F);
  const std::size_t b = at.parts[2 * depth + 1];
  const Group& group = chain.groups[begin_of(chain, leg, k).groups];
  return force_in(group.branches[b], std::get<PlacedParallel>(leg.parts[k]).branches[b],
                  group.solve(F, under).wrenches[b], at, depth + 1, p_WT, under);
}

/// The number of steps of a virtual chain that its first parts are.
std::size_t steps_of(const VirtualChain& chain, const PlacedLeg& leg, std::size_t parts) {
  std::size_t step = 0;
  for (std::size_t k = 0; k < parts; ++k) {
    if (std::holds_alternative<PlacedMember>(leg.parts[k])) {
      const std::size_t number = std::get<VirtualMember>(chain.steps[step]).number;
      while (step < chain.steps.size() && std::holds_alternative<VirtualMember>(chain.steps[step]) &&
             std::get<VirtualMember>(chain.steps[step]).number == number)
        ++step;
      continue;
    }
    const auto* joint = std::get_if<PlacedJoint>(&leg.parts[k]);
    bool moves = !joint;
    for (std::size_t i = 0; joint && i < 6; ++i) moves = moves || joint->free(i) || joint->elastic(i);
    if (moves) ++step;
  }
  return step;
}

/// Force in a freedom of a joint that has moved by x, under the wrench F about `end`; `before`: how the joint moves
/// with what is before it.
double force_in(const PlacedJoint& joint, const std::array<double, 6>& x, std::size_t freedom,
                const RigidMotion& before, const Vector6& F, const Vector3& end) {
  Matrix3 axes = before.R() * joint.R_WJ;
  const Vector3 f = F.head<3>();
  if (freedom < 3) return axes.col(as_index(freedom)).dot(f);
  for (std::size_t i = 3; i < freedom; ++i)
    axes = Eigen::AngleAxisd(x.at(i), axes.col(as_index(i - 3)).eval()).toRotationMatrix() * axes;
  const Vector3 point = before(joint.p_W + joint.R_WJ * Vector3(x[0], x[1], x[2]));
  return axes.col(as_index(freedom - 3)).dot(F.tail<3>() + (end - point).cross(f));
}

/// The same of a virtual chain whose end, in the axes of its start, is at `end`.
double force_in(const VirtualChain& chain, const PlacedLeg& leg, const Vector3& end, const Inside& at,
                std::size_t depth) {
  const std::size_t k = at.parts[2 * depth], step = steps_of(chain, leg, k);
  if (2 * depth + 1 < at.parts.size()) {
    const std::size_t b = at.parts[2 * depth + 1];
    const auto& group = std::get<VirtualGroup>(chain.steps[step]);
    return force_in(group.branches[b], std::get<PlacedParallel>(leg.parts[k]).branches[b],
                    group.tip.motion()(group.tip.p), at, depth + 1);
  }
  const PlacedJoint& joint = *joint_of(leg.parts[k]);
  std::array<double, 6> x{};
  if (step < chain.steps.size() && steps_of(chain, leg, k + 1) > step) {
    if (const auto* own = std::get_if<VirtualJoint>(&chain.steps[step]))
      x = own->x;
    else  // with laws side by side
      x = std::get<VirtualJoint>(std::get<VirtualGroup>(chain.steps[step]).branches.front().steps.front()).x;
  }
  return force_in(joint, x, *at.freedom, chain.motion_before(step, Geometry::finite), chain.F, end);
}

RigidMotion motion_in(const VirtualChain& chain, const PlacedLeg& leg, const Inside& at, std::size_t depth) {
  const std::size_t k = at.parts[2 * depth];
  if (2 * depth + 1 >= at.parts.size()) return chain.motion_before(steps_of(chain, leg, k + 1), Geometry::finite);
  const std::size_t b = at.parts[2 * depth + 1], step = steps_of(chain, leg, k);
  return chain.motion_before(step, Geometry::finite) * motion_in(std::get<VirtualGroup>(chain.steps[step]).branches[b],
                                                                 std::get<PlacedParallel>(leg.parts[k]).branches[b], at,
                                                                 depth + 1);
}

/// In the deformed shape: [δ; rotation vector], or the force.
Vector6 inside_deformed(const Inside& at, const Deformed& d, const Configuration& c) {
  const auto legs = std::find_if(d.whole.steps.begin(), d.whole.steps.end(),
                                 [](const VirtualStep& s) { return std::holds_alternative<VirtualGroup>(s); });
  const auto& group = std::get<VirtualGroup>(*legs);
  const VirtualChain& chain = group.branches[at.leg];
  const PlacedLeg& leg = c.legs[at.leg];
  Vector6 out = Vector6::Zero();
  if (at.freedom) {
    out(0) = force_in(chain, leg, group.tip.motion()(group.tip.p), at, 0);
    return out;
  }
  const RigidMotion moved =
      d.whole.motion_before(as_size(legs - d.whole.steps.begin()), Geometry::finite) * motion_in(chain, leg, at, 0);
  out << moved.displacement(c.pose.p_WT), rotation_vector(moved.D);
  return out;
}

/// Largest rotation of a body and largest strain of a member's axis so far.
struct Largest {
  double rotation = 0, strain = 0;

  /// `turned`: of the chain's start, small.
  void look_at(const VirtualChain& chain, Vector3 turned) {
    for (const VirtualStep& step : chain.steps) {
      if (const auto* joint = std::get_if<VirtualJoint>(&step)) {
        turned += joint->joint.R_WJ * Eigen::Map<const Vector3>(joint->x.data() + 3);
      } else if (const auto* member = std::get_if<VirtualMember>(&step)) {
        strain = std::max(strain, std::abs(member->tip.x(0)) / member->member.length());
        turned += member->tip.A * member->tip.x.tail<3>();
      } else {
        const auto& group = std::get<VirtualGroup>(step);
        for (const VirtualChain& branch : group.branches) look_at(branch, turned);
        turned += group.tip.A * group.tip.x.tail<3>();
      }
      rotation = std::max(rotation, turned.norm());
    }
  }
};

}  // namespace

double left_out_in_second_order(const Deformed& d) {
  Largest largest;
  largest.look_at(d.whole, Vector3::Zero());
  return largest.rotation * largest.rotation + largest.strain;
}

/// `s`: from the drawing, with the whole load at T.
Vector6 AnalyticModel::inside_linear(const Inside& at, const AnalyticSolution& s) const {
  const Configuration& c = configuration_;
  const Chain& chain = legs_.branches[at.leg];
  const Vector6& F = s.leg_wrenches[at.leg];
  Vector6 out = Vector6::Zero();
  if (at.freedom) {
    out(0) = force_in(chain, c.legs[at.leg], F, at, 0, c.pose.p_WT, s.under);
    return out;
  }
  ChainConditions drawn = s.under;
  drawn.printed.clear();
  const Vector6 through = through_.deflection(s.load, drawn);
  const Vector6 base = begin_of(through_, {"base and tool", {c.base, c.tool}}, 1).yields.deflection(s.load, drawn);
  return base + motion_in(chain, c.legs[at.leg], F, s.displacement - through, at, 0, s.under);
}

std::vector<Vector6> AnalyticModel::inside(const std::vector<Inside>& places, const AnalyticSolution& s) const {
  std::vector<Vector6> out;
  if (places.empty()) return out;
  const bool second_order = s.deformed && s.deformed->conditions.geometry == Geometry::second_order;
  if (second_order)
    throw NumericalError("sensors inside legs are predicted in linear and in finite geometry, not in second order");
  const bool fits = legs_.fits();
  if (s.deformed) {
    for (const Inside& at : places) out.push_back(inside_deformed(at, *s.deformed, configuration_));
    if (fits) return out;
    const AnalyticSolution rest = assembled(Geometry::finite);
    for (std::size_t i = 0; i < places.size(); ++i)
      out[i] -= inside_deformed(places[i], *rest.deformed, configuration_);
    return out;
  }
  AnalyticSolution whole = s;
  whole.load += weight_;
  whole.displacement -= s.shape;
  AnalyticSolution rest;
  if (!fits) {
    rest = assembled();
    whole.displacement += rest.displacement;
  }
  for (const Inside& at : places) out.push_back(inside_linear(at, whole));
  for (std::size_t i = 0; !fits && i < places.size(); ++i) out[i] -= inside_linear(places[i], rest);
  return out;
}

}  // namespace deflect::analytic
