// Legs with a friction element in parallel with each, solved line by line. Every leg carries only a force along one
// line, and the lines are statically determinate. So the force in each line follows from statics, and only the leg and
// its friction element share it. Legs may have one-sided laws, whose phase follows from the sign of the force. With the
// leg's wrench w, the line's total force λ, the friction force f, and the friction element's motion δ = β wᵀd_leg:
//   sticks   f = k (β wᵀd_leg(λ − β f) − slip),  |f| ≤ F
//   slides   f = ±F, the slip follows.
#pragma once

#include <optional>
#include <vector>

#include "analytic/chain.h"

namespace deflect::analytic {

class Lines {
 public:
  /// Nullopt where the group is not of this kind: other laws jump, or the lines are not determinate.
  static std::optional<Lines> of(const Group&);

  struct Answer {
    Group::State state;
    std::vector<Step> steps;    ///< by SteppedLaw::number
    std::vector<double> slips;  ///< by FrictionLaw::number
  };
  /// `slips`: before the load; empty: relaxed, all zero. Nullopt where a leg carries no force any more.
  std::optional<Answer> solve(const Group&, const Vector6& F, const std::vector<double>& slips,
                              const ChainConditions&) const;

 private:
  struct Beside {
    std::size_t branch = 0;
    double beta = 0;
    FrictionLaw law;
    int step = 0;  // SteppedLaw::number
  };
  struct Line {
    std::size_t leg = 0;
    std::optional<Beside> friction;
  };

  std::vector<Line> lines_;
  Eigen::PartialPivLU<MatrixX> statics_;  // of RᵀN of the legs
};

}  // namespace deflect::analytic
