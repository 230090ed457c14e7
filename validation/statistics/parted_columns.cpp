#include "validation/statistics/parted_columns.h"
#include "msa/base/index.h"

namespace deflect::statistics {

Eigen::Index PartedColumns::cols() const {
  Eigen::Index out = shared.cols();
  for (const GroupColumns& g : groups) out += g.columns.cols();
  return out;
}

VectorX PartedColumns::operator*(const VectorX& x) const {
  VectorX out = shared * x.head(shared.cols());
  Eigen::Index at = shared.cols();
  for (const GroupColumns& g : groups) {
    const VectorX own = g.columns * x.segment(at, g.columns.cols());
    for (std::size_t i = 0; i < g.rows.size(); ++i) out(g.rows[i]) += own(as_index(i));
    at += g.columns.cols();
  }
  return out;
}

PartedColumns& PartedColumns::operator*=(double factor) {
  shared *= factor;
  for (GroupColumns& g : groups) g.columns *= factor;
  return *this;
}

VectorX PartedColumns::squared_row_norms() const {
  VectorX out = shared.rowwise().squaredNorm();
  for (const GroupColumns& g : groups)
    for (std::size_t i = 0; i < g.rows.size(); ++i) out(g.rows[i]) += g.columns.row(as_index(i)).squaredNorm();
  return out;
}

MatrixX PartedColumns::dense() const {
  MatrixX out = MatrixX::Zero(rows(), cols());
  out.leftCols(shared.cols()) = shared;
  Eigen::Index at = shared.cols();
  for (const GroupColumns& g : groups) {
    out(g.rows, Eigen::seqN(at, g.columns.cols())) = g.columns;
    at += g.columns.cols();
  }
  return out;
}

}  // namespace deflect::statistics
