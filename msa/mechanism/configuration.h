// A mechanism at a pose: every joint and member placed in the base frame, names resolved to numbers. This is all
// that the two theories get to see.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "msa/base/spatial.h"
#include "msa/mechanism/description.h"
#include "msa/mechanism/joint_table.h"

namespace deflect {

/// A joint at p_W with axes R_WJ (columns are the joint's x, y, z in W). Freedoms are those of the joint table;
/// laws[i] in series on freedom i, materials resolved; a law makes the freedom elastic whatever freedoms[i] says. The
/// axes turn with what stands before the joint; in finite motions the freedoms move in the order tx ty tz rx ry rz.
struct PlacedJoint {
  std::string part;
  Vector3 p_W = Vector3::Zero();
  Matrix3 R_WJ = Matrix3::Identity();
  std::array<Freedom, 6> freedoms{};
  std::array<std::vector<Law>, 6> laws;
  std::array<double, 6> preload{};   ///< N, Nm: force in the laws while the joint transmits none
  std::optional<Matrix6> stiffness;  ///< symmetric, positive definite; then all six freedoms are elastic

  bool elastic(std::size_t i) const { return stiffness || !laws[i].empty(); }
  bool free(std::size_t i) const { return freedoms[i] == Freedom::free && !elastic(i); }
  bool rigid() const {
    for (std::size_t i = 0; i < 6; ++i)
      if (elastic(i) || free(i)) return false;
    return true;
  }
};

/// A straight member from p_W_start to p_W_end with axes R_WM, x along it.
struct PlacedMember {
  std::string part;
  Vector3 p_W_start, p_W_end;
  Matrix3 R_WM;
  SectionProperties section;  ///< Iy, Iz already times the bending factor
  double E = 0, G = 0;        ///< Pa
  double expansion = 0;       ///< 1/K
  BeamTheory beam = BeamTheory::euler_bernoulli;

  double length() const { return (p_W_end - p_W_start).norm(); }
};

struct PlacedLeg;

/// Branches side by side between two rigid bodies, which hold the points p_W_start and p_W_end.
struct PlacedParallel {
  std::string part;
  Vector3 p_W_start = Vector3::Zero(), p_W_end = Vector3::Zero();
  std::vector<PlacedLeg> branches;
  /// It is one joint of the description, the first branch, with laws side by side, one in each other branch.
  bool one_joint = false;
};

using PlacedPart = std::variant<PlacedJoint, PlacedMember, PlacedParallel>;

/// The joint of the description that the part is, with or without laws side by side; null where it is none.
const PlacedJoint* joint_of(const PlacedPart&);

struct PlacedLeg {
  std::string name;               ///< "leg 1"; of a branch "leg 1 parallelogram 2"
  std::vector<PlacedPart> parts;  ///< base to platform; neighbours are rigidly attached to one another
  /// Small twist [δ; θ] at T, base axes, by which the leg's end, unstrained, stands beside its seat on the platform.
  Vector6 misfit = Vector6::Zero();
  bool beside = false;  ///< it leads no platform: a joint beside the mechanism's legs
};

/// A commanded coordinate: m or rad.
struct Actuator {
  std::string name;
  double value = 0;
  bool rotation = false;
};

struct Configuration {
  Pose pose;
  PlacedJoint base, tool;
  /// Side by side between the base and the platform; a serial arm is one. Those beside come last.
  std::vector<PlacedLeg> legs;
  std::vector<Actuator> actuators;   ///< leg by leg
  Vector3 weight = Vector3::Zero();  ///< N at T, acts with and without load
  /// m: the mechanism's extent from T; where ranks are decided, moments weigh against forces by it.
  double size = 0;
  /// Of the family "chains": how its joints stand (chain_kinematics.h).
  std::shared_ptr<const struct ChainAssembly> assembly;
};

/// Calls f(part) for every PlacedJoint and PlacedMember of the legs, those of branches too, base to platform.
template <class Legs, class F>
void for_each_part(Legs&& legs, const F& f) {
  for (auto& leg : legs)
    for (auto& part : leg.parts)
      if (auto* group = std::get_if<PlacedParallel>(&part))
        for_each_part(group->branches, f);
      else if (auto* joint = std::get_if<PlacedJoint>(&part))
        f(*joint);
      else
        f(std::get<PlacedMember>(part));
}

/// Calls f(law) for every law of a joint: of the legs, as for_each_part, then of base and tool; tx … rz, in order.
template <class Placed, class F>
void for_each_law(Placed& c, const F& f) {
  const auto of = [&](auto& joint) {
    for (auto& laws : joint.laws)
      for (auto& law : laws) f(law);
  };
  for_each_part(c.legs, [&](auto& part) {
    if constexpr (requires { part.laws; }) of(part);
  });
  of(c.base);
  of(c.tool);
}

/// Whether no law's stiffness depends on its force, and whether any law jumps (law_table.h).
bool all_linear(const Configuration&);
bool any_jumps(const Configuration&);

/// Numbers the frictions in the order of for_each_law; returns how many there are.
int number_slips(Configuration&);

/// Of the mechanism, those beside not counted.
int leg_count(const Mechanism&);

/// Throws ModelError naming leg and limit when the pose is out of reach, or when it is singular, naming the direction
/// that is lost; InputError on names that do not resolve. `known`: where a mechanism stands that may have the same
/// kinematics at the same pose; if so, its joint states are taken and the result is the same, to the last bit.
Configuration configure(const Mechanism&, const Pose&, const Configuration* known = nullptr);

/// One device at pose after pose, names resolved once. Of the family "6-psu" nothing is allocated after the first pose.
class Posing {
 public:
  explicit Posing(const Mechanism&);  ///< must outlive it
  ~Posing();
  Posing(const Posing&) = delete;
  Posing& operator=(const Posing&) = delete;

  /// As configure(), bit by bit; the same errors. Until the next call.
  const Configuration& at(const Pose&);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The same from commanded joint coordinates, one per actuator (m, rad), by closing the loops from home; a singular
/// pose is no error there.
Configuration configure_joints(const Mechanism&, const VectorX& coordinates, const Configuration* known = nullptr);

/// Where the kinematics start and the workspace lies.
Pose home_pose(const Mechanism&);

/// What configure_joints expects, with the values at home.
std::vector<Actuator> actuators_of(const Mechanism&);

}  // namespace deflect
