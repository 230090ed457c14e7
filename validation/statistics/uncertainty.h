// How large a residual may be where nothing is missing: noise of the readings and tolerances of the machine.
//
// Measured numbers y (one per component that was measured) differ from the prediction by r = A η + ε:
//   η  tolerances in standard deviations, η ~ N(0, 1), common to all poses or of one pose; A by differences of the
//      prediction in linear geometry, with the subject deviating in one of them (Deviations, subject.h);
//   ε  reading noise σ, and the errors of a reading's loads (load_errors.h), each along what its load does: cov =
//      diag(σ²) + t² Σ_c p_c p_cᵀ.
// So Σ = A Aᵀ + cov(ε), and everything below weighs by Σ⁻¹; readings set aside have weight 0. Load errors affect one
// reading only and actuator errors one pose only. They are eliminated there (whitening.h), so that time and memory grow
// linearly with the readings.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <Eigen/SparseCore>
#include <memory>
#include <string>
#include <vector>

#include "validation/measurement/replicates.h"
#include "validation/parallel/work.h"
#include "validation/statistics/load_errors.h"
#include "validation/statistics/whitening.h"
#include "validation/subject/subject.h"

namespace deflect::statistics {

/// Stacks what was measured: from displacements of the measured point by reading (m, rad) to rows over the measured
/// numbers, to the first order (MeasuredValue::form). Columns are patterns.
MatrixX rows_of(const std::vector<measurement::MeasuredValue>&,
                const std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>>& by_reading);
VectorX rows_of(const std::vector<measurement::MeasuredValue>&, const std::vector<Vector6>& by_reading);
/// The same from the readings of all channels (Standing::predict).
VectorX rows_of(const std::vector<measurement::MeasuredValue>&, const std::vector<VectorX>& by_reading);

/// The subject's sensitivity to its tolerances, which are nuisance parameters with a prior.
struct ToleranceModel {
  std::vector<subject::Tolerance> nuisances;  ///< common to all poses, then pose by pose
  PartedColumns A;  ///< measured numbers × nuisances, per standard deviation; m, rad; groups: poses
};
ToleranceModel tolerance_model(const subject::Standing&, const measurement::Measurements&,
                               const std::vector<measurement::MeasuredValue>&, const parallel::Work& = {});

class Uncertainty {
 public:
  /// No reading may belong to two groups of A. `threads`: as in whitening.h.
  Uncertainty(const PartedColumns& A, const std::vector<measurement::MeasuredValue>&, const std::vector<double>& sigma,
              const LoadErrors&, const std::vector<bool>& set_aside = {}, int threads = 1);

  /// W X with WᵀW = Σ⁻¹: in least squares the rows are then independent with standard deviation 1. Rows set aside are
  /// 0.
  MatrixX whitened(const MatrixX& X) const { return (*whitening_)(X); }
  const std::shared_ptr<const Whitening>& whitening() const { return whitening_; }
  /// Xᵀ Σ⁻¹ Y.
  MatrixX inner(const MatrixX& X, const MatrixX& Y) const { return whitened(X).transpose() * whitened(Y); }
  /// The nuisance parameters η that explain a residual best, given their prior.
  VectorX nuisances(const VectorX& residual) const { return whitening_->amplitudes(residual); }
  /// Estimates by which factor, 1 … 3, the machine's tolerances exceed those declared. The residual is modelled as
  /// noise, scaled tolerances and the patterns `beside` (columns over the measured numbers, of any size). 1 unless
  /// another factor raises ln of the likelihood by more than 2.
  double scale_of_tolerances(const VectorX& residual, const MatrixX& beside) const;
  /// ln of the likelihood of a residual under tolerances s times as large, for each s, up to one constant. The columns
  /// of tolerances with these indices (of the shared ones) and the patterns `beside` are of any size.
  std::vector<double> log_likelihood_of_scales(const VectorX& residual, const MatrixX& beside,
                                               const std::vector<double>& scales,
                                               const std::vector<Eigen::Index>& free = {}) const;
  /// The covariance of T r, noise + E Eᵀ, for contrasts of the measured numbers (rows of T). Each must lie within one
  /// group of A and use no number that is set aside.
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

/// A regression of residuals on patterns G, weighed by Σ⁻¹: r = G a + …
struct Regression {
  VectorX amplitude;   ///< in the patterns' own unit
  MatrixX covariance;  ///< of the amplitudes
  double gain = 0;     ///< reduction of χ² by the patterns
  int freedoms = 0;    ///< their rank
  double p_value = 1;  ///< probability of a gain at least as large by chance
};
/// Regressions of one residual on one pattern after the other. The patterns `beside` are always fitted too. Directions
/// that the data do not determine stay 0. The uncertainty must outlive it.
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
