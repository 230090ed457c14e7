#include "analytic/flexibility.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>
#include <vector>

#include "msa/base/error.h"

namespace deflect::analytic {
namespace {

constexpr double lost = 1e-13;  // of the largest root: rounding of the wrenches that are carried

/// Weighs moments by 1/length or rotations by length.
Vector6 weights(double rotation) {
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(rotation);
  return w;
}

std::string triple(const Vector3& v, double scale) {
  const auto rounded = [&](int i) { return std::abs(v(i)) < 1e-9 * scale ? 0.0 : v(i); };
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", rounded(0), rounded(1), rounded(2));
}

/// The motion on which a wrench does its work.
std::string resisted_motion(const Vector6& F, double length) {
  const Vector3 f = F.head<3>(), m = F.tail<3>();
  if (f.norm() * length < 1e-6 * m.norm()) return "rotation about " + triple(m.normalized(), 1);
  std::string text = "translation along " + triple(f.normalized(), 1);
  const Vector3 point = f.cross(m) / f.squaredNorm();
  if (point.norm() > 1e-6 * length) text += fmt::format(" of T + {} mm", triple(1e3 * point, 1e3 * length));
  const double pitch = f.dot(m) / f.squaredNorm();
  if (std::abs(pitch) > 1e-6 * length) text += fmt::format(", turning by 1 rad per {:.4g} mm", -1e3 * pitch);
  return text;
}

/// The span of the columns by vectors along as few axes as possible (Gauss and Jordan).
MatrixX reduced(MatrixX columns) {
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    Eigen::Index row = 0, col = 0;
    columns.rightCols(columns.cols() - c).cwiseAbs().maxCoeff(&row, &col);
    columns.col(c).swap(columns.col(c + col));
    columns.col(c) /= columns(row, c);
    for (Eigen::Index other = 0; other < columns.cols(); ++other)
      if (other != c) columns.col(other) -= columns(row, other) * columns.col(c);
  }
  return columns;
}

}  // namespace

// By the Cholesky factors of the Gram matrix, which know ratios down to 1e-5.
bool plainly_span(const MatrixX& columns) {
  if (columns.cols() < columns.rows()) return false;
  const MatrixX gram = columns * columns.transpose();
  const Eigen::LLT<MatrixX> llt(gram);
  return llt.info() == Eigen::Success &&
         llt.matrixLLT().diagonal().cwiseAbs2().minCoeff() > 1e-10 * gram.diagonal().maxCoeff();
}

MatrixX complement(const MatrixX& columns) {
  if (columns.cols() == 0) return MatrixX::Identity(columns.rows(), columns.rows());
  if (plainly_span(columns)) return MatrixX(columns.rows(), 0);
  Eigen::ColPivHouseholderQR<MatrixX> qr;
  qr.setThreshold(1e-9);
  qr.compute(columns);
  const Eigen::Index left = columns.rows() - qr.rank();
  if (left == 0) return MatrixX(columns.rows(), 0);
  return evaluated(qr.householderQ()).rightCols(left);
}

Matrix6X carried_wrenches(const Matrix6X& J, double length) {
  return weights(length).asDiagonal() * complement(weights(length).asDiagonal() * J);
}

Matrix6X free_twists(const Matrix6X& N, double length) {
  return weights(1 / length).asDiagonal() * complement(weights(1 / length).asDiagonal() * N);
}

Matrix6X roots_of(const Matrix6& C, double length) {
  const Matrix6 weighed = weights(length).asDiagonal() * C * weights(length).asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(Matrix6((weighed + weighed.transpose()) / 2));
  const double rounding = 1e-15 * std::max(eigen.eigenvalues()(5), 0.0);
  const Vector6 root = eigen.eigenvalues().unaryExpr([&](double g) { return g > rounding ? std::sqrt(g) : 0; });
  return weights(1 / length).asDiagonal() * (eigen.eigenvectors() * root.asDiagonal());
}

Principal principal(const Flexibility& f, double length) {
  if (f.roots.cols() == 0) return {MatrixX::Identity(f.N.cols(), f.N.cols()), VectorX::Zero(f.N.cols())};
  const MatrixX yields = f.roots.transpose() * f.N;  // moments of N are forces times the length
  const Eigen::JacobiSVD<MatrixX> svd(yields, Eigen::ComputeFullV);
  Principal out{svd.matrixV(), VectorX::Zero(f.N.cols())};
  const double largest = (weights(length).asDiagonal() * f.roots).norm();
  for (Eigen::Index i = 0; i < svd.singularValues().size(); ++i)
    if (const double root = svd.singularValues()(i); root > lost * largest) out.g(i) = root * root;
  return out;
}

Resistance resistance(const Flexibility& f, double length) {
  Resistance out;
  if (f.N.cols() == 0) return out;
  if (f.rooted) {
    const Principal p = principal(f, length);
    const Eigen::Index yielding = (p.g.array() > 0).count();
    out.rigid = f.N * p.V.rightCols(f.N.cols() - yielding);
    const MatrixX N = f.N * p.V.leftCols(yielding);
    out.K = N * p.g.head(yielding).cwiseInverse().asDiagonal() * N.transpose();
    return out;
  }
  Eigen::FullPivLU<MatrixX> lu;
  lu.setThreshold(1e-13);
  lu.compute(MatrixX(f.N.transpose() * f.C * f.N));
  if (lu.isInvertible())
    out.K = f.N * MatrixX(lu.solve(MatrixX(f.N.transpose())));
  else
    out.rigid = f.N * MatrixX(lu.kernel());
  return out;
}

Resistance side_by_side(const std::vector<Resistance>& parts, double length) {
  Resistance out;
  for (const Resistance& part : parts) {
    out.K += part.K;
    out.rigid.conservativeResize(6, out.rigid.cols() + part.rigid.cols());
    out.rigid.rightCols(part.rigid.cols()) = part.rigid;
  }
  if (out.rigid.cols() == 0) return out;
  const MatrixX free = complement(weights(1 / length).asDiagonal() * out.rigid);
  const MatrixX moved = weights(1 / length).asDiagonal() * free, resisted = weights(length).asDiagonal() * free;
  out.K = resisted * (moved.transpose() * out.K * moved) * resisted.transpose();
  out.rigid = weights(length).asDiagonal() * complement(free);
  return out;
}

std::vector<std::string> motions_resisted_by(const Matrix6X& wrenches, double length) {
  const MatrixX along = reduced(weights(1 / length).asDiagonal() * wrenches);
  std::vector<std::string> motions;
  for (Eigen::Index i = 0; i < along.cols(); ++i)
    motions.push_back(resisted_motion(weights(length).cwiseProduct(along.col(i)), length));
  return motions;
}

Matrix6 finite(const Resistance& r, double length, const std::string& name) {
  if (r.rigid.cols() == 0) return r.K;
  throw ModelError(
      fmt::format("{}: infinite stiffness: held rigidly, nothing yields in {}; the pose is singular, or a member, "
                  "joint or actuator must be given some compliance",
                  name, fmt::join(motions_resisted_by(r.rigid, length), "; in ")));
}

Matrix6 stiffness(const Flexibility& f, double length, const std::string& name) {
  return finite(resistance(f, length), length, name);
}

LinearisedBranch::LinearisedBranch(const Flexibility& f, double length) : N(f.N), M(f.N) {
  if (N.cols() == 0) return;
  if (f.rooted) {
    const Principal p = principal(f, length);
    M = N *= p.V;
    g = p.g;
    return;
  }
  const Eigen::JacobiSVD<MatrixX> axes(f.N.transpose() * f.C * f.N, Eigen::ComputeFullU | Eigen::ComputeFullV);
  N *= axes.matrixV();
  M *= axes.matrixU();
  g = axes.singularValues();
  for (Eigen::Index i = 0; i < g.size(); ++i)
    if (!(g(i) > 1e-14 * g(0))) g(i) = 0;
}

}  // namespace deflect::analytic
