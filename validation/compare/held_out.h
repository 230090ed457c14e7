// How well a device predicts where it was not looked at.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "validation/compare/residual_study.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {

/// Residuals at each pose with the tolerances learnt at all others; poses in ten folds at most: η = (1 + BᵀB)⁻¹Bᵀz over
/// the readings of the other folds, B and z white within poses (whitening.h), η of what all poses share: of a pose's
/// own errors the others say nothing. Readings set aside neither teach nor count.
class HeldOut {
 public:
  /// The study must outlive it. Readings that the uncertainty sets aside are those given.
  HeldOut(const ResidualStudy&, const statistics::Uncertainty&, const std::vector<bool>& set_aside);

  /// Root mean square of the translations, m, or of rotations alone, rad. The residual: of all measured numbers, m and
  /// rad.
  double rmse(const VectorX& residual) const;

 private:
  std::size_t fold_of(std::size_t value) const;

  const ResidualStudy* study_;
  const statistics::Uncertainty* uncertainty_;
  std::vector<bool> set_aside_;
  std::size_t folds_;
  std::vector<Eigen::LLT<MatrixX>> others_;  // of 1 + BᵀB over all folds but one
};

}  // namespace deflect::compare
