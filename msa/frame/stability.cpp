#include "msa/frame/stability.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "msa/base/error.h"

namespace deflect::frame {
namespace {

constexpr double shift = 1e-10, null_below = 1e-11, unstrained_below = 1e-12;

/// y = K x for a matrix of which the lower triangle is stored.
MatrixX times(const SparsePattern& p, const std::vector<double>& values, const MatrixX& x) {
  MatrixX y = MatrixX::Zero(x.rows(), x.cols());
  for (int j = 0; j < p.n; ++j)
    for (int k = p.column_start[static_cast<std::size_t>(j)]; k < p.column_start[static_cast<std::size_t>(j) + 1];
         ++k) {
      const int i = p.row[static_cast<std::size_t>(k)];
      const double v = values[static_cast<std::size_t>(k)];
      y.row(i) += v * x.row(j);
      if (i != j) y.row(j) += v * x.row(i);
    }
  return y;
}

std::string describe_motion(const Model& m, const VectorX& u) {
  Eigen::Index most = 0;
  u.cwiseAbs().maxCoeff(&most);
  const auto nodal = static_cast<Eigen::Index>(6 * m.nodes.size());
  if (most >= nodal) return fmt::format("{} slides freely", m.dof_name(static_cast<int>(most)));
  const Eigen::Index node = most / 6;
  const Vector3 translation = u.segment<3>(6 * node), rotation = u.segment<3>(6 * node + 3);
  const bool turns = most % 6 >= 3;
  const Vector3 direction = (turns ? rotation : translation).normalized();
  return fmt::format("node '{}' {} ({:.3f}, {:.3f}, {:.3f})", m.nodes[static_cast<std::size_t>(node)].name,
                     turns ? "turns freely about" : "moves freely along", direction.x(), direction.y(), direction.z());
}

/// The largest translation, or rotation times `length`, is 1.
VectorX normalised(const Model& m, VectorX u, double length) {
  double size = 0;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    size =
        std::max(size, std::abs(u(i)) * (i < static_cast<Eigen::Index>(6 * m.nodes.size()) && i % 6 >= 3 ? length : 1));
  return u / size;
}

/// Combinations of the (normalised) candidates that strain no element, whatever its stiffness: beside a member that is
/// 1e12 times stiffer the others look free, but a motion that strains them is none.
MatrixX unstrained(const Model& m, const MatrixX& candidates, double length) {
  // Gram matrix of strain energies, every element scaled to the energy that a motion of size 1 of one end could store.
  MatrixX strain = MatrixX::Zero(candidates.cols(), candidates.cols());
  Vector12 reach = Vector12::Ones();
  reach.segment<3>(3).setConstant(1 / length);
  reach.segment<3>(9).setConstant(1 / length);
  for (const Beam& beam : m.beams) {
    const Matrix12 K = stiffness(beam);
    MatrixX d(12, candidates.cols());
    d << candidates.middleRows<6>(6 * beam.a), candidates.middleRows<6>(6 * beam.b);
    strain += d.transpose() * K * d / reach.cwiseAbs2().dot(K.diagonal());
  }
  for (const Spring& spring : m.springs) {
    if (!(tangent_at_force(spring.law, 1) > 0)) continue;
    Eigen::RowVectorXd d = Eigen::RowVectorXd::Zero(candidates.cols());
    double size = 0;
    for (const Term& t : spring.elongation) {
      d += t.coefficient * candidates.row(t.dof);
      size += t.coefficient * t.coefficient;
    }
    if (size > 0) strain += d.transpose() * d / size;
  }
  const Eigen::SelfAdjointEigenSolver<MatrixX> eigen(strain);
  MatrixX U(m.dofs(), 0);
  for (Eigen::Index j = 0; j < candidates.cols() && eigen.eigenvalues()(j) < unstrained_below; ++j) {
    U.conservativeResize(Eigen::NoChange, j + 1);
    U.col(j) = normalised(m, candidates * eigen.eigenvectors().col(j), length);
  }
  return U;
}

}  // namespace

MatrixX free_motions(const Model& m, const Elimination& e, const SparsePattern& p, const std::vector<double>& values,
                     int limit) {
  const int n = p.n, block = std::min(limit, n);
  VectorX scale(n);  // Jacobi scaling; a freedom with no stiffness at all keeps its own
  for (int j = 0; j < n; ++j) {
    const double d = values[static_cast<std::size_t>(p.column_start[static_cast<std::size_t>(j)])];
    scale(j) = d > 0 ? 1 / std::sqrt(d) : 1;
  }
  std::vector<double> scaled = values;
  for (int j = 0; j < n; ++j)
    for (int k = p.column_start[static_cast<std::size_t>(j)]; k < p.column_start[static_cast<std::size_t>(j) + 1]; ++k)
      scaled[static_cast<std::size_t>(k)] *= scale(j) * scale(p.row[static_cast<std::size_t>(k)]);
  std::vector<double> shifted = scaled;
  for (int j = 0; j < n; ++j) shifted[static_cast<std::size_t>(p.column_start[static_cast<std::size_t>(j)])] += shift;
  SparseCholesky cholesky(p);
  if (cholesky.factor(shifted) == 0) throw ModelError("the stiffness is not positive: a spring or section is negative");

  // Starting block: fixed quasi-random numbers, so that the answer is the same every time.
  MatrixX X(n, block);
  for (int j = 0; j < block; ++j)
    for (int i = 0; i < n; ++i) X(i, j) = std::sin(12.9898 * (i + 1) + 78.233 * (j + 1));
  for (int iteration = 0; iteration < 4; ++iteration) {
    X = cholesky.solve(X);
    X = Eigen::HouseholderQR<MatrixX>(X).householderQ() * MatrixX::Identity(n, block);
  }
  const Eigen::SelfAdjointEigenSolver<MatrixX> ritz(X.transpose() * times(p, scaled, X));
  const double length = characteristic_length(m);
  MatrixX candidates(m.dofs(), 0);
  for (int j = 0; j < block && ritz.eigenvalues()(j) < null_below; ++j) {
    const VectorX q = scale.asDiagonal() * (X * ritz.eigenvectors().col(j));
    const VectorX u = e.expand(q, VectorX::Zero(static_cast<Eigen::Index>(m.constraints.size())));
    candidates.conservativeResize(Eigen::NoChange, j + 1);
    candidates.col(j) = normalised(m, u, length);
  }
  return unstrained(m, candidates, length);
}

void refuse_mechanism(const Model& m, const Elimination& e, const SparsePattern& p, const std::vector<double>& values) {
  const MatrixX motions = free_motions(m, e, p, values);
  if (motions.cols() == 0) return;
  std::string list;
  for (Eigen::Index j = 0; j < motions.cols(); ++j)
    list += fmt::format("\n  {}: {}", j + 1, describe_motion(m, motions.col(j)));
  throw ModelError(fmt::format("the structure cannot stand: {} motion{} with nothing to resist{}{}", motions.cols(),
                               motions.cols() == 1 ? "" : "s", motions.cols() == 8 ? " (or more)" : "", list));
}

}  // namespace deflect::frame
