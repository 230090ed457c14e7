// What the laws at each place could take off a residual together.
//
// What is missing at a place may be a law that nobody wrote. The signatures of all laws at the place span what such a
// law can do to the readings, as a curve drawn by hand is a sum of a few shapes; any friction is tried as well, and any
// curve of deflection over force at the places whose laws explain most (whatever_the_law.h). With g the
// reduction of χ² by such a span, beside the fit, and k its dimension, its evidence is log_evidence(g, k) (evidence.h),
// divided by the number of spans from which it was chosen by its gain, and that of the place the mean over its spans.
//
// Where the unexplained rest of a misfit acts is told by the same gains. What no place explains makes places harder to
// tell apart: the gains are divided by s = max(1, χ² left by the best place over the numbers left).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/diagnosis/signatures.h"

namespace deflect::diagnosis {

/// Explanations as these observations weigh them. What was found counts as right (Observations::granted()), which moves
/// the tolerances; a residual weighed so is to be explained by columns weighed alike.
class Weighed {
 public:
  Weighed(const Explanations& as_they_are) : all_(&as_they_are) {}
  /// The signatures must outlive it.
  Weighed(const SignaturesAtPlaces&, const Observations&);

  const Explanations& all() const { return *all_; }
  /// Of one of the laws of all(). Computed at each call: kept for all laws they would take as much memory again.
  Signature law(const Signature&) const;
  PlaceWithoutLaw place(const PlaceWithoutLaw&) const;

 private:
  const Explanations* all_;
  const SignaturesAtPlaces* signatures_ = nullptr;
  std::shared_ptr<const Observations> observations_ = nullptr;
};

/// A place in all legs, or in one of them.
struct AtPlace {
  const Signature* best = nullptr;  ///< of the laws at the place the one that explains most; null without any
  const PlaceWithoutLaw* without_law = nullptr;  ///< where there is none
  bool other_way = false;                        ///< physics lets that one act to the other side only
  /// What may explain it: all laws together; of frictions those that gain much; where curves are tried, of each
  /// kind any curve, alone and beside the laws.
  /// Of the finer lines, alone, only the few bends that gain much, at the places that explain nearly as much as any,
  /// where what they leave is more than noise.
  struct Span {
    double gain = 0;  ///< in χ²
    int dimension = 0;
    double log_ways = 0;  ///< ln of the number of spans from which it was chosen by its gain
    bool rubs = false;    ///< it is of frictions
  };
  std::vector<Span> spans;
  /// Prior probability of each span. All places share it alike, and the single legs of a place share that of one place.
  double prior = 0;

  /// The one that gains most.
  const Span& most() const;
  /// ln of the prior times the evidence, of all spans together, where noise has that many times the variance it has.
  double log_odds(double noise = 1) const;
  const subject::Place& place() const { return best ? *best->effect.effect->place : without_law->place; }
};

/// Beside the fit of these effects, in the order of the signatures; places whose laws do nothing beside it are left
/// out. Any curve is tried at the places of the effects too. The explanations must be weighed as the fit is and outlive
/// the result.
std::vector<AtPlace> at_places(const Weighed&, const Hypothesis& fitted, const Fit&, int threads);

/// The same beside each of several fits that are weighed alike. What a law does there is found once for all of them.
struct Fitted {
  const Hypothesis& effects;
  const Fit& fit;
};
std::vector<std::vector<AtPlace>> at_places(const Weighed&, const std::vector<Fitted>&, int threads);

/// ln of the evidence that an unknown law acts at one of the places, over all places by their priors. ln 0 without any.
double log_evidence(const std::vector<AtPlace>&);

/// Chance that some place gains as much where there is only noise, at most (Bonferroni, by the priors).
double p_value(const std::vector<AtPlace>&);

struct Localised {
  subject::Place place;
  std::optional<int> leg;
  const effects::Effect* effect = nullptr;  ///< of the laws at the place the likeliest; null without any, or if it rubs
  std::string what;        ///< "the actuator rx of every leg yields like a spring", "forearm, by none of the laws"
  double share = 0;        ///< of χ² beyond noise and tolerances that the place can explain beside the fit
  double probability = 0;  ///< that it acts there and at no other place
};

/// The places for the residual of a fit with that χ² of `numbers` measured numbers, the most probable first, until they
/// have 95 % of the probability together, at most `most`. Empty where none reduces χ² clearly more than chance (by 30).
std::vector<Localised> localised(const std::vector<AtPlace>&, double chi2, double numbers, std::size_t most = 3);

}  // namespace deflect::diagnosis
