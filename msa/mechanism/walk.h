// The walk of a frame along the chains of a mechanism (family "chains", see description.h). It gives the joint
// coordinates on the way with their twists, and the loops that must close.
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

/// State of one joint: coordinates tx ty tz (m) rx ry rz (rad). A joint that turns freely about all three axes uses the
/// rotation matrix `ball` instead of rx ry rz, because that has no singularity.
struct JointState {
  std::array<double, 6> q{};
  Matrix3 ball = Matrix3::Identity();
};

/// A coordinate; it moves the frames after it on the walk.
struct Coordinate {
  std::size_t joint = 0;    ///< in the order of the walk: index of its JointState
  std::size_t freedom = 0;  ///< tx … rz
  bool actuated = false, ball = false;
  Vector6 twist;  ///< [δ; θ] at the origin of W, base axes, of a body moved by one unit
};

/// One part, with the chain's frame before and after it.
struct Step {
  const std::string* name = nullptr;
  const Part* part = nullptr;
  Frame before, after;
  Frame joint, moved;     ///< of a joint: its frame before and after its motion
  Matrix3 turning;        ///< of a joint: its axes after its first rotation, which contain its first two rotation axes
  std::size_t state = 0;  ///< of a joint
  Vector3 start;          ///< of a member
  std::vector<std::vector<Step>> branches;
};

/// Two paths to one frame, with the coordinates on each.
struct Closure {
  Frame a, b;
  std::vector<std::size_t> path_a, path_b;
};

struct Trace {
  std::vector<Coordinate> coordinates;
  std::vector<Closure> closures;  ///< of branches in parallel
  struct Leg {
    std::vector<Step> steps;
    Frame start, end;               ///< end: the frame of the platform computed along this leg
    std::vector<std::size_t> path;  ///< coordinates on the way to the end
  };
  std::vector<Leg> legs;
};

/// One leg: its mount and its own parts.
struct LegParts {
  Mount mount;
  Named<Part> parts;
};

/// A span with this leg only.
inline std::span<const LegParts> one(const LegParts& leg) { return {&leg, 1}; }

/// Every leg, with its variations applied.
std::vector<LegParts> legs_of(const Mechanism&);

/// The joints' states at their `home`, in the order of the walk.
std::vector<JointState> home_states(std::span<const LegParts>);

/// Walks along the legs; the states are those of their joints, in order. Steps point into the legs, which must outlive
/// them. Throws InputError where a member begins at a part that comes later in the walk.
Trace walk(std::span<const LegParts>, const std::vector<JointState>&);

/// Changes one coordinate of a joint by `step`.
void move(JointState&, const Coordinate&, double step);

/// Whether the kinematics move this freedom: free or actuated.
bool movable(Freedom);

/// Whether all three rotations are free and none is actuated.
bool is_ball(const std::array<Freedom, 6>&);

}  // namespace deflect
