// Both theories at pose after pose, every answer checked as in at_pose.h: condensed where the device allows it
// (pose_sweep.h, msa_sweep.h), else anew at each pose.
#pragma once

#include <optional>

#include "analytic/pose_sweep.h"
#include "msa/frame/mechanism/msa_sweep.h"
#include "validation/theories/at_pose.h"

namespace deflect {

class SweptTheories {
 public:
  explicit SweptTheories(const Mechanism&);  ///< must outlive it

  /// Moves on; throws as configure().
  const Configuration& at(const Pose&);

  /// Answers there; energies by part are left empty where the device was condensed. Throws as AnalyticAtPose and
  /// MsaAtPose, members one element each.
  Answer analytic(const Vector6& F_T_W);
  Answer msa(const Vector6& F_T_W);

  /// How far the two answers there may be apart (agreement.h).
  double bound() const;

 private:
  std::string where() const;
  template <class Sweep>
  Answer checked(const Sweep&, std::vector<LegStiffness>&, const Vector6& F, const Vector6& reaction,
                 const char* theory) const;

  const Mechanism* mechanism_;
  Posing posing_;
  const Configuration* configuration_ = nullptr;
  std::optional<analytic::PoseSweep> analytic_sweep_;
  std::optional<frame::MsaSweep> msa_sweep_;
  bool analytic_is_there_ = false, msa_is_there_ = false;  // sweeps move on where they are first asked at a pose
  std::vector<LegStiffness> analytic_legs_, msa_legs_;     // passive twists of the pose
  std::optional<AnalyticAtPose> analytic_;                 // made where the sweep does not reach
  std::optional<MsaAtPose> msa_;
};

}  // namespace deflect
