// What a theory says of the tool point T under one wrench, and the checks that every answer passes before it is given.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "msa/base/geometry.h"
#include "msa/base/stiffness_checks.h"
#include "msa/mechanism/conditions.h"
#include "msa/mechanism/configuration.h"

namespace deflect::theories {

/// Where nothing loads a play, the mechanism floats in it: the displacement is the middle (set_valued_laws.h), from
/// which T may move by between `least` and `most` along each axis (m, rad) without changing any force.
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
  std::vector<double> slips = {};                             ///< of the frictions after the load, as in Conditions
  /// Finite: about what dividing members leaves of the displacement, m and rad.
  Eigen::Vector2d discretisation = Eigen::Vector2d::Zero();
  Floating floating = {};
  /// Motions along which the stiffness is infinite; `stiffness` is that of the others.
  int rigid = 0;
  std::vector<std::string> rigid_motions = {};  ///< in words, by a theory that knows them
  double rounding = 0;  ///< by how much the theory amplified the rounding of its own numbers, where it knows
};

/// A displacement alone, not checked: for fits, which ask for many thousands of them and compare them with readings.
struct Prediction {
  Vector6 displacement;
  bool converged;
  std::vector<double> slips = {};
  std::string reason = {};  ///< where not converged, if it is known
};

/// Relative: what an answer's checks allow where rounding allows it.
inline constexpr double checked_to = 1e-9;

/// The bound of a check that demands `least`, relative: more where the structure amplifies the rounding of its own
/// numbers by `rounding` (Solver::rounding()), some dozens of which meet in an answer.
double bound_with(double least, double rounding);

/// The share of a displacement that rounding of the stiffness may cost: a tenth of ε times the ratio of the largest to
/// the smallest stiffness, but for infinite ones and those of motions that float, rotations weighed by the length; at
/// most 1e-7, so that no check loses its meaning.
double rounding_of(const Answer&, double length);

/// "haptic-6psu at (0, 0, 198.9, 0, 0, 0)", mm and deg: begins the messages of a theory.
std::string place_text(const std::string& device, const Configuration&);

/// The wrench on T and the weight.
Vector6 with_weight(const Vector6& F_T_W, const Configuration&);

/// Strain energy of all parts, J.
double total(const std::vector<std::pair<std::string, double>>& energies);

/// What the mechanism carries before any load, which the checks of energy must know.
struct AtRest {
  bool strained = false;  ///< parts carry forces: misfits, preloads
  bool history = false;   ///< some law has one: friction
};
AtRest at_rest(const Configuration&);

/// Who answers for what: begins the messages, which are made when one is needed.
struct Asked {
  const char* theory;
  const std::string& device;
  const Configuration& at;
};

/// What a theory found beside its answer, for the checks.
struct Found {
  Vector6 load;         ///< at T, the weight with it
  Vector6 reaction;     ///< of the ground on the mechanism, about T
  double energy = 0;    ///< stored since rest
  bool linear = true;   ///< no law's stiffness depends on its force
  double rounding = 0;  ///< widens the bounds of the checks
};

/// The check that an answer in linear geometry fails: sign, equilibrium or energy, and by how much; empty: none.
std::string failure_of(const Answer&, const Found&, const AtRest&, const Conditions&);
/// Throws NumericalError naming theory, place and check where there is one.
void check_answer(const Answer&, const Asked&, const Found&, const AtRest& = {}, const Conditions& = {});

/// Throws NumericalError where a check of the stiffness failed.
void enforce_stiffness(const StiffnessChecks&, const Asked&);

/// In the deformed shape (Geometry) legs carry forces that resist their passive joints, and the stored energy is not
/// ½Fᵀd: there K = Kᵀ of what is left without −½[m]× of the applied moment m, K ⪰ 0, sign and the balance of forces are
/// checked. Returns the answer with its checks.
Answer deformed_answer(Answer, const Asked&, const Found&);

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
