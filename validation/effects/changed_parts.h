// Which parts of the machine an edit of the description changed in stiffness, weight or misfit.
#pragma once

#include <string>
#include <vector>

#include "msa/mechanism/configuration.h"

namespace deflect::effects {

struct ChangedPart {
  std::string leg;  ///< "leg 4", for a branch "leg 4 parallelogram 2"; empty outside the legs
  std::string
      part;  ///< as in the description; empty for the seat of a leg; "base", "tool", "platform" outside the legs
  bool operator==(const ChangedPart&) const = default;
};

/// Compares parts by name, leg by leg: laws, freedoms and preloads of joints, sections and materials of members,
/// misfits of legs, the weight at the platform. New parts and legs count as changed. Positions are not compared: they
/// follow from the description.
std::vector<ChangedPart> changed_parts(const Configuration& before, const Configuration& after);

}  // namespace deflect::effects
