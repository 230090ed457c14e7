// The mechanism at every pose that was measured.
#pragma once

#include <span>
#include <vector>

#include "msa/mechanism/configuration.h"
#include "validation/measurement/measurements.h"

namespace deflect::measurement {

/// One configuration per Measurements::poses, by inverse kinematics or, where joint coordinates were commanded, by
/// forward kinematics. Throws InputError where number or kind (rad, mm) of the joint coordinates is not the device's,
/// ModelError "file:line: column 'pose': …" for the first pose where the mechanism cannot stand. `known`: a mechanism
/// at the same poses that may have the same kinematics (configuration.h), or none.
std::vector<Configuration> configure_all(const Mechanism&, const Measurements&,
                                         std::span<const Configuration> known = {});

/// What a sensor reads.
Quantity quantity_of(const PointSensor&);

/// Where a sensor is, what it reads along which axis (base axes), and in words: "sensor on the platform", "force of
/// leg.2.actuator".
struct SensorPlace {
  Vector3 p_W = Vector3::Zero(), axis = Vector3::Zero();
  std::string what;
};
SensorPlace sensor_place(const Mechanism&, const PointSensor&, const Configuration&);

/// The named sensors and points of load of a device.
Instruments instruments_of(const Mechanism&);

/// Sets the load at T of every reading from the loads at T and at the device's named points: [f; m + r × f], where r
/// leads from T to the point at the commanded pose. Does nothing where the measurements have no loads at points.
Measurements place_loads(Measurements, const Mechanism&);

}  // namespace deflect::measurement
