// A leg condensed to the platform, the elongations θ of its springs of load-dependent stiffness kept beside the
// platform's twist (static condensation, R. J. Guyan, AIAA Journal 3 (1965) 380, exact in statics).
//
// It is walked from the ground. What lies behind a node that moves by d stores ½dᵀK d + dᵀG θ + ½θᵀA θ: K d + G θ pulls
// the node, Gᵀd + A θ the springs (SI, base axes; K 6×6, G 6×n, A n×n). Over one more member of the ends a, b and the
// stiffness k
//   d_a = −M⁻¹(k_ab d_b + G θ),   M = k_aa + K,   K' = −XᵀK M⁻¹k_ab,   G' = −k_ba M⁻¹G,   A' = A − GᵀM⁻¹G,
// X the motion of a with b as one body. K' passes on what pulls a, the two in series; k_bb − k_ba M⁻¹k_ab is the same
// as a difference of larger numbers, taken only where nothing but joints lies behind.
// Over a freedom q of a joint with the unit motion t, behind which d = d' − t q, u = K t and g = Gᵀt: a kept one
//   adds to G the column −u, to A the row and the column −g and the diagonal tᵀu;
// one of constant stiffness c, 0 where it is free, goes,
//   q = (uᵀd' + gᵀθ)/a,   a = tᵀu + c,   K' = K − u uᵀ/a,   G' = G − u gᵀ/a,   A' = A − g gᵀ/a.
// At the start of the first member d_a = Φ q, Φ the motions of the joints before it; those not kept go together. At the
// platform springs that pull with s + κ θ change the leg by as many ranks as they are (Woodbury's formula):
//   B = (A + diag κ)⁻¹,   θ = −B(Gᵀd + s),   wrench on the platform (K − G B Gᵀ) d − G B s.
#pragma once

#include <optional>
#include <vector>

#include "msa/frame/elements/condensed_member.h"
#include "msa/frame/mechanism/build.h"

namespace deflect::frame {

class CondensedLeg {
 public:
  /// For legs of the same parts, freedoms and laws.
  CondensedLeg(const PlacedLeg&, const MemberDivision&);

  /// False where the leg has parts in parallel or no member, more than twelve freedoms before its first member or
  /// springs of load-dependent stiffness, springs that jump or belong to the pose (a cable as long as the actuator),
  /// joints of given 6×6 stiffness, a misfit, or stands beside.
  bool applies() const { return applies_; }

  /// Of load-dependent stiffness. linearise() wants k and s; stretch() finds elongation and force.
  struct Spring {
    SpringLaw law;
    double k = 0, s = 0, elongation = 0, force = 0;
  };
  std::vector<Spring>& springs() { return springs_; }

  /// The walk, at a pose; the placed leg may go afterwards. False, and no leg, where something in it is held by
  /// nothing.
  bool condense(const PlacedLeg&, const Vector3& p_WT);
  double stiffest() const { return stiffest_; }  ///< of its elements along or across, N/m

  /// The springs as they are. False where one is held by nothing. A leg without springs needs it not.
  bool linearise();
  const Matrix6& stiffness() const { return held_.K; }
  const Vector6& pull() const { return p_; }  ///< on the platform at rest
  void stretch(const Vector6& d);             ///< by the displacement of T

  struct LegForces {
    Vector6 reaction = Vector6::Zero();  ///< wrench of the ground on the leg, about T
    double energy = 0;
  };
  /// Of members and springs themselves, from the platform back to the ground, for the d of the last stretch().
  LegForces follow(const Vector6& d) const;

  /// Twists at T of its passive joints (columns).
  Matrix6X passive_twists(const PlacedLeg&, const Vector3& p_WT) const;

 private:
  static constexpr int most = 12;
  using Motions = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, most>;
  using Angles = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most, 1>;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most, most>;

  /// What lies behind a node at `at`; G and A have zeros for springs that lie further on.
  struct Behind {
    Vector3 at = Vector3::Zero();
    Matrix6 K = Matrix6::Zero();
    Motions G;
    Square A;
  };
  struct Freedom {
    std::size_t index;  // tx … rz
    Eigen::Index kept;  // of the springs; −1: none of them
    double k = 0;       // of the others; 0: free
    Vector6 t = Vector6::Zero(), u = Vector6::Zero();
    Angles g = {};
    double a = 0;  // 0: an idle freedom, which stays
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
