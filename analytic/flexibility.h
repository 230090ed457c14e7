// Flexibility of a piece of a mechanism at the point T: its compliance, the twists that it does not resist, the
// wrenches that it carries. Twists [δ; θ] and wrenches [f; m] at T, base axes, SI.
#pragma once

#include <string>
#include <vector>

#include "msa/base/spatial.h"

namespace deflect::analytic {

/// Under a wrench F = N λ the far end moves relative to the near one by C F + J q, q arbitrary; JᵀN = 0. C is
/// symmetric; it is defined only on the wrenches carried.
///
/// `roots` are columns s with C = Σ s sᵀ, one or more from each part. NᵀCN is formed as (rootsᵀN)ᵀ(rootsᵀN). So
/// compliances of parts that differ by a factor 1e12 keep their digits, and compliance along the motion of passive
/// joints costs none. An equation taken as printed may give a C that is not symmetric. It has no roots, and C itself is
/// used.
struct Flexibility {
  Matrix6 C = Matrix6::Zero();
  Matrix6X roots = Matrix6X(6, 0);
  bool rooted = true;
  Matrix6X J = Matrix6X(6, 0);  ///< twists that nothing resists
  Matrix6X N = Matrix6X(6, 0);  ///< wrenches carried
};

/// An orthonormal basis of the vectors perpendicular to all columns; columns count as linearly dependent within 1e-9.
MatrixX complement(const MatrixX& columns);
/// Whether columns span all for certain; where they do so only just, false.
bool plainly_span(const MatrixX& columns);

/// An orthonormal basis of the wrenches F with JᵀF = 0, moments weighed by `length` (m).
Matrix6X carried_wrenches(const Matrix6X& J, double length);

/// The same for the twists t with Nᵀt = 0, rotations weighed by `length`.
Matrix6X free_twists(const Matrix6X& N, double length);

/// Principal compliances on the wrenches carried: NᵀCN = V diag(g) Vᵀ, g in descending order; the wrenches N V yield
/// independently. Where the square root of g is below the rounding of the largest root, g is set to 0: nothing yields.
struct Principal {
  MatrixX V;
  VectorX g;
};
Principal principal(const Flexibility&, double length);

/// Roots of a symmetric C ⪰ 0, rotations weighed by `length` (m).
Matrix6X roots_of(const Matrix6& C, double length);

/// A stiffness that is infinite along some motions. Nothing yields under the wrenches `rigid` (columns), so that only
/// twists t with rigidᵀt = 0 are possible. For these the wrench is K t plus any combination of the rigid wrenches. K is
/// chosen so that K t is perpendicular to them, with rotations weighed by a length.
struct Resistance {
  Matrix6 K = Matrix6::Zero();
  Matrix6X rigid = Matrix6X(6, 0);
};
Resistance resistance(const Flexibility&, double length);

/// The sum of resistances in parallel; its K applies to the motions that all of them allow.
Resistance side_by_side(const std::vector<Resistance>&, double length);

/// Describes each motion on which the wrenches do work: "rotation about (0, 0, 1)".
std::vector<std::string> motions_resisted_by(const Matrix6X& wrenches, double length);

/// K = N (NᵀCN)⁻¹Nᵀ, which is C⁻¹ − C⁻¹J(JᵀC⁻¹J)⁻¹JᵀC⁻¹ where C⁻¹ exists; 0 where nothing is carried. Throws ModelError
/// with `name` and the motion where nothing yields.
Matrix6 stiffness(const Flexibility&, double length, const std::string& name);

/// The same from a known Resistance.
Matrix6 finite(const Resistance&, double length, const std::string& name);

/// A branch linearised about its force, in the principal axes of its compliance (singular values: as printed it need
/// not be symmetric): it carries N λ more when Mᵀt = g λ + e, t what the far body moves more, e = Mᵀd with d by how
/// much the branch is ahead of it; M = N but for signs where C is symmetric. A g that is lost in the rounding of the
/// largest is 0: there the branch is rigid.
struct LinearisedBranch {
  LinearisedBranch(const Flexibility&, double length);

  Matrix6X N, M;
  VectorX g;
};

}  // namespace deflect::analytic
