#include "msa/frame/iterative/incomplete_cholesky.h"
#include "msa/base/index.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace deflect::frame {
namespace {

/// C⁻¹ B.
Matrix6 divided(const Matrix6& C, const Matrix6& B) { return C.triangularView<Eigen::Lower>().solve(B); }

}  // namespace

IncompleteCholesky::IncompleteCholesky(NodeBlocks blocks) : k_(std::move(blocks)) {
  const auto rows = k_.diagonal.size();
  C_.reserve(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    Matrix6 pivot = k_.diagonal[i];
    const auto from = as_size(k_.start[i]), to = as_size(k_.start[i + 1]);
    for (std::size_t k = from; k < to; ++k) {
      const Matrix6 turned = divided(nth(C_, k_.column[k]), k_.lower[k].transpose());
      pivot.noalias() -= turned.transpose() * turned;
      k_.lower[k] = turned.transpose();
    }
    Eigen::LLT<Matrix6> cholesky(pivot);
    if (cholesky.info() != Eigen::Success) cholesky.compute(k_.diagonal[i]);
    const Matrix6 C = cholesky.matrixL();
    const double least = C.diagonal().minCoeff();
    if (cholesky.info() != Eigen::Success || !(least > 0)) {
      smallest_pivot_ = 0;
      return;
    }
    smallest_pivot_ = std::min(smallest_pivot_, least * least);
    for (std::size_t k = from; k < to; ++k) k_.lower[k] = divided(C, k_.lower[k]);
    const Matrix6 half = divided(C, k_.diagonal[i]);
    k_.diagonal[i] = divided(C, half.transpose());
    C_.push_back(C);
  }
}

IncompleteCholesky::Part IncompleteCholesky::part(int which) const {
  if (which == 0) return {0, k_.first_end};
  return which == 1 ? Part{k_.first_end, k_.ends} : Part{k_.ends, rows()};
}

/// w ← (I + L)⁻¹ w in these rows; what they refer to is done.
void IncompleteCholesky::forward(int from, int to, VectorX& w) const {
  for (int i = from; i < to; ++i) {
    Vector6 sum = w.segment<6>(6 * i);
    const auto row = as_size(i);
    for (int k = k_.start[row]; k < k_.start[row + 1]; ++k) {
      const auto block = as_size(k);
      sum.noalias() -= k_.lower[block] * w.segment<6>(6 * k_.column[block]);
    }
    w.segment<6>(6 * i) = sum;
  }
}

/// t ← (I + L)⁻ᵀ t in these rows, what follows from later rows being in; passed on to columns from `least` on.
void IncompleteCholesky::backward(int from, int to, int least, VectorX& t) const {
  for (int i = to - 1; i >= from; --i) {
    const Vector6 known = t.segment<6>(6 * i);
    const auto row = as_size(i);
    for (int k = k_.start[row + 1] - 1; k >= k_.start[row]; --k) {
      const auto block = as_size(k);
      if (k_.column[block] < least) break;
      t.segment<6>(6 * k_.column[block]).noalias() -= k_.lower[block].transpose() * known;
    }
  }
}

VectorX IncompleteCholesky::forces_inside(const VectorX& by_q) const {
  VectorX w = k_.gathered(by_q);
  for (int i = 0; i < rows(); ++i) nth(C_, i).triangularView<Eigen::Lower>().solveInPlace(w.segment<6>(6 * i));
  forward(0, rows(), w);
  return w;
}

VectorX IncompleteCholesky::motion_outside(const VectorX& inside) const {
  VectorX t = inside;
  backward(0, rows(), 0, t);
  for (int i = 0; i < rows(); ++i)
    nth(C_, i).triangularView<Eigen::Lower>().transpose().solveInPlace(t.segment<6>(6 * i));
  return k_.scattered(t);
}

void IncompleteCholesky::join(const VectorX& p, VectorX& t) const {
  const auto [from, to] = part(2);
  t.segment(6 * from, 6 * (to - from)) = p.segment(6 * from, 6 * (to - from));
  backward(from, to, from, t);
}

void IncompleteCholesky::sweep(int which, const VectorX& p, VectorX& t, VectorX& w) const {
  const auto [from, to] = part(which);
  t.segment(6 * from, 6 * (to - from)) = p.segment(6 * from, 6 * (to - from));
  for (int i = rows() - 1; i >= k_.ends; --i) {
    const auto row = as_size(i);
    for (int k = k_.start[row + 1] - 1; k >= k_.start[row]; --k) {
      const auto block = as_size(k);
      const int column = k_.column[block];
      if (column >= from && column < to)
        t.segment<6>(6 * column).noalias() -= k_.lower[block].transpose() * t.segment<6>(6 * i);
    }
  }
  backward(from, to, 0, t);
  for (int i = from; i < to; ++i) {
    const Vector6 known = t.segment<6>(6 * i);
    w.segment<6>(6 * i) = p.segment<6>(6 * i) - 2 * known;
    w.segment<6>(6 * i).noalias() += nth(k_.diagonal, i) * known;
  }
  forward(from, to, w);
}

void IncompleteCholesky::finish(const VectorX& p, const VectorX& t, VectorX& w) const {
  const auto [from, to] = part(2);
  for (int i = from; i < to; ++i) {
    const Vector6 known = t.segment<6>(6 * i);
    w.segment<6>(6 * i) = p.segment<6>(6 * i) - 2 * known;
    w.segment<6>(6 * i).noalias() += nth(k_.diagonal, i) * known;
  }
  forward(from, to, w);
}

}  // namespace deflect::frame
