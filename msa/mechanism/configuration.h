// A mechanism at a pose: every joint and member placed in the base frame, names resolved to numbers. The two theories
// depend on nothing else.
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

/// A joint at p_W with axes R_WJ (columns are the joint's x, y, z in W). Freedoms are those of the joint table. laws[i]
/// are in series on freedom i, materials resolved; a law makes the freedom elastic whatever freedoms[i] is. The axes
/// rotate with the part before the joint. In finite motions the freedoms move in the order tx ty tz rx ry rz.
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

/// Branches in parallel between two rigid bodies, which contain the points p_W_start and p_W_end.
struct PlacedParallel {
  std::string part;
  Vector3 p_W_start = Vector3::Zero(), p_W_end = Vector3::Zero();
  std::vector<PlacedLeg> branches;
  /// Represents one joint of the description with laws in parallel: the joint is the first branch, each parallel law
  /// one more branch.
  bool one_joint = false;
};

using PlacedPart = std::variant<PlacedJoint, PlacedMember, PlacedParallel>;

/// The joint of the description that the part represents, with or without parallel laws; null where it is no joint.
const PlacedJoint* joint_of(const PlacedPart&);

struct PlacedLeg {
  std::string name;               ///< "leg 1"; for a branch "leg 1 parallelogram 2"
  std::vector<PlacedPart> parts;  ///< base to platform; neighbours are rigidly attached to one another
  /// Small twist [δ; θ] at T, base axes: position of the leg's unstrained end relative to its seat on the platform.
  Vector6 misfit = Vector6::Zero();
  bool beside = false;  ///< a joint in parallel with the legs, which does not guide the platform
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
  /// In parallel between the base and the platform; a serial arm is one leg. Those with `beside` come last.
  std::vector<PlacedLeg> legs;
  std::vector<Actuator> actuators;   ///< leg by leg
  Vector3 weight = Vector3::Zero();  ///< N at T, acts with and without load
  /// m: the mechanism's extent from T; weighs moments against forces in rank decisions.
  double size = 0;
  /// Of the family "chains": how its joints stand (chain_kinematics.h).
  std::shared_ptr<const struct ChainAssembly> assembly;
};

/// Calls f(part) for every PlacedJoint and PlacedMember of the legs, including branches, base to platform.
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

/// Calls f(law) for every law of every joint, first of the legs in the order of for_each_part, then of base and tool;
/// within a joint from tx to rz.
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

/// Whether no law's stiffness depends on its force; whether any has a history (law.h).
bool all_linear(const Configuration&);
bool any_history(const Configuration&);

/// Numbers what laws with a history keep (Conditions::slips) in the order of for_each_law: one number of a friction,
/// two of a table that remembers. Returns how many there are.
int number_slips(Configuration&);

/// Number of legs, without joints beside them.
int leg_count(const Mechanism&);

/// Throws ModelError with leg and limit where the pose is out of reach, or with the lost direction where it is
/// singular; InputError where a name does not resolve. `known`: where a mechanism stands that may have the same
/// kinematics at the same pose; if so, its joint states are taken and the result is the same, to the last bit.
Configuration configure(const Mechanism&, const Pose&, const Configuration* known = nullptr);

/// One device at many poses, with names resolved once. For the family "6-psu" nothing is allocated after the first
/// pose.
class Posing {
 public:
  explicit Posing(const Mechanism&);  ///< must outlive it
  ~Posing();
  Posing(const Posing&) = delete;
  Posing& operator=(const Posing&) = delete;

  /// Bit-identical to configure(), with the same errors. Valid until the next call.
  const Configuration& at(const Pose&);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The same from commanded joint coordinates, one per actuator (m, rad), by closing the loops from home. Here a
/// singular pose is no error.
Configuration configure_joints(const Mechanism&, const VectorX& coordinates, const Configuration* known = nullptr);

/// The pose from which the kinematics start and about which the workspace lies.
Pose home_pose(const Mechanism&);

/// The actuators whose coordinates configure_joints() expects, with their values at home.
std::vector<Actuator> actuators_of(const Mechanism&);

}  // namespace deflect
