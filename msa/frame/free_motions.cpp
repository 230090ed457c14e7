#include "msa/frame/free_motions.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/frame/assembly.h"

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

/// Jacobi scaling S K S; a freedom with no stiffness at all keeps its own. Returns the scale.
VectorX scale_values(const SparsePattern& p, std::vector<double>& values) {
  VectorX scale(p.n);
  for (int j = 0; j < p.n; ++j) {
    const double d = values[static_cast<std::size_t>(p.column_start[static_cast<std::size_t>(j)])];
    scale(j) = d > 0 ? 1 / std::sqrt(d) : 1;
  }
  for (int j = 0; j < p.n; ++j)
    for (int k = p.column_start[static_cast<std::size_t>(j)]; k < p.column_start[static_cast<std::size_t>(j) + 1]; ++k)
      values[static_cast<std::size_t>(k)] *= scale(j) * scale(p.row[static_cast<std::size_t>(k)]);
  return scale;
}

/// Near null vectors (columns) of a scaled matrix among `block` iterated ones.
MatrixX null_block(const SparsePattern& p, const std::vector<double>& scaled, int block) {
  std::vector<double> shifted = scaled;
  for (int j = 0; j < p.n; ++j) shifted[static_cast<std::size_t>(p.column_start[static_cast<std::size_t>(j)])] += shift;
  SparseCholesky cholesky(p);
  if (cholesky.factor(shifted) == 0) throw ModelError("the stiffness is not positive: a spring or section is negative");
  // Starting block: fixed quasi-random numbers, so that the answer is the same every time.
  MatrixX X(p.n, block);
  for (int j = 0; j < block; ++j)
    for (int i = 0; i < p.n; ++i) X(i, j) = std::sin(12.9898 * (i + 1) + 78.233 * (j + 1));
  for (int iteration = 0; iteration < 4; ++iteration) {
    X = cholesky.solve(X);
    X = Eigen::HouseholderQR<MatrixX>(X).householderQ() * MatrixX::Identity(p.n, block);
  }
  const Eigen::SelfAdjointEigenSolver<MatrixX> ritz(X.transpose() * times(p, scaled, X));
  Eigen::Index found = 0;
  while (found < block && ritz.eigenvalues()(found) < null_below) ++found;
  return X * ritz.eigenvectors().leftCols(found);
}

/// Strain matrix of a beam against its reach: diag(K) weighed so that rotations count over the structure's size.
double reach_of(const Matrix12& K, double length) {
  Vector12 weight = Vector12::Ones();
  weight.segment<3>(3).setConstant(1 / length);
  weight.segment<3>(9).setConstant(1 / length);
  return weight.cwiseAbs2().dot(K.diagonal());
}

Eigen::RowVectorXd elongations(const Spring& spring, const MatrixX& motions) {
  Eigen::RowVectorXd d = Eigen::RowVectorXd::Zero(motions.cols());
  double size = 0;
  for (const Term& t : spring.elongation) {
    d += t.coefficient * motions.row(t.dof);
    size += t.coefficient * t.coefficient;
  }
  const bool resists = size > 0 && tangent_at_force(spring.law, 1) > 0;
  return resists ? Eigen::RowVectorXd(d / std::sqrt(size)) : Eigen::RowVectorXd(0 * d);
}

}  // namespace

VectorX normalised(const Model& m, VectorX u) {
  const double length = characteristic_length(m);
  const auto nodal = static_cast<Eigen::Index>(6 * m.nodes.size());
  double size = 0;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    size = std::max(size, std::abs(u(i)) * (i < nodal && i % 6 >= 3 ? length : 1));
  return u / size;
}

MatrixX soft_motions(const Model& m, const Elimination& e, const SparsePattern& p, const std::vector<double>& values) {
  std::vector<double> scaled = values;
  const VectorX scale = scale_values(p, scaled);
  MatrixX Q;
  for (int block = std::min(8, p.n);; block = std::min(4 * block, p.n)) {
    Q = null_block(p, scaled, block);
    if (Q.cols() < block || block == p.n) break;  // a full block may have more behind it
  }
  MatrixX U(m.dofs(), Q.cols());
  const VectorX no_values = VectorX::Zero(static_cast<Eigen::Index>(m.constraints.size()));
  for (Eigen::Index j = 0; j < Q.cols(); ++j)
    U.col(j) = normalised(m, e.expand(scale.asDiagonal() * Q.col(j), no_values));
  return U;
}

MatrixX unstrained(const Model& m, const MatrixX& motions) {
  const double length = characteristic_length(m);
  MatrixX strain = MatrixX::Zero(motions.cols(), motions.cols());
  MatrixX d(12, motions.cols());
  for (const Beam& beam : m.beams) {
    for (Eigen::Index j = 0; j < motions.cols(); ++j) d.col(j) = end_displacements(beam, motions.col(j));
    const Matrix12 K = stiffness(beam);
    strain += d.transpose() * K * d / reach_of(K, length);
  }
  for (const Spring& spring : m.springs) {
    const Eigen::RowVectorXd elongation = elongations(spring, motions);
    strain += elongation.transpose() * elongation;
  }
  const Eigen::SelfAdjointEigenSolver<MatrixX> eigen(strain);
  Eigen::Index found = 0;
  while (found < motions.cols() && eigen.eigenvalues()(found) < unstrained_below) ++found;
  return motions * eigen.eigenvectors().leftCols(found);
}

VectorX strain_of(const Model& m, const VectorX& u) {
  const double length = characteristic_length(m);
  VectorX strain(static_cast<Eigen::Index>(m.beams.size() + m.springs.size()));
  Eigen::Index i = 0;
  for (const Beam& beam : m.beams) {
    const Vector12 d = end_displacements(beam, u);
    const Matrix12 K = stiffness(beam);
    strain(i++) = d.dot(K * d) / reach_of(K, length);
  }
  for (const Spring& spring : m.springs) strain(i++) = elongations(spring, u).squaredNorm();
  return strain;
}

}  // namespace deflect::frame
