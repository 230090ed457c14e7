// Estimates the rounding error of an answer by rotating the whole machine, which changes only the rounding.
#pragma once

#include "validation/theories/theory.h"

namespace deflect::theories {

/// Two rotations, i = 0 and 1, about axes in general directions.
const Matrix3& turn_number(std::size_t i);

/// The machine rotated about the origin of W by R: points, axes, misfits and weight. Its answer to the rotated load is
/// the rotated answer.
Configuration turned(const Configuration&, const Matrix3& R);

/// Rotates an answer back to the original axes. Scalars stay; floating play is dropped.
Answer turned_back(const Answer&, const Matrix3& R);

/// The largest relative change of a theory's answer in linear geometry under the two rotations, as in difference(). A
/// rotated machine without an answer does not count.
double changed_by_turning(const Theory&, const Answer&, const Configuration&, const Vector6& F_T_W);

}  // namespace deflect::theories
