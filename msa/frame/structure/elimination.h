// Exact elimination of linear constraints: u = T q + G b, with b the constraints' values and q the independent
// freedoms. Without penalties or multipliers: the reduced stiffness Tᵀ K T stays symmetric and as definite as K.
#pragma once

#include <string>
#include <vector>

#include "msa/frame/structure/model.h"

namespace deflect::frame {

struct Redundancy {
  int constraint = 0;
  /// The others that already imply it: form_constraint = Σ coefficient · form_dof, with Term::dof a constraint's index.
  LinearForm implied_by;
};

struct Elimination {
  int independent = 0;        ///< number of q
  std::vector<int> dof_of_q;  ///< the freedom that each q is
  std::vector<LinearForm> T;  ///< by freedom: terms over q
  std::vector<LinearForm> G;  ///< by freedom: terms over constraints
  std::vector<int> pivot;     ///< by constraint: the freedom it eliminated, −1 where redundant
  std::vector<Redundancy> redundant;

  /// u for given q and constraint values.
  VectorX expand(const VectorX& q, const VectorX& values) const;
  ExtendedVector expand_fine(const ExtendedVector& q, const VectorX& values) const;
  /// Tᵀ f.
  VectorX reduce(const VectorX& f) const;
};

/// Constraints are taken in order; each eliminates the freedom with the largest coefficient (rotations weighed by the
/// size of the structure), among comparable ones the least connected. A constraint that the earlier ones imply to 1e-9
/// is redundant.
Elimination eliminate(const Model&);

/// Whether no redundant constraint contradicts, for these values, those that imply it.
bool consistent(const Elimination&, const VectorX& values);

/// Throws ModelError with the constraints where, for these values, a redundant one contradicts those that imply it.
void check_consistent(const Model&, const Elimination&, const VectorX& values);

/// "constraint 'a' is redundant: 'b', 'c' already imply it", for each.
std::vector<std::string> redundancies(const Model&, const Elimination&);

/// The values stored in the model's constraints.
VectorX constraint_values(const Model&);

/// A length to weigh rotations against translations: the diagonal of the nodes' bounding box, or 1 m for one node.
double characteristic_length(const Model&);

}  // namespace deflect::frame
