// A leg condensed to the platform's twist and the elongations θ of its springs with load-dependent stiffness (static
// condensation, R. J. Guyan, AIAA Journal 3 (1965) 380, exact in statics).
//
// The walk starts at the ground. The part of the leg between the ground and a node that moves by d stores the energy
// ½dᵀK d + dᵀG θ + ½θᵀA θ: the forces on it are K d + G θ at the node and Gᵀd + A θ at the springs (SI, base axes; K
// 6×6, G 6×n, A n×n). One more member with the ends a, b and the stiffness k gives
//   d_a = −M⁻¹(k_ab d_b + G θ),   M = k_aa + K,   K' = −XᵀK M⁻¹k_ab,   G' = −k_ba M⁻¹G,   A' = A − GᵀM⁻¹G,
// with X the rigid motion of a with b. This K' is the series combination; k_bb − k_ba M⁻¹k_ab is equal, but a
// difference of larger numbers, and used only where only joints lie before.
// A freedom q of a joint with the unit motion t gives d = d' − t q; let u = K t and g = Gᵀt. A kept one
//   adds to G the column −u, to A the row and the column −g and the diagonal tᵀu;
// one of constant stiffness c (0 where it is free) is eliminated,
//   q = (uᵀd' + gᵀθ)/a,   a = tᵀu + c,   K' = K − u uᵀ/a,   G' = G − u gᵀ/a,   A' = A − g gᵀ/a.
// At the start of the first member d_a = Φ q, with Φ the motions of the joints before it; those not kept are eliminated
// together. At the platform, springs with the force s + κ θ change the leg by a matrix whose rank is their number
// (Woodbury's formula):
//   B = (A + diag κ)⁻¹,   θ = −B(Gᵀd + s),   wrench on the platform (K − G B Gᵀ) d − G B s.
#pragma once

#include <optional>
#include <vector>

#include "msa/frame/elements/condensed_member.h"
#include "msa/frame/mechanism/build.h"

namespace deflect::frame {

class CondensedLeg {
 public:
  /// All legs given later must have the same parts, freedoms and laws.
  CondensedLeg(const PlacedLeg&, const MemberDivision&);

  /// False where the leg has parts in parallel or no member, more than twelve freedoms before its first member or
  /// springs of load-dependent stiffness, springs that jump or depend on the pose (a cable as long as the actuator),
  /// joints of given 6×6 stiffness, a misfit, or where it is a joint beside the legs.
  bool applies() const { return applies_; }

  /// A spring of load-dependent stiffness. linearise() needs k and s; stretch() computes elongation and force.
  struct Spring {
    SpringLaw law;
    double k = 0, s = 0, elongation = 0, force = 0;
  };
  std::vector<Spring>& springs() { return springs_; }

  /// Condenses the leg at a pose; the placed leg need not outlive the call. Returns false where a part of it is not
  /// held.
  bool condense(const PlacedLeg&, const Vector3& p_WT);
  double stiffest() const { return stiffest_; }  ///< of its elements along or across, N/m

  /// Takes in the springs with their present k and s. Returns false where one is not held, or where k is not finite and
  /// at least 0. Not needed for a leg without springs. A spring of no stiffness is a free joint: K is exactly 0 where
  /// only rounding is left of it.
  bool linearise();
  const Matrix6& stiffness() const { return held_.K; }
  const Vector6& pull() const { return p_; }  ///< force on the platform at zero displacement
  void stretch(const Vector6& d);             ///< updates the springs for the displacement d of T

  struct LegForces {
    Vector6 reaction = Vector6::Zero();  ///< wrench of the ground on the leg, about T
    double energy = 0;
  };
  /// Reaction and energy computed from members and springs, from the platform back to the ground, for the d of the last
  /// stretch().
  LegForces follow(const Vector6& d) const;

  /// Twists at T of the leg's passive joints (columns).
  void find_passive_twists(const PlacedLeg&, const Vector3& p_WT, Matrix6X& out) const;

 private:
  static constexpr int most = 12;
  using Motions = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, most>;
  using Angles = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most, 1>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, most>;

  /// The part of the leg between the ground and a node at `at`; G and A are zero for springs after it.
  struct Behind {
    Vector3 at = Vector3::Zero();
    Matrix6 K = Matrix6::Zero();
    Motions G;
    Square A;
  };
  struct Freedom {
    std::size_t index;  // tx … rz
    Eigen::Index kept;  // index among the kept springs; −1: not kept
    double k = 0;       // stiffness of one that is not kept; 0: free
    Vector6 t = Vector6::Zero(), u = Vector6::Zero();
    Angles g = {};
    double a = 0;  // 0: an idle freedom, which does not move
  };
  struct Member {
    CondensedMember condensed;
    Vector3 p_W_start = Vector3::Zero(), p_W_end = Vector3::Zero();
    Matrix3 R_WM = Matrix3::Zero();
    Matrix6 back = Matrix6::Zero();  // d_a = back d_b + back_springs θ, member axes
    Motions back_springs = {};
  };
  struct Step {
    std::size_t part;
    std::optional<Member> member;
    std::vector<Freedom> freedoms;  // of a joint
    Vector3 at = Vector3::Zero();   // what they are referred to
  };

  void add_freedoms(Step&, const PlacedJoint&);
  bool pass(Member&, Behind&, bool first) const;
  bool start(Member&, Motions& G) const;
  static void pass(Freedom&, Behind&);

  bool applies_ = true;
  std::vector<Step> steps_;
  std::size_t first_member_ = 0;
  std::vector<Spring> springs_;
  Vector3 p_WT_ = Vector3::Zero();
  double stiffest_ = 0;
  Behind end_, held_;  // before and after the springs, linearised, have gone one by one
  Angles s_, theta_;
  Vector6 p_ = Vector6::Zero();
};

}  // namespace deflect::frame
