#include "msa/frame/structure/sparse_cholesky.h"

#include <cholmod.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <stdexcept>
#include <utility>

#include "msa/base/index.h"
#include "msa/frame/elements/two_at_once.h"

// OpenBLAS, where it is the BLAS.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));
extern "C" int openblas_get_num_threads() __attribute__((weak));

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

  MatrixX solve_scaled(MatrixX B);

  int* columns() const { return static_cast<int*>(A->p); }
  int* rows() const { return static_cast<int*>(A->i); }
  double* values() const { return static_cast<double*>(A->x); }
};

namespace {

// From here on METIS on the graph of nodes, without a trial of others before it.
constexpr std::size_t many_columns = 5000;

/// As many threads of the BLAS as the machine has while a large matrix is worked on; then as before.
class BlasThreads {
 public:
  explicit BlasThreads(std::size_t columns) {
    if (columns < many_columns || !openblas_set_num_threads || !openblas_get_num_threads) return;
    before_ = openblas_get_num_threads();
    openblas_set_num_threads(threads_of(0));
  }
  ~BlasThreads() {
    if (before_ > 0) openblas_set_num_threads(before_);
  }
  BlasThreads(const BlasThreads&) = delete;
  BlasThreads& operator=(const BlasThreads&) = delete;

 private:
  int before_ = 0;
};

/// By column, a number for all that follow each other and have the same rows: the freedoms of a node.
std::vector<int> groups_of(const SparsePattern& p) {
  const auto rows = [&p](int j, int skip) {
    const auto k = as_size(j);
    return std::pair{p.row.begin() + p.column_start[k] + skip, p.row.begin() + p.column_start[k + 1]};
  };
  std::vector<int> group(as_size(p.n), 0);
  for (int j = 1; j < p.n; ++j) {
    const auto [from, to] = rows(j - 1, 1);
    const auto [first, last] = rows(j, 0);
    nth(group, j) = group[as_size(j) - 1] + !std::equal(from, to, first, last);
  }
  return group;
}

/// Nested dissection (Karypis and Kumar's METIS) of groups of columns; an order of columns.
std::vector<int> dissected(const SparsePattern& p, cholmod_common& common) {
  const std::vector<int> group = groups_of(p);
  const auto groups = as_size(group.back()) + 1;
  std::vector<int> column_start{0}, row, met(groups, -1), first{0};
  for (int j = 0; j < p.n; ++j) {
    const auto k = as_size(j);
    const int g = group[k];
    for (int at = p.column_start[k]; at < p.column_start[k + 1]; ++at) {
      const int other = nth(group, nth(p.row, at));
      if (std::exchange(nth(met, other), g) != g) row.push_back(other);
    }
    if (j + 1 == p.n || group[k + 1] != g) {
      column_start.push_back(static_cast<int>(row.size()));
      first.push_back(j + 1);
    }
  }
  cholmod_sparse graph{};
  graph.nrow = graph.ncol = groups;
  graph.nzmax = row.size();
  graph.p = column_start.data();
  graph.i = row.data();
  graph.stype = -1;
  graph.itype = CHOLMOD_INT;
  graph.xtype = CHOLMOD_PATTERN;
  graph.dtype = CHOLMOD_DOUBLE;
  graph.packed = true;
  std::vector<int> of_groups(groups), order;
  if (!cholmod_metis(&graph, nullptr, 0, true, of_groups.data(), &common)) throw std::bad_alloc();
  for (const int g : of_groups)
    for (int j = nth(first, g); j < first[as_size(g) + 1]; ++j) order.push_back(j);
  return order;
}

}  // namespace

SparseCholesky::SparseCholesky(const SparsePattern& p) : impl_(std::make_unique<Impl>()) {
  if (p.n == 0) return;  // nothing is free to move; CHOLMOD has no empty factor
  const auto n = as_size(p.n);
  impl_->A = cholmod_allocate_sparse(n, n, p.row.size(), true, true, -1, CHOLMOD_REAL, &impl_->common);
  if (!impl_->A) throw std::bad_alloc();
  std::copy(p.column_start.begin(), p.column_start.end(), impl_->columns());
  std::copy(p.row.begin(), p.row.end(), impl_->rows());
  std::fill_n(impl_->values(), p.row.size(), 0.0);
  if (n < many_columns) {
    impl_->L = cholmod_analyze(impl_->A, &impl_->common);
  } else {
    std::vector<int> order = dissected(p, impl_->common);
    impl_->common.nmethods = 1;
    impl_->common.method[0].ordering = CHOLMOD_GIVEN;
    impl_->L = cholmod_analyze_p(impl_->A, order.data(), nullptr, 0, &impl_->common);
  }
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
    const double diagonal = nth(values, s.columns()[j]);
    if (!(diagonal > 0)) return 0;
    s.scale(j) = 1 / std::sqrt(diagonal);
  }
  for (int j = 0; j < n; ++j)
    for (int k = s.columns()[j]; k < s.columns()[j + 1]; ++k)
      s.values()[k] = nth(values, k) * s.scale(j) * s.scale(s.rows()[k]);
  const BlasThreads threads(s.A->nrow);
  cholmod_factorize(s.A, s.L, &s.common);
  if (s.common.status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
  if (s.common.status < 0) throw std::logic_error("CHOLMOD refused the matrix");
  if (s.L->minor < s.L->n) return 0;  // read before the condition estimate, which would report success
  return cholmod_rcond(s.L, &s.common);
}

/// S K S X = B.
MatrixX SparseCholesky::Impl::solve_scaled(MatrixX B) {
  const auto rows = as_size(B.rows()), columns = as_size(B.cols());
  const BlasThreads threads(A->nrow);
  cholmod_dense b{rows, columns, rows * columns, rows, B.data(), nullptr, CHOLMOD_REAL, CHOLMOD_DOUBLE};
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, L, &b, &common);
  if (!x) throw std::bad_alloc();
  std::memcpy(B.data(), x->x, sizeof(double) * rows * columns);
  cholmod_free_dense(&x, &common);
  return B;
}

SparseCholesky::Softest SparseCholesky::softest() const {
  Impl& s = *impl_;
  if (!s.A) return {1, {}};
  const auto n = as_index(s.A->nrow);
  MatrixX X(n, 2);
  for (Eigen::Index i = 0; i < n; ++i)
    X.row(i) << std::sin(12.9898 * static_cast<double>(i + 1)), std::cos(78.233 * static_cast<double>(i + 1));
  Softest out;
  for (int pass = 0; pass < 3; ++pass) {
    X.colwise().normalize();
    X = s.solve_scaled(std::move(X));
  }
  Eigen::Index softer = 0;
  const double size = X.colwise().norm().maxCoeff(&softer);
  out.eigenvalue = std::isfinite(size) ? 1 / size : 0;
  out.motion = s.scale.cwiseProduct(X.col(softer) / size);
  return out;
}

MatrixX SparseCholesky::solve(const MatrixX& B) const {
  if (!impl_->A) return B;
  return impl_->scale.asDiagonal() * impl_->solve_scaled(impl_->scale.asDiagonal() * B);
}

}  // namespace deflect::frame
