// One leg in closed form: compliances in series (2), (45), moved to one point, passive joints released.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analytic/deflection.h"
#include "msa/base/spatial.h"
#include "msa/mechanism/configuration.h"

namespace deflect::analytic {

/// A freedom that yields by its laws: unit relative motion moves T by `twist`; under a wrench F at T it carries
/// twistᵀF.
struct ElasticFreedom {
  Vector6 twist;
  std::vector<Law> laws;
  std::string part;
};

/// A flexible member's compliance at T, base axes.
struct FlexibleMember {
  Matrix6 C;
  std::string part;
};

/// A chain from the base to T. For a wrench F = N λ at T that its passive joints can carry (N spans the wrenches with
/// J_qᵀF = 0), T moves by C F + Σ twist_j δ_j(twist_jᵀF) + J_q θ, θ arbitrary.
struct Chain {
  std::string name;
  std::vector<FlexibleMember> members;
  std::vector<ElasticFreedom> freedoms;
  Matrix6 C = Matrix6::Zero();  ///< sum of the members'
  Matrix6X J_q;                 ///< twists at T of the passive joints, whether released or not
  Matrix6X N;                   ///< wrenches carried; all of them where passive joints are not released

  /// Motion of T under F at T, but for J_q θ.
  Vector6 deflection(const Vector6& F, const AsPrinted&) const;
  /// Its derivative; a force below `least` counts as `least`, so that unloaded contacts stay finite.
  Matrix6 tangent_compliance(const Vector6& F, double least, const AsPrinted&) const;
  /// K_c = N (Nᵀ C N)⁻¹ Nᵀ, which is C⁻¹ − C⁻¹J_q(J_qᵀC⁻¹J_q)⁻¹J_qᵀC⁻¹ where C⁻¹ exists. Contacts without load do not
  /// resist.
  Matrix6 tangent_stiffness(const Vector6& F, const AsPrinted&) const;
};

/// The chain of a leg, referred to the point p_W (T, unless (46) is taken as printed).
Chain chain_of(const PlacedLeg&, const Vector3& p_W, const AsPrinted& = {});

/// Twist at p_W of a unit motion in freedom i (tx … rz) of a joint.
Vector6 freedom_twist(const PlacedJoint&, std::size_t i, const Vector3& p_W);

/// An orthonormal basis (rotations weighed by a length of the problem) of the wrenches F with JᵀF = 0.
Matrix6X carried_wrenches(const Matrix6X& J, double length);

}  // namespace deflect::analytic
