#include "msa/frame/sparse_cholesky.h"

#include <cholmod.h>

#include <cmath>
#include <cstring>
#include <new>
#include <stdexcept>

namespace deflect::frame {

struct SparseCholesky::Impl {
  cholmod_common common;
  cholmod_sparse* A = nullptr;
  cholmod_factor* L = nullptr;
  VectorX scale;

  Impl() {
    cholmod_start(&common);
    common.print = 0;
    common.final_ll = true;
    common.quick_return_if_not_posdef = true;
  }
  ~Impl() {
    cholmod_free_factor(&L, &common);
    cholmod_free_sparse(&A, &common);
    cholmod_finish(&common);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  int* columns() const { return static_cast<int*>(A->p); }
  int* rows() const { return static_cast<int*>(A->i); }
  double* values() const { return static_cast<double*>(A->x); }
};

SparseCholesky::SparseCholesky(const SparsePattern& p) : impl_(std::make_unique<Impl>()) {
  if (p.n == 0) return;  // nothing is free to move; CHOLMOD has no empty factor
  const auto n = static_cast<std::size_t>(p.n);
  impl_->A = cholmod_allocate_sparse(n, n, p.row.size(), true, true, -1, CHOLMOD_REAL, &impl_->common);
  if (!impl_->A) throw std::bad_alloc();
  std::copy(p.column_start.begin(), p.column_start.end(), impl_->columns());
  std::copy(p.row.begin(), p.row.end(), impl_->rows());
  std::fill_n(impl_->values(), p.row.size(), 0.0);
  impl_->L = cholmod_analyze(impl_->A, &impl_->common);
  if (!impl_->L) throw std::bad_alloc();
}

SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

double SparseCholesky::factor(const std::vector<double>& values) {
  Impl& s = *impl_;
  if (!s.A) return 1;
  const auto n = static_cast<int>(s.A->nrow);
  s.scale.resize(n);
  for (int j = 0; j < n; ++j) {
    const double diagonal = values[static_cast<std::size_t>(s.columns()[j])];
    if (!(diagonal > 0)) return 0;
    s.scale(j) = 1 / std::sqrt(diagonal);
  }
  for (int j = 0; j < n; ++j)
    for (int k = s.columns()[j]; k < s.columns()[j + 1]; ++k)
      s.values()[k] = values[static_cast<std::size_t>(k)] * s.scale(j) * s.scale(s.rows()[k]);
  cholmod_factorize(s.A, s.L, &s.common);
  if (s.common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (s.common.status < 0) throw std::logic_error("CHOLMOD refused the matrix");
  if (s.L->minor < s.L->n) return 0;  // read before the condition estimate, which would report success
  return cholmod_rcond(s.L, &s.common);
}

MatrixX SparseCholesky::solve(const MatrixX& B) const {
  Impl& s = *impl_;
  if (!s.A) return B;
  const auto rows = static_cast<std::size_t>(B.rows()), columns = static_cast<std::size_t>(B.cols());
  MatrixX scaled = s.scale.asDiagonal() * B;
  cholmod_dense b{rows, columns, rows * columns, rows, scaled.data(), nullptr, CHOLMOD_REAL, CHOLMOD_DOUBLE};
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, s.L, &b, &s.common);
  if (!x) throw std::bad_alloc();
  MatrixX X(B.rows(), B.cols());
  std::memcpy(X.data(), x->x, sizeof(double) * rows * columns);
  cholmod_free_dense(&x, &s.common);
  return s.scale.asDiagonal() * X;
}

}  // namespace deflect::frame
