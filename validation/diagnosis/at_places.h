// What the laws at each place could take off a residual together.
//
// What is missing at a place may be a law that nobody wrote. The signatures of all laws at the place span what such a
// law can do to the readings, as a curve drawn by hand is a sum of a few shapes. With g the reduction of χ² by that
// span, beside the fit, and k its dimension, the evidence for the place is log_evidence(g, k) (evidence.h).
#pragma once

#include <vector>

#include "validation/diagnosis/signatures.h"

namespace deflect::diagnosis {

/// A place in all legs, or in one of them.
struct AtPlace {
  const Signature* best = nullptr;  ///< of the laws at the place the one that explains most
  bool other_way = false;           ///< physics lets that one act to the other side only
  double gain = 0;                  ///< in χ², by all laws together
  int dimension = 0;                ///< of their span
  /// Prior probability. All places share it alike, and the single legs of a place share that of one place.
  double prior = 0;
};

/// In the order of the signatures; places whose laws do nothing beside the fit are left out. The signatures must
/// outlive the result.
std::vector<AtPlace> at_places(const std::vector<Signature>&, const Fit&, int threads);

/// ln of the evidence that an unknown law acts at one of the places, over all places by their priors. ln 0 without any.
double log_evidence(const std::vector<AtPlace>&);

/// Chance that some place gains as much where there is only noise, at most (Bonferroni, by the priors).
double p_value(const std::vector<AtPlace>&);

}  // namespace deflect::diagnosis
