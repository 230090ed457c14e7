// A linear structure solved in extended precision, for structures whose stiffnesses differ too much for doubles.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "msa/frame/structure/elimination.h"

namespace deflect::frame {

/// TᵀKT as the sum of SᵀkS over beams and springs. S maps the freedoms q to the strains of a part (motion of a beam's
/// end b relative to the body of its end a); k is the part's stiffness in its own axes. Rigid motions cause no strain,
/// to the precision of Extended, however stiff the part. Factored as LDLᵀ, which costs at most n³/6 software
/// operations; for up to most_freedoms.
class ExtendedStructure {
 public:
  static constexpr int most_freedoms = 300;

  ExtendedStructure(const Model&, const Elimination&, const VectorX& spring_tangents);

  /// u under a load by freedom, for the constraints' values. Freedoms without any stiffness stay at 0; nullopt where
  /// the load acts on them.
  std::optional<ExtendedVector> solve(const VectorX& load, const VectorX& values) const;

 private:
  using Form = std::vector<std::pair<int, Extended>>;  // scalar and coefficient
  struct Part {
    std::vector<Form> of_u, of_q;  // each strain over the structure's freedoms and over q
    MatrixX k;
  };
  void eliminate_again(const std::vector<Form>& constraints, const Elimination&);
  ExtendedVector expand(const ExtendedVector& q, const VectorX& values) const;
  void add(Part);
  void factor();

  std::vector<Form> T_, G_;  // as in Elimination
  std::vector<Part> parts_;
  ExtendedMatrix L_;  // K until it is factored; below the diagonal L, on it D, 0 where nothing resists
};

}  // namespace deflect::frame
