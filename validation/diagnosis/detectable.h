// What a campaign can show, before it is asked what is missing.
#pragma once

#include "validation/diagnosis/signatures.h"

namespace deflect::diagnosis {

/// What this campaign would show of an effect.
struct Detectable {
  effects::PlacedEffect effect;
  double lambda_at_start = 0;    ///< norm of its signature at the start values
  std::vector<double> smallest;  ///< values at which λ = 4; empty where they are outside the bounds
  std::string mistaken_for;      ///< the entry that is most like it, where the cosine is above 0.9
  double cosine = 0;
};

std::vector<Detectable> detectable_sizes(const std::vector<Signature>&);

}  // namespace deflect::diagnosis
