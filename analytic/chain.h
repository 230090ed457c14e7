// A mechanism in closed form: compliances in series (2), (45) and chains in parallel (1), (46), nested to any depth,
// with passive joints released. Everything is referred to one point T, in base axes. All parts of a chain carry the
// same wrench, so forces are the independent variables. Equation numbers are those of Ahmad, Andersson, Sellgren.
#pragma once

#include <Eigen/LU>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "analytic/deflection.h"
#include "analytic/flexibility.h"
#include "analytic/steps.h"
#include "msa/mechanism/configuration.h"

namespace deflect::analytic {

/// A freedom with laws. Unit relative motion moves T by `twist`; under a wrench F at T it carries twistᵀF. Laws that
/// jump are in series with those of the spring.
struct ElasticFreedom {
  Vector6 twist;
  Spring spring;
  std::string part;
  std::vector<SteppedLaw> stepped;
  bool rotation = false;
};

/// Conditions other than the load: errata, temperature, phases of the laws that jump.
struct ChainConditions {
  ChainConditions(AsPrinted p = {}) : printed(std::move(p)) {}
  AsPrinted printed;
  double warmer = 0;        ///< K
  std::vector<Step> steps;  ///< by SteppedLaw::number; empty: each phase follows from the force alone
};

/// Compliance at T of a linear part: a flexible member (21), a joint of given 6×6 stiffness, J K⁻¹Jᵀ.
struct FlexiblePart {
  Matrix6 C;
  std::string part;
};

/// Displacement under a wrench and its derivative there.
struct ChainResponse {
  Vector6 d = Vector6::Zero();
  Flexibility tangent;
  bool converged = true;  ///< whether all inner groups converged
};

struct Group;

/// Parts in series from a near end to a far one. A wrench F = N λ at T that the passive joints can carry (N spans the
/// wrenches with J_qᵀF = 0) moves the far end relative to the near one, at T, by
///   d = misfit + C F + Σ twist_j δ_j(twist_jᵀF) + Σ d_g(F) + J_q θ, θ arbitrary,
/// with d_g from the groups among the parts. A temperature rise lengthens a member by α ΔT L at any load and moves T
/// along the member: d grows by expansion · ΔT.
struct Chain {
  std::string name;
  double length = 1;  ///< m: weighs moments against forces
  Vector6 misfit = Vector6::Zero();
  std::vector<FlexiblePart> members;
  std::vector<ElasticFreedom> freedoms;
  std::vector<Group> groups;
  Vector6 expansion = Vector6::Zero();  ///< of the members, per kelvin
  Matrix6 C = Matrix6::Zero();          ///< sum of the members'
  Matrix6X roots = Matrix6X(6, 0);      ///< of C (flexibility.h), member by member
  bool rooted = true;                   ///< no member's C is taken as printed
  Matrix6X J_q = Matrix6X(6, 0);        ///< twists at T of the passive joints, released or not
  Matrix6X N = Matrix6X(6, 0);          ///< wrenches carried; all six where passive joints are not released

  /// Displacement under F without J_q θ, and its tangent. In the tangent forces below `least` (N, Nm) count as `least`,
  /// so that unloaded contacts have a finite compliance. With least = 0 they count as free, as do released steps.
  ChainResponse respond(const Vector6& F, double least, const ChainConditions&) const;
  /// `converged` is set to false where an inner group did not converge.
  Vector6 deflection(const Vector6& F, const ChainConditions&, bool* converged = nullptr) const;
  /// Motions θ of the passive joints, as the columns of J_q, when the far end moves by t relative to the near one under
  /// F: J_q θ = t − d, the least ones.
  VectorX passive_motions(const Vector6& F, const Vector6& t, const ChainConditions&) const;
  /// Tangent stiffness K_c. Contacts without load have no stiffness. Throws ModelError where it is infinite.
  Matrix6 stiffness(const Vector6& F, const ChainConditions&) const;
  Resistance resistance(const Vector6& F, const ChainConditions&) const;
  /// Whether no law's stiffness depends on its load.
  bool linear() const;
  /// The same where laws that jump are held in the steps of the conditions, none of them released.
  bool straight(const ChainConditions&) const;
  bool fits() const;  ///< whether neither the chain nor a branch of it has a misfit
  /// Adds the strain energy of each part, J.
  void add_energies(const Vector6& F, const ChainConditions&, std::map<std::string, double>&) const;
  /// Turns smooth nonlinear laws into steps too, so that the rest of the chain is linear.
  void bent_laws_to_steps();
  /// Appends its laws that jump, and those of its groups, to the list, and numbers them by their index there.
  void number_steps(std::vector<SteppedLaw>&);
  bool has_steps() const;
  /// Adds the forces in these laws under F, by number.
  void add_step_forces(const Vector6& F, const ChainConditions&, VectorX&) const;
};

/// Chains side by side between two rigid bodies. Equilibrium under F: Σ F_i = F, with F_i = N_i λ_i and N_iᵀ(t −
/// d_i(F_i)) = 0. Chains that are rigid against what they carry constrain t. Where rigid chains make their forces
/// statically indeterminate, the smallest forces are taken.
struct Group {
  std::string name;
  double length = 1;
  std::vector<Chain> branches;
  Matrix6X J = Matrix6X(6, 0);  ///< twists at T that not all branches together resist
  Matrix6X R = Matrix6X(6, 0);  ///< the other twists: a basis together with J, orthonormal with rotations weighed by
                                ///< length
  /// Factors of Rᵀ[N_1 N_2 …], where the branches' forces follow from statics alone.
  std::optional<Eigen::PartialPivLU<MatrixX>> determinate;

  struct State {
    Vector6 t = Vector6::Zero();    ///< displacement of the far body relative to the near one, without a component
                                    ///< along J
    std::vector<Vector6> wrenches;  ///< on each branch
    bool converged = false;
    int iterations = 0;
    double misfit = 0;  ///< largest gap between branches' ends and the body, relative to t
  };

  /// Newton's method in the branches' forces. F must be a wrench that the branches together carry, JᵀF = 0. Throws
  /// ModelError where rigid branches cannot be assembled.
  State solve(const Vector6& F, const ChainConditions&) const;
  std::optional<State> solve_by_statics(const Vector6& F, const ChainConditions&) const;
  /// Tangent flexibility in a state; `least` as for a chain.
  Flexibility flexibility(const std::vector<Vector6>& wrenches, double least, const ChainConditions&) const;
  /// Tangent stiffness Σ K_c. Throws ModelError with the name of a rigid branch.
  Matrix6 stiffness(const std::vector<Vector6>& wrenches, const ChainConditions&) const;
  Resistance resistance(const std::vector<Vector6>& wrenches, const ChainConditions&) const;
  bool linear() const;  ///< of every branch
  bool fits() const;

 private:
  struct Straight;
  std::shared_ptr<const Straight> factorised(const ChainConditions&) const;
  struct NewtonStep {
    Vector6 moved;              ///< the far body
    std::vector<Vector6> more;  ///< on each branch
    double held;                ///< what free deflections would bring, were the far body to stay
  };
  /// `size`: of forces, against which contradictions of rigid branches count; grows.
  NewtonStep newton_step(const Vector6& F, const State&, double least, const ChainConditions&, const Straight* known,
                         double& size) const;
  double share_of_step(const std::vector<Vector6>& from, const std::vector<Vector6>& step, double least,
                       const ChainConditions&) const;
  void settle(State&, double least, const ChainConditions&, const Straight*) const;

  mutable std::shared_ptr<const Straight> straight_ = {};  ///< the last one: a group is used by one thread at a time
};

/// The chain of a leg, referred to the point p_W (T, unless (46) is taken as printed).
Chain chain_of(const PlacedLeg&, const Vector3& p_W, double length, const AsPrinted& = {});
Group group_of(const std::string& name, std::vector<Chain>, double length);
/// The legs of a mechanism.
Group legs_of(const Configuration&, const AsPrinted& = {});

/// Twist at p_W by a unit motion in freedom i (tx … rz) of a joint.
Vector6 freedom_twist(const PlacedJoint&, std::size_t i, const Vector3& p_W);

}  // namespace deflect::analytic
