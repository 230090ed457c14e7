#include "msa/frame/elements/joint_motion.h"
#include "msa/base/index.h"

#include <cmath>

namespace deflect::frame {
namespace {

Matrix3 symmetric(const Matrix3& A) { return (A + A.transpose()) / 2; }

/// Second derivative of ½ axis·(ω × (ω × arm)) by ω.
Matrix3 centripetal(const Vector3& axis, const Vector3& arm) {
  return symmetric(axis * arm.transpose()) - axis.dot(arm) * Matrix3::Identity();
}

/// `v`: from node a, `arm`: from node b, to the point of body b.
void translation(const Vector3& axis, const Vector3& v, const Vector3& arm, Vector12& gradient, Matrix12& H) {
  gradient << -axis, -v.cross(axis), axis, arm.cross(axis);
  H.setZero();
  H.block<3, 3>(3, 6) = skew(axis);
  H.block<3, 3>(3, 0) = -skew(axis);
  H.block<3, 3>(3, 9) = axis.dot(arm) * Matrix3::Identity() - arm * axis.transpose();
  H.block<3, 3>(6, 3) = H.block<3, 3>(3, 6).transpose();
  H.block<3, 3>(0, 3) = H.block<3, 3>(3, 0).transpose();
  H.block<3, 3>(9, 3) = H.block<3, 3>(3, 9).transpose();
  H.block<3, 3>(3, 3) = centripetal(axis, v);
  H.block<3, 3>(9, 9) = centripetal(axis, arm);
}

/// `g`: the reciprocal axis, P: its derivative by the relative spin in the axes of body a.
void rotation(const Vector3& g, const Matrix3& P, Vector12& gradient, Matrix12& H) {
  gradient << Vector3::Zero(), -g, Vector3::Zero(), g;
  H.setZero();
  H.block<3, 3>(3, 3) = H.block<3, 3>(9, 9) = symmetric(P);
  H.block<3, 3>(9, 3) = -symmetric(P) - skew(g) / 2;
  H.block<3, 3>(3, 9) = H.block<3, 3>(9, 3).transpose();
}

void rotations(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, const Matrix3& axes, JointMotion& out) {
  const Matrix3 R_a = a.toRotationMatrix() * axes;
  // Rx(α) Ry(β) Rz(γ) = R_aᵀ R_b; small rotations keep their digits in the quaternion.
  Eigen::Quaterniond relative = a.conjugate() * b;
  relative.vec() = axes.transpose() * relative.vec();
  const Matrix3 S = relative.toRotationMatrix();
  const double alpha = std::atan2(-S(1, 2), S(2, 2)), sine = S(0, 2), cosine = std::hypot(S(0, 0), S(0, 1));
  out.components.tail<3>() << alpha, std::atan2(sine, cosine), std::atan2(-S(0, 1), S(0, 0));
  const double ca = std::cos(alpha), sa = std::sin(alpha), tangent = sine / cosine;
  const Vector3 g1 = R_a * Vector3(1, sa * tangent, -ca * tangent), g2 = R_a * Vector3(0, ca, sa),
                g3 = R_a * Vector3(0, -sa, ca) / cosine;
  rotation(g1, tangent * g2 * g1.transpose() - g3 * g2.transpose() / cosine, out.gradient[3], out.hessian[3]);
  rotation(g2, cosine * g3 * g1.transpose(), out.gradient[4], out.hessian[4]);
  rotation(g3, tangent * g3 * g2.transpose() - g2 * g1.transpose() / cosine, out.gradient[5], out.hessian[5]);
}

}  // namespace

JointMotion joint_motion(const Vector3& X_a, const BodyMotion& a, const Vector3& X_b, const BodyMotion& b,
                         const Vector3& p, const std::array<Matrix3, 2>& axes, const std::array<bool, 6>& wanted) {
  JointMotion out;
  if (wanted[0] || wanted[1] || wanted[2]) {
    const Matrix3 R_a = a.Q.toRotationMatrix() * axes[0];
    const Vector3 arm_a = a.Q * (p - X_a), arm_b = b.Q * (p - X_b);
    const Vector3 apart = (b.u - a.u) + turned_away(b.Q, p - X_b) - turned_away(a.Q, p - X_a), v = arm_a + apart;
    for (int i = 0; i < 3; ++i) {
      const auto k = as_size(i);
      if (!wanted[k]) continue;
      out.components(i) = R_a.col(i).dot(apart);
      translation(R_a.col(i), v, arm_b, out.gradient[k], out.hessian[k]);
    }
  }
  if (wanted[3] || wanted[4] || wanted[5]) rotations(a.Q, b.Q, axes[1], out);
  return out;
}

}  // namespace deflect::frame
