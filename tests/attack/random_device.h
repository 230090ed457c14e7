// Devices by the dice: one to six legs of joints of every type, members, offsets, joints with six coupled stiffnesses,
// stages in parallel inside a leg; 1 mm to 1 km large, stiffnesses up to 1e12 apart. They close at home by
// construction: each leg is walked with its joints at home, and its mount on the platform is put where the walk ends.
#pragma once

#include "msa/mechanism/description.h"

namespace deflect::attack {

/// aligned: directions along the axes and places on a coarse grid, so that joints coincide and axes are parallel.
enum class DeviceKind { serial, parallel, nested, aligned, stiff_and_soft };
inline constexpr const char* device_kind_names[] = {"serial", "parallel", "nested", "aligned", "stiff and soft"};

struct RandomDevice {
  unsigned seed = 0;
  DeviceKind kind = DeviceKind::serial;
  Mechanism mechanism;
  Vector6 load = Vector6::Zero();  ///< at T, N and Nm
  double unit = 1;                 ///< m: its lengths are of this order
};

RandomDevice random_device(unsigned seed);

/// About half of its elastic freedoms follow power, hardening or one-sided laws, or have play or friction in series; so
/// strong that the load is felt by them.
RandomDevice with_nonlinear_laws(RandomDevice);

/// All lengths times s, moduli the same; the load to match. Displacements become s times what they were, rotations
/// stay.
RandomDevice scaled(RandomDevice, double s);

/// Moduli, stiffnesses and the load times c: displacements stay.
RandomDevice in_force_unit(RandomDevice, double c);

/// Legs in another order.
RandomDevice reordered(RandomDevice);

/// Base axes turned by the rotation R: p → R p. Displacements become R times what they were.
RandomDevice turned(RandomDevice, const Matrix3& R);

}  // namespace deflect::attack
