// The rod of the judge of deformed shapes: a section carried along the member by the equations of a rod in space,
//   R' = R [κ]×,  κ = (m_x/GJ, m_y/EIy, m_z/EIz),   r' = (1 + ε) R t,   ε = N/EA,
// with the force and moment that pass through the section, n and m in its axes, from statics: the force is the same all
// along, the moment grows by its lever. t is the direction of the axis in the section: across it the section of a
// Timoshenko member yields by Q/GA_s, N pulls along it (F. Engesser). In extended precision, by the classical method of
// Runge and Kutta.
//
// Theories of small strain do not say which length the shear is of. Its work Q (1 + ε) δγ with the energy ½ GA_s γ²
// makes the angle γ = (1 + ε) Q/GA_s; with ½ GA_s ((1 + ε) γ)², of the way across, it is Q/((1 + ε) GA_s).
#pragma once

#include "msa/mechanism/configuration.h"

namespace deflect::attack {

using Long = long double;
using Vector3L = Eigen::Matrix<Long, 3, 1>;
using Vector6L = Eigen::Matrix<Long, 6, 1>;
using Matrix3L = Eigen::Matrix<Long, 3, 3>;

/// x ↦ p + u + R (x − p), with p the drawn place of T.
struct MotionL {
  Vector3L u = Vector3L::Zero();
  Matrix3L R = Matrix3L::Identity();
};

inline Matrix3L cross_matrix(const Vector3L& v) {
  Matrix3L out;
  out << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return out;
}

/// exp([φ]×), by its series halved until it is short.
Matrix3L rotation_by(const Vector3L& phi);
/// φ of R, for rotations below π.
Vector3L vector_of(const Matrix3L& R);

/// A wrench that passes through a chain: [f; moment about the drawn place of T].
struct WrenchL {
  Vector3L f, m, about;
  Vector3L moment_at(const Vector3L& x) const { return m - (x - about).cross(f); }
};

enum class Shear { as_angle, as_way };

class RodL {
 public:
  RodL(const PlacedMember&, const Vector3L& p_T, Shear);
  /// Of the body beyond the member, where the body before it moves by `before` and the member carries `w`.
  MotionL beyond(const MotionL& before, const WrenchL& w, int steps) const;

 private:
  struct Rate {
    Vector3L r;
    Matrix3L R;
  };
  Rate rate(const Vector3L& r, const Matrix3L& R, const WrenchL& w) const;

  Vector3L p_T_, start_, end_, bends_;  // bends_: 1/GJ, 1/EIy, 1/EIz
  Matrix3L axes_;
  Shear shear_;
  Long length_, EA_, per_GAy_ = 0, per_GAz_ = 0;
};

}  // namespace deflect::attack
