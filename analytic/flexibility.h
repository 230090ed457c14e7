// What a piece of a mechanism does to the point T when a wrench passes through it: how far it yields, what it lets go,
// what it carries. Twists [δ; θ] and wrenches [f; m] at T, base axes, SI.
#pragma once

#include <string>
#include <vector>

#include "msa/base/spatial.h"

namespace deflect::analytic {

/// Under a wrench F = N λ the far end moves against the near one by C F + J q, q arbitrary; JᵀN = 0. C is symmetric and
/// has a meaning on the wrenches carried only.
///
/// `roots` are columns s with C = Σ s sᵀ, one or more of each part. NᵀCN is formed as (rootsᵀN)ᵀ(rootsᵀN), so that
/// compliances of parts 1e12 apart keep their digits, and what yields only where passive joints yield anyway costs
/// none. An equation as printed may have a C that is not symmetric: it has no roots, and C itself is taken.
struct Flexibility {
  Matrix6 C = Matrix6::Zero();
  Matrix6X roots = Matrix6X(6, 0);
  bool rooted = true;
  Matrix6X J = Matrix6X(6, 0);  ///< twists that nothing resists
  Matrix6X N = Matrix6X(6, 0);  ///< wrenches carried
};

/// An orthonormal basis of the vectors perpendicular to all columns; these count as dependent within 1e-9.
MatrixX complement(const MatrixX& columns);

/// An orthonormal basis of the wrenches F with JᵀF = 0, moments weighed by `length` (m).
Matrix6X carried_wrenches(const Matrix6X& J, double length);

/// The same of the twists t with Nᵀt = 0.
Matrix6X free_twists(const Matrix6X& N, double length);

/// Principal compliances of what is carried: wrenches N V, of which each yields by itself, NᵀCN = V diag(g) Vᵀ, g
/// falling. A g whose root is lost in the rounding of the largest root is 0: there nothing yields.
struct Principal {
  MatrixX V;
  VectorX g;
};
Principal principal(const Flexibility&, double length);

/// Roots of a symmetric C ⪰ 0, rotations weighed by the length (m).
Matrix6X roots_of(const Matrix6& C, double length);

/// A stiffness that is infinite along some motions: nothing yields under the wrenches `rigid` (columns), so that only
/// twists t with rigidᵀt = 0 are possible. On these K t is the wrench, up to rigid ones; rotations weighed by a length,
/// K takes the one perpendicular to them.
struct Resistance {
  Matrix6 K = Matrix6::Zero();
  Matrix6X rigid = Matrix6X(6, 0);
};
Resistance resistance(const Flexibility&, double length);

/// The sum of resistances side by side, its K on the motions that all of them leave.
Resistance side_by_side(const std::vector<Resistance>&, double length);

/// "rotation about (0, 0, 1)", for each motion on which the wrenches do work.
std::vector<std::string> motions_resisted_by(const Matrix6X& wrenches, double length);

/// K = N (NᵀCN)⁻¹Nᵀ, which is C⁻¹ − C⁻¹J(JᵀC⁻¹J)⁻¹JᵀC⁻¹ where C⁻¹ exists; 0 where nothing is carried. Throws ModelError
/// saying of `name` where nothing yields.
Matrix6 stiffness(const Flexibility&, double length, const std::string& name);

/// The same of what is known already.
Matrix6 finite(const Resistance&, double length, const std::string& name);

}  // namespace deflect::analytic
