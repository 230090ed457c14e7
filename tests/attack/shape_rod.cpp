#include "tests/attack/shape_rod.h"

#include <cmath>

namespace deflect::attack {

Matrix3L rotation_by(const Vector3L& phi) {
  const Long angle = phi.norm(), square = angle * angle;
  const Matrix3L X = cross_matrix(phi);
  const Long half = std::sin(angle / 2);
  const Long by_X = angle > 0 ? std::sin(angle) / angle : 1;
  const Long by_XX = angle > 0 ? 2 * half * half / square : Long(0.5);
  return Matrix3L::Identity() + by_X * X + by_XX * X * X;
}

Vector3L vector_of(const Matrix3L& R) {
  const Vector3L sine = Vector3L(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1)) / 2;
  const Long s = sine.norm(), c = (R.trace() - 1) / 2;
  return s > 0 ? Vector3L(sine * (std::atan2(s, c) / s)) : Vector3L::Zero();
}

RodL::RodL(const PlacedMember& m, const Vector3L& p_T, Shear shear)
    : p_T_(p_T),
      start_(m.p_W_start.cast<Long>()),
      end_(m.p_W_end.cast<Long>()),
      axes_(m.R_WM.cast<Long>()),
      shear_(shear) {
  const Long E = m.E, G = m.G;
  length_ = (end_ - start_).norm();
  EA_ = E * m.section.A;
  bends_ << 1 / (G * m.section.J), 1 / (E * m.section.Iy), 1 / (E * m.section.Iz);
  if (m.beam == BeamTheory::timoshenko) per_GAy_ = 1 / (G * m.section.As_y), per_GAz_ = 1 / (G * m.section.As_z);
}

RodL::Rate RodL::rate(const Vector3L& r, const Matrix3L& R, const WrenchL& w) const {
  const Vector3L n = R.transpose() * w.f, kappa = bends_.cwiseProduct(R.transpose() * w.moment_at(r));
  // The angles by which the axis leaves the section's normal, and the force across the axis, follow from each other.
  Vector3L t = Vector3L::UnitX();
  for (int i = 0; i < 6 && (per_GAy_ > 0 || per_GAz_ > 0); ++i) {
    const Long longer = 1 + n.dot(t) / EA_, by = shear_ == Shear::as_angle ? longer : 1 / longer;
    const Long y = by * per_GAy_ * n.dot(Vector3L(-t.y(), t.x(), 0)),
               z = by * per_GAz_ * n.dot(Vector3L(-t.z(), 0, t.x()));
    t = Vector3L(1, std::tan(y), std::tan(z)).normalized();
  }
  return {(1 + n.dot(t) / EA_) * (R * t), R * cross_matrix(kappa)};
}

MotionL RodL::beyond(const MotionL& before, const WrenchL& w, int steps) const {
  const Long h = length_ / steps;
  Vector3L r = p_T_ + before.u + before.R * (start_ - p_T_);
  const Matrix3L first = before.R * axes_;
  Matrix3L R = first;
  for (int i = 0; i < steps; ++i) {
    const Rate a = rate(r, R, w), b = rate(r + h / 2 * a.r, R + h / 2 * a.R, w),
               c = rate(r + h / 2 * b.r, R + h / 2 * b.R, w), d = rate(r + h * c.r, R + h * c.R, w);
    r += h / 6 * (a.r + 2 * b.r + 2 * c.r + d.r);
    R += h / 6 * (a.R + 2 * b.R + 2 * c.R + d.R);
  }
  MotionL out;
  out.R = R * axes_.transpose();
  out.u = r - p_T_ - out.R * (end_ - p_T_);
  return out;
}

}  // namespace deflect::attack
