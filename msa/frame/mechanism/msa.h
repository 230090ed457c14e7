// The second theory: matrix structural analysis of a mechanism at a pose. It sees the configuration and nothing of the
// closed form in `analytic`.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "msa/frame/deformed/geometric_solver.h"
#include "msa/frame/mechanism/build.h"
#include "msa/frame/structure/solver.h"
#include "msa/mechanism/conditions.h"

namespace deflect::frame {

/// Response of the tool point T to one wrench [f; m] at T, base axes, SI; dead: its direction stays. The payload's
/// weight acts with it. Displacement and energies are those against the mechanism assembled at 20 °C without load and
/// weight.
struct MsaSolution {
  Vector6 displacement;  ///< [δ; θ] of T, θ a rotation vector
  Vector6 load;          ///< the wrench and the weight
  Solution state;        ///< of MsaModel::model(): not converged is said here, and why in state.geometric
  /// Strain energy by part, J, largest first. ½ loadᵀd where everything is linear and as warm as it was assembled.
  std::vector<std::pair<std::string, double>> energies;
  std::vector<double> slips;  ///< of the frictions after the load, as in Conditions
};

/// A mechanism at one pose, factorised once for all its load cases.
class MsaModel {
 public:
  explicit MsaModel(const Configuration&, const MemberDivision& = {});
  ~MsaModel();
  MsaModel(const MsaModel&) = delete;
  MsaModel& operator=(const MsaModel&) = delete;

  const Model& model() const { return solver_.model(); }
  /// Idle spins that were held, redundant constraints, poor conditioning.
  const std::vector<std::string>& notes() const { return solver_.notes(); }
  const MechanismModel& mechanism() const { return built_; }
  /// Solver::rounding() of the answers so far.
  double rounding() const;

  bool linear() const { return solver_.linear_springs(); }

  /// Second order and finite: members that bend far or are pressed hard want a division (MemberDivision); one element
  /// overestimates the buckling load of a cantilever by 0.8 %, two by 0.05 %. Without load both are linear.
  MsaSolution solve(const Vector6& F_T_W, const Conditions& = {});

  /// The mechanism as assembled, without load and weight: strained where legs stand beside their seats (misfits).
  const Solution& assembled();

  /// Tangent stiffness at T of the structure in a state, as computed, not symmetrised, and of each leg alone at the
  /// platform's T: reactions to unit displacements. A direction in which nothing holds T has zero stiffness. Where
  /// parts are rigid T may move in `motions` alone (orthonormal columns, rotations times the configuration's size):
  /// fewer than six; K is then that of these motions and resists no other. A leg's K likewise. Of a state that is not
  /// linear the tool's stiffness has its geometric part, per spin (geometric_solver.h), symmetric where no moment is
  /// applied, and the legs are left empty: forces between them are no leg's own.
  struct Stiffness {
    Matrix6 K;
    std::vector<Matrix6> legs;
    MatrixX motions = MatrixX::Identity(6, 6);
  };
  Stiffness stiffness(const Solution& state);

  /// Twists at T of a leg's passive joints (columns).
  Matrix6X passive_twists(std::size_t leg) const;

  /// Reaction of the world on the base at the base origin, [f; m], to the whole load on T.
  Vector6 base_reaction(const Vector6& load_T_W, const Solution& state);

 private:
  struct Held;
  VectorX tangents_of(const Model& leg, const Solution& state) const;
  Solution solve_linear(const VectorX& load, const Conditions&);
  Solution solve_geometric(const VectorX& load, const Conditions&);
  std::vector<double> strains(double warmer) const;

  int frictions_ = 0;
  Configuration configuration_;
  MemberDivision division_;
  MechanismModel built_;
  Solver solver_;
  std::unique_ptr<Solution> assembled_;  // made when first asked for
  std::vector<std::pair<std::string, double>> rest_energies_;
  std::unique_ptr<GeometricSolver> geometric_;  // made when a geometry that is not linear is first asked for
  std::unique_ptr<Held> tool_held_;             // made when a stiffness is first asked for
  std::unique_ptr<Reactions> supports_;         // made when a reaction is first asked for
};

}  // namespace deflect::frame
