#include "validation/statistics/columns.h"

#include <Eigen/QR>

namespace deflect::statistics {

MatrixX side_by_side(const std::vector<MatrixX>& parts, Eigen::Index rows) {
  Eigen::Index columns = 0;
  for (const MatrixX& p : parts) columns += p.cols();
  MatrixX out(rows, columns);
  columns = 0;
  for (const MatrixX& p : parts) {
    out.middleCols(columns, p.cols()) = p;
    columns += p.cols();
  }
  return out;
}

MatrixX orthonormal(const MatrixX& X, double threshold) {
  if (X.cols() == 0) return X;
  const auto ranked = [threshold](const MatrixX& Y) {
    Eigen::ColPivHouseholderQR<MatrixX> qr;
    if (threshold > 0) qr.setThreshold(threshold);
    qr.compute(Y);
    return leading_columns(qr.householderQ(), qr.rank());
  };
  if (X.cols() < 16 || X.rows() < 4 * X.cols()) return ranked(X);
  // X = Q R: the columns of R are as long as those of X, so that the pivots are the same, and R is small.
  const Eigen::HouseholderQR<MatrixX> qr(X);
  const MatrixX R = qr.matrixQR().topRows(X.cols()).triangularView<Eigen::Upper>();
  const MatrixX of_R = ranked(R);
  MatrixX out = MatrixX::Zero(X.rows(), of_R.cols());
  out.topRows(X.cols()) = of_R;
  out.applyOnTheLeft(qr.householderQ());
  return out;
}

MatrixX chosen_in_turn(MatrixX columns, VectorX explained, double least, double threshold) {
  MatrixX out(columns.rows(), 0);
  while (out.cols() < columns.cols()) {
    Eigen::Index best = -1;
    double most = least;
    for (Eigen::Index i = 0; i < columns.cols(); ++i) {
      const double length = columns.col(i).norm();
      if (length <= threshold) continue;
      const double along = columns.col(i).dot(explained) / length;
      if (along * along > most) most = along * along, best = i;
    }
    if (best < 0) break;
    const VectorX direction = columns.col(best).normalized();
    out.conservativeResize(Eigen::NoChange, out.cols() + 1);
    out.rightCols(1) = direction;
    explained -= direction * direction.dot(explained);
    columns -= direction * (direction.transpose() * columns).eval();
  }
  return out;
}

}  // namespace deflect::statistics
