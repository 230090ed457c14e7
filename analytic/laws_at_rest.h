// Whether laws that are held in steps come to rest while the shape around them is solved.
#pragma once

#include <cmath>
#include <limits>

namespace deflect::analytic {

struct StepsMoved {
  /// By how much the forces were not those of the laws, of the largest force; infinite where the laws have no place to
  /// go.
  double lacking = std::numeric_limits<double>::infinity();
  double by = 0;  ///< the largest change of an offset, rotations times length (m)
};

/// Follows the laws round by round.
class LawsAtRest {
 public:
  /// Of the mechanism, m.
  explicit LawsAtRest(double length) : lost_(1e-10 * length) {}

  /// False where they go back and forth, or have no place to go.
  bool go_on(const StepsMoved& last) {
    rests_ = last.lacking <= alike || (last.lacking <= 10 * alike && last.lacking > 0.5 * before_.lacking);
    if (before_.by > lost_ && last.by > 0.5 * before_.by) ++astray_;
    before_ = last;
    return std::isfinite(last.lacking) && astray_ <= 4;
  }
  bool rest() const { return rests_; }
  /// Whether they moved by no more than that in this round, m.
  bool stay_within(double by) const { return before_.by <= by; }
  /// Whether a step of Newton's method, m, may be large because of where they moved in this round.
  bool explain(double step) const { return before_.by > 0.01 * step; }

 private:
  static constexpr double alike = 1e-9;
  double lost_;  // in rounding: moves that say nothing
  StepsMoved before_;
  int astray_ = 0;
  bool rests_ = true;
};

}  // namespace deflect::analytic
