// The MSA theory: matrix structural analysis of a mechanism at a pose. It depends on the configuration only, not on the
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
#include "msa/mechanism/inside.h"

namespace deflect::frame {

/// Response of the tool point T to one wrench [f; m] at T, base axes, SI; the load is dead: its direction is fixed. The
/// payload's weight acts with it. Displacement and energies are relative to the mechanism assembled at 20 °C without
/// load and weight.
struct MsaSolution {
  Vector6 displacement;  ///< [δ; θ] of T, θ a rotation vector
  Vector6 load;          ///< the wrench plus the weight
  Solution state;        ///< of MsaModel::model(); whether it converged, and why not (state.geometric)
  /// Strain energy by part, J, largest first. The sum is ½ loadᵀd where everything is linear and at the temperature of
  /// assembly.
  std::vector<std::pair<std::string, double>> energies;
  std::vector<double> slips;                  ///< of the frictions after the load, as in Conditions
  std::shared_ptr<const Solution> rest = {};  ///< the assembled state, where it is strained
};

/// A mechanism at one pose, factorised once for all its load cases.
class MsaModel {
 public:
  explicit MsaModel(const Configuration&, const MemberDivision& = {});
  ~MsaModel();
  MsaModel(const MsaModel&) = delete;
  MsaModel& operator=(const MsaModel&) = delete;

  const Model& model() const { return solver_.model(); }
  /// Notes on idle spins that were held, redundant constraints, poor conditioning.
  const std::vector<std::string>& notes() const { return solver_.notes(); }
  const MechanismModel& mechanism() const { return built_; }
  /// Solver::rounding() of the answers so far.
  double rounding() const;

  bool linear() const { return solver_.linear_springs(); }

  /// Second order and finite: members with large bending or compression must be divided (MemberDivision); one element
  /// overestimates the buckling load of a cantilever by 0.8 %, two by 0.05 %. Without load linear geometry is used.
  MsaSolution solve(const Vector6& F_T_W, const Conditions& = {});

  /// The mechanism as assembled, without load and weight: strained where legs have misfits.
  const Solution& assembled();

  /// By place, [δ; θ] of a body behind a part, or in its first component the force of a drive (inside.h): the force of
  /// the joint's own constraint or spring; of a rigid drive what passes the next connection of the leg.
  std::vector<Vector6> inside(const std::vector<Inside>&, const MsaSolution&);

  /// Tangent stiffness at T of the structure in a state, not symmetrised, and of each leg alone at the platform's T:
  /// reactions to unit displacements. A direction in which nothing holds T has zero stiffness. Where parts are rigid, T
  /// may move only in `motions` (fewer than six orthonormal columns, rotations times the configuration's size). K is
  /// then the stiffness for these motions and zero for others; a leg's K likewise. For a state in nonlinear geometry K
  /// includes the geometric stiffness, with respect to spins (geometric_solver.h), and is symmetric where no moment is
  /// applied; `legs` is then empty, because the geometric stiffness cannot be assigned to single legs.
  struct Stiffness {
    Matrix6 K;
    std::vector<Matrix6> legs;
    MatrixX motions = MatrixX::Identity(6, 6);
    Matrix6 rounding = Matrix6::Zero();  ///< of K, by entry; in nonlinear geometry
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
  struct Forces;
  Forces forces_in(const Solution&, const Vector6& load_T_W);
  double drive_force(const Inside&, const Forces&, const Solution&) const;
  Vector6 motion(const Inside&, const Solution&) const;

  int frictions_ = 0;
  Configuration configuration_;
  MemberDivision division_;
  MechanismModel built_;
  Solver solver_;
  std::unique_ptr<Solution> assembled_;  // made on first use
  std::vector<std::pair<std::string, double>> rest_energies_;
  std::unique_ptr<GeometricSolver> geometric_;  // made on first use of a nonlinear geometry
  std::unique_ptr<Held> tool_held_;             // made for the first stiffness
  std::unique_ptr<Reactions> supports_;         // made for the first reaction
};

}  // namespace deflect::frame
