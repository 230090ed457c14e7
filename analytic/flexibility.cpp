#include "analytic/flexibility.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <vector>

#include "msa/base/error.h"

namespace deflect::analytic {
namespace {

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

MatrixX complement(const MatrixX& columns) {
  if (columns.cols() == 0) return MatrixX::Identity(columns.rows(), columns.rows());
  Eigen::ColPivHouseholderQR<MatrixX> qr;
  qr.setThreshold(1e-9);
  qr.compute(columns);
  const MatrixX Q = qr.householderQ();
  return Q.rightCols(columns.rows() - qr.rank());
}

Matrix6X carried_wrenches(const Matrix6X& J, double length) {
  return weights(length).asDiagonal() * complement(weights(length).asDiagonal() * J);
}

Matrix6X free_twists(const Matrix6X& N, double length) {
  return weights(1 / length).asDiagonal() * complement(weights(1 / length).asDiagonal() * N);
}

Matrix6 stiffness(const Flexibility& f, double length, const std::string& name) {
  if (f.N.cols() == 0) return Matrix6::Zero();
  const MatrixX G = f.N.transpose() * f.C * f.N;
  Eigen::FullPivLU<MatrixX> lu;
  lu.setThreshold(1e-13);
  lu.compute(G);
  if (!lu.isInvertible()) {
    const MatrixX rigid = reduced(weights(1 / length).asDiagonal() * (f.N * lu.kernel()));
    std::vector<std::string> motions;
    for (Eigen::Index i = 0; i < rigid.cols(); ++i)
      motions.push_back(resisted_motion(weights(length).cwiseProduct(rigid.col(i)), length));
    throw ModelError(fmt::format(
        "{}: infinite stiffness: nothing yields in {}; the pose is singular, or a member, joint or actuator "
        "must be given some compliance",
        name, fmt::join(motions, "; in ")));
  }
  return f.N * lu.solve(f.N.transpose());
}

}  // namespace deflect::analytic
