// Mechanisms by the dice, which close at home by construction: every leg is walked at random coordinates, and its mount
// on the platform is put where the walk ends.
#pragma once

#include <string>
#include <vector>

#include "msa/mechanism/walk.h"
#include "tests/support/chains.h"

namespace deflect::test {

class RandomMechanism {
 public:
  explicit RandomMechanism(unsigned seed) : random_(seed) {
    m_.name = fmt::format("random {}", seed);
    m_.materials = {{"steel", {210e9, 0.3, {}}}, {"alloy", {70e9, {}, 26e9}}};
    m_.sections = {{"round", {RoundSection{0.02}}},
                   {"tube", {TubeSection{0.03, 0.02}}},
                   {"flat", {RectangleSection{0.012, 0.025}}},
                   {"given", {GivenSection{3e-4, 4e-9, 9e-9, 6e-9, 2e-4, 2.5e-4}}}};
  }

  /// Six motors or slides with flexible members between them.
  Mechanism serial() {
    m_.kinematics = Chains();
    for (int i = 0; i < 6; ++i) {
      add(m_.leg, "drive", actuator());
      add(m_.leg, "member", member());
    }
    add(m_.leg, "tool", offset());
    return m_;
  }

  /// Legs side by side, each with parts of its own. Three to five legs leave four freedoms each, six leave five.
  Mechanism parallel(int legs) {
    Placement home{random_vector(random_, 0.2) + Vector3(0, 0, 0.8), random_vector(random_, 0.3)};
    m_.kinematics = Chains{home, {}};
    for (int i = 0; i < legs; ++i) {
      Mount mount;
      mount.base = {random_vector(random_, 0.6), random_vector(random_, 0.5)};
      mount.leg = leg(legs == 6 ? 5 : 4);
      close(mount, frame_of(home));
      m_.mounts.push_back(mount);
    }
    return m_;
  }

  /// An arm that carries three rods side by side, held by ball joints below and fixed above, and a member behind them.
  Mechanism nested() {
    serial();
    Parallel group;
    Frame end = frame_of({random_vector(random_, 0.1) + Vector3(0, 0, 0.5), random_vector(random_, 0.5)});
    for (int branch = 0; branch < 3; ++branch) {
      Mount mount;
      mount.base = {random_vector(random_, 0.3), random_vector(random_, 0.5)};
      Joint ball;
      ball.axes = "before";
      ball.type = branch == 0 ? "universal" : "ball";
      turn_home(ball);
      add(mount.leg, "foot", ball);
      add(mount.leg, "rod", member());
      close(mount, end);
      group.mounts.push_back(mount);
    }
    m_.leg.insert(m_.leg.begin() + 4, {"group", group});
    return m_;
  }

 private:
  double uniform(double low, double high) { return test::uniform(random_, low, high); }
  std::size_t any(std::size_t count) { return random_() % count; }

  void add(Named<Part>& parts, const char* name, const Part& part) {
    parts.emplace_back(fmt::format("{}_{}", name, parts.size() + 1), part);
  }

  Part member() {
    Member out;
    out.section = m_.sections[any(m_.sections.size())].first;
    out.material = m_.materials[any(2)].first;
    out.along = random_vector(random_, 0.3) + Vector3(0, 0, 0.3);
    out.beam = static_cast<BeamTheory>(any(2));
    out.bending_factor = uniform(0.5, 1);
    return out;
  }

  Part offset() {
    Offset out;
    out.shift = random_vector(random_, 0.2);
    out.turn = random_vector(random_, 1);
    return out;
  }

  void turn_home(Joint& joint) {
    const std::array<Freedom, 6> freedoms = freedoms_of(find_joint_type(joint.type)->letters);
    for (std::size_t i = 0; i < 6; ++i)
      if (movable(freedoms[i])) joint.home[i] = uniform(-1, 1) * (i < 3 ? 0.1 : 0.6);
  }

  Joint actuator() {
    Joint out;
    out.type = any(2) ? "motor" : "prismatic";
    out.axis = random_vector(random_, 1);
    out.axes = any(2) ? "before" : "after";
    turn_home(out);
    const bool motor = out.type == "motor";
    out.laws[motor ? 5 : 2] = {LinearLaw{motor ? uniform(1e4, 1e5) : uniform(1e6, 1e7)}};
    if (any(3) == 0) out.laws[0] = {LinearLaw{uniform(1e6, 1e7)}, LinearLaw{uniform(1e6, 1e7)}};
    return out;
  }

  Part flexure() {
    Joint out;
    out.axes = "before";
    if (any(2)) {
      MatrixX A = MatrixX::Zero(6, 6);
      for (Eigen::Index i = 0; i < 36; ++i) A(i) = uniform(-1, 1);
      Vector6 size;
      size << 2e3, 2e3, 2e3, 3e2, 3e2, 3e2;
      out.stiffness = size.asDiagonal() * (A * A.transpose() + MatrixX::Identity(6, 6)) * size.asDiagonal();
    } else {
      for (std::size_t i = 0; i < 6; ++i)
        if (any(2)) out.laws[i] = {LinearLaw{i < 3 ? uniform(1e6, 1e7) : uniform(1e4, 1e5)}};
    }
    return out;
  }

  /// Passive joints that leave so many freedoms, a drive, members, perhaps a flexure.
  Named<Part> leg(int freedoms) {
    static const std::vector<std::vector<const char*>> of_four = {{"ball", "revolute"},
                                                                  {"universal", "cylindrical"},
                                                                  {"universal", "revolute", "slider"},
                                                                  {"revolute", "revolute", "universal"},
                                                                  {"ball", "slider"}};
    static const std::vector<std::vector<const char*>> of_five = {{"ball", "universal"},
                                                                  {"ball", "cylindrical"},
                                                                  {"universal", "cylindrical", "revolute"},
                                                                  {"ball", "revolute", "revolute"},
                                                                  {"universal", "universal", "revolute"}};
    const auto& choices = freedoms == 4 ? of_four : of_five;
    Named<Part> parts;
    add(parts, "drive", actuator());
    add(parts, "member", member());
    for (const char* type : choices[any(choices.size())]) {
      Joint joint;
      joint.type = type;
      joint.axis = random_vector(random_, 1);
      joint.axes = any(2) ? "before" : "after";
      turn_home(joint);
      if (any(4) == 0) joint.laws[0] = {LinearLaw{uniform(1e6, 1e7)}};  // rigid in every type above
      add(parts, "joint", joint);
      add(parts, "member", member());  // joints in one place could move and leave the platform at rest
      if (any(3) == 0) add(parts, "offset", offset());
      if (any(3) == 0) add(parts, "flexure", flexure());
    }
    return parts;
  }

  /// Puts the mount on the platform where the walk ends when the platform is at `target`.
  void close(Mount& mount, const Frame& target) {
    const LegParts leg{mount, mount.leg};
    const Frame end = walk(one(leg), home_states(one(leg))).legs[0].end;  // of a platform mounted at the end itself
    const Frame seat = target.inverse() * end;
    mount.platform = {seat.p, rpy_from_rotation(seat.R)};
  }

  std::mt19937 random_;
  Mechanism m_;
};

/// Arms, three to six legs, arms with a parallel stage: as many of each kind.
inline std::vector<Mechanism> mechanisms(int of_each) {
  std::vector<Mechanism> all;
  for (int i = 0; i < of_each; ++i) {
    const auto seed = static_cast<unsigned>(10 * i);
    all.push_back(RandomMechanism(seed).serial());
    all.push_back(RandomMechanism(seed + 1).nested());
    for (int legs = 3; legs <= 6; ++legs)
      all.push_back(RandomMechanism(seed + static_cast<unsigned>(legs)).parallel(legs));
  }
  return all;
}

/// What rounding may make of a compliance between two ways to the same: members and joints are stiffnesses that differ
/// by 1e3 or so, which leaves 1e-13 of what they are assembled to, and the compliance has its condition times that.
/// Most mechanisms by the dice have one of some hundreds; a few nearly fall over.
inline double rounding(const Matrix6& C, double length) {
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(length);
  const Vector6 s = Eigen::JacobiSVD<Matrix6>(w.asDiagonal() * C * w.asDiagonal()).singularValues();
  return 1e-11 + 2e-13 * s(0) / s(5);
}

}  // namespace deflect::test
