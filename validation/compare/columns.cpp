#include "validation/compare/columns.h"

#include <Eigen/QR>

namespace deflect {

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
  Eigen::ColPivHouseholderQR<MatrixX> qr;
  if (threshold > 0) qr.setThreshold(threshold);
  qr.compute(X);
  return qr.householderQ() * MatrixX::Identity(X.rows(), qr.rank());
}

}  // namespace deflect
