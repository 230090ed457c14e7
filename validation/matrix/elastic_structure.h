// What a 6×6 stiffness says of the device behind it, free of the point at which it is given.
//
// With K = [A B; Bᵀ D] at T and C = K⁻¹ = [E F; Fᵀ G] (translation first), both symmetric:
// centre of stiffness   T + r, where the coupling block A[r]× + B is symmetric:  (tr A · I − A) r = −vee(B − Bᵀ);
// centre of compliance  T + r, where F − [r]×G is symmetric:                     (tr G · I − G) r = vee(F − Fᵀ);
// vee([b]×) = b.
// Where an axis has no stiffness r is the shortest solution. Sources: J. Lončarić, Normal forms of stiffness and
// compliance matrices, IEEE J. Robotics and Automation 3 (1987); S. Ciblak, H. Lipkin, Centers of stiffness, compliance
// and elasticity, ASME Mechanisms Conference 1994.
#pragma once

#include <optional>

#include "msa/base/spatial.h"

namespace deflect::matrix {

/// In N, rad and K's unit of length; base axes.
struct ElasticStructure {
  Vector3 centre_of_stiffness = Vector3::Zero();  ///< from T
  std::optional<Vector3> centre_of_compliance;    ///< from T; where C exists
  Vector3 translational = Vector3::Zero();        ///< principal stiffnesses, rising; rotations held
  Matrix3 axes = Matrix3::Identity();             ///< their directions, columns
  Vector3 rotational = Vector3::Zero();           ///< principal stiffnesses about the centre of stiffness, rising
  double length = 0;                              ///< ℓ = √(tr D / tr A) at the centre of stiffness; 0: none
};

/// Of a symmetric K.
ElasticStructure elastic_structure(const Matrix6& K);

/// ℓ = √(tr |D| / tr |A|) at T, by which rotations are weighed against translations; 1 where a block is zero.
double weighing_length(const Matrix6& K);

/// W⁻¹ K W⁻¹ with W = diag(1, 1, 1, ℓ, ℓ, ℓ): the unit of length no longer matters.
Matrix6 weighed(const Matrix6& K, double length);

}  // namespace deflect::matrix
