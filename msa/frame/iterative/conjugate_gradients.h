// Conjugate gradients on the preconditioned stiffness (incomplete_cholesky.h), with estimates of error and conditioning
// from the coefficients.
//
// Error: e with ‖e‖²_K = r̂ᵀ K̂⁻¹ r̂ ≤ ‖r̂‖² / λ_min(K̂), with r̂ the preconditioned residual. The inequality is exact,
// but λ_min is estimated: the smallest eigenvalue θ of the Lanczos matrix of the coefficients α, β (Golub and Meurant,
// Matrices, Moments and Quadrature, 2010, (2.20)–(2.22)), is above λ_min and decreases to it while the iteration
// converges; θ/4 is used for it. A lower bound of the norm of the solution, ‖u‖²_K, is Σ α ‖r̂‖² (Hestenes and Stiefel,
// 1952, theorem 6:1).
#pragma once

#include <functional>

#include "msa/frame/iterative/incomplete_cholesky.h"

namespace deflect::frame {

struct GradientOptions {
  double error = 1e-10;  ///< to reach, of the estimate above: ‖e‖_K / size
  double size = 0;       ///< reference for the error; 0: ‖u‖_K itself
  double smallest = 0;   ///< smallest eigenvalue, where known better from another right-hand side; 0: unknown
  int most_iterations = 1500;
  int threads = 0;  ///< 0: as many as there are; more than two are not used
  /// Progress callback, 0 … 1, by the digits gained.
  std::function<void(double)> progress = {};
};

struct GradientSummary {
  VectorX x;  ///< preconditioned coordinates x̂; see IncompleteCholesky::motion_outside
  bool converged = false;
  int iterations = 0;
  double size = 0;                   ///< ‖u‖_K from below
  double residual = 0;               ///< ‖r̂‖ by recursion
  double smallest = 1, largest = 1;  ///< estimates of the extreme eigenvalues of K̂; θ, not θ/4
  /// Estimate above, relative to `size`.
  double error = 0;
};

/// Solves K̂ x = b. Bit-identical for any number of threads.
GradientSummary conjugate_gradients(const IncompleteCholesky&, const VectorX& b, const GradientOptions&);

}  // namespace deflect::frame
