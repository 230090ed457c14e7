// Equilibrium with the geometry of the displaced structure (msa/base/geometry.h): second order, or finite.
//
// Loads are dead: forces and moments constant in base axes. A moment is conjugate to the spin of its node, its work in
// a motion is m·ω dt with ω the angular velocity in base axes; such a moment has no potential where the node turns
// about more than one axis, and then the tangent stiffness is not symmetric (tangent.h). Line loads come as the forces
// and couples on nodes that they are equivalent to in the undeformed shape. Those couples, qh²/12 of an element of the
// length h, cancel but at the ends of a member, where that they keep their direction is an error of the order of h².
//
// Finite: members, arms and joints turn by any amount (deformed_beam.h, joint_motion.h), springs follow their laws,
// constraints that are not of a connection keep their linear forms (model.h). Load, heat and prescribed values grow
// together in steps; Newton with the consistent tangent in each. A step is halved where Newton fails, where it ends in
// an equilibrium that is unstable, and where it may have left the path of equilibria that begins at rest. Newton's
// steps tell, which shrink by a factor of ten each where no other equilibrium is near; else the energy does, where
// loads are all that acts: along the path it grows by their work, of which the trapezium ½ (f_0 + f_1)·Δu is right to a
// quarter in a short enough step (a spring δ^{3/2} from rest: a fifth), while a jump loses energy in a step of any
// length. Springs that jump are taken as they come. Where steps get no further, a buckling or limit load is there. At a
// buckling load the motion for which K vanishes is none that the load drives: the last stable state is the answer. At a
// limit load it is; then the structure snaps through. The state behind the jump is looked for under the whole load by
// steps (K + μ M)⁻¹ r downhill from the last stable state, as of a slow damped fall (implicit steps of M u̇ = r; C. T.
// Kelley, D. E. Keyes, SIAM J. Numer. Anal. 35 (1998) 508), and given with a message; where there is none the last
// stable state is the answer. Second order: K_E + K_G at the forces of the state, iterated until forces and
// displacements agree (linearisation.h); for rotations up to some tenths of a radian.
//
// Both begin from the undeformed shape, in which the linear Solver has refused mechanisms, those that forces would hold
// among them, and held idle spins. Very stiff members keep their nodes' coordinates here: digits are lost in proportion
// to the ratio of stiffnesses, so that a member 10⁶ times stiffer than its neighbours costs six of sixteen. Constraints
// that were redundant at the start are left out and must still hold at the end.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "msa/base/geometry.h"
#include "msa/frame/deformed/tangent.h"
#include "msa/frame/structure/solver.h"

namespace deflect::frame {

struct GeometricOptions {
  Geometry geometry = Geometry::finite;
  int load_steps = 1;        ///< at least; second order takes the load at once
  int max_iterations = 30;   ///< in a step
  double tolerance = 1e-12;  ///< of the last change of shape, relative
  int halvings = 20;         ///< of a step, before it is given up
  /// Of the frictions before the load, by their numbers; empty: zero. However many steps the load takes, a friction
  /// goes from there to where it ends at once.
  std::vector<double> slips;
};

struct GeometricLoad {
  VectorX forces;               ///< by freedom of the given model: N, Nm
  VectorX values;               ///< by constraint, a shorter one counts as zero behind; empty: those in the model
  std::vector<double> strains;  ///< by beam, free strain; empty: none
};

/// Not converged, or not stable: message says why. Then the state is the last one that was found, at load_factor. A
/// state behind a jump is converged and has a message too.
struct GeometricState {
  Geometry geometry = Geometry::finite;
  bool converged = false;
  /// K is positive definite on the free motions. Second order: the load is below the first buckling load.
  bool stable = false;
  std::string message;
  double load_factor = 0;  ///< of the load that is carried
  double snaps_at = 0;     ///< of the load, where the structure snaps through on the way to this state; 0: it does not
  int steps = 0, iterations = 0;
  double residual = 0;        ///< what Newton would still change, relative to the displacement
  VectorX u;                  ///< by freedom of GeometricSolver::model(): m, rotation vector, the scalars' unit
  VectorX constraint_forces;  ///< λ: what constraint k does to the freedoms is λ_k forms_k
  VectorX elongations, spring_forces, spring_tangents;
  std::vector<SpringLaw> jumping;  ///< by spring, with what they know of the state (stepped_spring.h); none: no jumps
  std::vector<double> slips;       ///< of the frictions after the load
  std::vector<BeamState> beams;
  /// Of constraints and springs in this shape: a spring does −spring_forces_i spring_forms_i to the freedoms.
  std::vector<LinearForm> forms, spring_forms;
  Eigen::SparseMatrix<double> K;  ///< tangent by freedom, constraints apart
  double energy = 0;              ///< J, beams and springs
  /// Finite: no less, by and large, than what the elements leave out; the largest relative one, all twists.
  LeftOut left_out;

  const SpringLaw& law(const Model& m, std::size_t i) const { return jumping.empty() ? m.springs[i].law : jumping[i]; }
};

/// Energies by part, in order of first appearance, J.
std::vector<std::pair<std::string, double>> energies(const Model&, const GeometricState&);

class GeometricSolver {
 public:
  /// ModelError as Solver.
  explicit GeometricSolver(Model);

  /// The given model with constraints behind its own that hold idle spins.
  const Model& model() const { return model_; }
  const std::vector<std::string>& notes() const { return notes_; }

  /// Throws ModelError for constraint values that contradict each other and for a load that drives an idle spin.
  GeometricState solve(const GeometricLoad&, const GeometricOptions& = {});

  /// Tangent stiffness [f; m] by [δ; spin] of a node in a state, base axes: its reactions when it is displaced. It is
  /// symmetric unless moments are applied. A direction in which nothing holds the node has zero stiffness. Throws
  /// ModelError where the rest of the structure has no stiffness of its own.
  Matrix6 stiffness(const GeometricState&, int node) const;

  /// Tangent response of a state, [δ; spin] and scalars by freedom, to columns of load increments.
  MatrixX response(const GeometricState&, const MatrixX& loads) const;

 private:
  struct Work;
  Model constrained(const std::vector<LinearForm>& forms) const;
  double driving_force(const Linearisation& rest, const VectorX& values) const;
  VectorX update_forces(Work&, const Linearisation&, const Elimination&, const Model& constraints, double factor) const;
  struct Step;
  Step newton(Work&, double factor, Geometry) const;
  void keep_laws(Work&, const Linearisation&, const VectorX& loads, Step&) const;
  bool iterate(Work&, double factor, const GeometricOptions&, GeometricState&) const;
  bool arrived(Work&, const VectorX& before, double factor, const GeometricState&, bool doubtful) const;
  bool drives(Work&, double factor, const VectorX& towards) const;
  bool fall(Work&, const GeometricOptions&, GeometricState&) const;
  void follow(Work&, const GeometricOptions&, GeometricState&) const;
  void conclude(Work&, GeometricState&) const;

  void take_jumps(Work&) const;
  void begin_jumps(Work&, double factor) const;
  void release_jumps(Work&, GeometricState&) const;
  Model held(const GeometricState&) const;

  std::unique_ptr<Solver> linear_;
  Model model_;
  std::vector<std::size_t> active_;  // constraints that are not redundant
  std::vector<std::string> notes_;
};

}  // namespace deflect::frame
