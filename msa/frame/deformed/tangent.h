// The tangent structure of a state: linear response around it under u̇ = T q̇ + G ḃ (elimination.h), constraints taken
// in the present shape. Sparse LU, since moments that keep their direction make the stiffness unsymmetric.
//
// A dead moment m at a node (constant in base axes) has no potential: the derivative of the internal forces with
// respect to spins has the skew part −½[m_int]× at each node, and m_int = m in equilibrium. So the stiffness is the
// symmetric K of linearisation.h minus ½[m]× there. Without applied moments K is symmetric, also where constraints act:
// then m_int and their moments cancel.
#pragma once

#include <memory>

#include "msa/frame/deformed/linearisation.h"
#include "msa/frame/structure/elimination.h"

namespace deflect::frame {

/// K by freedom, with the contributions of beams, springs, constraint forces and applied moments.
Eigen::SparseMatrix<double> tangent_stiffness(const Linearisation&, const VectorX& lambda, const VectorX& loads);

class Tangent {
 public:
  Tangent(const Elimination&, const Eigen::SparseMatrix<double>& K);
  ~Tangent();

  /// False where K is singular on the free motions; solve() must not be called then.
  bool regular() const;
  /// Whether the equilibrium is stable: K is positive definite on the free motions. Where applied moments make K
  /// unsymmetric, definiteness is no criterion, and a positive determinant is tested instead: no critical load was
  /// passed, or two.
  bool stable() const;
  /// The reciprocal condition of K on the free motions (sparse_cholesky.h) and its softest motion, by freedom; 0 where
  /// K is not positive definite but for rounding.
  struct Softest {
    double condition = 1;
    VectorX u;
  };
  Softest softest() const;
  double largest_entry() const;  ///< of K on the free motions, by magnitude
  /// u̇ for columns of load increments and of increments of constraint values.
  MatrixX solve(const MatrixX& loads, const MatrixX& values) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace deflect::frame
