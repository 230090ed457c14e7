// Checks of a 6×6 stiffness: K = Kᵀ, K ⪰ 0, and no resistance of legs along their passive joints, K_c J_q = 0.
#pragma once

#include <string>
#include <vector>

#include "msa/base/spatial.h"

namespace deflect {

/// One leg's stiffness at T and the twists at T of its passive joints (columns), SI, base axes.
struct LegStiffness {
  std::string name;
  Matrix6 K;
  Matrix6X passive_twists;
};

struct StiffnessChecks {
  bool symmetric = true, positive = true, passive_joints_free = true;
  std::string failure;  ///< which check failed, where and by how much; empty: all hold

  bool all() const { return symmetric && positive && passive_joints_free; }
};

/// Rotations are weighed by the length ℓ = √(tr K_θθ / tr K_δδ), so that the result does not depend on units. Each
/// quantity may differ from zero by `tolerance` times the largest entry (eigenvalue) of its matrix. The resistance of a
/// leg along its passive joints may also be that share of K, because for a leg far softer than the others only rounding
/// is left. `rounding`: by entry of K, what is known to be open; K may be so much less symmetric.
StiffnessChecks check_stiffness(const Matrix6& K, const std::vector<LegStiffness>& legs, double tolerance = 1e-9,
                                const Matrix6& rounding = Matrix6::Zero());

/// The response of a structure to one load at T, SI, base axes.
struct Response {
  Vector6 F, d;        ///< wrench on T, displacement of T
  Vector6 reaction;    ///< of the supports on the structure, as a wrench about T
  double energy = 0;   ///< strain energy, J
  bool linear = true;  ///< no spring's stiffness depends on its load
  /// Only the load moved it from its assembled state: no temperature change, no slip from earlier loads.
  bool from_rest = true;
  bool strained = false;  ///< parts carry forces before the load: misfits, preloads
  bool slides = false;    ///< some part has friction
  bool softens = false;   ///< the stiffness of some law may fall under load
  bool rigid = false;     ///< some motions have an infinite stiffness: a load along them does no work
};

/// Checks sign (Fᵀd > 0: a load moves its point in its own direction), equilibrium (reaction = −F) and energy, each to
/// `tolerance`; without `from_rest` only equilibrium. Returns the check that fails and by how much; empty: all hold.
/// Reciprocity is checked as the symmetry of the stiffness.
///
/// The energy E is relative to the state at rest. For a linear structure E = ½Fᵀd. All nonlinear laws but tables
/// stiffen under load, or have play or friction. With reversible laws that do so and carry nothing at rest, 0 ≤ E ≤
/// ½Fᵀd. Laws become softer as a table may have it, or where the load reduces their force at rest, and a friction
/// element whose force reverses stores more than half of the work done on it. Then only this holds: the total potential
/// E + D − Fᵀd, with D > 0 the heat of sliding, is at most that of the state at rest, so that E ≤ Fᵀd. Sliding may
/// release strain energy stored at rest; otherwise E ≥ 0. Where friction has slid at rest already (strained and
/// slides), the heat of that sliding is not in the balance: no bound.
std::string response_failure(const Response&, double tolerance = 1e-9);

}  // namespace deflect
