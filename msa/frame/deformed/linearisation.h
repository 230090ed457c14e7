// Forces of a structure and how they change, in a shape of any displacement (finite) or at small displacements with the
// forces of the state (second order). Base axes; moments conjugate to spins (deformed_beam.h).
//
// With c_k the components of connections and the other linear forms, λ_k the forces of constraints, s_i those of
// springs, equilibrium is f_beams + Σ s_i ∂c_i − Σ λ_k ∂c_k = f, and its stiffness
//   K = K_beams + Σ (s_i' ∂c_i ∂c_iᵀ + s_i ∂²c_i) − Σ λ_k ∂²c_k :
// forces that act through arms and joint axes which turn with their bodies have a geometric stiffness too.
//
// Second order: all derivatives at the undeformed shape, with the forces that the small displacements u cause there:
//   f_int = K_E u + K_G u,   K = K_E + K_G,   constraints as in the linear theory.
// What this leaves out is of the order of strains and of squares of rotations; that a turned member gets longer by half
// such a square is among it.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "msa/frame/elements/deformed_beam.h"
#include "msa/frame/structure/model.h"

namespace deflect::frame {

struct Shape {
  std::vector<BodyMotion> nodes;
  /// By freedom, all increments added up: translations, sums of spins, scalars. Linear forms are evaluated on it; of a
  /// rotation about a fixed axis the sum is the angle.
  VectorX path;

  explicit Shape(const Model&);
  void move(const VectorX& increment);
  /// Translations, rotation vectors, scalars.
  VectorX displacements() const;
};

struct BeamState {
  Vector12 forces;  ///< on the ends, [f_a; m_a; f_b; m_b], base axes
  Matrix3 A, B;     ///< axes of the sections at the ends
  double energy;
};

struct Linearisation {
  VectorX forces;                                 ///< f_beams + Σ s ∂c, by freedom
  std::vector<Eigen::Triplet<double>> stiffness;  ///< of beams and springs
  std::vector<LinearForm> forms;                  ///< ∂c by constraint
  VectorX values;                                 ///< c by constraint
  struct Curvature {
    int constraint;
    std::array<int, 2> nodes;  ///< −1: the ground
    Matrix12 H;                ///< ∂²c by the freedoms of the two nodes
  };
  std::vector<Curvature> curvatures;
  VectorX elongations, spring_forces, spring_tangents;
  std::vector<LinearForm> spring_forms;  ///< ∂c by spring
  std::vector<BeamState> beams;
  std::size_t nodal = 0;  ///< freedoms of nodes; scalars follow
};

/// What the solver adds to a structure and its loads.
struct StructureConditions {
  std::vector<double> strains;  ///< by beam: free strain of heat
  VectorX least_tangents;       ///< by spring: the stiffness takes no less
  /// Constraints from here on hold a node against spinning about its own axis, which turns with the node.
  std::size_t first_hold = 0;
};

Linearisation linearise_finite(const Model&, const Shape&, const StructureConditions&);

/// `lambda`: forces of constraints, as known so far.
Linearisation linearise_second_order(const Model&, const Shape&, const VectorX& lambda, const StructureConditions&);

}  // namespace deflect::frame
