// Legs with a friction beside each, solved line by line: where every leg carries a force along one line only and the
// lines are statically determinate, the force in each line follows from statics, and leg and friction share it alone.
// Legs may hold one-sided laws, whose phase is that of the force.
// On a line with the wrench w of the leg, λ in all, f in the friction and the friction's motion δ = β wᵀd_leg:
//   sticks   f = k (β wᵀd_leg(λ − β f) − slip),  |f| ≤ F
//   slides   f = ±F, the slip follows.
#pragma once

#include <optional>
#include <vector>

#include "analytic/chain.h"

namespace deflect::analytic {

class Lines {
 public:
  /// Nothing where the group is not of that kind: another law that jumps, lines that are not determinate.
  static std::optional<Lines> of(const Group&);

  struct Answer {
    Group::State state;
    std::vector<Step> steps;    ///< by SteppedLaw::number
    std::vector<double> slips;  ///< by FrictionLaw::number
  };
  /// `slips` before the load; empty: relaxed. Nothing where a leg has let go.
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
