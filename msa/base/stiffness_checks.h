// Whether a 6×6 stiffness can be trusted: K = Kᵀ, K ⪰ 0, and legs that their passive joints leave free, K_c J_q = 0.
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
  std::string failure;  ///< which check failed, where, by how much; empty when all hold

  bool all() const { return symmetric && positive && passive_joints_free; }
};

/// Rotations are weighed by the length ℓ = √(tr K_θθ / tr K_δδ) so that the verdict does not depend on units. Each
/// quantity may differ from zero by `tolerance` of the largest entry (eigenvalue) of what it is made from; what a leg
/// resists along its passive joints by that of K, too: of a leg far softer than the others rounding is left.
StiffnessChecks check_stiffness(const Matrix6& K, const std::vector<LegStiffness>& legs, double tolerance = 1e-9);

/// What one load did to a structure at T, SI, base axes.
struct Response {
  Vector6 F, d;        ///< wrench on T, displacement of T
  Vector6 reaction;    ///< of the supports on the structure, as a wrench about T
  double energy = 0;   ///< strain energy, J
  bool linear = true;  ///< no spring's stiffness depends on its load
  /// The load is all that moved it from where it was assembled: neither heat nor what earlier loads left.
  bool from_rest = true;
  bool strained = false;  ///< parts carry forces before the load: misfits, preloads
  bool slides = false;    ///< some part has friction
  bool rigid = false;     ///< some motions have an infinite stiffness: a load along them does no work
};

/// Sign (a load moves its point its own way, Fᵀd > 0), equilibrium (reaction = −F), energy, each to `tolerance`; of one
/// that was not at rest equilibrium alone. Empty when all hold, else which fails and by how much. Reciprocity is the
/// symmetry of the stiffness.
///
/// Energy E against the state at rest: ½Fᵀd of a linear structure. All laws stiffen under load, have play or friction.
/// Of reversible ones that carry nothing at rest 0 ≤ E ≤ ½Fᵀd. Where forces at rest fall under the load a law grows
/// softer, and a friction whose force turns stores more than half of what it has taken up: then what is left is that
/// the total potential E + D − Fᵀd, D > 0 the heat of sliding, is at most that of the state at rest, so E ≤ Fᵀd.
/// Sliding may let go what was strained at rest; else E ≥ 0.
std::string response_failure(const Response&, double tolerance = 1e-9);

}  // namespace deflect
