// What effects a campaign can detect, and how large they must be.
#pragma once

#include "validation/diagnosis/signatures.h"

namespace deflect::diagnosis {

/// How well this campaign shows an effect.
struct Detectable {
  effects::PlacedEffect effect;
  double lambda_at_start = 0;    ///< norm of its signature at the start values
  std::vector<double> smallest;  ///< values at which λ = 4; empty where they are outside the bounds
  std::string mistaken_for;      ///< the most similar entry, where the cosine is at least 0.9
  double cosine = 0;
};

/// Of the entries of the catalogue; with `laws_at_places` of these too. `cosines`: of the signatures.
std::vector<Detectable> detectable_sizes(const std::vector<Signature>&, const MatrixX& cosines,
                                         bool laws_at_places = false);

}  // namespace deflect::diagnosis
