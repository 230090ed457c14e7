// Forces of a structure and their derivatives: in a shape with displacements of any size (finite), or at small
// displacements with the forces of the state (second order). Base axes; moments conjugate to spins (deformed_beam.h).
//
// With c_k the components of connections and the other linear forms, λ_k the forces of constraints, s_i those of
// springs, equilibrium is f_beams + Σ s_i ∂c_i − Σ λ_k ∂c_k = f, and its stiffness
//   K = K_beams + Σ (s_i' ∂c_i ∂c_iᵀ + s_i ∂²c_i) − Σ λ_k ∂²c_k :
// forces that act through arms and along joint axes, which rotate with their bodies, have a geometric stiffness too.
//
// Second order: all derivatives at the undeformed shape, with the forces that the small displacements u cause there:
//   f_int = K_E u + K_G u,   K = K_E + K_G,   constraints as in the linear theory.
// This neglects terms of the order of strains and of squares of rotations, for example the elongation of a rotated
// member by half the square of its rotation.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <vector>

#include "msa/frame/elements/deformed_beam.h"
#include "msa/frame/structure/model.h"

namespace deflect::frame {

struct Shape {
  std::vector<BodyMotion> nodes;
  /// By freedom, the sum of all increments: translations, spins, scalars. Linear forms are evaluated on it. For a
  /// rotation about a fixed axis the sum of spins is the angle.
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
    Matrix12 H;                ///< ∂²c with respect to the freedoms of the two nodes
  };
  std::vector<Curvature> curvatures;
  VectorX elongations, spring_forces, spring_tangents;
  std::vector<LinearForm> spring_forms;  ///< ∂c by spring
  std::vector<BeamState> beams;
  std::size_t nodal = 0;  ///< freedoms of nodes; scalars follow
};

/// Conditions that the solver adds to a structure and its loads.
struct StructureConditions {
  std::vector<double> strains;  ///< by beam: free thermal strain
  VectorX least_tangents;       ///< by spring: lower bound of the tangent used
  /// Constraints from this index on hold idle motions: a node against spinning about its own axis, which rotates with
  /// the node, or bodies by the linear form of their motion.
  std::size_t first_hold = 0;
};

Linearisation linearise_finite(const Model&, const Shape&, const StructureConditions&);

/// `lambda`: present estimate of the constraint forces.
Linearisation linearise_second_order(const Model&, const Shape&, const VectorX& lambda, const StructureConditions&);

}  // namespace deflect::frame
