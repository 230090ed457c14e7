// Random devices for the deformed shape: those of random_device.h with more of what turns with the parts, under a load
// that moves the tool point by 1e-4 to 3e-2 of the device's size.
#pragma once

#include <optional>

#include "msa/mechanism/stand.h"
#include "tests/attack/random_device.h"

namespace deflect::attack {

struct ShapedDevice {
  RandomDevice random;
  Stand at;
  double share = 0;  ///< of its size that the load moves T in linear geometry
  VectorX posed;     ///< coordinates of its joints, where it does not stand at home
};

/// Joints with stiffnesses of all six freedoms more often, springs and such joints as base and tool, a payload, joints
/// away from home, loads that act beside T; with `laws` nonlinear ones at about half of the elastic freedoms, tables
/// that soften among them. Nothing where the machine cannot stand in linear geometry or nothing yields.
std::optional<ShapedDevice> shaped_device(unsigned seed, bool laws);

}  // namespace deflect::attack
