// An incomplete Cholesky factor in 6×6 blocks, and the preconditioned stiffness.
//
// With K = D + N + Nᵀ (N strictly lower, by blocks) the preconditioner is M = (Δ + N) Δ⁻¹ (Δ + Nᵀ), where
//   Δ_i = D_i − Σ_{j<i} N_ij Δ_j⁻¹ N_ijᵀ    (off-diagonal fill is dropped; Δ_i = C_i C_iᵀ)
// (Meijerink and van der Vorst, 1977, ICCG(0) without triangles in the graph; by blocks Axelsson, Iterative Solution
// Methods, 1994, ch. 7). For beams, springs between two nodes and supports every Δ_i is positive definite. By induction
// Δ_i ⪰ the stiffness at i of the beams to later nodes, because a beam's matrix [P Q; Qᵀ R] is positive semidefinite,
// so that Qᵀ P⁻¹ Q ⪯ R. Constraints over several nodes can break this; then Δ_i = D_i. On a chain M = K.
//
// The preconditioned stiffness K̂ = (I + L)⁻¹ C⁻¹ K C⁻ᵀ (I + L)⁻ᵀ with L_ij = C_i⁻¹ N_ij C_j⁻ᵀ costs only the two
// triangular solves (Eisenstat, SIAM J. Sci. Stat. Comput. 2, 1981):
//   t = (I + L)⁻ᵀ p,   K̂ p = t + (I + L)⁻¹ (p − (2I − C⁻¹ D C⁻ᵀ) t).
// Norms of residuals in this space are ‖r‖_{M⁻¹}, its eigenvalues are those of M⁻¹K.
#pragma once

#include "msa/frame/elements/two_at_once.h"
#include "msa/frame/iterative/node_blocks.h"

namespace deflect::frame {

class IncompleteCholesky {
 public:
  explicit IncompleteCholesky(NodeBlocks);

  /// False where a D_i is not positive definite; the factor must not be used then.
  bool positive() const { return smallest_pivot_ > 0; }
  /// The smallest squared diagonal entry of the C_i, for the matrix scaled to a diagonal of ones.
  double smallest_pivot() const { return smallest_pivot_; }
  int rows() const { return k_.rows(); }

  /// To preconditioned coordinates: b̂ = (I + L)⁻¹ C⁻¹ S b, for forces by q.
  VectorX forces_inside(const VectorX& by_q) const;
  /// From preconditioned coordinates: q = S C⁻ᵀ (I + L)⁻ᵀ x̂.
  VectorX motion_outside(const VectorX& inside) const;

  /// Rows of a part, 0 … 2: two independent parts, and the separator that joins them.
  struct Part {
    int from, to;
  };
  Part part(int which) const;

  /// K̂ p = t + w in stages: `join` first, then `sweep` of parts 0 and 1 (in parallel), then `finish`.
  void join(const VectorX& p, VectorX& t) const;
  void sweep(int which, const VectorX& p, VectorX& t, VectorX& w) const;
  void finish(const VectorX& p, const VectorX& t, VectorX& w) const;

 private:
  void forward(int from, int to, VectorX& w) const;
  void backward(int from, int to, int least, VectorX& t) const;

  NodeBlocks k_;            // lower: L; diagonal: C⁻¹ D C⁻ᵀ
  std::vector<Matrix6> C_;  // lower triangles
  double smallest_pivot_ = 1;
};

}  // namespace deflect::frame
