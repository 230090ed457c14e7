// Straight members along x, clamped at the left, for tests of geometric stiffness.
#pragma once

#include <limits>
#include <string>

#include "msa/frame/deformed/geometric_solver.h"

namespace deflect::test {

inline constexpr double rigid_in_shear = std::numeric_limits<double>::infinity();

inline frame::Model column(int elements, double length, const frame::BeamRigidity& rigidity) {
  frame::Model m;
  for (int i = 0; i <= elements; ++i) m.add_node("n" + std::to_string(i), {length * i / elements, 0, 0});
  for (int i = 0; i < elements; ++i) m.add_beam(i, i + 1, Matrix3::Identity(), rigidity, "column", "column");
  m.fix(0, "clamp");
  return m;
}

inline VectorX load_at(const frame::Model& m, int node, const Vector3& force, const Vector3& moment = Vector3::Zero()) {
  VectorX load = VectorX::Zero(m.dofs());
  load.segment<3>(6 * node) = force;
  load.segment<3>(6 * node + 3) = moment;
  return load;
}

inline frame::GeometricState solve(const frame::Model& m, const VectorX& load, Geometry geometry, int load_steps = 1) {
  frame::GeometricOptions options;
  options.geometry = geometry;
  options.load_steps = load_steps;
  return frame::GeometricSolver(m).solve({load, {}, {}}, options);
}

/// The load factor at which second order loses its stability, by bisection between 0 and `high`.
inline double buckling_factor(const frame::Model& m, const VectorX& load, double high) {
  frame::GeometricSolver solver(m);
  frame::GeometricOptions options;
  options.geometry = Geometry::second_order;
  double low = 0;
  for (int i = 0; i < 45; ++i) {
    const double factor = (low + high) / 2;
    (solver.solve({factor * load, {}, {}}, options).stable ? low : high) = factor;
  }
  return low;
}

}  // namespace deflect::test
