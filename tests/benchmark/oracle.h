// How much could be told at all: an answer by exact Bayes, which knows the list of effects, their priors, the sizes
// that are drawn (λ = 4, 8 or 16) and the noise.
//
// Where two effects may be hidden it also knows that both have the same λ, 8 or 16. What two do together is taken as
// the sum of what each does alone.
#pragma once

#include <string>
#include <vector>

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

  /// The most probable list of effects where none, one or two may be hidden, with probabilities 1/5, 3/5 and 1/5 before
  /// the data.
  std::vector<std::string> answer_of_two(const VectorX& residual) const;

 private:
  /// One of the things that can be hidden: of an effect, at a place, with a sign and a size.
  struct Case {
    const effects::Effect* effect;
    double lambda;
    double prior;
    VectorX change;
  };
  double nothing_;
  std::vector<Case> cases_;
  MatrixX between_;  ///< inner products of the changes
};

}  // namespace deflect::benchmark
