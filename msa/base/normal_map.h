// The laws of set_valued_laws.h where they have one solution that is at no kink, by Newton's method: quick for many d0.
#pragma once

#include <Eigen/LU>
#include <optional>
#include <vector>

#include "msa/base/set_valued_laws.h"

namespace deflect {

class NormalMap {
 public:
  /// c and P as in LinearRelation, n of each.
  NormalMap(const VectorX& c, const MatrixX& P);

  struct State {
    VectorX d, s;
    std::vector<int> end;  ///< as in SetValuedSolution
  };
  /// The search begins where the last one ended. `size` as in LinearRelation. Nullopt where it does not come to an end
  /// in a few steps, where a law stands at a kink, and where more than one solution is possible or digits are missing:
  /// then solve() of set_valued_laws.h tells more.
  std::optional<State> solve(const VectorX& d0, const VectorX& size, const std::vector<ScalarLaw>&);

 private:
  struct AtSum {
    double d, slope;
  };
  AtSum at_sum(const ScalarLaw&, Eigen::Index i, double p) const;
  VectorX lacking(const std::vector<ScalarLaw>&, const VectorX& d0);
  bool factor(double extra);
  bool only_solution(const std::vector<ScalarLaw>&, double size);
  bool search(const std::vector<ScalarLaw>&, const VectorX& d0);
  State state(const std::vector<ScalarLaw>&) const;

  VectorX unit_;
  MatrixX P_;
  VectorX p_, d_, slope_;
  MatrixX J_;
  VectorX factored_slope_;  // of the factor at hand
  double factored_extra_ = 0;
  bool digits_ = false;
  Eigen::PartialPivLU<MatrixX> lu_;
};

}  // namespace deflect
