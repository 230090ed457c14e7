// Scalar laws, some of them set-valued, coupled by a linear relation. Mathematics only; the caller gives d and s their
// meaning.
//
//   d = d0 + P o,   s = (d − o)/c,   c > 0;   diag(c)⁻¹ᐟ² P diag(c)¹ᐟ² symmetric, eigenvalues from 0 to 1
//   s_i = force_i(d_i), nondecreasing, for low_i < d_i < high_i;
//   s_i ≤ force_i(low_i) at d_i = low_i,   s_i ≥ force_i(high_i) at d_i = high_i
//
// Every monotone linear relation between d and s can be written in this form, with any c. Eigenvalues 1 are directions
// in which d changes and s does not, eigenvalues 0 those in which s changes and d does not. Choosing c of the size of
// dd/ds preserves accuracy.
//
// The solutions minimise a convex function of d (convex_search.h): Σ∫force_i dd_i plus the energy of the relation.
// Where laws have slack there may be many solutions, with the same s and a convex polytope of d. The middle one is
// returned, which minimises
//   Σ ((d_i − middle_i)/half_i)²   over the laws with slack.
// The sum is strictly convex on the polytope, because only d of laws with slack vary in it; so the middle is unique.
// Each term is a ratio of lengths of one law: the middle depends neither on units nor on the order of the laws.
#pragma once

#include <functional>
#include <vector>

#include "msa/base/spatial.h"

namespace deflect {

struct ScalarLaw {
  double low = 0, high = 0;                      ///< of d; may be infinite
  std::function<double(double)> force, tangent;  ///< within low and high
  /// half > 0: a law with slack, whose force is constant over a range: between low and high if these are finite,
  /// otherwise below middle − half and above middle + half.
  double middle = 0, half = 0;
};

struct LinearRelation {
  VectorX c, d0;
  MatrixX P;
  VectorX size;  ///< by law: scale of s; below 1e-9 of it slack counts as unloaded
};

/// The same at o, with the eigenvalues of P brought between 0 and 1: of a relation that is linearised about a deformed
/// shape, whose geometric stiffness may make d fall where s grows. Before that the laws are decoupled that stay at the
/// end at which they are wherever the others go: what they give to the others is then constant. A search that asks
/// again at each o it finds ends on the given relation.
LinearRelation monotone(LinearRelation, const VectorX& o, const std::vector<ScalarLaw>&);

struct SetValuedSolution {
  enum class Outcome { solved, no_fit, overcome, undecided };
  /// no_fit: no d of the relation satisfies all bounds; overcome: the laws cannot supply the s that d0 requires.
  Outcome outcome = Outcome::undecided;
  VectorX d, s, o;
  /// By law: −1 or 1 where d is at low or high and that end is loaded; without finite ends, where d is below middle −
  /// half or above middle + half.
  std::vector<int> end;
  VectorX along;  ///< overcome: the direction in which d grows without bound
  /// Columns: directions in which d can change within the slack without a change of s; none where the solution is
  /// unique.
  MatrixX loose;
  VectorX least, most;  ///< bounds of watched · (d' − d) over d' of the polytope
};

/// `watched`: linear functions of d (rows) whose range over the polytope is needed.
SetValuedSolution solve(const LinearRelation&, const std::vector<ScalarLaw>&, const MatrixX& watched);

/// δ of a law where δ + c f = p, c ≥ 0, searched from `start`.
double deflection_at_sum(const ScalarLaw&, double c, double p, double start = 0);

}  // namespace deflect
