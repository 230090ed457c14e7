// Chains of virtual joints: rigid links between virtual freedoms, which yield by the laws of what they stand for. The
// loaded mechanism after A. Pashkevich, A. Klimchik, D. Chablat, Enhanced stiffness modeling of manipulators with
// passive joints, Mech. Mach. Theory 46 (2011) 662, with members and groups that have laws of their own.
//
// A chain is the product of the motions of its steps, each in the axes of what stands before it:
//   joint    tx ty tz, then Rx Ry Rz about its point, as far as they are free or elastic;
//   member   its tip moves by [u; φ], by its law (beam_column.h); a bent one is several of them in series;
//   group    its far body moves by [u; φ], by the law of its branches, which are chains.
// With J the twists at its end E of unit motions of the freedoms x and H the second derivative of the work of its end
// wrench F = [f; m] by them, of freedom i before j and between rotations of one tip
//   H_ij = f·(ω_i × v_j) + ½ m·(ω_i × ω_j),   H_ij = ½ f·(ω_i × v_j + ω_j × v_i),
// equilibrium and the end's displacement t, linearised, are
//   JᵀF + H δ = s + K δ,   J δ = t + c,
// s + K δ being the laws' forces (0 of passive freedoms) and c what the chain's end lacks. So δ and F follow from t:
//   F = F_0 + K_c t + B μ,   Bᵀt = b.
// B are the wrenches that nothing in the chain yields to; K_c is symmetric.
//
// Forces and moments are dead: constant in the axes of the start. A dead moment is conjugate to the spin of the end and
// has no potential; H belongs to one that is conjugate to a rotation vector counted from the state, which differs by
// −½[m]× in the stiffness by spins (added where Newton's method needs it). Where no outer moment acts those add up to
// 0.
//
// Passive motions that move nothing but what lies between them, along one screw (a rod between ball joints spins) have
// neither stiffness nor use; they are held.
//
// Second order: J and H in the undeformed shape, H δ → H (x + δ), members under the axial force of the state. As in the
// theory of beam-columns, the stretch of a member makes no lever longer: H has no entries of it.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "analytic/deflection.h"
#include "analytic/rotation_vector.h"
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

/// Motion of a body's point p against what stands before it, in axes A.
struct Tip {
  Vector3 p = Vector3::Zero();
  Matrix3 A = Matrix3::Identity();
  Vector6 x = Vector6::Zero();  ///< [u; φ]; second order adds up increments
  Matrix3 D = Matrix3::Zero();  ///< exp([φ]×) − I

  RigidMotion motion() const;
  void move(const Vector6& increment, Geometry);  ///< [δ; ψ]
};

/// Conditions under which a shape is linearised.
struct ShapeConditions {
  Geometry geometry = Geometry::finite;
  double least = 0;     ///< N, Nm: forces below count as this in the compliance of contacts
  double misfit = 1;    ///< share of the misfits that is in place
  bool judged = false;  ///< whether the state is stable is asked for
};

/// How a body is held, linearised about the state: F = F0 + K t + B μ where Bᵀt = b, t = [δ; ψ] its further motion.
struct Restraint {
  Matrix6 K = Matrix6::Zero();  ///< symmetric
  Vector6 F0 = Vector6::Zero();
  Matrix6X B = Matrix6X(6, 0);
  VectorX b = VectorX(0);
  Vector3 m = Vector3::Zero();  ///< moment of the state: by spins the stiffness is K − ½[m]×
  bool stable = true;           ///< while the body is held still; known where the conditions ask for it
};

/// How far freedoms have moved, and in the last step; the largest of them, rotations times length (m).
struct Progress {
  double reach = 0, step = 0;

  void add(const Progress& p) { reach = std::max(reach, p.reach), step = std::max(step, p.step); }
};

struct VirtualJoint {
  PlacedJoint joint;
  std::vector<std::size_t> freedoms;  ///< those that move
  std::array<double, 6> x{};
};

struct VirtualMember {
  PlacedMember member;
  Tip tip;
  std::size_t number = 0;  ///< of the member that this is (a piece of), in the order of for_each_part
};

struct VirtualChain;

/// Branches side by side from a common start to a body that moves by tip.x; T of the mechanism for its legs.
struct VirtualGroup {
  std::string part;
  Tip tip;
  std::vector<VirtualChain> branches;
  /// About the state as it is, the branches' too, where no condition changes but whether it is judged.
  std::optional<Restraint> known = {};

  Restraint restrain(const ShapeConditions&);
  /// The body moves further by t under the wrench F.
  Progress follow(const Vector6& t, const Vector6& F, const ShapeConditions&);
};

using VirtualStep = std::variant<VirtualJoint, VirtualMember, VirtualGroup>;

/// Forces and motions of the freedoms x of a chain, linearised about the state.
struct Linearised {
  Matrix6X J;
  MatrixX H, K;
  VectorX s, x;
  VectorX turned;   ///< second order: what H of the state, H x, adds to JᵀF; taken off s
  MatrixX Z;        ///< δ = offset + Z z: motions that rigid branches of groups allow
  bool all = true;  ///< Z = 1, offset = 0
  VectorX offset;
  std::vector<bool> kept;  ///< of z: not to be eliminated, passive freedoms and groups
  VectorX scale;           ///< of z: 1/length of rotations
  RigidMotion end;
  bool stable = true;  ///< of groups and members within
};

struct VirtualChain {
  std::string name;
  double length = 1;  ///< m: moments weigh against forces by it
  std::vector<VirtualStep> steps;
  Vector3 p_E = Vector3::Zero();     ///< the end, before any motion
  Vector6 misfit = Vector6::Zero();  ///< at p_E
  Vector6 F = Vector6::Zero();       ///< on the end about the end, in the axes of the start

  /// About the state under F.
  Linearised linearise(const ShapeConditions&);
  /// The freedoms move by δ; groups by the wrenches JᵀF + H δ that then pass through them.
  Progress advance(const Linearised&, const VectorX& delta, const ShapeConditions&);

  /// For an end that is held by another body, at `end`; then that body moves further by t under a wrench that B μ
  /// completes, and freedoms and F follow.
  Restraint restrain(const Tip& end, const ShapeConditions&);
  Progress follow(const Vector6& t, const VectorX& mu, const ShapeConditions&);

  const Restraint& restraint() const { return restraint_; }  ///< as last asked for
  /// Adds the strain energy of each part in an equilibrium, J.
  void add_energies(const ShapeConditions&, std::map<std::string, double>&) const;
  /// Axes of the start as the steps before `step` have turned them.
  Matrix3 axes_before(std::size_t step, Geometry) const;

 private:
  Linearised held_;
  Restraint restraint_;
  Vector6 lack_;      // c
  MatrixX response_;  // z by [t + c; 1]
};

/// How many equal pieces in series stand for each member, in the order of for_each_part; one where that ends.
struct Pieces {
  std::vector<int> of;
  std::size_t next = 0;  ///< member that virtual_chain_of will come to
};

/// The chain of a leg whose end is the point p_E, misfits given at p_W. Axes: those of the configuration.
VirtualChain virtual_chain_of(const PlacedLeg&, const Vector3& p_E, const Vector3& p_WT, double length, Pieces&);

/// Puts a chain into the state of one whose members are in fewer pieces: each piece of that is bent as evenly as its
/// ends allow.
void take_state(VirtualChain&, const VirtualChain& coarser);

}  // namespace deflect::analytic
