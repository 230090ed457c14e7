#include "msa/frame/structure/motions.h"

namespace deflect::frame {

std::vector<Eigen::Index> take_apart(MatrixX& U) {
  std::vector<Eigen::Index> leads;
  for (Eigen::Index j = 0; j < U.cols(); ++j) {
    Eigen::Index row = 0, column = 0;
    U.rightCols(U.cols() - j).cwiseAbs().maxCoeff(&row, &column);
    U.col(j).swap(U.col(j + column));
    U.col(j) /= U(row, j);
    for (Eigen::Index k = 0; k < U.cols(); ++k)
      if (k != j) U.col(k) -= U(row, k) * U.col(j);
    leads.push_back(row);
  }
  return leads;
}

}  // namespace deflect::frame
