#include "msa/frame/structure/mobility.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/structure/motions.h"
#include "msa/frame/structure/pieces.h"
#include "msa/frame/structure/sparse_cholesky.h"

namespace deflect::frame {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

constexpr double free_below = 1e-10, soft_below = 1e-5;
constexpr double at_rest = 1e-9;  // of a motion's size

/// Upper triangular R of M = QR, square.
MatrixX triangle(const MatrixX& M) {
  MatrixX padded = M;
  if (M.rows() < M.cols()) padded.conservativeResizeLike(MatrixX::Zero(M.cols(), M.cols()));
  return Eigen::HouseholderQR<MatrixX>(padded).matrixQR().topRows(M.cols()).template triangularView<Eigen::Upper>();
}

/// Small singular values of B and their vectors.
class SoftBlock {
 public:
  explicit SoftBlock(const Pieces& p) : B_(std::ssize(p.rows), p.coordinates) {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t i = 0; i < p.rows.size(); ++i)
      for (const Term& t : p.rows[i]) entries.emplace_back(static_cast<int>(i), t.dof, t.coefficient);
    B_.setFromTriplets(entries.begin(), entries.end());
    const Sparse lower = Sparse(B_.transpose() * B_).triangularView<Eigen::Lower>();
    pattern_ = {p.coordinates, {0}, {}};
    for (int j = 0; j < p.coordinates; ++j) {
      const std::size_t diagonal = values_.size();
      pattern_.row.push_back(j);
      values_.push_back(0);
      for (Sparse::InnerIterator it(lower, j); it; ++it) {
        if (it.row() == j) {
          values_[diagonal] = it.value();
        } else {
          pattern_.row.push_back(static_cast<int>(it.row()));
          values_.push_back(it.value());
        }
      }
      pattern_.column_start.push_back(static_cast<int>(pattern_.row.size()));
    }
  }

  /// At least all motions (columns of X) with σ < 1e-3, σ ascending; none where the smallest is proved to lie above
  /// 1e-4.
  void find(MatrixX& X, VectorX& sigma) const {
    const SparseCholesky shifted = factor();
    // The eigenvalue is that of BᵀB with a diagonal of ones; BᵀB has none below it times its own smallest entry there.
    double least = 1;
    for (int j = 0; j < pattern_.n; ++j) least = std::min(least, nth(values_, nth(pattern_.column_start, j)));
    if (shifted.softest().eigenvalue * least > 1e-8) return;
    const int n = pattern_.n;
    for (int block = std::min(8, n);; block = std::min(4 * block, n)) {
      iterate(shifted, block, X);
      const Eigen::JacobiSVD<MatrixX> svd(triangle(B_ * X), Eigen::ComputeFullV);
      X = X * svd.matrixV().rowwise().reverse();
      sigma = svd.singularValues().reverse();
      if (block == n || sigma(block - 1) > 1e-3) return;
    }
  }

 private:
  SparseCholesky factor() const {
    for (double shift = 1e-12; shift < 1e-3; shift *= 100) {
      std::vector<double> values = values_;
      for (int j = 0; j < pattern_.n; ++j) nth(values, nth(pattern_.column_start, j)) += shift;
      SparseCholesky cholesky(pattern_);
      if (cholesky.factor(values) > 0) return cholesky;
    }
    throw std::logic_error("a sum of squares is not positive");
  }

  /// The start is a block of fixed quasi-random numbers, so that the answer is the same every time.
  void iterate(const SparseCholesky& shifted, int block, MatrixX& X) const {
    X.resize(pattern_.n, block);
    for (int j = 0; j < block; ++j)
      for (Eigen::Index i = 0; i < X.rows(); ++i)
        X(i, j) = std::sin(12.9898 * static_cast<double>(i + 1) + 78.233 * static_cast<double>(j + 1));
    for (int pass = 0; pass < 4; ++pass) {
      X = shifted.solve(X);
      X = leading_columns(Eigen::HouseholderQR<MatrixX>(X).householderQ(), block);
    }
  }

  Sparse B_;
  SparsePattern pattern_;  // of BᵀB
  std::vector<double> values_;
};

/// Combinations of motions (columns): those that move nothing that is read, and the others.
struct Split {
  MatrixX idle, moving;
};

/// `observed` of each motion what is read, `whole` all of it, in metres.
Split split(const MatrixX& observed, const MatrixX& whole) {
  const MatrixX inverse = triangle(whole).inverse();
  const Eigen::JacobiSVD<MatrixX> svd(triangle(observed * inverse), Eigen::ComputeFullV);
  Eigen::Index moving = 0;
  while (moving < whole.cols() && svd.singularValues()(moving) > at_rest) ++moving;
  const MatrixX combinations = inverse * svd.matrixV();
  return {combinations.rightCols(whole.cols() - moving), combinations.leftCols(moving)};
}

class Motions {
 public:
  Motions(const Model& m, const Pieces& p) : m_(m), p_(p) {}

  /// A piece's motions x (columns, [u; size · θ] at its centre) at its nodes: six rows each, metres.
  MatrixX at_nodes(const Piece& piece, const MatrixX& x) const {
    MatrixX out(as_index(6 * piece.nodes.size()), x.cols());
    for (std::size_t i = 0; i < piece.nodes.size(); ++i)
      for (Eigen::Index j = 0; j < x.cols(); ++j) {
        const Vector3 turned = x.col(j).tail<3>();
        const Vector3 arm = nth(m_.nodes, piece.nodes[i]).position - piece.centre;
        out.block<3, 1>(as_index(6 * i), j) = x.col(j).head<3>() + turned.cross(arm) / piece.size;
        out.block<3, 1>(as_index(6 * i + 3), j) = turned;
      }
    return out;
  }

  /// The rows of at_nodes that are read.
  MatrixX observed(const Piece& piece, const MatrixX& at_nodes) const {
    std::vector<Eigen::Index> rows;
    for (std::size_t i = 0; i < piece.nodes.size(); ++i) {
      const bool all = m_.watched == piece.nodes[i];
      for (Eigen::Index k = 0; k < (all ? 6 : m_.watched < 0 ? 3 : 0); ++k) rows.push_back(as_index(6 * i) + k);
    }
    return at_nodes(rows, Eigen::all);
  }

  /// Motions of all pieces and scalars by freedom; rows as in at_nodes, the scalars' in their y.
  MatrixX of_coordinates(const MatrixX& Y) const {
    MatrixX out = MatrixX::Zero(m_.dofs(), Y.cols());
    for (const Piece& piece : p_.pieces) {
      const MatrixX at = at_nodes(piece, piece.held * Y.middleRows(piece.first, piece.held.cols()));
      for (std::size_t i = 0; i < piece.nodes.size(); ++i)
        out.middleRows<6>(6 * piece.nodes[i]) = at.middleRows<6>(as_index(6 * i));
    }
    for (std::size_t s = 0; s < m_.scalars.size(); ++s)
      if (p_.y_of_scalar[s] >= 0) out.row(as_index(6 * m_.nodes.size() + s)) = Y.row(p_.y_of_scalar[s]);
    return out;
  }

  MatrixX observed(const MatrixX& all) const {
    if (m_.watched >= 0) return all.middleRows<6>(6 * m_.watched);
    MatrixX out(as_index(3 * m_.nodes.size()), all.cols());
    for (std::size_t i = 0; i < m_.nodes.size(); ++i)
      out.middleRows<3>(as_index(3 * i)) = all.middleRows<3>(as_index(6 * i));
    return out;
  }

  bool nodal(int dof) const { return dof < static_cast<int>(6 * m_.nodes.size()); }

  /// By freedom: what turns rows in metres into the freedom's own unit.
  double unit(Eigen::Index dof) const {
    const auto node = as_size(dof / 6);
    if (node >= m_.nodes.size()) return p_.scalar_unit[as_size(dof) - 6 * m_.nodes.size()];
    return dof % 6 < 3 ? 1 : 1 / nth(p_.pieces, p_.of_node[node]).size;
  }

 private:
  const Model& m_;
  const Pieces& p_;
};

/// Idle motions, rows for the given freedoms. Each is held along its own direction at the node where it leads, where no
/// other one moves that way, else by the one freedom in which the others rest.
void append_idle(std::vector<IdleMotion>& out, const Motions& motions, MatrixX U, const std::vector<int>& dofs) {
  const std::vector<Eigen::Index> leads = take_apart(U);
  for (Eigen::Index j = 0; j < U.cols(); ++j) {
    const Eigen::Index lead = nth(leads, j), first = lead / 3 * 3;
    std::vector<Eigen::Index> rows{lead};
    if (first + 2 < U.rows() && motions.nodal(nth(dofs, first + 2))) {
      const Vector3 direction = U.block<3, 1>(first, j);
      VectorX others = U.middleRows<3>(first).transpose() * direction;
      others(j) = 0;
      if (others.isZero(at_rest)) rows = {first, first + 1, first + 2};
    }
    IdleMotion idle;
    double size = 0;
    for (const Eigen::Index row : rows) size += U(row, j) * U(row, j);
    for (const Eigen::Index row : rows) {
      const int dof = nth(dofs, row);
      if (std::abs(U(row, j)) > at_rest) idle.hold.push_back({dof, U(row, j) / size / motions.unit(dof)});
    }
    for (Eigen::Index i = 0; i < U.rows(); ++i) {
      const int dof = nth(dofs, i);
      if (std::abs(U(i, j)) > at_rest) idle.u.push_back({dof, U(i, j) * motions.unit(dof)});
    }
    out.push_back(std::move(idle));
  }
}

/// Motions of single pieces, and of scalars, that no condition sees; those that are not idle as columns of `moving`.
void append_loose(const Model& m, const Pieces& p, const Motions& motions, std::vector<IdleMotion>& idle,
                  std::vector<VectorX>& moving) {
  for (const Piece& piece : p.pieces) {
    if (piece.loose.cols() == 0) continue;
    const MatrixX at = motions.at_nodes(piece, piece.loose);
    Split parts = split(motions.observed(piece, at), at);
    // What moves anyway is told with all that it can do.
    if (parts.moving.cols() > 0) parts = {MatrixX(at.cols(), 0), MatrixX::Identity(at.cols(), at.cols())};
    std::vector<int> dofs;
    for (const int node : piece.nodes)
      for (int i = 0; i < 6; ++i) dofs.push_back(6 * node + i);
    if (parts.idle.cols() > 0) append_idle(idle, motions, at * parts.idle, dofs);
    const MatrixX moved = at * parts.moving;
    for (Eigen::Index j = 0; j < moved.cols(); ++j) {
      moving.push_back(VectorX::Zero(m.dofs()));
      for (std::size_t i = 0; i < dofs.size(); ++i)
        moving.back()(dofs[i]) = motions.unit(dofs[i]) * moved(as_index(i), j);
    }
  }
  for (std::size_t s = 0; s < m.scalars.size(); ++s) {
    const int dof = static_cast<int>(6 * m.nodes.size() + s);
    if (p.y_of_scalar[s] < 0) idle.push_back({{{dof, 1}}, {{dof, 1}}});
  }
}

}  // namespace

std::vector<IdleMotion> loose_pieces(const Model& m, const std::vector<char>& resists) {
  const Pieces p = pieces_of(m, resists);
  std::vector<IdleMotion> idle;
  std::vector<VectorX> moving;
  append_loose(m, p, Motions(m, p), idle, moving);
  return idle;
}

Mobility mobility_of(const Model& m, const std::vector<char>& resists) {
  const Pieces p = pieces_of(m, resists);
  const Motions motions(m, p);
  Mobility out;
  std::vector<VectorX> moving;
  append_loose(m, p, motions, out.idle, moving);
  const auto in_own_units = [&](MatrixX U) {
    for (Eigen::Index i = 0; i < U.rows(); ++i) U.row(i) *= motions.unit(i);
    return U;
  };
  for (const Piece& piece : p.pieces) {
    if (piece.weakest >= out.smallest_held) continue;
    out.smallest_held = piece.weakest;
    if (piece.weakest > soft_below) continue;
    out.softest = VectorX::Zero(m.dofs());
    for (const Term& t : motion_of(m, piece, piece.held.rightCols<1>().normalized()))
      out.softest(t.dof) = t.coefficient;
  }
  if (p.coordinates > 0) {
    MatrixX Y;
    VectorX sigma;
    SoftBlock(p).find(Y, sigma);
    Eigen::Index found = 0;
    while (found < sigma.size() && sigma(found) < free_below) ++found;
    if (found > 0) {
      out.largest_free = sigma(found - 1);
      const MatrixX U = motions.of_coordinates(Y.leftCols(found));
      const Split parts = split(motions.observed(U), U);
      std::vector<int> dofs(as_size(m.dofs()));
      std::iota(dofs.begin(), dofs.end(), 0);
      if (parts.idle.cols() > 0) append_idle(out.idle, motions, U * parts.idle, dofs);
      const MatrixX moved = in_own_units(U * parts.moving);
      for (Eigen::Index j = 0; j < moved.cols(); ++j) moving.emplace_back(moved.col(j));
    }
    if (found < sigma.size() && sigma(found) < out.smallest_held) {
      out.smallest_held = sigma(found);
      if (sigma(found) < soft_below) out.softest = in_own_units(motions.of_coordinates(Y.col(found)));
    }
  }
  out.free.resize(m.dofs(), std::ssize(moving));
  for (std::size_t j = 0; j < moving.size(); ++j) out.free.col(as_index(j)) = moving[j];
  return out;
}

}  // namespace deflect::frame
