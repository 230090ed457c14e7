// A mechanism at a pose: every joint and member placed in the base frame, names resolved to numbers. This is all
// that the two theories get to see.
#pragma once

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "msa/base/spatial.h"
#include "msa/mechanism/description.h"
#include "msa/mechanism/joint_table.h"

namespace deflect {

/// A joint at p_W with axes R_WJ (columns are the joint's x, y, z in W). Freedoms are those of the joint table;
/// laws[i] in series on freedom i, materials resolved; a law makes the freedom elastic whatever freedoms[i] says.
struct PlacedJoint {
  std::string part;
  Vector3 p_W = Vector3::Zero();
  Matrix3 R_WJ = Matrix3::Identity();
  std::array<Freedom, 6> freedoms{};
  std::array<std::vector<Law>, 6> laws;

  bool elastic(std::size_t i) const { return !laws[i].empty(); }
  bool free(std::size_t i) const { return freedoms[i] == Freedom::free && laws[i].empty(); }
};

/// A straight member from p_W_start to p_W_end with axes R_WM, x along it.
struct PlacedMember {
  std::string part;
  Vector3 p_W_start, p_W_end;
  Matrix3 R_WM;
  SectionProperties section;  ///< Iy, Iz already times the bending factor
  double E = 0, G = 0;        ///< Pa
  BeamTheory beam = BeamTheory::euler_bernoulli;

  double length() const { return (p_W_end - p_W_start).norm(); }
};

using PlacedPart = std::variant<PlacedJoint, PlacedMember>;

struct PlacedLeg {
  std::string name;               ///< "leg 1"
  std::vector<PlacedPart> parts;  ///< base to platform; neighbours are rigidly attached to one another
  double actuator = 0;            ///< joint coordinate, m
};

struct Configuration {
  Pose pose;
  PlacedJoint base, tool;
  std::vector<PlacedLeg> legs;
};

/// Throws ModelError naming leg and limit when the pose is out of reach, InputError on names that do not resolve.
Configuration configure(const Mechanism&, const Pose&);

}  // namespace deflect
