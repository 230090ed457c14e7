// What sensors inside the legs read: the force of a drive, the motion of a body.
//
// The force of a drive is that in its freedom, as everywhere in this project positive where it lengthens what is
// elastic there: it acts along +z of the joint (about it, Nm) on the part before the drive and along −z on the part
// after it. So it is the force with which the mechanism behind the drive pulls at it, and a motor that holds its
// commanded position exerts minus this force on the part that it moves. Like displacements it is counted from the
// assembled, unloaded, weightless machine.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "msa/mechanism/configuration.h"

namespace deflect {

/// A place inside a leg of a configuration.
struct Inside {
  std::size_t leg = 0;  ///< of Configuration::legs
  /// The part in the leg; in a branch: the part with branches, the branch, the part in it, and so on.
  std::vector<std::size_t> parts;
  /// Force in this freedom of the joint, N or Nm; none: [δ; θ] of the body that follows the part, δ of its point at T.
  std::optional<std::size_t> freedom;
  bool operator==(const Inside&) const = default;
};

/// The part that a path names: "leg.2.actuator"; of a machine with one leg also "leg.actuator"; in a branch
/// "leg.2.forearm.1.knee", where all branches are alike or there is one also without the number.
///
/// Throws InputError "'leg.2.motor': there is no 'motor' (known: …)" where it names no joint or member; for a force
/// where the joint is not driven, or in several freedoms of which the path names none ("leg.2.motor.rz").
struct NamedPart {
  int leg = 0;                        ///< 1-based
  std::vector<std::string> names;     ///< of parts, from without to within
  std::vector<std::size_t> branches;  ///< between them, 0-based
  std::optional<std::size_t> freedom;
};
NamedPart part_of_drive(const Mechanism&, const std::string& path);
NamedPart part_of_body(const Mechanism&, const std::string& path);

/// The same in a configuration of the mechanism.
Inside placed(const NamedPart&, const Configuration&);

/// What a sensor inside a leg reads; nullopt for a sensor on the platform or the tool.
std::optional<NamedPart> inside_part(const Mechanism&, const PointSensor&);

/// Where the part ends, and its axes: a joint's before its motion, a member's with x along it.
struct PartEnd {
  Vector3 p_W;
  Matrix3 R_W;
};
PartEnd end_of(const Inside&, const Configuration&);

/// The part itself.
const PlacedPart& part_at(const Inside&, const Configuration&);

/// Sets what follows from the rest: `direction` of a drive, its freedom, and whether it turns. Throws as
/// part_of_drive() and part_of_body(), with "sensors.NAME: " before it.
void complete_sensor(const Mechanism&, PointSensor&);

}  // namespace deflect
