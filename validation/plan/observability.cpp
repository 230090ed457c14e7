#include "validation/plan/observability.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace deflect::plan {

Observability observability(const MatrixX& information, double m) {
  Observability out;
  const Eigen::Index L = information.rows();
  if (L == 0 || !(m > 0)) return out;
  const VectorX w = Eigen::SelfAdjointEigenSolver<MatrixX>(information, Eigen::EigenvaluesOnly).eigenvalues();
  // Rounding leaves a few ε of the largest where there is nothing.
  const double nothing = 1e-14 * static_cast<double>(L) * w(L - 1);
  double logs = 0, reciprocals = 0;
  for (Eigen::Index i = 0; i < L; ++i) {
    const double sigma = w(i) > nothing ? std::sqrt(w(i)) : 0;
    logs += std::log(sigma);
    reciprocals += 1 / sigma;
    out.D_gain += 0.5 * std::log1p(std::max(0.0, w(i)));
  }
  const double least = w(0) > nothing ? std::sqrt(w(0)) : 0, most = std::sqrt(std::max(0.0, w(L - 1)));
  out.O = {std::exp(logs / static_cast<double>(L)) / std::sqrt(m), most > 0 ? least / most : 0, least,
           most > 0 ? least * least / most : 0, 1 / reciprocals};
  return out;
}

double test_pose_error(const MatrixX& covariance, const MatrixX& V) {
  if (V.rows() == 0) return 0;
  return std::sqrt(std::max(0.0, (V * covariance).cwiseProduct(V).sum() / static_cast<double>(V.rows())));
}

}  // namespace deflect::plan
