#include "validation/matrix/matrix_checks.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "validation/matrix/elastic_structure.h"

namespace deflect::matrix {
namespace {

constexpr double computed_to = 1e-9, softest_N_m = 1, stiffest_N_m = 1e12;

void judge_symmetry(JudgedMatrix& out, const Matrix6& K, const Matrix6& u, double scale) {
  double worst = -1;
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = i + 1; j < 6; ++j) {
      const double difference = std::abs(K(i, j) - K(j, i)), allowed = u(i, j) + u(j, i);
      out.asymmetric_pairs += difference > allowed;
      const double excess = allowed > 0 ? difference / allowed : difference;
      if (excess <= worst) continue;
      worst = excess;
      out.row = i, out.column = j;
      out.symmetric.measured = difference / scale;
      out.symmetric.at_most = allowed / scale;
    }
}

Eigen::Index rank_of(const PrintedMatrix* twists, double length) {
  if (!twists) return 0;
  MatrixX J = twists->values;
  J.bottomRows(3) *= length;
  J.colwise().normalize();
  Eigen::ColPivHouseholderQR<MatrixX> qr(J);
  qr.setThreshold(1e-6);
  return qr.rank();
}

void judge_passive(JudgedMatrix& out, const Matrix6& K, const Matrix6& u, const PrintedMatrix& twists, double length,
                   double scale) {
  for (Eigen::Index j = 0; j < twists.values.cols(); ++j) {
    Vector6 t = twists.values.col(j), t_known = twists.rounding.col(j);
    t.tail<3>() *= length, t_known.tail<3>() *= length;
    const Vector6 resisted = (K * t).cwiseAbs(), allowed = u * t.cwiseAbs() + K.cwiseAbs() * t_known;
    Eigen::Index worst = 0;
    (resisted.array() / (allowed.array() + 1e-300)).maxCoeff(&worst);
    const double size = scale * t.norm();
    out.passive.push_back({fmt::format("passive_joint_{}", j + 1), "|K J| / |K||J|", resisted(worst) / size,
                           -std::numeric_limits<double>::infinity(), allowed(worst) / size});
  }
}

}  // namespace

PrintedMatrix with_tolerance(PrintedMatrix K, const std::optional<double>& tolerance) {
  const double length = weighing_length(K.values);
  const double known_to = 0.5 * tolerance.value_or(computed_to) * weighed(K.values, length).cwiseAbs().maxCoeff();
  const Matrix6 alike = weighed(Matrix6::Constant(known_to), 1 / length);
  K.rounding = tolerance ? MatrixX(alike) : MatrixX(K.rounding.cwiseMax(alike));
  return K;
}

JudgedMatrix judge(const PrintedMatrix& printed, const PrintedMatrix* passive_twists, double unit_m,
                   const PlausibleSize& plausible) {
  JudgedMatrix out;
  const double length = weighing_length(printed.values);
  const Matrix6 K = weighed(printed.values, length), u = weighed(printed.rounding, length);
  const double scale = std::max(K.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  out.symmetric = {"symmetric", "|K − Kᵀ| / |K|", {}};
  out.positive = {"positive", "smallest / largest eigenvalue", {}};
  out.holds = {"holds_every_direction", "smallest / largest eigenvalue", {}};
  out.length = {"characteristic_length", "mm", {}, 1e3 * plausible.smallest_m, 1e3 * plausible.largest_m};
  out.stiffness = {"translational_stiffness", "mean, N/mm", {}, 1e-3 * softest_N_m, 1e-3 * stiffest_N_m};
  judge_symmetry(out, K, u, scale);

  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(Matrix6((K + K.transpose()) / 2));
  out.eigenvalues = eigen.eigenvalues();
  const double largest = std::max(out.eigenvalues.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  const auto known_to = [&](Eigen::Index i) {
    const Vector6 v = eigen.eigenvectors().col(i).cwiseAbs();
    return v.dot(u * v) / largest;
  };
  const auto twist = [&](Eigen::Index i) {
    Vector6 t = eigen.eigenvectors().col(i);
    t.tail<3>() /= length;
    return t;
  };
  out.softest = twist(0);
  out.positive.measured = out.eigenvalues(0) / largest;
  out.positive.at_least = -known_to(0);
  if (passive_twists) judge_passive(out, K, u, *passive_twists, length, scale);
  if (!out.positive.passes()) return out;

  const Eigen::Index released = rank_of(passive_twists, length);
  out.holds.measured = out.eigenvalues(released) / largest;
  out.holds.at_least = std::nextafter(known_to(released), 1.0);
  for (Eigen::Index i = released; i < 6; ++i)
    if (out.eigenvalues(i) / largest <= known_to(i)) out.free.push_back(twist(i));
  if (!(out.eigenvalues(0) > computed_to * largest) || !out.symmetric.passes()) return out;

  const ElasticStructure structure = elastic_structure((printed.values + printed.values.transpose()) / 2);
  out.length.measured = 1e3 * unit_m * structure.length;
  out.stiffness.measured = structure.translational.mean() * 1e-3 / unit_m;
  return out;
}

}  // namespace deflect::matrix
