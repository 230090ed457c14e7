// The analytic theory: the methodology of Ahmad, Andersson and Sellgren in closed form, with errata corrected or, by
// name, as printed. Legs act in parallel (1), (46), in series with the compliances of base and tool. It depends on the
// configuration only, not on the frame solver.
//
// There are three states: as drawn, with unstrained parts; assembled at 20 °C, without load and weight, strained only
// by the misfits; loaded, with misfits, temperature, weight and load. Displacements under load are relative to the
// assembled state.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "analytic/chain.h"
#include "analytic/lines.h"
#include "analytic/same_phases.h"
#include "msa/mechanism/conditions.h"
#include "msa/mechanism/inside.h"

namespace deflect::analytic {

struct Deformed;

/// Equilibrium under one wrench [f; m] at T; base axes, SI.
struct AnalyticSolution {
  /// [δ; θ] of T from the assembled state, by load and weight; θ a rotation vector.
  Vector6 displacement = Vector6::Zero();
  Vector6 load = Vector6::Zero();  ///< without the weight
  /// Wrench of the platform on each leg, at T; they add up to load and weight.
  std::vector<Vector6> leg_wrenches;
  bool converged = false;
  int iterations = 0;
  double misfit = 0;          ///< largest gap between legs' ends and platform, relative to the displacement
  std::vector<double> slips;  ///< after the load, as in Conditions
  /// Unloaded play, in which the mechanism floats (steps.h): the laws that have it, by number, and the twists by which
  /// T may move (columns). Along each axis T may move by `least` to `most` from the displacement given, which is the
  /// middle.
  std::vector<std::size_t> loose;
  Matrix6X free = Matrix6X(6, 0);
  Vector6 least = Vector6::Zero(), most = Vector6::Zero();
  ChainConditions under;  ///< temperature, and the phases of laws that jump (steps.h)
  std::string message;    ///< why it did not converge, where a law that jumps or the geometry is the cause
  Eigen::Vector2d discretisation = Eigen::Vector2d::Zero();  ///< of T, m and rad: estimated discretisation error
  std::shared_ptr<const Deformed> deformed;  ///< the state in a geometry that is not linear (deformed.h)
  /// Where laws jump in the deformed shape: the contribution of the shape to the displacement. All else is of linear
  /// geometry.
  Vector6 shape = Vector6::Zero();
  bool apart = false;  ///< they were not balanced in that shape: one of the cases that solve() names
};

/// A mechanism at one pose.
class AnalyticModel {
 public:
  /// `apart`: in the deformed shape laws that jump are taken as in linear geometry (see solve()).
  explicit AnalyticModel(const Configuration&, const AsPrinted& = {}, bool apart = false);

  const std::vector<Chain>& chains() const { return legs_.branches; }

  /// Whether no law's stiffness depends on its load.
  bool linear() const { return through_.linear() && legs_.linear(); }

  /// Whether some law jumps: clearance, friction, one-sided.
  bool jumps() const { return !stepped_.empty(); }
  /// The laws in steps, by number.
  const std::vector<SteppedLaw>& in_steps() const { return stepped_; }

  /// Legs' forces and the displacement of T in equilibrium, contacts at their load, by Newton's method in the legs'
  /// forces. Throws ModelError with the motion where something is free to move, even under a load that does not move
  /// it; also where rigid legs cannot be assembled. For nonlinear geometries see deformed.h. Linear geometry is used
  /// instead where there are no forces, and always for equations as printed. Laws that jump are then balanced in the
  /// deformed shape too, which decides where unloaded play stands; all but the displacement is that of linear geometry
  /// with the play there. Not so where they are to be taken apart, and in three cases, in which the displacement is the
  /// linear one plus what the shape adds to the mechanism without such laws: beside misfits, beside a change of
  /// temperature, and where only frictions beside the legs jump.
  AnalyticSolution solve(const Vector6& F_T_W, const Conditions& = {}) const;

  /// Only displacement, slips, convergence and message of solve(), and the laws of unloaded play that T moves in: for
  /// fits, which need many loads. Where laws jump, the linear rest of the mechanism is solved once for six loads and a
  /// temperature, so that each further load solves only the laws.
  AnalyticSolution displaced(const Vector6& F_T_W, const Conditions& = {}) const;

  /// The assembled state: displacement of T from the drawing, and the legs' wrenches by misfits.
  AnalyticSolution assembled(Geometry = Geometry::linear) const;

  /// Tangent stiffness at T in the solution's state; leg_stiffness(): of one leg. Throws ModelError with the leg and
  /// the motion where it is infinite, as in a singular pose of a serial arm. Contacts without load have no stiffness.
  Matrix6 stiffness(const AnalyticSolution&) const;
  /// The same also where the stiffness is infinite along some motions, without throwing. leg_stiffness() is then that
  /// of the motions that the leg allows.
  Resistance resistance(const AnalyticSolution&) const;
  Matrix6 leg_stiffness(std::size_t leg, const AnalyticSolution&) const;

  /// Tangent compliance at T, also where the stiffness is infinite. Throws ModelError with the motion that contacts
  /// without load leave free.
  Matrix6 compliance(const AnalyticSolution&) const;

  /// By place, in the solution's state relative to the assembled one: [δ; θ] of a body, δ at T, or in its first
  /// component the force of a drive (inside.h). By virtual work: the wrench F on the leg at T loads a freedom that
  /// moves T by the twist t with tᵀF; a body moves by what the parts before it yield under F and by the motions of
  /// passive joints, which follow from the motion of the platform; one that moves neither the platform nor itself by
  /// more than others stays (the least motions are taken). Where laws jump in the deformed shape, of linear geometry.
  /// Throws NumericalError in second order.
  std::vector<Vector6> inside(const std::vector<Inside>&, const AnalyticSolution&) const;

  /// Strain energy by part in the solution's state, J, largest first; of preloaded springs see Spring.
  std::vector<std::pair<std::string, double>> energies(const AnalyticSolution&) const;

 private:
  AnalyticSolution equilibrium(const Vector6& F, const Conditions&) const;
  void refuse_motions(const Vector6& F) const;
  /// With the laws held in these steps; `held`: a force whose rounding is nothing.
  SteppedForces under_steps(const Vector6& F, ChainConditions&, const std::vector<Step>&, double held) const;
  AnalyticSolution equilibrium_under(const Vector6& F, const ChainConditions&) const;
  AnalyticSolution solution(const Group::State&, const Vector6& F, const ChainConditions&) const;
  AnalyticSolution deformed_equilibrium(const Vector6& F, Geometry) const;
  /// Nothing loads or strains it: no shape differs from that at rest, and play stands in its middle.
  bool forceless(const Vector6& F, const Conditions&) const;
  AnalyticSolution solve_in_part(const Vector6& F, const Conditions&) const;
  /// Laws in balance in the deformed shape, and what that adds up to.
  struct InShape {
    BalancedSteps laws;
    Vector6 displacement = Vector6::Zero();
    Eigen::Vector2d discretisation = Eigen::Vector2d::Zero();
  };
  Imposed offsets_unloaded() const;  ///< what offsets of the laws do in linear geometry
  std::optional<InShape> jumps_in_shape(const Vector6& F, const Conditions&) const;
  std::optional<InShape> balanced_from_linear(const Vector6& F, const Conditions&, Imposed) const;
  std::optional<InShape> balanced_on_the_way(const Deformed& begun, const Vector6& F, const Conditions&, Imposed&,
                                             bool& far) const;
  void put_play(const InShape&, const Vector6& F, AnalyticSolution&) const;
  AnalyticSolution with_shape(AnalyticSolution, Geometry) const;
  Flexibility flexibility(const AnalyticSolution&) const;
  Vector6 inside_linear(const Inside&, const AnalyticSolution&) const;

  Configuration configuration_;
  AsPrinted as_printed_;
  bool apart_;
  Group legs_;
  Chain through_;                             ///< base and tool joints, each carries the whole load
  Vector6 weight_;                            ///< at T
  double heat_force_ = 0, misfit_force_ = 0;  ///< scale of forces in the stiffest member: per kelvin, and by the
                                              ///< misfits
  std::vector<SteppedLaw> stepped_;
  std::optional<Lines> lines_;  ///< set where only friction elements beside the legs jump
  int frictions_ = 0;
  using Vector7 = Eigen::Matrix<double, 7, 1>;
  using Matrix67 = Eigen::Matrix<double, 6, 7>;
  /// Linear response, to a load at T including weight and to K above 20 °C, of everything except the laws that jump.
  struct Between {
    MatrixX forces;  ///< of the laws, by load and kelvin
    Matrix67 displacement;
    std::vector<Matrix67> wrenches;  ///< of the legs
    Imposed known;                   ///< of which it is
    SamePhases same;                 ///< as the last load left the laws
  };
  Between between(const Imposed&) const;
  Between& linear_response() const;
  SteppedForces held_under(const Between&, const Vector6& F, const Conditions&) const;
  struct Quick {
    BalancedSteps laws;
    Vector6 displacement;
  };
  std::optional<Quick> quick(const Vector6& F, const Conditions&) const;
  /// The laws at these offsets, each with the compliance that `between_` has in its place.
  std::vector<Step> held_at(const VectorX& offsets) const;
  bool agrees(const Vector6& driving, double warmer, const VectorX& offsets, const SteppedForces&) const;
  /// Where heat or misfits are all that drives it, forces that should vanish are the rounding of this force.
  double held_without_load(const Conditions& c) const {
    return 1e-3 * (heat_force_ * std::abs(c.warmer) + misfit_force_);
  }

  // Made on first use: a model may be used by one thread at a time.
  mutable std::shared_ptr<Between> between_;
  mutable std::shared_ptr<Imposed> imposed_;
  mutable std::shared_ptr<const Deformed> rest_, rest_in_steps_;
};

}  // namespace deflect::analytic
