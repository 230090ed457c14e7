// The tangent structure of a state: linear response around it under u̇ = T q̇ + G ḃ (elimination.h), constraints taken
// in the present shape. Sparse LU, since moments that keep their direction make the stiffness unsymmetric.
//
// A dead moment m at a node (constant in base axes) has no potential: with the forces' change by spins, whose skew part
// is −½[m_int]× at each node, and m_int = m in equilibrium, the stiffness is the symmetric K of linearisation.h less
// ½[m]× there. Without applied moments K is symmetric, also where constraints act: then m_int and their moments cancel.
#pragma once

#include <memory>

#include "msa/frame/deformed/linearisation.h"
#include "msa/frame/structure/elimination.h"

namespace deflect::frame {

/// K by freedom: beams, springs, forces of constraints and applied moments.
Eigen::SparseMatrix<double> tangent_stiffness(const Linearisation&, const VectorX& lambda, const VectorX& loads);

class Tangent {
 public:
  Tangent(const Elimination&, const Eigen::SparseMatrix<double>& K);
  ~Tangent();

  /// False where K cannot be inverted on the free motions; then there is nothing to solve with.
  bool regular() const;
  /// Equilibrium is stable: K is positive definite on the free motions. Where applied moments make K unsymmetric, which
  /// is no question of definiteness, a positive determinant stands for it: no such load was passed, or two.
  bool stable() const;
  double largest_entry() const;  ///< of K on the free motions, by magnitude
  /// u̇ for columns of load increments and of increments of constraint values.
  MatrixX solve(const MatrixX& loads, const MatrixX& values) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace deflect::frame
