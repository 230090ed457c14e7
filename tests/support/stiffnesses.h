// Stiffness matrices for tests: of random devices, as a program prints them, and with every usual mistake made in them.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "tests/support/devices.h"
#include "validation/matrix/matrix_file.h"

namespace deflect::test {

/// N, mm, rad at a point beside the centre of stiffness: nine springs k along random lines, Σ k s sᵀ.
inline Matrix6 random_stiffness(std::mt19937& random) {
  Matrix6 K = Matrix6::Zero();
  for (int i = 0; i < 9; ++i) {
    const Vector3 along = random_vector(random, 1).normalized(), at = Vector3(40, -25, 60) + random_vector(random, 100);
    Vector6 s;
    s << along, at.cross(along);
    K += std::pow(10, uniform(random, 2.5, 4)) * s * s.transpose();
  }
  return K;
}

/// With `digits` significant digits, as "%g" does it.
inline std::string printed(const MatrixX& K, int digits) {
  std::string text;
  for (Eigen::Index i = 0; i < K.rows(); ++i)
    for (Eigen::Index j = 0; j < K.cols(); ++j)
      text += fmt::format("{:.{}g}{}", K(i, j), digits, j + 1 < K.cols() ? ',' : '\n');
  return text;
}

inline matrix::PrintedMatrix read_back(const MatrixX& K, int digits) {
  return matrix::parse_matrix(printed(K, digits), "K.csv");
}

/// Lines swapped so that the halves change places.
inline Matrix6 halves_exchanged() {
  Matrix6 P = Matrix6::Zero();
  P.topRightCorner<3, 3>() = P.bottomLeftCorner<3, 3>() = Matrix3::Identity();
  return P;
}

inline Matrix6 halves_scaled(double translation, double rotation) {
  Vector6 v;
  v << Vector3::Constant(translation), Vector3::Constant(rotation);
  return v.asDiagonal();
}

/// A right stiffness with one mistake in it, by the mistake's id.
using Spoil = std::function<Matrix6(const Matrix6& K, std::mt19937&)>;

inline std::map<std::string, Spoil> spoilt() {
  using R = std::mt19937&;
  const auto X = [](R r) { return shift_twist(random_vector(r, 50)); };
  const auto Q = [](R r) { return rotate_twist(rotation_from_vector(random_vector(r, 1.5))); };
  const auto with_block = [](const Matrix6& K, double A, double B, double D) {
    Matrix6 out = B * K;
    out.topLeftCorner<3, 3>() = A * K.topLeftCorner<3, 3>();
    out.bottomRightCorner<3, 3>() = D * K.bottomRightCorner<3, 3>();
    return out;
  };
  const auto spring = [](const Matrix6& K, R r) {
    Vector6 s;
    s << random_vector(r, 1), random_vector(r, 50);
    return Matrix6(0.05 * K(0, 0) * s * s.transpose());
  };
  return {
      {"negated", [](const Matrix6& K, R) { return -K; }},
      {"triangle", [](const Matrix6& K, R) { return Matrix6(K.triangularView<Eigen::Upper>()); }},
      {"one_pair",
       [](const Matrix6& K, R) {
         Matrix6 k = K;
         k(1, 5) *= -1;
         return k;
       }},
      {"coupling_not_transposed",
       [](const Matrix6& K, R) {
         Matrix6 k = K;
         k.bottomLeftCorner<3, 3>() = K.topRightCorner<3, 3>();
         return k;
       }},
      {"coupling_sign", [](const Matrix6& K, R) { return Matrix6(halves_scaled(1, -1) * K * halves_scaled(1, -1)); }},
      {"moment_sign", [](const Matrix6& K, R) { return Matrix6(halves_scaled(1, -1) * K); }},
      {"moments_in_Nm", [](const Matrix6& K, R) { return Matrix6(halves_scaled(1, 1e-3) * K); }},
      {"moments_in_Nmm", [](const Matrix6& K, R) { return Matrix6(K * halves_scaled(1e3, 1)); }},
      {"degrees", [](const Matrix6& K, R) { return Matrix6(K * halves_scaled(1, pi / 180)); }},
      {"mixed_order", [](const Matrix6& K, R) { return Matrix6(halves_exchanged() * K); }},
      {"two_exchanged",
       [](const Matrix6& K, R) {
         Matrix6 k = K;
         k.row(1).swap(k.row(3));
         return k;
       }},
      {"rotation_first", [](const Matrix6& K, R) { return Matrix6(halves_exchanged() * K * halves_exchanged()); }},
      {"metres", [=](const Matrix6& K, R) { return with_block(K, 1e3, 1, 1e-3); }},
      {"millimetres", [=](const Matrix6& K, R) { return with_block(K, 1e-3, 1, 1e3); }},
      {"translation_block", [=](const Matrix6& K, R) { return with_block(K, 1e-3, 1, 1); }},
      {"rotation_block", [=](const Matrix6& K, R) { return with_block(K, 1, 1, 1e-3); }},
      {"coupling_block", [=](const Matrix6& K, R) { return with_block(K, 1, 1e3, 1); }},
      {"compliance", [](const Matrix6& K, R) { return Matrix6(K.inverse()); }},
      {"moved",
       [=](const Matrix6& K, R r) {
         const Matrix6 x = X(r);
         return Matrix6(x.transpose() * K * x);
       }},
      {"moved_as_compliance",
       [=](const Matrix6& K, R r) {
         const Matrix6 x = X(r);
         return Matrix6(x * K * x.transpose());
       }},
      {"moved_on_one_side", [=](const Matrix6& K, R r) { return Matrix6(K * X(r)); }},
      {"turned_on_one_side", [=](const Matrix6& K, R r) { return Matrix6(Q(r) * K); }},
      {"turned",
       [=](const Matrix6& K, R r) {
         const Matrix6 q = Q(r);
         return Matrix6(q * K * q.transpose());
       }},
      {"scaled", [](const Matrix6& K, R) { return Matrix6(1.3 * K); }},
      {"stiffer", [=](const Matrix6& K, R r) { return Matrix6(K + spring(K, r)); }},
      {"softer",
       [=](const Matrix6& K, R r) {
         const Matrix6 s = spring(K, r);
         return Matrix6(K - 0.5 * K * s * K / (K * s).trace());
       }},
  };
}

}  // namespace deflect::test
