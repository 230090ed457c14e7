// Functions that every family of mechanisms (variant Kinematics) provides: one overload for each family.
#pragma once

#include "msa/mechanism/configuration.h"
#include "msa/mechanism/six_psu.h"

namespace deflect {

/// The points at which a leg is attached to base and platform.
struct Seats {
  Vector3 p_W_base, p_W_platform;
};

struct PlacedMechanism {
  Pose pose;
  std::vector<PlacedLeg> legs;
  std::vector<Seats> seats;  ///< of the legs
  std::vector<Actuator> actuators;
  std::shared_ptr<const ChainAssembly> assembly = {};
};

/// Places the parts of a 6-PSU at any pose, with names resolved.
class SixPsuMoves {
 public:
  /// Throws InputError where a name does not resolve.
  SixPsuMoves(const SixPsu&, const Mechanism&);
  /// Whether move() can handle the result of place(): every part must be placed as one, without joints with parallel
  /// laws and without members whose ends yield.
  bool hold(const std::vector<PlacedLeg>&) const;
  /// Moves the result of place() to another pose without allocation. Throws ModelError as place() does.
  void move(const SixPsu&, const Pose&, std::vector<PlacedLeg>&, std::vector<Actuator>&, std::vector<Seats>&) const;

 private:
  struct Move {
    std::size_t leg, first, second;                           // point and axes of a joint, points of a member
    std::vector<std::pair<std::size_t, std::size_t>> cables;  // freedom and law; their length is the slider's extension
  };
  std::vector<SixPsuDrawing> drawn_;
  std::vector<std::vector<Move>> moves_;  // one for each of PlacedMechanism::legs
};

/// InputError where another number of joint coordinates is given than the mechanism has.
void require_count(const Mechanism&, Eigen::Index has, const VectorX& given);

/// Implement configure(), configure_joints(), home_pose() and actuators_of() for the families.
PlacedMechanism place(const SixPsu&, const Mechanism&, const Pose&, const ChainAssembly* known);
PlacedMechanism place_joints(const SixPsu&, const Mechanism&, const VectorX& coordinates, const ChainAssembly* known);
Pose home_pose(const SixPsu&, const Mechanism&);
std::vector<Actuator> actuators_of(const SixPsu&, const Mechanism&);

PlacedMechanism place(const Chains&, const Mechanism&, const Pose&, const ChainAssembly* known);
PlacedMechanism place_joints(const Chains&, const Mechanism&, const VectorX& coordinates, const ChainAssembly* known);
Pose home_pose(const Chains&, const Mechanism&);
std::vector<Actuator> actuators_of(const Chains&, const Mechanism&);

}  // namespace deflect
