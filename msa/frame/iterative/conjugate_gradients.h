// Conjugate gradients on the preconditioned stiffness (incomplete_cholesky.h), with what its coefficients tell of error
// and conditioning.
//
// Error: e with ‖e‖²_K = r̂ᵀ K̂⁻¹ r̂ ≤ ‖r̂‖² / λ_min(K̂), r̂ the residual seen through the preconditioner. The inequality is
// exact; λ_min is an estimate: the smallest eigenvalue θ of the Lanczos matrix that the coefficients α, β make
// (Golub and Meurant, Matrices, Moments and Quadrature, 2010, (2.20)–(2.22)), which lies above λ_min and falls onto it
// while the iteration converges. θ/4 is taken for it. The norm of the solution, ‖u‖²_K, is known from below:
// Σ α ‖r̂‖² (Hestenes and Stiefel, 1952, theorem 6:1).
#pragma once

#include <functional>

#include "msa/frame/iterative/incomplete_cholesky.h"

namespace deflect::frame {

struct GradientOptions {
  double error = 1e-10;  ///< to reach, of the estimate above: ‖e‖_K / size
  double size = 0;       ///< what the error is relative to; 0: ‖u‖_K itself
  double smallest = 0;   ///< eigenvalue where it is known better, from another right-hand side; 0: not
  int most_iterations = 1500;
  int threads = 0;  ///< 0: as many as there are; more than two are not used
  /// Told how far it has come, 0 … 1, by the digits gained.
  std::function<void(double)> progress = {};
};

struct GradientSummary {
  VectorX x;  ///< inside: see IncompleteCholesky::motion_outside
  bool converged = false;
  int iterations = 0;
  double size = 0;                   ///< ‖u‖_K from below
  double residual = 0;               ///< ‖r̂‖, carried along
  double smallest = 1, largest = 1;  ///< estimates of the extreme eigenvalues of K̂; θ, not θ/4
  /// Estimate above, relative to `size`.
  double error = 0;
};

/// K̂ x = b. The same bits for any number of threads.
GradientSummary conjugate_gradients(const IncompleteCholesky&, const VectorX& b, const GradientOptions&);

}  // namespace deflect::frame
