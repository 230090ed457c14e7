// Chains of virtual joints: rigid links connected by virtual freedoms, which yield by the laws of the parts that they
// represent. The loaded mechanism follows A. Pashkevich, A. Klimchik, D. Chablat, Enhanced stiffness modeling of
// manipulators with passive joints, Mech. Mach. Theory 46 (2011) 662, extended by members and groups with laws of their
// own.
//
// The motion of a chain is the product of the motions of its steps, each in the axes of the step before it:
//   joint    tx ty tz, then Rx Ry Rz about its point, where free or elastic;
//   member   its tip moves by [u; φ] by its law (beam_column.h); a bent member is several of them in series;
//   group    its far body moves by [u; φ] by the law of its branches, which are chains.
// J are the twists at the chain's end E by unit motions of the freedoms x. H is the second derivative of the work of
// the end wrench F = [f; m] with respect to x; for freedom i before j, and for rotations of one tip,
//   H_ij = f·(ω_i × v_j) + ½ m·(ω_i × ω_j),   H_ij = ½ f·(ω_i × v_j + ω_j × v_i),
// equilibrium and the end's displacement t, linearised, are
//   JᵀF + H δ = s + K δ,   J δ = t + c,
// with the laws' forces s + K δ (0 for passive freedoms) and the gap c at the chain's end. So δ and F follow from t:
//   F = F_0 + K_c t + B μ,   Bᵀt = b.
// B are the wrenches under which nothing in the chain yields; K_c is symmetric.
//
// Forces and moments are dead: constant in the axes of the start. A dead moment is conjugate to the spin of the end and
// has no potential. H is for a moment conjugate to a rotation vector relative to the state; the stiffness with respect
// to spins differs by −½[m]× (added where Newton's method needs it). Without an outer moment these terms add up to 0.
//
// Passive motions along one screw that move only the parts between them (a rod between ball joints spins) have no
// stiffness and no effect; they are held.
//
// Second order: J and H in the undeformed shape, H δ → H (x + δ), members under the axial force of the state. As in
// beam-column theory, the stretch of a member lengthens no lever: H has no entries for it.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "analytic/deflection.h"
#include "analytic/rotation_vector.h"
#include "analytic/steps.h"
#include "msa/base/geometry.h"
#include "msa/mechanism/configuration.h"

namespace deflect::analytic {

/// x ↦ x + D x + p.
struct RigidMotion {
  Matrix3 D = Matrix3::Zero();  ///< R − I
  Vector3 p = Vector3::Zero();

  Matrix3 R() const { return Matrix3::Identity() + D; }
  Vector3 displacement(const Vector3& x) const { return D * x + p; }
  Vector3 operator()(const Vector3& x) const { return x + displacement(x); }
  friend RigidMotion operator*(const RigidMotion& a, const RigidMotion& b) {
    return {combined(a.D, b.D), b.p + a.displacement(b.p)};
  }
};

/// Motion of a body's point p relative to the step before it, in axes A.
struct Tip {
  Vector3 p = Vector3::Zero();
  Matrix3 A = Matrix3::Identity();
  Vector6 x = Vector6::Zero();  ///< [u; φ]; in second order, the sum of increments
  Matrix3 D = Matrix3::Zero();  ///< exp([φ]×) − I

  RigidMotion motion() const;
  void move(const Vector6& increment, Geometry);  ///< [δ; ψ]
};

/// Conditions under which a shape is linearised.
struct ShapeConditions {
  Geometry geometry = Geometry::finite;
  double least = 0;              ///< N, Nm: smaller forces count as this in the compliance of contacts
  double misfit = 1;             ///< share of the misfits that is applied
  bool judged = false;           ///< whether to test the stability of the state
  std::vector<Step> steps = {};  ///< of the laws that are held in steps, by number (hold_laws); none released
};

/// The restraint on a body, linearised about the state: F = F0 + K t + B μ with Bᵀt = b, where t = [δ; ψ] is its
/// further motion.
struct Restraint {
  Matrix6 K = Matrix6::Zero();  ///< symmetric
  Vector6 F0 = Vector6::Zero();
  Matrix6X B = Matrix6X(6, 0);
  VectorX b = VectorX(0);
  Vector3 m = Vector3::Zero();  ///< moment of the state: with respect to spins the stiffness is K − ½[m]×
  bool stable = true;           ///< with the body held fixed; set where ShapeConditions::judged
};

/// The largest motion of a freedom so far, and in the last step; rotations times length (m).
struct Progress {
  double reach = 0, step = 0;

  void add(const Progress& p) { reach = std::max(reach, p.reach), step = std::max(step, p.step); }
};

struct VirtualJoint {
  PlacedJoint joint;
  std::vector<std::size_t> freedoms;  ///< those that move
  std::array<double, 6> x{};
  std::array<std::vector<std::size_t>, 6> held{};  ///< by freedom, the numbers of its laws that are held in steps

  bool elastic(std::size_t i) const { return joint.elastic(i) || !held[i].empty(); }
  /// The deflection of the laws of freedom i under the force f, and their compliance.
  Step deflected(std::size_t i, double f, const ShapeConditions&) const;
  /// The force under which the laws of freedom i are taken for linear: f, that of statics, or, where f and the
  /// deflection are on two sides of the unloaded laws, the one that the laws give to the deflection. |f|ⁿ with n < ½ is
  /// so steep at its origin that Newton's method in f would go from one side to the other and back.
  double tangent_force(std::size_t i, double f, const ShapeConditions&) const;
};

struct VirtualMember {
  PlacedMember member;
  Tip tip;
  std::size_t number = 0;  ///< of the member (or the member divided into this piece), in the order of for_each_part
};

struct VirtualChain;

/// Branches in parallel from a common start to a body that moves by tip.x; for the legs of the mechanism, to T.
struct VirtualGroup {
  std::string part;
  Tip tip;
  std::vector<VirtualChain> branches;
  /// Restraint about the present state of body and branches, if computed already; valid while no condition other than
  /// `judged` changes.
  std::optional<Restraint> known = {};

  Restraint restrain(const ShapeConditions&);
  /// The body moves further by t under the wrench F.
  Progress follow(const Vector6& t, const Vector6& F, const ShapeConditions&);
};

using VirtualStep = std::variant<VirtualJoint, VirtualMember, VirtualGroup>;

/// Forces and motions of a chain's freedoms x, linearised about the state.
struct Linearised {
  Matrix6X J;
  MatrixX H, K;
  VectorX s, x;
  VectorX turned;   ///< second order: H x, which adds to JᵀF and is subtracted from s
  MatrixX Z;        ///< δ = offset + Z z: motions that rigid branches of groups allow
  bool all = true;  ///< Z = 1, offset = 0
  VectorX offset;
  std::vector<bool> kept;  ///< of z: not to be eliminated (passive freedoms and groups)
  VectorX scale;           ///< of z: 1/length of rotations
  RigidMotion end;
  bool stable = true;  ///< of the groups and members within
};

struct VirtualChain {
  std::string name;
  double length = 1;  ///< m: weighs moments against forces
  std::vector<VirtualStep> steps;
  Vector3 p_E = Vector3::Zero();     ///< the end in the undeformed state
  Vector6 misfit = Vector6::Zero();  ///< at p_E
  Vector6 F = Vector6::Zero();       ///< on the end about the end, in the axes of the start

  /// Linearises about the state under F.
  Linearised linearise(const ShapeConditions&);
  /// Moves the freedoms by δ; groups move by the wrenches JᵀF + H δ that then pass through them.
  Progress advance(const Linearised&, const VectorX& delta, const ShapeConditions&);

  /// restrain(): for an end held by another body, at `end`. follow(): that body moves further by t, under a wrench that
  /// B μ completes; freedoms and F follow.
  const Restraint& restrain(const Tip& end, const ShapeConditions&);
  Progress follow(const Vector6& t, const VectorX& mu, const ShapeConditions&);

  const Restraint& restraint() const { return restraint_; }  ///< of the last restrain()
  /// Of the last restrain() that was ShapeConditions::judged: the smallest motion of the end by passive freedoms beside
  /// the largest, rotations weighed by the length; 0 in a singular position, 1 without passive freedoms.
  double mobility() const;
  /// Adds the strain energy of each part in an equilibrium, J.
  void add_energies(const ShapeConditions&, std::map<std::string, double>&) const;
  /// How the steps before `step` move what stands behind them; in second order nothing moves.
  RigidMotion motion_before(std::size_t step, Geometry) const;

 private:
  Linearised held_;
  Restraint restraint_;
  MatrixX passive_;   // motions of the end by passive freedoms, weighed
  Vector6 lack_;      // c
  MatrixX response_;  // z by [t + c; 1]
};

/// The number of equal pieces in series for each member, in the order of for_each_part; one beyond the end of the list.
struct Pieces {
  std::vector<int> of;
  std::size_t next = 0;  ///< index of the next member that virtual_chain_of() will reach
};

/// The chain of a leg whose end is the point p_E, misfits given at p_W. Axes: those of the configuration.
VirtualChain virtual_chain_of(const PlacedLeg&, const Vector3& p_E, const Vector3& p_WT, double length, Pieces&);

/// In the deformed shape a law that is held in the step {o, c} (steps.h) deflects by o + c f, whatever it is. So the
/// shape answers as balance() asks.
///
/// Takes all laws that are not linear out of the joints of a mechanism (Deformed::whole) and numbers them as
/// AnalyticModel does: leg by leg, in each the joints before the groups, then base and tool. Returns their number.
std::size_t hold_laws(VirtualChain& whole);

/// The forces with which these laws resist the motions of the state, by number.
VectorX forces_in_held(const VirtualChain& whole, const ShapeConditions&);

/// Largest force on the chain and on all branches within, moments divided by the length, N.
double largest_wrench(const VirtualChain&);

/// Name of a branch of a group whose passive freedoms are all but in a singular position; empty where there is none.
std::string at_dead_centre(VirtualChain whole, ShapeConditions);

/// Initialises a chain with the state of one whose members have fewer pieces; each coarser piece is taken to be bent as
/// evenly as its ends allow.
void take_state(VirtualChain&, const VirtualChain& coarser);

}  // namespace deflect::analytic
