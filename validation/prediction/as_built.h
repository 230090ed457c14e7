// A machine as built: every part deviates a little from its drawing, within the tolerances declared in the device.
#pragma once

#include <vector>

#include "msa/mechanism/configuration.h"

namespace deflect::prediction {

struct LegAsBuilt {
  Vector3 base_joint = Vector3::Zero();      ///< m, base axes: shift of the leg's joint on the base
  Vector3 platform_joint = Vector3::Zero();  ///< m, platform axes: shift of its joint on the platform
  double link_length = 0;                    ///< m; family "6-psu" only
  double guide_diameter = 0;                 ///< relative; of the first member, counted from the base
};

/// Deviations from the drawing; all zero: as drawn.
struct AsBuilt {
  double modulus = 0;            ///< relative, of every member
  std::vector<LegAsBuilt> legs;  ///< one per leg of the mechanism, or none
};

/// The mechanism with shifted joints and changed link lengths. A serial arm without mounts is not changed.
Mechanism with_geometry(const Mechanism& drawn, const AsBuilt&);

/// The configuration of a machine with this geometry when the controller, which knows only the drawing, moves it to the
/// pose of `drawn`: actuator values as in the drawing plus their errors (m, rad; one per actuator, or none). Members
/// have the moduli and diameters as built: A ∝ d², I and J ∝ d⁴.
Configuration configure_as_built(const Mechanism& geometry, const AsBuilt&, const Configuration& drawn,
                                 const VectorX& actuator_errors = {});

}  // namespace deflect::prediction
