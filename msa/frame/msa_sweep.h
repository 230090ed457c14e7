// The frame solver for one device at many poses: legs condensed to the platform, nothing allocated from pose to pose.
//
// A leg is walked from the ground to the platform. What lies behind a node pulls it with K d + p (static condensation,
// R. J. Guyan, AIAA Journal 3 (1965) 380, exact in statics). Over one more beam element from a to b
//   M = k_aa + K_a,   K_b = k_bb − k_ba M⁻¹ k_ab,   p_b = −k_ba M⁻¹ p_a,
// and over a freedom of a joint with the unit motion t and the spring s + k θ (k = s = 0 where it is free)
//   u = K t,   a = tᵀu + k,   K' = K − u uᵀ/a,   p' = p − u (tᵀp − s)/a,   θ = (uᵀd' + tᵀp − s)/a,   d = d' − t θ.
// Before the first member the node moves by Φ θ only, Φ the motions of the joints so far, and
//   A = Φᵀk_aa Φ + diag k,   K_b = k_bb − k_ba Φ A⁻¹ Φᵀk_ab,   p_b = −k_ba Φ A⁻¹ s,   θ = −A⁻¹(Φᵀk_ab d_b + s).
// The legs' K add up to that of the tool. Springs whose stiffness depends on their load are linearised about their
// forces until these stay.
#pragma once

#include <vector>

#include "msa/frame/build.h"

namespace deflect::frame {

class MsaSweep {
 public:
  /// For configurations of this device: of the same parts, freedoms and laws.
  explicit MsaSweep(const Configuration&, const MemberDivision& = {});

  /// False where the device has what a sweep leaves to MsaModel: parts in parallel within a leg, legs without a
  /// member, springs that jump or belong to the pose (a cable as long as the actuator), joints of given 6×6 stiffness,
  /// legs beside, misfits, base or tool that move or yield.
  bool applies() const { return applies_; }

  /// Response to the wrench F at T and the weight, base axes, SI: displacement [δ; θ] of T and the tangent stiffness.
  /// False, and no result, where nothing holds T in some direction, a contact carries nothing, the springs' forces do
  /// not settle, or a member is so stiff beside the whole (10⁵ times) that condensation would lose digits (relative.h
  /// keeps them).
  bool solve(const Configuration&, const Vector6& F_T_W);

  const Vector6& displacement() const { return displacement_; }
  const Matrix6& stiffness() const { return stiffness_; }
  bool linear() const { return linear_; }  ///< no spring's stiffness depends on its load
  /// Of the last solve(): a leg's stiffness; the wrench of the ground on the legs, about T; the stored energy, J.
  const Matrix6& leg_stiffness(std::size_t leg) const { return legs_[leg].end.K; }
  const Vector6& reaction() const { return reaction_; }
  double energy() const { return energy_; }
  /// Twists at T of a leg's passive joints (columns).
  Matrix6X passive_twists(const Configuration&, std::size_t leg) const;
  int iterations() const { return iterations_; }  ///< of the last solve; 1 where all springs are linear

 private:
  static constexpr int most_motions = 12;
  using Motions = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, most_motions>;
  using Angles = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_motions, 1>;
  using AnglesBy6 = Eigen::Matrix<double, Eigen::Dynamic, 6, 0, most_motions, 6>;

  /// How what lies behind pulls a node at `at`, base axes.
  struct Pull {
    Vector3 at = Vector3::Zero();
    Matrix6 K = Matrix6::Zero();
    Vector6 p = Vector6::Zero();
  };
  struct Spring {
    SpringLaw law;
    double k = 0, s = 0, force = 0, elongation = 0;
  };
  struct Freedom {
    std::size_t index;  // tx … rz
    int spring;         // of springs_; −1: free
    Vector6 t, u;
    double a = 0, pull = 0;  // tᵀp − s; a = 0: an idle freedom, which stays
  };
  struct Element {
    double share;  // of the member's length
    Matrix6 back;  // d_a = back d_b + shift, member axes
    Vector6 shift;
  };
  struct Step {
    std::size_t part;               // of the leg
    std::vector<Element> elements;  // of a member
    std::vector<Freedom> freedoms;  // of a joint
    Pull before;
  };
  struct Leg {
    std::vector<Step> steps;
    std::size_t first_member = 0, first_nonlinear = 0;
    Pull end;
    // Before the first member: θ = theta_back d_b + theta_shift, d_b of its first element.
    AnglesBy6 theta_back;
    Angles theta_shift;
  };

  bool condense(Leg&, const PlacedLeg&, const Vector3& p_WT, std::size_t from);
  bool start(Leg&, const PlacedMember&, const Matrix12& element, Element&, Matrix6& K, Vector6& p);
  template <class OfElement>
  void follow(Leg&, const PlacedLeg&, const Vector3& p_WT, const OfElement&);
  void follow_springs(const Configuration&);
  void conclude(const Configuration&);
  double settle();

  bool applies_ = true, linear_ = true;
  int iterations_ = 0;
  std::vector<Leg> legs_;
  std::vector<Spring> springs_;
  double energy_ = 0, stiffest_ = 0;  // of elements, N/m
  Vector6 displacement_ = Vector6::Zero(), reaction_ = Vector6::Zero();
  Matrix6 stiffness_ = Matrix6::Zero();
};

}  // namespace deflect::frame
