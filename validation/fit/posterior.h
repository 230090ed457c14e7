// What data say of parameters and tolerances together, to first order about the fitted values:
//
//   r = P δ + A η + ε,   δ ~ N(δ₀, S₀),   η ~ N(0, 1)
//
//   r  measured − predicted, n numbers (m, rad, …)
//   δ  parameters from their fitted values, in their coordinates (FreeParameter); P = ∂prediction/∂δ by differences
//   η  tolerances common to all poses, in standard deviations, and the size of the deformed shape's part
//   A  ∂prediction/∂η
//   ε  noise, load errors, errors of a pose
// With z = W_O W_N r and B = W_O W_N [P A] (whitening.h),
//   Λ = Λ₀ + BᵀB,   mean Λ⁻¹(Λ₀μ₀ + Bᵀz),   covariance Λ⁻¹.
// A parameter without a prior has the variance of a uniform distribution over its range of search, which counts only
// where the data say nothing.
//
// Held out: each group of readings (held_out.h; ten folds at most) with Λ and z of the others. A number then deviates
// by r − [P A] mean, with variance var(ε) + [P A] Λ⁻¹ [P A]ᵀ.
#pragma once

#include <functional>
#include <vector>

#include "validation/fit/free_parameters.h"

namespace deflect::fit {

/// Half the width of a 95 % interval in standard deviations.
inline constexpr double normal95 = 1.959964;

struct Posterior {
  Eigen::Index parameters = 0;
  VectorX mean;        ///< of [δ; η]
  MatrixX covariance;  ///< of [δ; η]
};

/// At held-out groups, by measured number; 0 for readings set aside.
struct HeldOutNumbers {
  VectorX residual, variance;
};

/// Derivatives of a prediction with respect to the coordinates of the parameters, by central differences about the
/// values (SI); to one side where the other cannot be predicted. NumericalError where neither can.
MatrixX derivatives(const subject::Subject&, const std::vector<FreeParameter>&, const VectorX& values,
                    const std::function<VectorX(const subject::Subject&)>& prediction);

class Learnt {
 public:
  /// `values`: SI, where the derivatives are taken. The observations must outlive it.
  Learnt(const diagnosis::Observations&, const std::vector<FreeParameter>&, const VectorX& values);

  const Posterior& posterior() const { return posterior_; }
  HeldOutNumbers held_out() const;
  /// Derivative of the whitened residual with respect to the coordinates over their scales, tolerances free: what the
  /// data alone say.
  const MatrixX& whitened_derivative() const { return whitened_; }
  /// Derivative of the prediction with respect to the coordinates: P.
  const MatrixX& derivative() const { return P_; }

 private:
  VectorX variance_of_noise() const;

  const diagnosis::Observations* observations_;
  VectorX residual_;
  MatrixX P_, whitened_, columns_;  // [P A]
  MatrixX prior_;                   // Λ₀
  VectorX prior_score_;             // Λ₀μ₀
  MatrixX B_;
  VectorX z_;
  Posterior posterior_;
};

/// By quantity: root mean square of a deviation that is left beyond noise, tolerances and what is known of parameters
/// at held-out poses, as a share of the root mean square of the reading's predictions of that quantity:
///   c² = Σ (r² − var r) / Σ s²,   at least 0.
struct Discrepancy {
  measurement::Quantity quantity = measurement::Quantity::length;
  double share = 0;
};
std::vector<Discrepancy> discrepancies(const diagnosis::Observations&, const HeldOutNumbers&);

/// Root mean square of the predictions of one quantity in one reading, over the channels that are counted.
double size_of_prediction(const std::vector<measurement::MeasuredValue>&, const VectorX& predicted, std::size_t reading,
                          measurement::Quantity);

}  // namespace deflect::fit
