// A theory's answer at the tool point T under one wrench, and the checks that every answer must pass.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "msa/base/geometry.h"
#include "msa/base/stiffness_checks.h"
#include "msa/mechanism/conditions.h"
#include "msa/mechanism/configuration.h"

namespace deflect::theories {

/// Unloaded play, in which the mechanism floats. The displacement given is the middle of the play (set_valued_laws.h).
/// From there T can move by `least` to `most` along each axis (m, rad) without a change of any force.
struct Floating {
  std::vector<std::string> loose;  ///< the parts with that play; empty: nothing floats
  Vector6 least = Vector6::Zero(), most = Vector6::Zero();
};

/// A theory's answer to one wrench at T; SI, base axes.
struct Answer {
  Vector6 displacement;
  Matrix6 stiffness;                                          ///< tangent, in the state under the load
  std::vector<std::pair<std::string, double>> energies = {};  ///< by part, J, largest first
  StiffnessChecks checks = {};                                ///< of the stiffness; all hold
  std::vector<double> slips = {};                             ///< of the friction elements after the load, as in
                                                              ///< Conditions
  /// In finite geometry: estimated discretisation error of the displacement, m and rad.
  Eigen::Vector2d discretisation = Eigen::Vector2d::Zero();
  /// In second-order geometry: the order of what it leaves out, relative to the displacement: the square of the largest
  /// rotation of a body plus the largest strain of a member's axis.
  double left_out = 0;
  Floating floating = {};
  /// Number of motions with infinite stiffness; `stiffness` is that of the other motions.
  int rigid = 0;
  std::vector<std::string> rigid_motions = {};  ///< in words, where the theory knows them
  double rounding = 0;                          ///< estimated relative rounding error, where the theory knows it
  bool apart = false;  ///< in the deformed shape: laws that jump are taken as in linear geometry
};

/// Only a displacement, not checked: for fits, which need many thousands of them and compare them with readings.
struct Prediction {
  Vector6 displacement;
  bool converged;
  std::vector<double> slips = {};
  std::string reason = {};  ///< why it did not converge, where known
  /// By TheoryOptions::inside: [δ; θ] of a body, or in its first component the force of a drive (inside.h).
  std::vector<Vector6> inside = {};
  /// Play that the load leaves open, in whose middle the displacement is: a name for each law, the same for the same
  /// law under other loads. Where the theory knows it.
  std::vector<std::string> floating = {};
};

/// Relative bound of an answer's checks, unless rounding makes a wider one necessary.
inline constexpr double checked_to = 1e-9;

/// Relative bound of a check: `least`, or 100 times `rounding` (Solver::rounding()) where that is more, because an
/// answer collects some dozens of rounding errors.
double bound_with(double least, double rounding);

/// Estimated relative error of a displacement by rounding of the stiffness: ε/10 times the ratio of the largest to the
/// smallest stiffness. Infinite stiffnesses and those of floating motions are left out; rotations are weighed by the
/// length. At most 1e-7, so that the checks stay meaningful.
double rounding_of(const Answer&, double length);

/// "haptic-6psu at (0, 0, 198.9, 0, 0, 0)", mm and deg, for the start of a theory's messages.
std::string place_text(const std::string& device, const Configuration&);

/// The wrench on T plus the weight.
Vector6 with_weight(const Vector6& F_T_W, const Configuration&);

/// Strain energy of all parts, J.
double total(const std::vector<std::pair<std::string, double>>& energies);

/// The state of the mechanism before any load, which the checks of energy need.
struct AtRest {
  bool strained = false;  ///< parts carry forces: misfits, preloads
  bool history = false;   ///< some law has a history: friction
  bool softens = false;   ///< some law may: a table
};
AtRest at_rest(const Configuration&);

/// Which theory answers for which device and configuration; messages begin with it.
struct Asked {
  const char* theory;
  const std::string& device;
  const Configuration& at;
};

/// Further results of a theory, for the checks.
struct Found {
  Vector6 load;         ///< at T, including the weight
  Vector6 reaction;     ///< of the ground on the mechanism, about T
  double energy = 0;    ///< J, stored since rest
  bool linear = true;   ///< no law's stiffness depends on its force
  double rounding = 0;  ///< widens the bounds of the checks
};

/// The check that an answer in linear geometry fails (sign, equilibrium or energy), and by how much; empty: all hold.
std::string failure_of(const Answer&, const Found&, const AtRest&, const Conditions&);
/// Throws NumericalError with theory, place and check where failure_of() is not empty.
void check_answer(const Answer&, const Asked&, const Found&, const AtRest& = {}, const Conditions& = {});

/// Throws NumericalError where a check of the stiffness failed.
void enforce_stiffness(const StiffnessChecks&, const Asked&);

/// Checks an answer in the deformed shape (Geometry). There the forces in legs resist the motion of passive joints, and
/// the stored energy is not ½Fᵀd. Checked are K = Kᵀ and K ⪰ 0 for K without the term −½[m]× of the applied moment m,
/// the sign, and the balance of forces. `rounding`: of K, by entry. Returns the answer with its checks.
Answer deformed_answer(Answer, const Asked&, const Found&, const Matrix6& rounding = Matrix6::Zero());

/// The checked answer of a sweep (pose_sweep.h, msa_sweep.h) after its solve(). `legs` have their passive twists.
template <class Sweep>
Answer swept_answer(const Sweep& sweep, std::vector<LegStiffness>& legs, const Asked& asked, const Vector6& F,
                    const Vector6& reaction) {
  for (std::size_t i = 0; i < legs.size(); ++i) legs[i].K = sweep.leg_stiffness(i);
  Answer answer{sweep.displacement(), sweep.stiffness()};
  answer.checks = check_stiffness(answer.stiffness, legs);
  enforce_stiffness(answer.checks, asked);
  check_answer(answer, asked, {with_weight(F, asked.at), reaction, sweep.energy(), sweep.linear()});
  return answer;
}

}  // namespace deflect::theories
