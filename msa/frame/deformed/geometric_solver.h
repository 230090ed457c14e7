// Equilibrium in the displaced shape of a structure: second-order or finite geometry (msa/base/geometry.h).
//
// Loads are dead: forces and moments constant in base axes. A moment is conjugate to the spin of its node: its work is
// ∫ m·ω dt with ω the angular velocity in base axes. It has no potential where the node rotates about more than one
// axis, and then the tangent stiffness is not symmetric (tangent.h). Line loads are replaced by equivalent nodal forces
// and couples in the undeformed shape. The couples, qh²/12 for an element of length h, cancel except at the ends of a
// member; there their fixed direction is an error of order h².
//
// Finite: members, arms and joints rotate by any amount (deformed_beam.h, joint_motion.h), springs follow their laws,
// and constraints outside connections keep their linear forms (model.h). Load, temperature and prescribed values grow
// together in load steps, each solved by Newton's method with the consistent tangent. A load step is halved where
// Newton fails, where it ends in an unstable equilibrium, and where it may have left the path of equilibria that begins
// at rest. It is on the path where each Newton step is at most a tenth of the one before, because then no other
// equilibrium is near. Otherwise the energy decides, where only loads act and all springs are linear: along the path it
// grows by the work of the loads, for which the trapezium ½ (f_0 + f_1)·Δu is right to a quarter in a short enough
// step; a jump loses energy in a step of any length. States with springs that jump are accepted without this test.
//
// Where steps cannot be halved further, there is a buckling or limit load. At a buckling load the load does no work on
// the motion for which K vanishes: the last stable state is the answer. At a limit load it does, and the structure
// snaps through. The state after the jump is searched under the whole load by descent steps (K + μ M)⁻¹ r from the last
// stable state, as in a slow damped motion (implicit steps of M u̇ = r; C. T. Kelley, D. E. Keyes, SIAM J. Numer. Anal.
// 35 (1998) 508), and returned with a message. Where none is found, the last stable state is the answer.
//
// Second order: K_E + K_G at the forces of the state, iterated until forces and displacements agree (linearisation.h);
// for rotations up to some tenths of a radian.
//
// Both begin from the undeformed shape. For this shape the linear Solver has already refused mechanisms, also those
// that forces would stabilise, and held idle spins. Very stiff members get no relative coordinates here: a member 10⁶
// times stiffer than its neighbours costs six of sixteen digits. Constraints that are redundant at the start are left
// out and must still hold at the end.
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
  int load_steps = 1;        ///< at least; second order applies the whole load at once
  int max_iterations = 30;   ///< in a step; second order: in which the change has to halve
  double tolerance = 1e-12;  ///< of the last change of shape, relative
  int halvings = 20;         ///< of a load step, before it fails
  /// Slips of the friction elements before the load, by their numbers; empty: zero. A friction element changes from
  /// this slip to its final one in a single step, however many load steps there are.
  std::vector<double> slips;
  std::vector<double> limits;  ///< of the same; empty: those where nothing is carried beside them
};

struct GeometricLoad {
  VectorX forces;               ///< by freedom of the given model: N, Nm
  VectorX values;               ///< by constraint, missing ones at the end are zero; empty: those in the model
  std::vector<double> strains;  ///< by beam, free strain; empty: none
};

/// Where it is not converged or not stable, `message` says why, and the state is the last one found, at load_factor. A
/// state after a snap-through is converged and has a message too.
struct GeometricState {
  Geometry geometry = Geometry::finite;
  bool converged = false;
  /// Whether K is positive definite on the free motions. Second order: whether the load is below the first buckling
  /// load.
  bool stable = false;
  std::string message;
  double load_factor = 0;  ///< share of the load that is carried
  double snaps_at = 0;     ///< share of the load at which the structure snaps through before this state; 0: it does not
  int steps = 0, iterations = 0;
  double residual = 0;    ///< size of the next step, relative to the displacement; 0: what forces lack is rounding
  double unbalanced = 0;  ///< N: the largest force that is not balanced at a node, and the node
  int unbalanced_node = 0;
  VectorX u;                  ///< by freedom of GeometricSolver::model(): m, rotation vector, the scalars' unit
  VectorX constraint_forces;  ///< λ: constraint k exerts λ_k forms_k on the freedoms
  VectorX elongations, spring_forces, spring_tangents;
  std::vector<SpringLaw> jumping;  ///< by spring, with their known forces (stepped_spring.h); empty: no spring jumps
  std::vector<double> slips;       ///< of the friction elements after the load
  std::vector<std::string> loose;  ///< springs with unloaded play in which the structure floats: the middle is given
  std::vector<BeamState> beams;
  /// Of constraints and springs in this shape; spring i exerts −spring_forces_i spring_forms_i on the freedoms.
  std::vector<LinearForm> forms, spring_forms;
  Eigen::SparseMatrix<double> K;  ///< tangent by freedom, without constraints
  double energy = 0;              ///< J, beams and springs
  /// Finite: approximate upper bound of the elements' errors: the largest relative one, the sum of twists. Second
  /// order: the order of what it leaves out, relative: the square of the largest rotation plus the largest strain N/EA.
  LeftOut left_out;

  const SpringLaw& law(const Model& m, std::size_t i) const { return jumping.empty() ? m.springs[i].law : jumping[i]; }
};

struct NodeStiffness {
  Matrix6 K;
  Matrix6 rounding;  ///< by entry: ε |U|ᵀ|K||U|, U the motions of all nodes. Where one hardly held moves far, digits go
};

/// Energies by part, in order of first appearance, J.
std::vector<std::pair<std::string, double>> energies(const Model&, const GeometricState&);

class GeometricSolver {
 public:
  /// Throws ModelError as Solver does.
  explicit GeometricSolver(Model);

  /// The given model, with constraints appended that hold idle spins.
  const Model& model() const { return model_; }
  const std::vector<std::string>& notes() const { return notes_; }

  /// Throws ModelError for constraint values that contradict each other and for a load that drives an idle spin.
  GeometricState solve(const GeometricLoad&, const GeometricOptions& = {});

  /// Tangent stiffness ∂[f; m]/∂[δ; spin] of a node in a state, base axes: its reactions to unit displacements. It is
  /// symmetric unless moments are applied. A direction in which nothing holds the node has zero stiffness. Throws
  /// ModelError where the structure, with the node held, has no stiffness.
  NodeStiffness stiffness(const GeometricState&, int node) const;

  /// Tangent response of a state, [δ; spin] and scalars by freedom, to columns of load increments.
  MatrixX response(const GeometricState&, const MatrixX& loads) const;

 private:
  struct Work;
  Model constrained(const std::vector<LinearForm>& forms) const;
  double driving_force(const Linearisation& rest, const VectorX& values) const;
  VectorX update_forces(Work&, const Linearisation&, const Elimination&, const Model& constraints, double factor) const;
  /// Whether at each free freedom the forces cancel up to what rounding leaves of those that were added up there.
  bool balances(const Work&, const Linearisation&, const Elimination&, double factor, const VectorX& unbalanced,
                const VectorX& gaps) const;
  struct Step;
  Step newton(Work&, double factor, Geometry) const;
  void keep_laws(Work&, const Linearisation&, double factor, Step&, VectorX& unbalanced) const;
  bool iterate(Work&, double factor, const GeometricOptions&, GeometricState&) const;
  bool arrived(Work&, const VectorX& before, const VectorX& tangent, double factor, const GeometricState&,
               bool doubtful) const;
  bool drives(Work&, double factor, const VectorX& towards) const;
  bool fall(Work&, const GeometricOptions&, GeometricState&) const;
  void follow(Work&, const GeometricOptions&, GeometricState&) const;
  void conclude(Work&, GeometricState&) const;
  std::string lost_digits(const Work&, Geometry) const;

  void take_jumps(Work&) const;
  void begin_jumps(Work&, double factor) const;
  void release_jumps(Work&, GeometricState&) const;
  Model held(const GeometricState&) const;

  std::unique_ptr<Solver> linear_;
  Model model_;
  std::vector<std::size_t> active_;  // constraints that are not redundant
  std::vector<std::string> notes_;
};

/// The same where limits of frictions grow with the loads beside them: they are found with the shape.
GeometricState solve_settled(GeometricSolver&, const GeometricLoad&, GeometricOptions);

}  // namespace deflect::frame
