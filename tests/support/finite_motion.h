// Bodies that move by any amount, for tests of what is written in spins.
#pragma once

#include <random>

#include "msa/frame/elements/finite_rotation.h"

namespace deflect::test {

inline Vector3 any_vector(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> one(-1, 1);
  const double x = one(random), y = one(random), z = one(random);
  return size * Vector3(x, y, z);
}

/// Moves a body by [δ; ω]: the increment that derivatives by spins belong to.
inline frame::BodyMotion moved(const frame::BodyMotion& body, const Vector6& d) {
  return {body.u + d.head<3>(), (frame::rotation_by(d.tail<3>()) * body.Q).normalized()};
}

/// The rigid motion x → Q x + t, taken by a body whose node stands at X in the undeformed shape.
inline frame::BodyMotion carried(const frame::BodyMotion& body, const Vector3& X, const Eigen::Quaterniond& Q,
                                 const Vector3& t) {
  return {Q * (X + body.u) + t - X, (Q * body.Q).normalized()};
}

}  // namespace deflect::test
