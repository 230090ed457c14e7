// Whitening: makes numbers independent that have errors of their own, errors shared by a group, and errors shared by
// all. The cost grows linearly with the numbers.
//
//   r ~ N(0, Σ),   Σ = N + ⊕_g O_g O_gᵀ + S Sᵀ
//   N    block diagonal; a block has consecutive numbers (those of a reading);
//   O_g  columns over the rows of group g only (those of a pose);
//   S    columns over all rows.
// The three are eliminated in turn, W = W_S W_O W_N with WᵀW = Σ⁻¹:
//   W_N = ⊕_b L_b⁻¹,                        N_b = L_b L_bᵀ
//   W_O = ⊕_g (1 + Õ_g Õ_gᵀ)^(−1/2),        Õ = W_N O
//   W_S = (1 + B Bᵀ)^(−1/2),                B = W_O W_N S
// because W_O⁻² + B̃ B̃ᵀ = W_O⁻¹ (1 + B Bᵀ) W_O⁻¹ for B̃ = W_N S = W_O⁻¹ B. With XᵀX = V diag(w) Vᵀ
//   (1 + X Xᵀ)^(−1/2) = 1 − X V diag(1/(√(1+w) (1 + √(1+w)))) Vᵀ Xᵀ,
//   (1 + X Xᵀ)^(+1/2) = 1 + X V diag(1/(1 + √(1+w))) Vᵀ Xᵀ,
// which hold for any rank of X and lose no digits where w is small. For each number, a product with W costs twice the
// columns of S, twice those of its group, and the size of its block. No matrix is larger than S.
#pragma once

#include <vector>

#include "validation/statistics/parted_columns.h"

namespace deflect::statistics {

/// Numbers first … first + size − 1. Without a covariance they are ignored: W sets them to 0.
struct NoiseBlock {
  Eigen::Index first = 0, size = 0;
  MatrixX covariance;  ///< size × size, positive definite; or empty
};

class Whitening {
 public:
  /// The blocks must be in order and cover all rows. `threads`: for products with many columns; 0: all.
  Whitening(const std::vector<NoiseBlock>&, const PartedColumns& errors, int threads = 1);

  /// W X: in least squares the rows are then independent with standard deviation 1. Columns are processed in chunks
  /// whose size does not depend on the threads, so that sums do not either.
  MatrixX operator()(const MatrixX& X) const;
  /// W⁻¹ X. Rows that W sets to 0 are 0.
  MatrixX undo(const MatrixX& X) const;
  /// W_N X and W_O W_N X.
  MatrixX by_noise(const MatrixX& X) const;
  MatrixX within_groups(const MatrixX& X) const;
  /// W_S X and W_S⁻¹ X, for X whitened within groups.
  MatrixX of_shared(MatrixX X) const;
  MatrixX undo_shared(MatrixX X) const;
  /// Õ.
  std::vector<GroupColumns> groups_by_noise() const;
  /// Applies W_O W_N to columns by group, in place. The groups must be those of the errors, or any where these have
  /// none.
  void white_within_groups(std::vector<GroupColumns>&) const;
  /// Norms of the columns of W_S X, for X of one group, whitened within it.
  VectorX norms_of_shared(const GroupColumns&) const;
  /// B.
  const MatrixX& shared() const { return B_; }
  /// ln det Σ, of the numbers that are not ignored.
  double log_determinant() const { return log_determinant_; }
  /// Expectation of the errors' amplitudes, prior N(0, 1), given r: [S O]ᵀ Σ⁻¹ r; those of S, then group by group.
  VectorX amplitudes(const VectorX& r) const;
  Eigen::Index rows() const { return rows_; }
  int threads() const { return threads_; }

 private:
  /// (1 + X Xᵀ)^(∓1/2) = 1 + X less Xᵀ, 1 + X more Xᵀ;
  struct Root {
    MatrixX less, more, square;  // (1 + X Xᵀ)⁻¹ = 1 + X square Xᵀ
    double log_determinant = 0;  // of 1 + X Xᵀ
  };
  struct Factor {
    Eigen::Index first, size;
    std::size_t at;  // position in entries_ of L⁻¹, row by row up to the diagonal
  };
  struct Group {
    std::vector<Eigen::Index> rows;
    MatrixX O, less, more;  // Õ
    Eigen::Index first;     // index of its first amplitude
  };
  void within_groups_in_place(MatrixX&) const;
  void undo_noise_in_place(MatrixX&) const;
  static Root root(const MatrixX& X);

  Eigen::Index rows_ = 0, amplitudes_ = 0;
  int threads_ = 1;
  double log_determinant_ = 0;
  std::vector<Factor> factors_;
  std::vector<double> entries_;
  std::vector<Group> groups_;
  MatrixX B_;
  Root root_;
};

}  // namespace deflect::statistics
