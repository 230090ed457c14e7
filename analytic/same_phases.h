// Laws that jump, under one load after another: each is tried in the phase that it had under the load before.
//
// In a phase the deflection δ of a law and its force f lie on a straight line (steps.h), so that the offsets o of all
// laws follow from linear equations. With f = f0 − S o and δ = o + c f (Imposed), P the preload:
//   clearance          +, −    δ = ±gap                              while the force on it keeps that sign
//                      open    f = −P                                while |δ| ≤ gap
//   one-sided          pull, push  δ = c± (f + P)                    while f + P keeps that sign
//   friction           sticks  δ − f/k = slip                        while |f + P| ≤ limit
//                      slides  f + P = ±limit                        while the slip moves that way
// with limit = force + share · |f of the law beside it|. Laws that bend are straight along their tangent, found anew
// until they agree. A law that leaves its phase takes the next one, and all are solved again. Where every law is in its
// phase the offsets are those that balance() finds; where the phases do not settle, or do not determine the offsets,
// there is no answer here.
#pragma once

#include <Eigen/LU>
#include <optional>

#include "analytic/steps.h"

namespace deflect::analytic {

class SamePhases {
 public:
  /// `imposed` has S.
  SamePhases(std::vector<SteppedLaw>, Imposed imposed);

  /// Offsets and slips under a load of which the laws would carry the forces f0 without offsets; `slips`: before it.
  /// Nothing before the first call of remember().
  std::optional<BalancedSteps> after(const VectorX& f0, const std::vector<double>& slips);

  /// The phases of an answer of balance() to these. Nothing is remembered of laws that begin where loads left them in a
  /// table.
  void remember(const VectorX& f0, const std::vector<double>& slips, const BalancedSteps&);

 private:
  struct LawPhase {
    int phase = 0;    // ±1: at that end, sliding that way; 0: open, sticking, bending
    int of_load = 1;  // sign of the force of the law beside it
    double d = 0;     // of a law that bends, where its tangent is taken
    bool operator==(const LawPhase&) const = default;
  };
  struct Line {
    double of_d = 0, of_s = 0, of_load = 0, is = 0;  // of_d δ + of_s f + of_load f_load = is
  };
  Line line(Eigen::Index i, const std::vector<double>& slips) const;
  /// The phase in which the law is at these; the present one where it may stay.
  LawPhase phase(Eigen::Index i, const VectorX& d, const VectorX& s, const std::vector<double>& slips) const;
  bool factorise(const std::vector<Line>&);

  std::vector<SteppedLaw> laws_;
  Imposed imposed_;
  Eigen::Index n_;
  bool known_ = false, bends_ = false;
  std::vector<LawPhase> phases_, factorised_;
  VectorX root_;  // √c
  Eigen::PartialPivLU<MatrixX> lu_;
  std::optional<bool> determined_;  // by the phases that are factorised, where it was asked
};

}  // namespace deflect::analytic
