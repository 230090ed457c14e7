// The frame solver for one device at many poses and loads: legs condensed to the platform once per pose
// (condensed_leg.h), whose stiffnesses add up; nothing is allocated from pose to pose. Springs with load-dependent
// stiffness are linearised about their forces until these converge, without walking along the legs again.
#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "msa/frame/mechanism/condensed_leg.h"

namespace deflect::frame {

class MsaSweep {
 public:
  /// For configurations of this device: all must have the same parts, freedoms and laws.
  explicit MsaSweep(const Configuration&, const MemberDivision& = {});

  /// False where the device needs MsaModel: legs to which CondensedLeg does not apply, a base or tool that moves or
  /// yields.
  bool applies() const { return applies_; }

  /// Moves to another pose, for any number of solve(). The configuration need not outlive the call.
  void at(const Configuration&);

  /// Response at this pose to the wrench F at T and the weight, base axes, SI: displacement [δ; θ] of T and tangent
  /// stiffness. Without any load nothing moves, and contacts that carry nothing have no stiffness. Returns false,
  /// without a result, where nothing holds T in some direction, where under load a contact carries nothing, where the
  /// springs' forces do not converge, or where a member is so much stiffer than the whole (10⁵ times) that condensation
  /// would lose digits (relative.h avoids this).
  bool solve(const Vector6& F_T_W);

  const Vector6& displacement() const { return displacement_; }
  const Matrix6& stiffness() const { return stiffness_; }
  bool linear() const { return linear_; }  ///< no spring's stiffness depends on its load
  /// Of the last solve(): stiffness of a leg; wrench of the ground on the legs, about T; stored energy, J.
  const Matrix6& leg_stiffness(std::size_t leg) const { return legs_[leg].stiffness(); }
  const Vector6& reaction() const { return reaction_; }
  double energy() const { return energy_; }
  /// Twists at T of a leg's passive joints (columns).
  void find_passive_twists(const Configuration&, std::size_t leg, Matrix6X& out) const;
  int iterations() const { return iterations_; }  ///< of the last solve; 1 where all springs are linear

 private:
  bool assemble();
  Vector6 moved_by(Vector6 F) const;
  bool rest();
  bool linearise_about(double force);
  bool iterate(const Vector6& F);
  double settle();

  bool applies_ = true, linear_ = true, held_ = false;
  int iterations_ = 0;
  std::vector<CondensedLeg> legs_;
  Vector3 weight_ = Vector3::Zero();
  double size_ = 0;
  // Of the stiffness, rotations weighed by the size. Factorised at once: Eigen leaves info() uninitialised before.
  Eigen::LLT<Matrix6> factor_{Matrix6::Identity()};
  Vector6 displacement_ = Vector6::Zero(), reaction_ = Vector6::Zero();
  Matrix6 stiffness_ = Matrix6::Zero();
  double energy_ = 0;
};

}  // namespace deflect::frame
