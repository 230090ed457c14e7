// What a residual may be without anything missing: the noise of readings and the tolerances of the machine.
//
// Measured numbers y (one per component that was measured) differ from the prediction by r = A η + ε:
//   η  tolerances in standard deviations, η ~ N(0, 1), of all poses and of each; A by differences of the prediction in
//      linear geometry of the subject that is off by one of them (subject.h);
//   ε  reading noise σ, and within a reading the error of its load, relative, which moves along the prediction d:
//      cov = diag(σ²) + t² d dᵀ.
// So Σ = A Aᵀ + cov(ε), and everything below weighs by Σ⁻¹. Readings set aside weigh nothing. Errors of the load are of
// a reading alone and those of the actuators of a pose alone: they are eliminated there (whitening.h), so that time and
// memory grow as the readings do.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SparseCore>
#include <memory>
#include <string>
#include <vector>

#include "validation/measurement/replicates.h"
#include "validation/parallel/work.h"
#include "validation/statistics/whitening.h"
#include "validation/subject/subject.h"

namespace deflect::statistics {

/// Columns are patterns, rows the measured numbers: each reading's six components (m, rad), where they were measured.
MatrixX rows_of(const std::vector<measurement::MeasuredValue>&,
                const std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>>& by_reading);
VectorX rows_of(const std::vector<measurement::MeasuredValue>&, const std::vector<Vector6>& by_reading);

/// The subject's sensitivity to its tolerances, which are nuisance parameters with a prior.
struct ToleranceModel {
  std::vector<subject::Tolerance> nuisances;  ///< of all poses, then pose by pose
  PartedColumns A;  ///< measured numbers × nuisances, per standard deviation; m, rad; groups: poses
};
ToleranceModel tolerance_model(const subject::Standing&, const measurement::Measurements&,
                               const std::vector<measurement::MeasuredValue>&, const parallel::Work& = {});

class Uncertainty {
 public:
  /// `predicted`: by reading; `load`: relative standard deviation of a recorded load. Readings lie within A's groups.
  /// `threads`: of whitening.h.
  Uncertainty(const PartedColumns& A, const std::vector<measurement::MeasuredValue>&, const std::vector<double>& sigma,
              const std::vector<Vector6>& predicted, double load, const std::vector<bool>& set_aside = {},
              int threads = 1);

  /// W X with WᵀW = Σ⁻¹: with it least squares are those of independent numbers of deviation 1. Rows set aside are 0.
  MatrixX whitened(const MatrixX& X) const { return (*whitening_)(X); }
  const std::shared_ptr<const Whitening>& whitening() const { return whitening_; }
  /// Xᵀ Σ⁻¹ Y.
  MatrixX inner(const MatrixX& X, const MatrixX& Y) const { return whitened(X).transpose() * whitened(Y); }
  /// The nuisances η that explain a residual best, with their prior.
  VectorX nuisances(const VectorX& residual) const { return whitening_->amplitudes(residual); }
  /// How many times the declared tolerances those of the machine look, 1 … 3: where noise, the tolerances so scaled and
  /// the patterns `beside` (columns over the measured numbers, of any size) make up the residual; 1 unless the data say
  /// otherwise by more than 2 in ln of the likelihood.
  double scale_of_tolerances(const VectorX& residual, const MatrixX& beside) const;
  /// The covariance of T r, noise + E Eᵀ, for contrasts T (rows) of the measured numbers, each within a group of A and
  /// none of a number that is set aside.
  struct OfContrasts {
    MatrixX noise;
    PartedColumns errors;  ///< E
  };
  OfContrasts of_contrasts(const Eigen::SparseMatrix<double, Eigen::RowMajor>& T) const;
  MatrixX covariance(const Eigen::SparseMatrix<double, Eigen::RowMajor>& T) const;
  int threads() const { return whitening_->threads(); }
  /// Numbers that are not set aside.
  std::size_t count() const { return count_; }

  const PartedColumns& tolerances() const { return A_; }

 private:
  std::vector<NoiseBlock> blocks_;  // of readings
  PartedColumns A_;
  std::shared_ptr<const Whitening> whitening_;
  std::size_t count_ = 0;
};

/// A regression of residuals on patterns G, weighed by Σ: r = G a + …
struct Regression {
  VectorX amplitude;   ///< in the patterns' own unit
  MatrixX covariance;  ///< of the amplitudes
  double gain = 0;     ///< χ² that the patterns take away
  int freedoms = 0;    ///< their rank
  double p_value = 1;  ///< of a gain at least as large by chance
};
/// Regressions of one residual on pattern after pattern, with other patterns `beside` that are fitted in any case.
/// Directions that the data do not determine stay 0. The uncertainty must outlive it.
class Regressions {
 public:
  Regressions(const Uncertainty&, const VectorX& residual, const MatrixX& beside = {});
  MatrixX whitened(const MatrixX& G) const { return uncertainty_->whitened(G); }
  Regression on(const MatrixX& G) const { return on_whitened(whitened(G)); }
  Regression on_whitened(const MatrixX& g) const;
  int threads() const { return uncertainty_->threads(); }

 private:
  const Uncertainty* uncertainty_;
  VectorX y_;       // whitened
  MatrixX beside_;  // whitened
  Eigen::CompleteOrthogonalDecomposition<MatrixX> of_beside_;
  VectorX fitted_;  // amplitudes of `beside` alone
};
Regression regress(const Uncertainty&, const VectorX& residual, const MatrixX& G, const MatrixX& beside = {});

}  // namespace deflect::statistics
