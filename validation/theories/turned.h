// What rounding does to an answer, seen by turning the whole machine: that changes nothing of it but the rounding.
#pragma once

#include "validation/theories/theory.h"

namespace deflect::theories {

/// Two turns, i = 0 and 1, about axes that no machine is drawn along.
const Matrix3& turn_number(std::size_t i);

/// The machine with everything turned about the origin of W by R: points, axes, load and weight. Its answer is that of
/// the machine as it stands, turned.
Configuration turned(const Configuration&, const Matrix3& R);

/// The answer in the axes before. What has no axes stays.
Answer turned_back(const Answer&, const Matrix3& R);

/// By how much a theory's answer in linear geometry changes under two turns, relative, as difference() has it; 0 where
/// a turned machine has no answer.
double changed_by_turning(const Theory&, const Answer&, const Configuration&, const Vector6& F_T_W);

}  // namespace deflect::theories
