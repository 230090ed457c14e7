// What every family of mechanisms provides: one overload each, listed in the variant Kinematics.
#pragma once

#include "msa/mechanism/configuration.h"
#include "msa/mechanism/six_psu.h"

namespace deflect {

/// Where a leg stands on the base and on the platform.
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

/// Where the parts of a 6-PSU stand at any pose, names resolved.
class SixPsuMoves {
 public:
  /// Throws InputError on names that do not resolve.
  SixPsuMoves(const SixPsu&, const Mechanism&);
  /// Whether they do for what place() makes: every part is placed as one, no joint with laws side by side, no member
  /// between ends that yield.
  bool hold(const std::vector<PlacedLeg>&) const;
  /// What place() made for one pose, moved to another; nothing is allocated. Throws ModelError as place() does.
  void move(const SixPsu&, const Pose&, std::vector<PlacedLeg>&, std::vector<Actuator>&, std::vector<Seats>&) const;

 private:
  struct Move {
    std::size_t leg, first, second;                           // point and axes of a joint, points of a member
    std::vector<std::pair<std::size_t, std::size_t>> cables;  // freedom and law: as long as the slider stands out
  };
  std::vector<SixPsuDrawing> drawn_;
  std::vector<std::vector<Move>> moves_;  // as PlacedMechanism::legs
};

/// InputError where another number of joint coordinates is given than the mechanism has.
void require_count(const Mechanism&, Eigen::Index has, const VectorX& given);

/// At a pose, from joint coordinates, at home: as configure(), configure_joints(), home_pose() say.
PlacedMechanism place(const SixPsu&, const Mechanism&, const Pose&, const ChainAssembly* known);
PlacedMechanism place_joints(const SixPsu&, const Mechanism&, const VectorX& coordinates, const ChainAssembly* known);
Pose home_pose(const SixPsu&, const Mechanism&);
std::vector<Actuator> actuators_of(const SixPsu&, const Mechanism&);

PlacedMechanism place(const Chains&, const Mechanism&, const Pose&, const ChainAssembly* known);
PlacedMechanism place_joints(const Chains&, const Mechanism&, const VectorX& coordinates, const ChainAssembly* known);
Pose home_pose(const Chains&, const Mechanism&);
std::vector<Actuator> actuators_of(const Chains&, const Mechanism&);

}  // namespace deflect
