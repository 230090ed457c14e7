// Checks that theories that share no stiffness formula agree.
#pragma once

#include <string>
#include <vector>

#include "validation/theories/theory.h"

namespace deflect::theories {

/// The larger of |δa − δb| / |δb| and |θa − θb| / |θb| for displacements in mm and rad, Euclidean norms of translation
/// and rotation. Where one of the two vanishes by symmetry, its rounding is compared with the other: a rotation against
/// at least |δb| / 1 m, a translation against at least |θb| · 1 mm.
double relative_difference(const Vector6& a, const Vector6& b);

/// The largest relative_difference() of any two; 0 for a single one.
double largest_difference(const std::vector<Vector6>& displacements_mm_rad);

/// How far two answers to one wrench differ, relative to the size of the whole quantity: displacements |(δ, ℓθ)_a − (δ,
/// ℓθ)_b| / |(δ, ℓθ)_b| with the structure's length ℓ (m), stiffnesses by their largest entry, moments over ℓ. 0 where
/// both vanish. `play`: the ends of unloaded play (Floating), relative to the larger of play and displacement; infinite
/// where an end is infinite in only one of the two answers.
struct Difference {
  double displacement = 0, stiffness = 0, play = 0;
  double largest() const;
};
Difference difference(const Answer& a, const Answer& b, double length);

/// How far they may differ: 1e-9 where all laws are linear, 1e-7 where contacts are solved to equilibrium; more where
/// the structure amplifies the rounding of its own numbers, by `rounding` (Solver::rounding()).
double agreement_bound(bool linear, double rounding);

/// Estimate of the rounding error, relative, in the theories' answers to one wrench.
double rounding_of(const Theories&, const std::vector<Answer>&, double length);

/// Throws NumericalError where two answers to F, one by each theory, differ by more than allowed. Allowed is
/// agreement_bound(), or, where that is exceeded, ten times the change by rounding when the machine is turned
/// (turned.h; 1e-4 at most); in both cases plus Theory::known_to of both. The message begins with `device` and the
/// configuration and states the differences and both displacements. Returns the allowance by turning, relative; 0 where
/// turning was not needed.
double require_agreement(const Theories&, const std::vector<Answer>&, const Vector6& F_T_W, const Configuration&,
                         const std::string& device);

/// Equilibrium in the deformed shape, by each theory, in mm and rad.
struct DeformedAnswers {
  Geometry geometry;
  std::vector<Answer> answers;
  std::vector<double> from_linear;  ///< relative_difference() from the answer in linear geometry
  double discretisation = 0;        ///< sum of the discretisation errors of all, as relative_difference
  double play = 0;  ///< how far T can move in the play that the load leaves open in linear geometry, likewise
};
/// As require_agreement(), for equilibrium in the deformed shape. Theories may differ by the discretisation errors that
/// each estimates. In second-order geometry they may also differ by four times the square of the change from the linear
/// answer plus what the theory with the smaller one says it leaves out (Answer::left_out): each neglects several terms
/// of that order in its own way. Where one takes laws that jump as in linear geometry (Answer::apart) they may differ
/// by the change itself. Where play floats in linear geometry, equilibrium in the deformed shape may be stable at both
/// its ends, and they may differ by the play. Returns whether they do.
bool require_agreement_deformed(const Theories&, const DeformedAnswers&, const Configuration&,
                                const std::string& device);

}  // namespace deflect::theories
