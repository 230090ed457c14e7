#include "msa/base/stiffness_checks.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>

namespace deflect {
namespace {

double weighing_length(const Matrix6& K) {
  const double translation = K.topLeftCorner<3, 3>().trace(), rotation = K.bottomRightCorner<3, 3>().trace();
  return translation > 0 && rotation > 0 ? std::sqrt(rotation / translation) : 1;
}

Vector6 weights(double length) {
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(length);
  return w;
}

Matrix6 weighed(const Matrix6& K, double length) {
  const Vector6 inverse = weights(length).cwiseInverse();
  return inverse.asDiagonal() * K * inverse.asDiagonal();
}

/// Which eigenvalue fails smallest ≥ −tolerance · largest, as a sentence; empty: none does. A Cholesky factorisation
/// that succeeds is that of a matrix within some fifty roundings of the largest entry, far less than any tolerance, and
/// costs a tenth of the eigenvalues, which are left to the matrices where it fails.
std::string negative_eigenvalue(const Matrix6& symmetric, double tolerance) {
  if (Eigen::LLT<Matrix6>(symmetric).info() == Eigen::Success) return "";
  const Vector6 all = Eigen::SelfAdjointEigenSolver<Matrix6>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
  if (all(0) >= -tolerance * all(5)) return "";
  return fmt::format("K >= 0 fails: the smallest eigenvalue is {:.3g} of the largest; ", all(0) / all(5));
}

}  // namespace

StiffnessChecks check_stiffness(const Matrix6& K_SI, const std::vector<LegStiffness>& legs, double tolerance,
                                const Matrix6& rounding) {
  StiffnessChecks out;
  const double length = weighing_length(K_SI);
  const Matrix6 K = weighed(K_SI, length);
  const double scale = K.cwiseAbs().maxCoeff();
  if (!K.allFinite()) {
    out = {false, false, false, "the stiffness is not finite"};
    return out;
  }
  const Matrix6 differences = (K - K.transpose()).cwiseAbs(), open = weighed(rounding + rounding.transpose(), length);
  const double asymmetry = differences.maxCoeff();
  out.symmetric = (differences.array() <= tolerance * scale + open.array()).all();
  if (!out.symmetric)
    out.failure +=
        fmt::format("K = K^T fails: the largest difference is {:.3g} of the largest entry; ", asymmetry / scale);
  const std::string negative = negative_eigenvalue((K + K.transpose()) / 2, tolerance);
  out.positive = negative.empty();
  out.failure += negative;
  const Vector6 per_length = weights(length).cwiseInverse();
  for (const LegStiffness& leg : legs) {
    for (Eigen::Index j = 0; j < leg.passive_twists.cols(); ++j) {
      const Vector6 twist = weights(length).cwiseProduct(leg.passive_twists.col(j));
      const Vector6 resists = per_length.cwiseProduct(leg.K * leg.passive_twists.col(j));
      const double bound = tolerance * scale, size = twist.norm();
      // Nearly always: no entry is larger than the root of the sum of squares.
      if (resists.squaredNorm() <= bound * bound * twist.squaredNorm()) continue;
      const double resisted = resists.cwiseAbs().maxCoeff();
      const double leg_scale = weighed(leg.K, length).cwiseAbs().maxCoeff();
      if (resisted <= tolerance * std::max(leg_scale, scale) * size) continue;
      if (out.passive_joints_free)
        out.failure += fmt::format("K_c J_q = 0 fails: {} resists passive freedom {} with {:.3g} of its stiffness; ",
                                   leg.name, j + 1, resisted / (leg_scale * size));
      out.passive_joints_free = false;
    }
  }
  if (!out.failure.empty()) out.failure.resize(out.failure.size() - 2);
  return out;
}

std::string response_failure(const Response& r, double tolerance) {
  if (r.F.isZero(0)) return "";
  const double work = r.F.dot(r.d) / 2;
  if (!std::isfinite(work)) return "the displacement is not finite";
  const bool held = r.rigid && work == 0;
  if (r.from_rest && !held && !(work > 0))
    return fmt::format("sign fails: the load does the work {:.3g} J on its own displacement", work);
  // Moments weigh against forces by the length that makes them do comparable work.
  const double translation = r.d.head<3>().norm(), rotation = r.d.tail<3>().norm();
  const double length = translation > 0 && rotation > 0 ? translation / rotation : 1;
  const Vector6 inverse = weights(length).cwiseInverse();
  const double imbalance = inverse.cwiseProduct(r.F + r.reaction).norm() / inverse.cwiseProduct(r.F).norm();
  if (imbalance > tolerance)
    return fmt::format("equilibrium fails: reactions and load differ by {:.3g} of the load", imbalance);
  if (!r.from_rest || held) return "";
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  // The heat D₀ of that sliding is missing in the sum of the potentials, E ≤ Fᵀd + D₀: nothing bounds E.
  const bool slid_at_rest = r.strained && r.slides;
  const double least = r.linear ? 1 : slid_at_rest ? -unbounded : 0;
  const double most = r.linear || !(r.strained || r.slides || r.softens) ? 1 : slid_at_rest ? unbounded : 2;
  if (const double share = r.energy / work; share < least - tolerance || share > most + tolerance)
    return fmt::format("energy fails: {:.9g} J are stored, the load does {:.9g} J", r.energy, work);
  return "";
}

}  // namespace deflect
