// Scalar laws, some of them set-valued, coupled by a linear relation. Mathematics only: what d and s are is the
// caller's.
//
//   d = d0 + P o,   s = (d − o)/c,   c > 0;   diag(c)⁻¹ᐟ² P diag(c)¹ᐟ² symmetric, eigenvalues from 0 to 1
//   s_i = force_i(d_i), which does not fall, within low_i < d_i < high_i; at most that at low_i, at least that at
//   high_i
//
// A linear relation between d and s of any kind that is monotone can be written so, with any c: eigenvalues 1 are
// directions in which d changes and s does not, eigenvalues 0 those in which s changes and d does not. c of the size of
// dd/ds keeps the digits.
//
// The solutions are the least values of a convex function of d (convex_search.h), Σ∫force_i dd_i and what the relation
// stores. Where laws have slack there may be many: they have the same s and their d are a convex polytope. Of these the
// solution is the middle one, which minimises
//   Σ ((d_i − middle_i)/half_i)²   over the laws with slack.
// The sum is strictly convex along the polytope, because a d that no law with slack has is the same for all of it; so
// there is one middle. Each term is a ratio of a law's own lengths: it does not depend on units, nor on the order of
// the laws.
#pragma once

#include <functional>
#include <vector>

#include "msa/base/spatial.h"

namespace deflect {

struct ScalarLaw {
  double low = 0, high = 0;                      ///< of d; may be infinite
  std::function<double(double)> force, tangent;  ///< within low and high
  /// half > 0: a law with slack, where force is the same over a range: between low and high, if they are finite,
  /// otherwise beyond middle − half and beyond middle + half.
  double middle = 0, half = 0;
};

struct LinearRelation {
  VectorX c, d0;
  MatrixX P;
  VectorX size;  ///< by law: an s as large as those that drive the relation; 1e-9 of it is no load on slack
};

struct SetValuedSolution {
  enum class Outcome { solved, no_fit, overcome, undecided };
  /// no_fit: no d of the relation lies within all of low and high; overcome: no s reaches what d0 wants.
  Outcome outcome = Outcome::undecided;
  VectorX d, s, o;
  /// By law: −1 and 1 where d is low or high and that end pushes; without ends, where d is beyond middle ∓ half.
  std::vector<int> end;
  VectorX along;  ///< overcome: how d would go on changing
  /// d changes along these columns within the slack, s does not; none where the solution is the only one.
  MatrixX loose;
  VectorX least, most;  ///< of watched · (d of the polytope − d)
};

/// `watched`: linear functions of d (rows), whose extent over the polytope is wanted.
SetValuedSolution solve(const LinearRelation&, const std::vector<ScalarLaw>&, const MatrixX& watched);

}  // namespace deflect
