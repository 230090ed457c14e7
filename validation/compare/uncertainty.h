// What a residual may be without anything missing: the noise of readings and the tolerances of the machine.
//
// Measured numbers y (one per component that was measured) differ from the prediction by r = A η + ε:
//   η  tolerances in standard deviations, η ~ N(0, 1): modulus, each leg's guideway diameter, joints on base and
//      platform and link length, each pose's actuators; A by differences of the prediction (closed form, linear
//      geometry) of machines as built (as_built.h);
//   ε  reading noise σ, and within a reading the error of its load, relative, which moves along the prediction d:
//      cov = diag(σ²) + t² d dᵀ.
// So Σ = A Aᵀ + cov(ε), and everything below weighs by Σ⁻¹. Readings set aside weigh nothing.
#pragma once

#include <Eigen/SparseCore>
#include <string>
#include <vector>

#include "msa/mechanism/configuration.h"
#include "validation/measurement/replicates.h"
#include "validation/parallel/cases.h"

namespace deflect {

/// Columns are patterns, rows the measured numbers: each reading's six components (m, rad), where they were measured.
MatrixX rows_of(const std::vector<MeasuredValue>&,
                const std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>>& by_reading);
VectorX rows_of(const std::vector<MeasuredValue>&, const std::vector<Vector6>& by_reading);

/// A tolerance as a nuisance parameter.
struct Nuisance {
  std::string name;  ///< "modulus", "leg 3 base joint x", "pose 4 leg 1 slider"
  double sigma = 0;  ///< prior standard deviation: relative, or m
};

/// The machine's sensitivity to its tolerances.
struct ToleranceModel {
  std::vector<Nuisance> nuisances;
  MatrixX A;  ///< measured numbers × nuisances, per standard deviation; m, rad
};
ToleranceModel tolerance_model(const Mechanism&, const std::vector<Configuration>& drawn, const Measurements&,
                               const std::vector<MeasuredValue>&, int threads = 0, const Told& = {});

class Uncertainty {
 public:
  /// `predicted`: by reading; `load`: relative standard deviation of a recorded load.
  Uncertainty(const MatrixX& A, const std::vector<MeasuredValue>&, const std::vector<double>& sigma,
              const std::vector<Vector6>& predicted, double load, const std::vector<bool>& set_aside = {});

  /// Σ^(−1/2) X: with it least squares are those of independent numbers of deviation 1. Rows set aside are 0.
  MatrixX whitened(const MatrixX& X) const;
  /// Xᵀ Σ⁻¹ Y.
  MatrixX inner(const MatrixX& X, const MatrixX& Y) const { return whitened(X).transpose() * whitened(Y); }
  /// The nuisances η that explain a residual best, with their prior.
  VectorX nuisances(const VectorX& residual) const;
  /// How many times the declared tolerances those of the machine look, 1 … 3: where noise, the tolerances so scaled and
  /// the patterns `beside` (columns over the measured numbers, of any size) make up the residual; 1 unless the data say
  /// otherwise by more than 2 in ln of the likelihood.
  double scale_of_tolerances(const VectorX& residual, const MatrixX& beside) const;
  /// The covariance of T r for contrasts T (rows) of the measured numbers, none of which may be set aside.
  MatrixX covariance(const Eigen::SparseMatrix<double, Eigen::RowMajor>& T) const;
  /// Numbers that are not set aside.
  std::size_t count() const { return count_; }

  /// By cov(ε) alone; rows set aside are 0.
  MatrixX whitened_by_noise(const MatrixX&) const;
  const MatrixX& tolerances() const { return bare_A_; }
  const MatrixX& tolerances_by_noise() const { return A_; }

 private:
  struct Block {
    Eigen::Index first, size;
    MatrixX covariance, inverse_factor;  // and L⁻¹ of it, 0 where set aside
  };
  std::vector<Block> blocks_;
  MatrixX bare_A_;
  MatrixX A_;      // whitened by noise; A = Q S Vᵀ
  MatrixX Q_, V_;  // where S > 0
  VectorX S_;
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
/// With `beside` other patterns that are fitted in any case. Directions that the data do not determine stay 0.
Regression regress(const Uncertainty&, const VectorX& residual, const MatrixX& G, const MatrixX& beside = {});

}  // namespace deflect
