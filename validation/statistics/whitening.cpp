#include "validation/statistics/whitening.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "msa/base/index.h"
#include "validation/parallel/cases.h"

namespace deflect::statistics {
namespace {

/// f of some columns at a time, as many whatever the threads: so are the sums in products.
template <class F>
MatrixX by_parts(const MatrixX& X, int threads, const F& f) {
  constexpr Eigen::Index some = 8, little = 200'000;  // numbers that are not worth a thread
  if (X.cols() <= some) return f(X);
  MatrixX out(X.rows(), X.cols());
  const auto parts = as_size((X.cols() + some - 1) / some);
  parallel::for_each_case(parts, 1, X.size() > little ? threads : 1, [&](std::size_t part) {
    const Eigen::Index first = as_index(part) * some, count = std::min(some, X.cols() - first);
    out.middleCols(first, count) = f(X.middleCols(first, count));
  });
  return out;
}

}  // namespace

Whitening::Root Whitening::root(const MatrixX& X) {
  if (X.cols() == 0) return {MatrixX(0, 0), MatrixX(0, 0), MatrixX(0, 0), 0};
  MatrixX squares = MatrixX::Zero(X.cols(), X.cols());
  squares.selfadjointView<Eigen::Lower>().rankUpdate(X.transpose());
  const Eigen::SelfAdjointEigenSolver<MatrixX> axes(squares);  // reads the lower half
  const VectorX deviation = (1 + axes.eigenvalues().array().max(0)).sqrt();
  const VectorX less = -(deviation.array() * (1 + deviation.array())).inverse(),
                more = (1 + deviation.array()).inverse();
  const MatrixX& V = axes.eigenvectors();
  const VectorX square = -deviation.array().square().inverse();
  return {V * less.asDiagonal() * V.transpose(), V * more.asDiagonal() * V.transpose(),
          V * square.asDiagonal() * V.transpose(), 2 * deviation.array().log().sum()};
}

Whitening::Whitening(const std::vector<NoiseBlock>& blocks, const PartedColumns& errors, int threads)
    : rows_(errors.rows()), amplitudes_(errors.cols()), threads_(threads) {
  for (const NoiseBlock& b : blocks) {
    if (b.covariance.size() == 0) continue;
    MatrixX inverse = MatrixX::Identity(b.size, b.size);
    b.covariance.llt().matrixL().solveInPlace(inverse);
    factors_.push_back({b.first, b.size, entries_.size()});
    log_determinant_ -= 2 * inverse.diagonal().array().log().sum();
    for (Eigen::Index i = 0; i < b.size; ++i)
      for (Eigen::Index k = 0; k <= i; ++k) entries_.push_back(inverse(i, k));
  }
  Eigen::Index widest = 0, first = errors.shared.cols();
  for (const GroupColumns& g : errors.groups) {
    if (!g.rows.empty() && g.columns.cols() > 0) groups_.push_back({g.rows, g.columns, {}, {}, first});
    first += g.columns.cols();
    widest = std::max(widest, g.columns.cols());
  }
  if (!groups_.empty()) {
    MatrixX together = MatrixX::Zero(rows_, widest);
    for (const Group& g : groups_) together(g.rows, Eigen::seqN(0, g.O.cols())) = g.O;
    together = by_noise(together);
    for (Group& g : groups_) {
      g.O = together(g.rows, Eigen::seqN(0, g.O.cols())).eval();
      Root of_group = root(g.O);
      g.less = std::move(of_group.less);
      g.more = std::move(of_group.more);
      log_determinant_ += of_group.log_determinant;
    }
  }
  B_ = by_parts(errors.shared, threads_, [&](const MatrixX& part) { return within_groups(part); });
  root_ = root(B_);
  log_determinant_ += root_.log_determinant;
}

MatrixX Whitening::by_noise(const MatrixX& X) const {
  MatrixX out = MatrixX::Zero(X.rows(), X.cols());
  constexpr std::size_t some = 512;  // blocks whose factors stay at hand while they pass over all columns
  for (std::size_t begin = 0; begin < factors_.size(); begin += some) {
    const std::size_t end = std::min(begin + some, factors_.size());
    for (Eigen::Index c = 0; c < X.cols(); ++c)
      for (std::size_t b = begin; b < end; ++b) {
        const Factor& f = factors_[b];
        const double *entry = &entries_[f.at], *from = &X(f.first, c);
        double* to = &out(f.first, c);
        for (Eigen::Index i = 0; i < f.size; ++i) {
          double sum = 0;
          for (Eigen::Index k = 0; k <= i; ++k) sum += *entry++ * from[k];
          to[i] = sum;
        }
      }
  }
  return out;
}

void Whitening::within_groups_in_place(MatrixX& X) const {
  change_groups(groups_, X,
                [](const Group& g, MatrixX& part) { part += g.O * (g.less * (g.O.transpose() * part)).eval(); });
}

std::vector<GroupColumns> Whitening::groups_by_noise() const {
  std::vector<GroupColumns> out;
  for (const Group& g : groups_) out.push_back({g.rows, g.O});
  return out;
}

void Whitening::white_within_groups(std::vector<GroupColumns>& all) const {
  Eigen::Index widest = 0;
  for (const GroupColumns& g : all) widest = std::max(widest, g.columns.cols());
  MatrixX together = MatrixX::Zero(rows_, widest);
  for (const GroupColumns& g : all) together(g.rows, Eigen::seqN(0, g.columns.cols())) = g.columns;
  together = within_groups(together);
  for (GroupColumns& g : all) g.columns = together(g.rows, Eigen::seqN(0, g.columns.cols())).eval();
}

VectorX Whitening::norms_of_shared(const GroupColumns& g) const {
  const MatrixX along = B_(g.rows, Eigen::all).transpose() * g.columns;
  const VectorX less = along.cwiseProduct(root_.square * along).colwise().sum().transpose();
  return (g.columns.colwise().squaredNorm().transpose() + less).cwiseMax(0).cwiseSqrt();
}

MatrixX Whitening::within_groups(const MatrixX& X) const {
  MatrixX out = by_noise(X);
  within_groups_in_place(out);
  return out;
}

MatrixX Whitening::of_shared(MatrixX X) const {
  if (B_.cols() > 0) X += B_ * (root_.less * (B_.transpose() * X)).eval();
  return X;
}

MatrixX Whitening::undo_shared(MatrixX X) const {
  if (B_.cols() > 0) X += B_ * (root_.more * (B_.transpose() * X)).eval();
  return X;
}

MatrixX Whitening::operator()(const MatrixX& X) const {
  return by_parts(X, threads_, [&](const MatrixX& part) { return of_shared(within_groups(part)); });
}

/// By substitution: L⁻¹ is stored.
void Whitening::undo_noise_in_place(MatrixX& X) const {
  Eigen::Index next = 0;
  for (const Factor& f : factors_) {
    X.middleRows(next, f.first - next).setZero();
    for (Eigen::Index c = 0; c < X.cols(); ++c) {
      const double* entry = &entries_[f.at];
      double* x = &X(f.first, c);
      for (Eigen::Index i = 0; i < f.size; ++i) {
        for (Eigen::Index k = 0; k < i; ++k) x[i] -= *entry++ * x[k];
        x[i] /= *entry++;
      }
    }
    next = f.first + f.size;
  }
  X.bottomRows(rows_ - next).setZero();
}

MatrixX Whitening::undo(const MatrixX& X) const {
  return by_parts(X, threads_, [&](const MatrixX& part) {
    MatrixX out = undo_shared(part);
    change_groups(groups_, out,
                  [](const Group& g, MatrixX& own) { own += g.O * (g.more * (g.O.transpose() * own)).eval(); });
    undo_noise_in_place(out);
    return out;
  });
}

// Sᵀ Σ⁻¹ r = Bᵀ W_S W r and Oᵀ Σ⁻¹ r = Õᵀ W_O W_S W r.
VectorX Whitening::amplitudes(const VectorX& r) const {
  MatrixX white = of_shared(of_shared(within_groups(r)));
  VectorX out = VectorX::Zero(amplitudes_);
  out.head(B_.cols()) = B_.transpose() * white;
  within_groups_in_place(white);
  for (const Group& g : groups_) out.segment(g.first, g.O.cols()) = g.O.transpose() * white(g.rows, Eigen::all);
  return out;
}

}  // namespace deflect::statistics
