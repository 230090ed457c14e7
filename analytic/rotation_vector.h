// Rotation vectors φ (axis times angle, rad): R = exp([φ]×), |φ| < 2π. Rotations are stored as R − I, so that small
// ones keep all their digits.
#pragma once

#include "msa/base/spatial.h"

namespace deflect::analytic {

/// exp([φ]×) − I.
Matrix3 turning(const Vector3& phi);

/// The shortest φ with R = exp([φ]×), |φ| ≤ π, of R − I.
Vector3 rotation_vector(const Matrix3& turning);

/// The product of two rotations, b applied first: (I + a)(I + b) − I.
inline Matrix3 combined(const Matrix3& a, const Matrix3& b) { return a + b + a * b; }

/// The rotation by which exp([φ]×) changes with φ: exp([φ + d]×) = exp([ψ]×) exp([φ]×) with
///   ψ = J d + ½ Q(d, d) + …,  J = I + b [φ]× + c [φ]×²,  b = (1 − cos θ)/θ²,  c = (θ − sin θ)/θ³,  θ = |φ|.
struct RotationChange {
  explicit RotationChange(const Vector3& phi);

  Matrix3 J;
  /// m · Q as a symmetric matrix: dᵀ(m·Q) d = m · Q(d, d).
  Matrix3 curvature(const Vector3& m) const;

 private:
  Vector3 phi_;
  double c_, db_, dc_;  // c, and db/dθ and dc/dθ divided by θ
};

}  // namespace deflect::analytic
