// Assembles the reduced tangent stiffness Tᵀ K T: the pattern once, the values for every state of the springs.
#pragma once

#include <vector>

#include "msa/frame/structure/elimination.h"
#include "msa/frame/structure/sparse_cholesky.h"

namespace deflect::frame {

class Assembly {
 public:
  /// `threads`: 0: as many as the machine has, for many beams. Results are bit-identical for any number.
  Assembly(const Model&, const Elimination&, int threads = 0);

  const SparsePattern& pattern() const { return pattern_; }
  /// Values in the pattern's order for the tangent stiffness of each spring (in the model's order).
  std::vector<double> values(const VectorX& spring_tangents) const;

 private:
  struct ReducedSpring {
    std::vector<Term> form;      // over q
    std::vector<int> positions;  // of (i, j), i ≥ j, row by row
  };
  SparsePattern pattern_;
  std::vector<double> beams_;  // the constant part of the values
  std::vector<ReducedSpring> springs_;
};

/// Internal forces f_int(u) of beams and springs by freedom, and the springs' tangents at u.
VectorX internal_forces(const Model&, const VectorX& u, VectorX& spring_tangents);

/// The forces of the springs' laws, by spring.
VectorX spring_forces(const Model&, const ExtendedVector& u);

/// f_int(u) for given forces of the springs.
VectorX forces_with(const Model&, const VectorX& u, const VectorX& spring_forces);
VectorX forces_with(const Model&, const ExtendedVector& u, const VectorX& spring_forces);

/// The same for the tangent structure, in which spring i is linear with stiffness spring_tangents(i).
VectorX tangent_forces(const Model&, const VectorX& u, const VectorX& spring_tangents);
VectorX tangent_forces(const Model&, const ExtendedVector& u, const VectorX& spring_tangents);

/// The vector padded with zeros, because the solver's model may have more freedoms.
VectorX padded(const VectorX&, Eigen::Index size);

/// form(u).
double evaluate(const LinearForm&, const VectorX& u);
double evaluate(const LinearForm&, const ExtendedVector& u);

}  // namespace deflect::frame
