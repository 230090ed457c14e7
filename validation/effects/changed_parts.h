// What an edit of a description changed in the machine: the parts that yield, weigh or fit otherwise than before.
#pragma once

#include <string>
#include <vector>

#include "msa/mechanism/configuration.h"

namespace deflect::effects {

struct ChangedPart {
  std::string leg;  ///< "leg 4", of a branch "leg 4 parallelogram 2"; empty outside the legs
  std::string
      part;  ///< as in the description; empty for the seat of a leg; "base", "tool", "platform" outside the legs
  bool operator==(const ChangedPart&) const = default;
};

/// Parts by name, leg by leg: laws, freedoms, preloads of joints, sections and materials of members, misfits of legs,
/// the weight at the platform, parts and legs that are new. Places do not count: they follow from those.
std::vector<ChangedPart> changed_parts(const Configuration& before, const Configuration& after);

}  // namespace deflect::effects
