#include "msa/mechanism/chain_kinematics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/motion_text.h"
#include "msa/base/units.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/place.h"

namespace deflect {
namespace {

constexpr double path_step = 0.25;  // of the mechanism's length, or rad
constexpr int most_steps = 10000;   // beyond, steps are longer
constexpr double farthest = 1e6;    // mechanism's lengths: beyond, its own measures lose their digits

int steps_along(double way) {
  return way / path_step < most_steps ? 1 + static_cast<int>(way / path_step) : most_steps;
}

/// From here to there, less whole turns on the way.
double way_to(double wanted, double from, bool rotation) {
  const double way = wanted - from;
  return rotation ? std::fmod(way, 2 * pi) : way;
}

std::string leg_name(const ChainAssembly& a, std::size_t leg) {
  return a.legs.size() == 1 ? "" : fmt::format("leg {}: ", leg + 1);
}

Frame frame_of(const Pose& pose) { return {pose.p_WT, pose.R_WT}; }

Closed close_leg(ChainAssembly& a, std::size_t leg, const Pose& pose) {
  return close_loops(one(a.legs[leg]), a.states[leg], frame_of(pose), a.length);
}

/// All legs together: passive coordinates follow the actuated ones. The platform is where the legs have it.
Closed close_all(ChainAssembly& a) {
  std::vector<JointState> all;
  for (const auto& states : a.states) all.insert(all.end(), states.begin(), states.end());
  const Closed closed = close_loops(a.legs, all, std::nullopt, a.length);
  auto from = all.begin();
  for (auto& states : a.states) {
    std::copy(from, from + as_index(states.size()), states.begin());
    from += as_index(states.size());
  }
  a.pose = {closed.trace.legs[0].end.p, closed.trace.legs[0].end.R};
  return closed;
}

std::string left_open(const Closed& c) {
  return fmt::format("{:.4g} mm and {:.4g} deg are left open", 1e3 * c.shift, c.turn * 180 / pi);
}

/// The rotation nearby with which this leg takes the position: where one direction is missing, its nearest pose tells
/// how far the rotation alone would have to go. Nothing where the leg lacks a motion of the position itself.
std::optional<Matrix3> rotation_taken(ChainAssembly& a, std::size_t leg, Pose pose) {
  constexpr int most_turns = 20;
  constexpr double largest_turn = 0.3, farthest_turn = 1.5;  // rad: of a step, of what is called nearby
  for (int i = 0; i < most_turns; ++i) {
    const Closed c = close_leg(a, leg, pose);
    if (c.closed) return pose.R_WT;
    const Frame& end = c.trace.legs[0].end;
    const Eigen::AngleAxisd turn(end.R * pose.R_WT.transpose());
    const double turned = a.length * turn.angle(), gap = (end.p - pose.p_WT).squaredNorm() + turned * turned;
    if (!(std::abs(turned) > 1e-6 * std::sqrt(gap))) return std::nullopt;
    const double needed = turn.angle() * gap / (turned * turned);
    if (!(std::abs(needed) < farthest_turn)) return std::nullopt;
    const double angle = std::clamp(needed, -largest_turn, largest_turn);
    pose.R_WT = Eigen::AngleAxisd(angle, turn.axis()).toRotationMatrix() * pose.R_WT;
  }
  return std::nullopt;
}

/// "; this position is taken with roll, pitch, yaw = 0, 0, 26.24699 deg", where the mechanism has such a rotation: what
/// depends on the position must be given as it is there.
std::string rotation_words(ChainAssembly a, std::size_t leg, const Pose& pose) {
  const std::optional<Matrix3> R = rotation_taken(a, leg, pose);
  if (!R) return "";
  const Vector3 deg = (rpy_from_rotation(*R) * 180 / pi * 1e9).array().round() / 1e9;
  const Pose taken{pose.p_WT, rotation_from_rpy(deg(0) * pi / 180, deg(1) * pi / 180, deg(2) * pi / 180)};
  for (std::size_t each = 0; each < a.legs.size(); ++each)
    if (!close_leg(a, each, taken).closed) return "";
  return fmt::format("; this position is taken with roll, pitch, yaw = {:.12g}, {:.12g}, {:.12g} deg", deg(0) + 0.0,
                     deg(1) + 0.0, deg(2) + 0.0);
}

/// The joints of a leg in the order of their states, with their names.
void joints_of(const Named<Part>& parts, const std::string& within,
               std::vector<std::pair<std::string, const Joint*>>& out) {
  for (const auto& [name, part] : parts)
    if (const auto* joint = std::get_if<Joint>(&part)) {
      out.emplace_back(within + name, joint);
    } else if (const auto* group = std::get_if<Parallel>(&part)) {
      for (std::size_t b = 0; b < group->mounts.size(); ++b) {
        const Mount& mount = group->mounts[b];
        joints_of(mount.leg.empty() ? group->leg : mount.leg, fmt::format("{}{} {} ", within, name, b + 1), out);
      }
    }
}

void check_limits(const ChainAssembly& a) {
  for (std::size_t leg = 0; leg < a.legs.size(); ++leg) {
    std::vector<std::pair<std::string, const Joint*>> joints;
    joints_of(a.legs[leg].parts, "", joints);
    for (std::size_t k = 0; k < joints.size(); ++k) {
      const auto& [name, joint] = joints[k];
      for (std::size_t i = 0; i < 6; ++i) {
        const double q = a.states[leg][k].q[i];
        const bool low = joint->min[i] && q < *joint->min[i], high = joint->max[i] && q > *joint->max[i];
        if (!low && !high) continue;
        const Dimension d = i < 3 ? Dimension::length : Dimension::angle;
        const double scale = i < 3 ? 1e3 : 180 / pi;
        const char *unit = i < 3 ? "mm" : "deg", *side = low ? "below" : "above";
        throw ModelError(
            fmt::format("{}{} {} would stand at {:.6g} {}, {} its limit of {}", leg_name(a, leg), name,
                        freedom_names[i], scale * q, unit, side,
                        format_quantity(low ? *joint->min[i] : *joint->max[i], d)),
            {fmt::format("{} {} would stand at … {}, {} its limit of … {}", name, freedom_names[i], unit, side, unit),
             static_cast<int>(leg) + 1});
      }
    }
  }
}

/// Refuses a coordinate of which no digits are left that matter.
void require_reachable(double q, bool rotation, double length, const std::string& name) {
  if (rotation && !(std::abs(q) <= largest_angle))
    throw InputError(
        fmt::format("joint {}: {:.6g} rad is so large an angle that too few of its digits are left: write "
                    "it within one turn",
                    name, q));
  if (!rotation && !(std::abs(q) <= farthest * length))
    throw InputError(
        fmt::format("joint {}: {:.6g} mm is {:.3g} times the mechanism's size of {:.4g} mm, which loses its "
                    "digits beside it: check the unit",
                    name, 1e3 * q, std::abs(q) / length, 1e3 * length));
}

/// Refuses a pose in which a leg's end can move in fewer directions than it can at home.
void refuse_singular(const ChainAssembly& a, const ChainAssembly& home) {
  for (std::size_t leg = 0; leg < a.legs.size(); ++leg) {
    const auto at = [&](const ChainAssembly& s) {
      return reach(walk(one(s.legs[leg]), s.states[leg]), 0, s.pose.p_WT, s.length);
    };
    const Reach here = at(a), there = at(home);
    if (here.can.cols() >= there.can.cols()) continue;
    // Of what cannot be done here, that which can be done best at home.
    const MatrixX overlap = there.can.transpose() * here.cannot;
    const Eigen::JacobiSVD<MatrixX> svd(overlap, Eigen::ComputeThinV);
    Vector6 lost = here.cannot * svd.matrixV().col(0);
    lost.tail<3>() /= a.length;  // from weighed coordinates
    throw ModelError(
        fmt::format("{}singular pose: it cannot move in {}", leg_name(a, leg), motion_text(lost, a.length)),
        {"singular pose", static_cast<int>(leg) + 1});
  }
}

ChainAssembly with_joints_at_home(const Mechanism& m) {
  ChainAssembly a;
  a.legs = legs_of(m);
  for (const LegParts& leg : a.legs) a.states.push_back(home_states(one(leg)));
  return a;
}

// What decides where parts stand, without their laws and sections.
bool same(const Named<Part>&, const Named<Part>&);
bool same(const std::pair<std::string, Part>&, const std::pair<std::string, Part>&);

bool same(const Placement& a, const Placement& b) { return a.shift == b.shift && a.turn == b.turn; }

bool same(const Mount& a, const Mount& b) {
  return same(a.base, b.base) && same(a.platform, b.platform) && same(a.leg, b.leg);
}

bool same(const Joint& a, const Joint& b) {
  return static_cast<const JointKinematics&>(a) == static_cast<const JointKinematics&>(b);
}

bool same(const Member& a, const Member& b) {
  return a.along == b.along && a.from == b.from && a.from_point == b.from_point;
}

bool same(const Offset& a, const Offset& b) {
  return same(static_cast<const Placement&>(a), static_cast<const Placement&>(b));
}

template <class T>
bool all_same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const T& x, const T& y) { return same(x, y); });
}

bool same(const Parallel& a, const Parallel& b) { return all_same(a.mounts, b.mounts) && same(a.leg, b.leg); }

bool same(const std::pair<std::string, Part>& a, const std::pair<std::string, Part>& b) {
  if (a.first != b.first || a.second.index() != b.second.index()) return false;
  const auto with = [&](const auto& part) { return same(part, std::get<std::decay_t<decltype(part)>>(b.second)); };
  return std::visit(with, a.second);
}

bool same(const Named<Part>& a, const Named<Part>& b) { return all_same(a, b); }

}  // namespace

bool same_kinematics(const std::vector<LegParts>& a, const std::vector<LegParts>& b) {
  const auto alike = [](const LegParts& x, const LegParts& y) {
    return same(x.mount, y.mount) && same(x.parts, y.parts);
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), alike);
}

ChainAssembly home_assembly(const Mechanism& m) {
  const Chains& k = std::get<Chains>(m.kinematics);
  ChainAssembly a = with_joints_at_home(m);
  std::vector<JointState> all;
  for (const auto& states : a.states) all.insert(all.end(), states.begin(), states.end());
  const Trace guess = walk(a.legs, all);
  double length = 0;
  const Vector3 centre = guess.legs[0].end.p;
  for (const Trace::Leg& leg : guess.legs) {
    length = std::max({length, (leg.start.p - centre).norm(), (leg.end.p - centre).norm()});
    for (const Step& step : leg.steps) length = std::max(length, (step.after.p - centre).norm());
  }
  a.length = length > 0 ? length : 1;
  a.home = k.home;
  if (const auto n = actuated(a).values.size(); k.controller.size() > 0 && k.controller.rows() != n)
    throw InputError(fmt::format("{}: kinematics.controller has {} rows: the mechanism has {} actuated coordinates",
                                 m.name, k.controller.rows(), n));

  if (k.home) {
    const Frame home = deflect::frame_of(*k.home);
    a.pose = {home.p, home.R};
    for (std::size_t leg = 0; leg < a.legs.size(); ++leg)
      if (const Closed c = close_leg(a, leg, a.pose); !c.closed)
        throw ModelError(fmt::format("{}does not reach kinematics.home from the joints' home coordinates: {}{}",
                                     leg_name(a, leg), left_open(c), rotation_words(a, leg, a.pose)));
  } else if (const Closed c = close_all(a); !c.closed) {
    throw ModelError(
        fmt::format("the loops do not close from the joints' home coordinates: {}; give kinematics.home, a "
                    "pose at which they do, and coordinates near it",
                    left_open(c)));
  }
  return a;
}

void move_to(ChainAssembly& a, const Pose& pose) {
  const ChainAssembly home = a;
  const Eigen::AngleAxisd turn(home.pose.R_WT.transpose() * pose.R_WT);
  const Vector3 shift = pose.p_WT - home.pose.p_WT;
  if (!(shift.norm() <= farthest * a.length))
    throw ModelError(
        fmt::format("the tool point would be {:.3g} times the mechanism's size of {:.4g} mm away from home",
                    shift.norm() / a.length, 1e3 * a.length),
        {"the tool point would be … times the mechanism's size of … mm away from home"});
  const int steps = steps_along(std::max(shift.norm() / a.length, std::abs(turn.angle())));
  for (int i = 1; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    a.pose = i == steps ? pose
                        : Pose{home.pose.p_WT + s * shift,
                               home.pose.R_WT * Eigen::AngleAxisd(s * turn.angle(), turn.axis()).toRotationMatrix()};
    for (std::size_t leg = 0; leg < a.legs.size(); ++leg) {
      const Closed c = close_leg(a, leg, a.pose);
      if (i == steps && !c.closed)
        throw ModelError(fmt::format("{}does not take this pose: {} at the nearest{}", leg_name(a, leg), left_open(c),
                                     rotation_words(a, leg, pose)),
                         {"does not take this pose", static_cast<int>(leg) + 1});
    }
  }
  check_limits(a);
  refuse_singular(a, home);
}

void move_to_coordinates(ChainAssembly& a, const VectorX& wanted) {
  const ActuatedCoordinates home = actuated(a);
  const VectorX from = home.values;
  VectorX way(from.size());
  double largest = 0;
  for (Eigen::Index i = 0; i < from.size(); ++i) {
    const auto at = as_size(i);
    const double size = home.rotation[at] ? 1 : a.length;
    require_reachable(wanted(i), home.rotation[at], a.length, home.names[at]);
    way(i) = way_to(wanted(i), from(i), home.rotation[at]);
    largest = std::max(largest, std::abs(way(i)) / size);
  }
  const int steps = steps_along(largest);
  for (int i = 1; i <= steps; ++i) {
    const VectorX q = i == steps ? wanted : VectorX(from + static_cast<double>(i) / steps * way);
    Eigen::Index n = 0;
    for (std::size_t leg = 0; leg < a.legs.size(); ++leg)
      for (const Coordinate& c : walk(one(a.legs[leg]), a.states[leg]).coordinates)
        if (c.actuated) a.states[leg][c.joint].q[c.freedom] = q(n++);
    const Closed c = close_all(a);
    if (i == steps && !c.closed)
      throw ModelError(fmt::format("the loops do not close: {}", left_open(c)), {"the loops do not close"});
  }
  check_limits(a);
}

ActuatedCoordinates actuated(const ChainAssembly& a) {
  ActuatedCoordinates out;
  std::vector<double> values;
  for (std::size_t leg = 0; leg < a.legs.size(); ++leg) {
    std::vector<std::pair<std::string, const Joint*>> joints;
    joints_of(a.legs[leg].parts, a.legs.size() == 1 ? "" : fmt::format("leg {} ", leg + 1), joints);
    for (const Coordinate& c : walk(one(a.legs[leg]), a.states[leg]).coordinates) {
      if (!c.actuated) continue;
      const auto& [name, joint] = joints[c.joint];
      const std::array<Freedom, 6> freedoms = freedoms_of(*joint);
      const bool several = std::count(freedoms.begin(), freedoms.end(), Freedom::actuated) > 1;
      values.push_back(a.states[leg][c.joint].q[c.freedom]);
      out.names.push_back(several ? fmt::format("{} {}", name, freedom_names[c.freedom]) : name);
      out.rotation.push_back(c.freedom >= 3);
    }
  }
  out.values = Eigen::Map<VectorX>(values.data(), std::ssize(values));
  return out;
}

ActuatedCoordinates actuated_at_home(const Mechanism& m) { return actuated(with_joints_at_home(m)); }

}  // namespace deflect
