// Whether theories that share no stiffness formula say the same: the check that a wrong number does not survive.
#pragma once

#include <string>
#include <vector>

#include "validation/theories/theory.h"

namespace deflect::theories {

/// The larger of |δa − δb| / |δb| and |θa − θb| / |θb| for displacements in mm and rad, Euclidean norms of translation
/// and rotation. Where symmetry makes one of the two vanish its rounding is measured by the other: a rotation against
/// at least |δb| / 1 m, a translation against at least |θb| · 1 mm.
double relative_difference(const Vector6& a, const Vector6& b);

/// The largest relative_difference() of any two; 0 for one.
double largest_difference(const std::vector<Vector6>& displacements_mm_rad);

/// How far two answers to one wrench are apart, each measured by the size of the whole: displacements
/// |(δ, ℓθ)_a − (δ, ℓθ)_b| / |(δ, ℓθ)_b| with the structure's length ℓ (m), stiffnesses by their largest entry, moments
/// over ℓ. 0 where both vanish. `play`: the ends of play that nothing loads, by the size of the play and the
/// displacement; infinite where but one of them is.
struct Difference {
  double displacement = 0, stiffness = 0, play = 0;
  double largest() const;
};
Difference difference(const Answer& a, const Answer& b, double length);

/// How far they may be apart: 1e-9 where all laws are linear, 1e-7 where contacts are solved to equilibrium; more where
/// the structure amplifies the rounding of its own numbers, by `rounding` (Solver::rounding()).
double agreement_bound(bool linear, double rounding);

/// By how much rounding may be amplified in the theories' answers to one wrench.
double rounding_of(const Theories&, const std::vector<Answer>&, double length);

/// Throws NumericalError where two of the answers to F, one by each theory, are further apart than the bound, than what
/// the two are known to, and than rounding makes of their answers where the machine is turned (turned.h; 1e-4 at most):
/// it says by how much, both displacements, and what is known of the cause. `device` and the configuration begin the
/// message. Returns what the answers are known to, relative, where turning was asked; else 0.
double require_agreement(const Theories&, const std::vector<Answer>&, const Vector6& F_T_W, const Configuration&,
                         const std::string& device);

/// Equilibrium in the deformed shape, by each theory, in mm and rad.
struct DeformedAnswers {
  Geometry geometry;
  std::vector<Answer> answers;
  std::vector<double> from_linear;  ///< relative_difference() of the answer in linear geometry
  double discretisation = 0;        ///< what dividing members leaves of relative_difference, of all together
};
/// In the deformed shape theories may differ by what dividing members leaves, estimated by each; in second order by the
/// squares of the change and of the rotation, which they leave out in ways of their own; where laws jump by the change
/// itself, because the closed form takes their jumps in linear geometry.
void require_agreement_deformed(const Theories&, const DeformedAnswers&, const Configuration&,
                                const std::string& device);

}  // namespace deflect::theories
