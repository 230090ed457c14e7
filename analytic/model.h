// The first theory: the methodology of Ahmad, Andersson and Sellgren in closed form, errata corrected (or, by name, as
// printed). Legs in parallel (1), (46) between the compliance of the base and of the tool. It sees the configuration
// and nothing of the frame solver.
//
// Three states: as drawn, parts unstrained; assembled at 20 °C, without load and weight, strained by the misfits only;
// loaded, with misfits, heat, weight and load. Displacements under load are counted from the assembled state.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analytic/chain.h"
#include "analytic/lines.h"
#include "msa/mechanism/conditions.h"

namespace deflect::analytic {

struct Deformed;

/// Equilibrium under one wrench [f; m] at T; base axes, SI.
struct AnalyticSolution {
  /// [δ; θ] of T from the assembled state, by load and weight; θ a rotation vector.
  Vector6 displacement = Vector6::Zero();
  Vector6 load = Vector6::Zero();  ///< without the weight
  /// What the platform exerts on each leg, at T; they add up to load and weight.
  std::vector<Vector6> leg_wrenches;
  bool converged = false;
  int iterations = 0;
  double misfit = 0;          ///< how far the legs' ends and the platform disagree, relative to the displacement
  std::vector<double> slips;  ///< of the frictions after the load, as in Conditions
  /// Where the mechanism floats in its play, which nothing loads: the parts that have it, the twists by which T may
  /// move (columns), by between least and most along each axis from the displacement, which is the middle (steps.h).
  std::vector<std::string> loose;
  Matrix6X free = Matrix6X(6, 0);
  Vector6 least = Vector6::Zero(), most = Vector6::Zero();
  ChainConditions under;  ///< warmth, and the phases of laws that jump (steps.h)
  std::string message;    ///< where not converged: why, when a law that jumps or the geometry is to blame
  Eigen::Vector2d discretisation = Eigen::Vector2d::Zero();  ///< of T, m and rad: about what dividing members leaves
  std::shared_ptr<const Deformed> deformed;  ///< the state in a geometry that is not linear (deformed.h)
  /// Where laws jump in the deformed shape: what of the displacement is the shape's. All else is linear geometry.
  Vector6 shape = Vector6::Zero();
};

/// A mechanism at one pose.
class AnalyticModel {
 public:
  explicit AnalyticModel(const Configuration&, const AsPrinted& = {});

  const std::vector<Chain>& chains() const { return legs_.branches; }

  /// No law's stiffness depends on its load.
  bool linear() const { return through_.linear() && legs_.linear(); }

  /// Some law jumps: a gap, friction.
  bool jumps() const { return !stepped_.empty(); }

  /// Legs' forces and the displacement of T in equilibrium, contacts at their load: Newton on the legs' forces. Throws
  /// ModelError naming the motion when something is free to move, whatever the load; or when rigid legs cannot be
  /// assembled. Geometries that are not linear: see deformed.h; without forces they are linear, as printed equations
  /// are always. There what laws that jump and heat do is added as they do it in linear geometry, and the stiffness is
  /// the linear one where there are such.
  AnalyticSolution solve(const Vector6& F_T_W, const Conditions& = {}) const;

  /// Displacement, slips, convergence and message of solve(), nothing of what is inside: for fits, which ask for many
  /// loads. Where laws jump in linear geometry, what lies between them is solved for six loads once, and a load costs
  /// the laws alone.
  AnalyticSolution displaced(const Vector6& F_T_W, const Conditions& = {}) const;

  /// The assembled state: displacement of T from the drawing, the legs' wrenches by misfit.
  AnalyticSolution assembled(Geometry = Geometry::linear) const;

  /// Tangent stiffness at T in the solution's state, and of one leg alone. Throws ModelError naming the leg and where
  /// nothing yields when it is infinite, as in a singular pose of a serial arm. Contacts without load let go.
  Matrix6 stiffness(const AnalyticSolution&) const;
  /// The same where it is infinite along some motions; never throws for that. A leg's is that of the motions it leaves.
  Resistance resistance(const AnalyticSolution&) const;
  Matrix6 leg_stiffness(std::size_t leg, const AnalyticSolution&) const;

  /// Tangent compliance at T, also where the stiffness is infinite. Throws ModelError naming the motion where contacts
  /// without load let something go.
  Matrix6 compliance(const AnalyticSolution&) const;

  /// Strain energy by part in the solution's state, J, largest first; of preloaded springs see Spring.
  std::vector<std::pair<std::string, double>> energies(const AnalyticSolution&) const;

 private:
  AnalyticSolution equilibrium(const Vector6& F, const Conditions&) const;
  AnalyticSolution equilibrium_under(const Vector6& F, const ChainConditions&) const;
  AnalyticSolution solution(const Group::State&, const Vector6& F, const ChainConditions&) const;
  AnalyticSolution deformed_equilibrium(const Vector6& F, Geometry) const;
  AnalyticSolution solve_in_part(const Vector6& F, const Conditions&) const;
  Flexibility flexibility(const AnalyticSolution&) const;

  Configuration configuration_;
  AsPrinted as_printed_;
  Group legs_;
  Chain through_;                             ///< base and tool joints, which carry the whole load
  Vector6 weight_;                            ///< at T
  double heat_force_ = 0, misfit_force_ = 0;  ///< that the stiffest member would bear: per kelvin, by the misfits
  std::vector<SteppedLaw> stepped_;
  std::optional<Lines> lines_;  ///< where frictions beside the legs are all that jumps
  int frictions_ = 0;
  /// What all but the laws that jump does under a load at T, weight included: linear.
  struct Between {
    MatrixX forces;  ///< of the laws, by load
    Matrix6 displacement;
    std::vector<Matrix6> wrenches;  ///< of the legs
  };
  Between between(const Imposed&) const;

  // Made when first needed: a model is for one thread at a time.
  mutable std::shared_ptr<const Between> between_;
  mutable std::shared_ptr<Imposed> imposed_;
  mutable std::shared_ptr<const Deformed> rest_;
};

}  // namespace deflect::analytic
