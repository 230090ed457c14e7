// How far answers are apart, relative to the second; rotations weighed by a length (m). Two zeros are not apart.
#pragma once

#include "msa/base/spatial.h"

namespace deflect::test {

inline double relative(double apart, double size) { return apart == 0 ? 0 : apart / size; }

inline double apart(const Matrix6& a, const Matrix6& b, double length) {
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(1 / length);
  return relative((w.asDiagonal() * (a - b) * w.asDiagonal()).norm(), (w.asDiagonal() * b * w.asDiagonal()).norm());
}

inline double apart(const Vector6& a, const Vector6& b, double length) {
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(length);
  return relative(w.cwiseProduct(a - b).norm(), w.cwiseProduct(b).norm());
}

}  // namespace deflect::test
