// A linear structure solved with extended digits throughout, for the few whose stiffnesses leave doubles none.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "msa/frame/structure/elimination.h"

namespace deflect::frame {

/// TᵀKT as the sum of SᵀkS over beams and springs. S gives what strains a part, the motion of a beam's end b beside the
/// body of its end a, from the freedoms q; k is the part's stiffness in its own axes. Rigid motions strain nothing, to
/// the digits of Extended, however stiff the part is. Factored as LDLᵀ, which costs n³/6 operations of software: for up
/// to most_freedoms.
class ExtendedStructure {
 public:
  static constexpr int most_freedoms = 300;

  ExtendedStructure(const Model&, const Elimination&, const VectorX& spring_tangents);

  /// u under a load by freedom, for the constraints' values. Freedoms that nothing resists stay where they are; none
  /// where the load drives them.
  std::optional<ExtendedVector> solve(const VectorX& load, const VectorX& values) const;

 private:
  using Form = std::vector<std::pair<int, Extended>>;  // scalar and coefficient
  struct Part {
    std::vector<Form> of_u, of_q;  // each strain over the structure's freedoms and over q
    MatrixX k;
  };
  void eliminate_again(const Model&, const Elimination&);
  ExtendedVector expand(const ExtendedVector& q, const VectorX& values) const;
  void add(Part);
  void factor();

  std::vector<Form> T_, G_;  // as in Elimination
  std::vector<Part> parts_;
  ExtendedMatrix L_;  // K until it is factored; below the diagonal L, on it D, 0 where nothing resists
};

}  // namespace deflect::frame
