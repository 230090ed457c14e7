// How much could be told at all: an answer by exact Bayes, which knows the list of effects, their priors, the sizes
// that are drawn (λ = 4, 8 or 16) and the noise.
#pragma once

#include "tests/benchmark/hidden.h"

namespace deflect::benchmark {

class Oracle {
 public:
  /// `place`: how probable a law at a place is, `entry`: an entry of the catalogue; the rest is nothing.
  Oracle(const Plan&, double place, double entry, std::uint64_t seed, int threads);

  struct Answer {
    std::string first;         ///< the most probable effect, "" for nothing
    double probability = 0;    ///< of it
    std::size_t reported = 0;  ///< how many it takes, the most probable first, to have 95 % of the probability
  };
  /// Of a whitened residual (Σ^(−1/2) (measured − predicted)).
  Answer answer(const VectorX& residual) const;

 private:
  /// One of the things that can be hidden: of an effect, at a place, with a sign and a size.
  struct Case {
    const effects::Effect* effect;
    double prior;
    VectorX change;
  };
  double nothing_;
  std::vector<Case> cases_;
};

}  // namespace deflect::benchmark
