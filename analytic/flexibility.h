// What a piece of a mechanism does to the point T when a wrench passes through it: how far it yields, what it lets go,
// what it carries. Twists [δ; θ] and wrenches [f; m] at T, base axes, SI.
#pragma once

#include <string>

#include "msa/base/spatial.h"

namespace deflect::analytic {

/// Under a wrench F = N λ the far end moves against the near one by C F + J q, q arbitrary; JᵀN = 0. C is symmetric and
/// has a meaning on the wrenches carried only.
struct Flexibility {
  Matrix6 C = Matrix6::Zero();
  Matrix6X J = Matrix6X(6, 0);  ///< twists that nothing resists
  Matrix6X N = Matrix6X(6, 0);  ///< wrenches carried
};

/// An orthonormal basis of the vectors perpendicular to all columns; these count as dependent within 1e-9.
MatrixX complement(const MatrixX& columns);

/// An orthonormal basis of the wrenches F with JᵀF = 0, moments weighed by `length` (m).
Matrix6X carried_wrenches(const Matrix6X& J, double length);

/// The same of the twists t with Nᵀt = 0.
Matrix6X free_twists(const Matrix6X& N, double length);

/// K = N (NᵀCN)⁻¹Nᵀ, which is C⁻¹ − C⁻¹J(JᵀC⁻¹J)⁻¹JᵀC⁻¹ where C⁻¹ exists; 0 where nothing is carried. Throws ModelError
/// saying of `name` where nothing yields when NᵀCN is singular to 1e-13.
Matrix6 stiffness(const Flexibility&, double length, const std::string& name);

}  // namespace deflect::analytic
