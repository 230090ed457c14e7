// A machine as it was built: every part a little off its drawing, within the tolerances that the device declares.
#pragma once

#include <vector>

#include "msa/mechanism/configuration.h"

namespace deflect::prediction {

struct LegAsBuilt {
  Vector3 base_joint = Vector3::Zero();      ///< m, base axes: where the leg stands on the base
  Vector3 platform_joint = Vector3::Zero();  ///< m, platform axes: where it stands on the platform
  double link_length = 0;                    ///< m; of the family "6-psu"
  double guide_diameter = 0;                 ///< relative; of the first member from the base
};

/// Zero is as drawn.
struct AsBuilt {
  double modulus = 0;            ///< relative, of every member
  std::vector<LegAsBuilt> legs;  ///< one per leg of the mechanism, or none
};

/// The mechanism with the joints and links where they are. A serial arm without mounts has no seats that matter.
Mechanism with_geometry(const Mechanism& drawn, const AsBuilt&);

/// Where a machine of that geometry stands when the controller, which knows the drawing only, has led it to the pose of
/// `drawn`: the actuators stand where the drawing wants them, but for their errors (m, rad; one per actuator, or
/// none). Members have the moduli and diameters of the machine: A ∝ d², I and J ∝ d⁴.
Configuration configure_as_built(const Mechanism& geometry, const AsBuilt&, const Configuration& drawn,
                                 const VectorX& actuator_errors = {});

}  // namespace deflect::prediction
