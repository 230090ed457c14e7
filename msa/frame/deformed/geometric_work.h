// State of GeometricSolver while a load grows. geometric_solver.cpp begins and concludes a solution; load_path.cpp
// follows the load path.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "msa/base/index.h"
#include "msa/frame/deformed/geometric_solver.h"
#include "msa/frame/elements/jumping_springs.h"
#include "msa/frame/structure/driving.h"

namespace deflect::frame {

/// Largest entry, with rotations times `length`.
inline double size_of(const VectorX& u, std::size_t nodes, double length) {
  double size = 0;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    size = std::max(size, std::abs(u(i)) * (i < as_index(6 * nodes) && i % 6 >= 3 ? length : 1));
  return size;
}

inline VectorX stiffness_at(const Model& m, double force) {
  VectorX k(std::ssize(m.springs));
  for (std::size_t i = 0; i < m.springs.size(); ++i) k(as_index(i)) = tangent_at_force(m.springs[i].law, force);
  return k;
}

/// The state of one solve().
struct GeometricSolver::Work {
  explicit Work(const Model& m)
      : structure(m),
        jump(std::any_of(m.springs.begin(), m.springs.end(), [](const Spring& s) { return jumps(s.law); })),
        shape(m),
        lambda(VectorX::Zero(std::ssize(m.constraints))),
        length(characteristic_length(m)) {}

  Model structure;  // springs that jump are linear in it: s = k (δ − o)
  bool jump = false;
  struct Jumping {
    std::vector<std::size_t> springs;  // those
    std::vector<ScalarLaw> laws;       // their own
    VectorX k, o;
    VectorX d, s;             // as the last step left them
    std::vector<int> end;     // as in SetValuedSolution
    std::vector<char> loose;  // whether it floats in its play
  } jumping;
  VectorX loads, values;  // in full
  std::vector<double> strains;
  StructureConditions with;
  double force = 0;  // the largest that springs may see
  Driving driving;   // by the whole load, heat with it
  VectorX least_tangents;
  Shape shape;
  VectorX lambda;
  double length;
  double damping = 0;    // μ of fall()
  bool falling = false;  // behind the jump already
  double energy = 0;     // J, of the last equilibrium
  std::string why;       // the last step failed

  /// Whether only loads act (no strains, no prescribed values), so that the energy grows by their work.
  bool by_loads_alone() const {
    const auto none = [](double x) { return x == 0; };
    return std::all_of(strains.begin(), strains.end(), none) && std::all_of(values.begin(), values.end(), none);
  }
  double stored(const Linearisation& at) const {
    double sum = 0;
    for (const BeamState& beam : at.beams) sum += beam.energy;
    for (std::size_t i = 0; i < structure.springs.size(); ++i)
      sum += stored_energy(structure.springs[i].law, at.elongations(as_index(i)));
    return sum;
  }
  /// Sets the springs that jump to s = k (δ − o).
  void set_offsets() {
    for (std::size_t j = 0; j < jumping.springs.size(); ++j) {
      const auto i = as_index(j);
      SpringLaw& law = structure.springs[jumping.springs[j]].law;
      const bool rotation = law.rotation;
      law = LinearSpring{jumping.k(i)};
      law.rotation = rotation;
      law.preload = jumping.k(i) * jumping.o(i);
    }
  }
  /// Scales the thermal strains with the load.
  void strain(double factor) {
    for (std::size_t e = 0; e < strains.size(); ++e) with.strains[e] = factor * strains[e];
  }
  Linearisation linearise(Geometry geometry) const {
    return geometry == Geometry::finite ? linearise_finite(structure, shape, with)
                                        : linearise_second_order(structure, shape, lambda, with);
  }
};

/// One Newton step; its tangent is that of the shape before the step.
struct GeometricSolver::Step {
  std::unique_ptr<Tangent> tangent;
  VectorX u;              // empty: the tangent is singular
  double unbalanced = 0;  // the largest force before the step, of the largest load; of a structure with laws that jump
  bool balanced = false;  // see balances()
};

}  // namespace deflect::frame
