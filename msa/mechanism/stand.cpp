#include "msa/mechanism/stand.h"

namespace deflect {

Pose pose_from(const Vector6& v) {
  const Vector3 angle = v.tail<3>() * pi / 180;
  return {v.head<3>() / 1e3, rotation_from_rpy(angle(0), angle(1), angle(2))};
}

Vector6 mm_deg_from(const Pose& pose) {
  Vector6 v;
  v << 1e3 * pose.p_WT, rpy_from_rotation(pose.R_WT) * 180 / pi;
  return v;
}

Stand stand(const Mechanism& m, const Vector6& pose_mm_deg) {
  return {pose_mm_deg, configure(m, pose_from(pose_mm_deg))};
}

}  // namespace deflect
