// A mechanism in closed form: compliances in series (2), (45), chains in parallel (1), (46), passive joints released;
// each may hold the other. Everything is referred to one point T, in base axes; what carries a wrench carries it as a
// whole, so that forces are what a chain is asked with. Equation numbers are those of Ahmad, Andersson, Sellgren.
#pragma once

#include <Eigen/LU>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analytic/deflection.h"
#include "analytic/flexibility.h"
#include "analytic/steps.h"
#include "msa/mechanism/configuration.h"

namespace deflect::analytic {

/// A freedom that yields by its laws: unit relative motion moves T by `twist`; under a wrench F at T it carries
/// twistᵀF. Laws that jump stand in series with those of the spring.
struct ElasticFreedom {
  Vector6 twist;
  Spring spring;
  std::string part;
  std::vector<SteppedLaw> stepped;
  bool rotation = false;
};

/// Conditions under which a chain moves, other than its load: errata, warmth, phases of its laws that jump.
struct ChainConditions {
  ChainConditions(AsPrinted p = {}) : printed(std::move(p)) {}
  AsPrinted printed;
  double warmer = 0;        ///< K
  std::vector<Step> steps;  ///< by SteppedLaw::number; none: each as its force alone says
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
  bool converged = true;  ///< of the groups within
};

struct Group;

/// Parts in series from a near end to a far one. A wrench F = N λ at T that the passive joints can carry (N spans the
/// wrenches with J_qᵀF = 0) moves the far end against the near one, at T, by
///   d = misfit + C F + Σ twist_j δ_j(twist_jᵀF) + Σ d_g(F) + J_q θ, θ arbitrary,
/// d_g of the groups among the parts. A member that is warmer lengthens by α ΔT L whatever it carries, which moves T
/// along the member: d grows by expansion · ΔT.
struct Chain {
  std::string name;
  double length = 1;  ///< m: moments weigh against forces by it
  Vector6 misfit = Vector6::Zero();
  std::vector<FlexiblePart> members;
  std::vector<ElasticFreedom> freedoms;
  std::vector<Group> groups;
  Vector6 expansion = Vector6::Zero();  ///< of the members, per kelvin
  Matrix6 C = Matrix6::Zero();          ///< sum of the members'
  Matrix6X roots = Matrix6X(6, 0);      ///< of C (flexibility.h), each member's behind the other
  bool rooted = true;                   ///< no member's C is as printed
  Matrix6X J_q = Matrix6X(6, 0);        ///< twists at T of the passive joints, whether released or not
  Matrix6X N = Matrix6X(6, 0);          ///< wrenches carried; all of them where passive joints are not released

  /// Motion under F but for J_q θ; the tangent's compliance takes a force below `least` (N, Nm) for `least`, so that
  /// unloaded contacts stay finite; with least = 0 they let go, and so do released steps.
  ChainResponse respond(const Vector6& F, double least, const ChainConditions&) const;
  Vector6 deflection(const Vector6& F, const ChainConditions&) const;
  /// Tangent stiffness K_c. Contacts without load do not resist. Throws ModelError where it is infinite.
  Matrix6 stiffness(const Vector6& F, const ChainConditions&) const;
  Resistance resistance(const Vector6& F, const ChainConditions&) const;
  /// No law's stiffness depends on its load.
  bool linear() const;
  bool fits() const;  ///< neither the chain nor a branch of it has a misfit
  /// Adds the strain energy of each part, J.
  void add_energies(const Vector6& F, const ChainConditions&, std::map<std::string, double>&) const;
  /// Laws that bend become steps too, so that what is left between the steps is linear.
  void bent_laws_to_steps();
  /// Adds its laws that jump, and those of its groups, to the list and numbers them by it.
  void number_steps(std::vector<SteppedLaw>&);
  bool has_steps() const;
  /// Their forces under F.
  void add_step_forces(const Vector6& F, const ChainConditions&, VectorX&) const;
};

/// Chains side by side between two rigid bodies. Equilibrium under F: Σ F_i = F, with F_i = N_i λ_i and
/// N_iᵀ(t − d_i(F_i)) = 0. Chains that are rigid against what they carry are constraints on t; where several of them
/// leave their forces open, the smallest are taken.
struct Group {
  std::string name;
  double length = 1;
  std::vector<Chain> branches;
  Matrix6X J = Matrix6X(6, 0);  ///< twists at T that no branch resists
  Matrix6X R = Matrix6X(6, 0);  ///< the other twists: with J a basis, orthonormal with rotations weighed by length
  /// Of Rᵀ[N_1 N_2 …], where the branches' forces follow from statics alone.
  std::optional<Eigen::PartialPivLU<MatrixX>> determinate;

  struct State {
    Vector6 t = Vector6::Zero();    ///< displacement of the far body against the near one, none of it along J
    std::vector<Vector6> wrenches;  ///< on each branch
    bool converged = false;
    int iterations = 0;
    double misfit = 0;  ///< how far branches' ends and the body disagree, relative to t
  };

  /// Newton on the branches' forces. F is one that the branches together carry, JᵀF = 0. Throws ModelError where rigid
  /// branches cannot be assembled.
  State solve(const Vector6& F, const ChainConditions&) const;
  std::optional<State> solve_by_statics(const Vector6& F, const ChainConditions&) const;
  /// Tangent in a state; `least` as for a chain.
  Flexibility flexibility(const std::vector<Vector6>& wrenches, double least, const ChainConditions&) const;
  /// Σ K_c. Throws ModelError naming the branch that is rigid.
  Matrix6 stiffness(const std::vector<Vector6>& wrenches, const ChainConditions&) const;
  Resistance resistance(const std::vector<Vector6>& wrenches, const ChainConditions&) const;
  bool linear() const;  ///< of every branch
  bool fits() const;

 private:
  void settle(State&, double least, const ChainConditions&) const;
};

/// The chain of a leg, referred to the point p_W (T, unless (46) is taken as printed).
Chain chain_of(const PlacedLeg&, const Vector3& p_W, double length, const AsPrinted& = {});
Group group_of(const std::string& name, std::vector<Chain>, double length);
/// The legs of a mechanism.
Group legs_of(const Configuration&, const AsPrinted& = {});

/// Twist at p_W of a unit motion in freedom i (tx … rz) of a joint.
Vector6 freedom_twist(const PlacedJoint&, std::size_t i, const Vector3& p_W);

}  // namespace deflect::analytic
