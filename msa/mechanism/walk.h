// The walk of a frame along the chains of a mechanism (family "chains", see description.h), and what it depends on:
// the coordinates of the joints on its way with their twists, and the loops that must close.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "msa/mechanism/description.h"
#include "msa/mechanism/joint_table.h"

namespace deflect {

/// A frame in W.
struct Frame {
  Vector3 p = Vector3::Zero();
  Matrix3 R = Matrix3::Identity();

  Frame operator*(const Frame& next) const { return {p + R * next.p, R * next.R}; }
  Frame inverse() const { return {-(R.transpose() * p), R.transpose()}; }
};

Frame frame_of(const Placement&);

/// Where one joint stands: coordinates tx ty tz (m) rx ry rz (rad). A joint that turns freely about all three axes is
/// told by `ball` instead of rx ry rz, which has no singular place.
struct JointState {
  std::array<double, 6> q{};
  Matrix3 ball = Matrix3::Identity();
};

/// A coordinate that moves the frames behind it on the walk.
struct Coordinate {
  std::size_t joint = 0;    ///< in the order of the walk: index of its JointState
  std::size_t freedom = 0;  ///< tx … rz
  bool actuated = false, ball = false;
  Vector6 twist;  ///< [δ; θ] of a body that moves with it by one unit, at the origin of W, base axes
};

/// One part with the chain's frame before and after it.
struct Step {
  const std::string* name = nullptr;
  const Part* part = nullptr;
  Frame before, after;
  Frame joint, moved;     ///< of a joint: its place and axes before and after its motion
  Matrix3 turning;        ///< of a joint: axes that hold the first two which it turns about
  std::size_t state = 0;  ///< of a joint
  Vector3 start;          ///< of a member
  std::vector<std::vector<Step>> branches;
};

/// Two ways to one frame, with the coordinates on either.
struct Closure {
  Frame a, b;
  std::vector<std::size_t> path_a, path_b;
};

struct Trace {
  std::vector<Coordinate> coordinates;
  std::vector<Closure> closures;  ///< of branches in parallel
  struct Leg {
    std::vector<Step> steps;
    Frame start, end;               ///< end: of the platform, as this leg has it
    std::vector<std::size_t> path;  ///< coordinates on the way to the end
  };
  std::vector<Leg> legs;
};

/// One leg as it stands: its mount and its own parts.
struct LegParts {
  Mount mount;
  Named<Part> parts;
};

/// A leg by itself.
inline std::span<const LegParts> one(const LegParts& leg) { return {&leg, 1}; }

/// Every leg, with its variations in it.
std::vector<LegParts> legs_of(const Mechanism&);

/// The joints' states at their `home`, in the order of the walk.
std::vector<JointState> home_states(std::span<const LegParts>);

/// Walks along legs; the states are those of their joints in order. Steps point into the legs. Throws InputError where
/// a member begins at a part that has not been passed.
Trace walk(std::span<const LegParts>, const std::vector<JointState>&);

/// Moves a joint by a step of one of its coordinates.
void move(JointState&, const Coordinate&, double step);

/// Which freedoms the kinematics move: free or actuated.
bool movable(Freedom);

/// Turns about all three axes, none of them actuated.
bool is_ball(const std::array<Freedom, 6>&);

}  // namespace deflect
