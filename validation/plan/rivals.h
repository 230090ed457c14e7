// The effects of a tie as hypotheses, and how far readings would tell them apart.
//
// Truth a, rival b, each as it was fitted, with parameters drawn from what the readings taken say of them. b is fitted
// again to what a would read; tolerances bend as far as their priors and what was read allow. What is then left, λ²_ab
// (design.h), is by how much 2 ln L of a is expected to exceed that of b (T-optimality: Atkinson, Fedorov 1975). Where
// readings are chosen, b is fitted to first order: about its fit to the data, or about its fits to what the truths
// would read (about()), which matters where a law bends. refitted() fits it to the end. What the readings taken say is
// in the probabilities of the rivals already: all below is the increase of λ² beyond theirs. The expected log Bayes
// factor is Δ = λ²/2, and 2 ln of the ratio of likelihoods ~ N(λ², 4 λ²).
#pragma once

#include <optional>
#include <vector>

#include "validation/plan/choice.h"
#include "validation/plan/rival.h"

namespace deflect::plan {

/// Two of the rivals and λ² between them: mean over the draws and both as the truth.
struct Pair {
  std::size_t a = 0, b = 0;
  double separation = 0;
  double if_a = 0, if_b = 0;  ///< where a, or b, is the truth
  double least = 0;           ///< smallest of the draws
};

/// Coordinates of each rival's parameters, fitted to what each truth would read: by rival and truth; none of its own.
using FitsToTruths = std::vector<std::vector<VectorX>>;

/// By how much readings raise λ² (design.h) above those taken: by linearisation of a rivalry and target.
using Gains = std::vector<VectorX>;

struct Refits {
  Gains gain;
  FitsToTruths at;  ///< to all readings, with the truth at its first draw
};

/// All rivals against each other.
class Rivalry {
 public:
  /// `draws`: of each rival's parameters (posterior.h), three at least or the fit itself. Rivals whose prediction fails
  /// are an InputError with the reason; a draw that fails is left out.
  Rivalry(const Prospect&, const subject::Subject&, std::vector<Rival>, int draws, std::uint64_t seed,
          const parallel::Work&);

  const std::vector<Rival>& rivals() const { return rivals_; }
  /// Of all readings of the prospect.
  Gains gain_of_all() const;
  /// The same with every rival fitted to the end, to the readings taken and to all (rival.h).
  Refits refitted(const parallel::Work&) const;
  /// The same rivals, each linearised about its fits to what the truths would read; where that fails, as before.
  Rivalry about(const FitsToTruths&, const parallel::Work&) const;
  /// What it says of each two.
  std::vector<Pair> pairs(const Gains&) const;
  /// Probability that is expected of the true one, mean over truths and draws.
  double probability(const Gains&) const;

 private:
  friend class RivalryAim;
  struct Target {
    std::size_t truth = 0, draw = 0;
  };
  /// One rival about one point, and the truths that are compared with it there.
  struct Linearisation {
    std::size_t fitted = 0;
    MatrixX beside;
    MatrixX targets;             // whitened
    std::vector<Target> origin;  // of each of their columns
  };
  Linearisation linearisation(std::size_t fitted, const Linearised&, const std::vector<std::size_t>& truths) const;
  std::vector<std::size_t> others(std::size_t fitted) const;
  Design design(const Linearisation&, bool all) const;

  const Prospect* prospect_;
  std::vector<Rival> rivals_;
  std::vector<RivalModel> models_;
  std::vector<Linearised> fits_;                                // to the data
  std::vector<std::vector<std::optional<VectorX>>> predicted_;  // by rival and draw; none where it failed
  std::vector<Linearisation> linearised_;
};

/// The aim of a plan: −8 ln ⟨exp(−λ²/8)⟩ over the pairs that are not `hopeless`, their truths and draws: the bound of
/// Bhattacharyya on the probability of taking the wrong one. Reached once the expected probability of the true one is
/// `wanted`. The rivalry must outlive it.
///
/// One design has the tolerances as nuisances and, as targets, what all linearisations compare and what they fit. With
/// Q of it, t a target and b what is fitted beside it, of prior variance V:
///   λ²_t = Q_tt − Q_tb (Q_bb + V⁻¹)⁻¹ Q_bt.
class RivalryAim final : public Aim {
 public:
  RivalryAim(const Rivalry&, const std::vector<Pair>& hopeless, double wanted);

  double value() const override { return soft_least(gain_); }
  double with(std::size_t block) const override;
  void take(std::size_t block) override { update(block, false); }
  void drop(std::size_t block) override { update(block, true); }
  std::unique_ptr<Aim> copy() const override { return std::make_unique<RivalryAim>(*this); }
  bool reached() const override { return rivalry_->probability(gain_) >= wanted_; }

  /// Of the blocks taken.
  const Gains& gain() const { return gain_; }

 private:
  /// What the readings say of one linearisation, whose columns of the design stand from `first` on.
  struct Said {
    Eigen::Index first = 0;
    VectorX tt;      // diagonal of Q
    MatrixX bt, bb;  // bb with V⁻¹
    VectorX separations() const;
    void add(const MatrixX& white, double sense);  // innovations of all columns
  };
  WhiteRows rows(std::size_t block) const;
  void update(std::size_t block, bool taken);
  double soft_least(const Gains&) const;

  const Rivalry* rivalry_;
  double wanted_;
  std::vector<Said> said_;  // by linearisation
  Design design_;
  Gains before_, gain_;                    // λ² of the readings taken; what is added to it
  std::vector<std::vector<bool>> counts_;  // by linearisation and target
};

}  // namespace deflect::plan
