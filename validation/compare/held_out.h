// Cross-validation: how well a device predicts at poses whose readings were not used.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "validation/compare/residual_study.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {

/// Of each reading, the group that is held out with it: its pose; where a subject without tool point has one pose
/// alone, the readings in which the same loads act in the same sense.
std::vector<std::size_t> held_out_groups(const ResidualStudy&);

/// Residuals at each pose with the tolerances estimated from the other poses, in ten folds at most: η = (1 + BᵀB)⁻¹Bᵀz
/// over the readings of the other folds, with B and z whitened within poses (whitening.h). η contains the errors that
/// all poses share; a pose's own errors cannot be estimated from the others. Readings set aside are used neither for
/// the estimate nor for the error.
class HeldOut {
 public:
  /// The study and the uncertainty must outlive it. `set_aside` must be the same as in the uncertainty.
  HeldOut(const ResidualStudy&, const statistics::Uncertainty&, const std::vector<bool>& set_aside);

  /// Root mean square over the numbers of the quantity of errors (errors_by_group.h). `residual`: of
  /// all measured numbers, m and rad.
  double rmse(const VectorX& residual) const;
  /// The sum of their squares by fold.
  VectorX squares(const VectorX& residual) const;

 private:
  bool counts(std::size_t value) const;
  std::size_t fold_of(std::size_t value) const;

  const ResidualStudy* study_;
  const statistics::Uncertainty* uncertainty_;
  std::vector<bool> set_aside_;
  measurement::Quantity quantity_;
  std::vector<std::size_t> group_;  // of each reading; held out together
  std::size_t folds_ = 1;
  std::vector<Eigen::LLT<MatrixX>> others_;  // of 1 + BᵀB over all folds but one
};

}  // namespace deflect::compare
