// The effects of a tie as hypotheses, and how far readings would tell them apart.
//
// Truth a, rival b, each as it was fitted, with parameters drawn from what the readings taken say of them. b is fitted
// again, to first order, to what a would read; tolerances bend as far as their priors and what was read allow. What is
// then left, λ²_ab (design.h), is by how much 2 ln L of a is expected to exceed that of b (T-optimality: Atkinson,
// Fedorov 1975). What the readings taken say is in the probabilities of the rivals already: all below is the increase
// of λ² beyond theirs. The expected log Bayes factor is Δ = λ²/2, and 2 ln of the ratio of likelihoods ~ N(λ², 4 λ²).
#pragma once

#include <string>
#include <vector>

#include "validation/diagnosis/found_effects.h"
#include "validation/diagnosis/hypothesis.h"
#include "validation/plan/choice.h"
#include "validation/plan/prospect.h"

namespace deflect::plan {

struct Rival {
  diagnosis::Hypothesis hypothesis;  ///< what was found beside it first; itself last
  VectorX values;                    ///< as fitted together
  double probability = 0;            ///< among the rivals

  const effects::PlacedEffect& own() const { return hypothesis.back(); }
};

/// The rivals of a tie that a diagnosis found; their probabilities sum to 1. Throws InputError as
/// diagnosis::instance() does. The effects must outlive them.
std::vector<Rival> rivals_of(const diagnosis::FoundTie&, const std::vector<effects::Effect>&);

subject::Subject subject_with(const subject::Subject&, const Rival&, const VectorX& values);

/// Two of the rivals and λ² between them: mean over the draws and both as the truth.
struct Pair {
  std::size_t a = 0, b = 0;
  double separation = 0;
  double least = 0;  ///< smallest of the draws
};

/// All rivals against each other.
class Rivalry {
 public:
  /// `draws`: of each rival's parameters, the fit itself first. Rivals whose prediction fails are an InputError with
  /// the reason; a draw that fails is left out.
  Rivalry(const Prospect&, const subject::Subject&, std::vector<Rival>, int draws, std::uint64_t seed,
          const parallel::Work&);

  const std::vector<Rival>& rivals() const { return rivals_; }
  /// By how much all readings of the prospect raise Q (design.h) above those taken, by fitted rival.
  std::vector<MatrixX> gain_of_all() const;
  /// What it says of each two.
  std::vector<Pair> pairs(const std::vector<MatrixX>& gain) const;
  /// Probability that is expected of the true one, mean over truths and draws.
  double probability(const std::vector<MatrixX>& gain) const;

 private:
  friend class RivalryAim;
  struct Target {
    std::size_t truth = 0, draw = 0;
  };
  Design design(std::size_t fitted, bool all) const;

  const Prospect& prospect_;
  std::vector<Rival> rivals_;
  std::vector<MatrixX> beside_;              // by fitted rival: derivatives, whitened
  std::vector<VectorX> prior_;               // variances of its coordinates
  std::vector<MatrixX> targets_;             // by fitted rival
  std::vector<std::vector<Target>> origin_;  // of each column of them
};

/// The aim of a plan: −8 ln ⟨exp(−λ²/8)⟩ over the pairs that are not `hopeless`, their truths and draws: the bound of
/// Bhattacharyya on the probability of taking the wrong one. Reached once the expected probability of the true one is
/// `wanted`. The rivalry must outlive it.
class RivalryAim final : public Aim {
 public:
  RivalryAim(const Rivalry&, const std::vector<Pair>& hopeless, double wanted);

  double value() const override { return soft_least(gain_); }
  double with(std::size_t block) const override;
  void take(std::size_t block) override;
  void drop(std::size_t block) override;
  std::unique_ptr<Aim> copy() const override { return std::make_unique<RivalryAim>(*this); }
  bool reached() const override { return rivalry_->probability(gain_) >= wanted_; }

  /// By how much the blocks taken raise Q.
  const std::vector<MatrixX>& gain() const { return gain_; }

 private:
  WhiteRows rows(std::size_t block, std::size_t fitted) const;
  double soft_least(const std::vector<MatrixX>& gain) const;

  const Rivalry* rivalry_;
  double wanted_;
  std::vector<Design> designs_;
  std::vector<MatrixX> before_, gain_;     // Q of the readings taken; what is added to it
  std::vector<std::vector<bool>> counts_;  // by design and target
};

}  // namespace deflect::plan
