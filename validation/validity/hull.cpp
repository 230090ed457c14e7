#include "validation/validity/hull.h"

#include <Eigen/QR>
#include <algorithm>
#include <vector>

#include "msa/base/index.h"

namespace deflect::validity {
namespace {

/// min ‖A w − b‖, w ≥ 0.
VectorX non_negative(const MatrixX& A, const VectorX& b) {
  const Eigen::Index n = A.cols();
  const double small = 1e-12 * std::max(1.0, A.cwiseAbs().maxCoeff() * b.cwiseAbs().maxCoeff());
  VectorX w = VectorX::Zero(n);
  std::vector<Eigen::Index> free;
  for (Eigen::Index round = 0; round < 3 * n + 10; ++round) {
    const VectorX slope = A.transpose() * (b - A * w);
    Eigen::Index best = -1;
    for (Eigen::Index i = 0; i < n; ++i)
      if (std::find(free.begin(), free.end(), i) == free.end() && slope(i) > small &&
          (best < 0 || slope(i) > slope(best)))
        best = i;
    if (best < 0) break;
    free.push_back(best);
    while (true) {
      const VectorX wanted = A(Eigen::all, free).colPivHouseholderQr().solve(b);
      double step = 1;
      for (std::size_t k = 0; k < free.size(); ++k)
        if (const double to = wanted(as_index(k)); to <= 0 && w(free[k]) > to)
          step = std::min(step, w(free[k]) / (w(free[k]) - to));
      for (std::size_t k = 0; k < free.size(); ++k) w(free[k]) += step * (wanted(as_index(k)) - w(free[k]));
      if (step == 1) break;
      std::erase_if(free, [&](Eigen::Index i) {
        if (w(i) > 1e-14) return false;
        w(i) = 0;
        return true;
      });
    }
  }
  return w;
}

}  // namespace

VectorX nearest_in_hull(const MatrixX& X, const VectorX& q) {
  const double size = std::max({X.cwiseAbs().maxCoeff(), q.cwiseAbs().maxCoeff(), 1e-300});
  MatrixX A(X.rows() + 1, X.cols());
  A.topRows(X.rows()) = X / size;
  A.bottomRows<1>().setConstant(1e4);
  VectorX b(q.size() + 1);
  b << q / size, 1e4;
  VectorX w = non_negative(A, b);
  w /= w.sum();
  return X * w;
}

}  // namespace deflect::validity
