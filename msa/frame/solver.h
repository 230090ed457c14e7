// Static equilibrium of a structure: f_int(u) = f under u = T q + G b.
#pragma once

#include <vector>

#include "msa/frame/assembly.h"

namespace deflect::frame {

struct NewtonOptions {
  int max_iterations = 100;
  double tolerance = 1e-12;  ///< of the last step and of the residual, relative; rounding may stop a little above
};

struct Solution {
  VectorX u;                ///< by freedom: m, rad, and the scalars' unit
  VectorX spring_tangents;  ///< N/m or Nm/rad at u
  bool converged = false;
  int iterations = 0;
  double residual = 0;  ///< |Tᵀ(f − f_int)| relative to |Tᵀf| + |Tᵀ f_int|, largest entry
};

/// Keeps elimination, ordering and symbolic analysis of one structure for all its load cases and spring states.
class Solver {
 public:
  /// Throws ModelError for constraints that contradict each other. The model must outlive the solver.
  explicit Solver(const Model&);

  const Elimination& elimination() const { return elimination_; }

  /// One load by freedom (dofs()), constraint values as in the model. Newton with a line search on the potential
  /// where a spring is nonlinear. Throws ModelError naming what moves when the structure cannot stand.
  Solution solve(const VectorX& load, const NewtonOptions& options = {});

  /// As above for other constraint values (prescribed displacements).
  Solution solve(const VectorX& load, const VectorX& values, const NewtonOptions& options = {});

  /// Linear response of the tangent structure (springs at `spring_tangents`) to columns of loads and of constraint
  /// values; the columns of the result are u.
  MatrixX linear(const VectorX& spring_tangents, const MatrixX& loads, const MatrixX& values);

 private:
  void factor(const VectorX& spring_tangents);
  VectorX starting_tangents(double force) const;

  const Model& model_;
  Elimination elimination_;
  Assembly assembly_;
  SparseCholesky cholesky_;
  bool factored_ = false;
  VectorX factored_tangents_;  // the state that the factor belongs to
};

/// The forces with which constraints act, λ with f_int(u) − f = Cᵀ λ: what the support pushes along the constraint's
/// form. Zero for redundant constraints. Units N or Nm by form.
VectorX constraint_forces(const Model&, const Elimination&, const VectorX& u, const VectorX& load);

/// Total ½∫ energies by part: beams ½ dᵀ K d, springs ∫ F dδ; in order of first appearance. J.
std::vector<std::pair<std::string, double>> energies(const Model&, const VectorX& u);

}  // namespace deflect::frame
