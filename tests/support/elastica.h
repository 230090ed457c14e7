// The plane elastica of a cantilever under a force at its tip, by elliptic integrals.
#pragma once

#include <algorithm>
#include <cmath>

#include "msa/base/spatial.h"

namespace deflect::test {

/// A cantilever of EI = 1 and length 1 along x under a force of the size P that pushes it back, turned by δ to +y. The
/// tangent's angle to the line of the force is φ: φ'' + P sin φ = 0, φ(0) = δ, φ' = 0 and φ = α at the tip. With
/// p = sin α/2 and sin χ = sin(δ/2)/p: √P = K(p) − F(χ, p) (S. Timoshenko, J. M. Gere, Theory of Elastic Stability,
/// 2nd ed., art. 2.7, for δ = 0).
struct Elastica {
  double angle, x, y;  // of the tip, in the axes of the cantilever
};

inline Elastica elastica(double P, double delta) {
  const auto excess = [&](double alpha) {
    const double p = std::sin(alpha / 2);
    return std::comp_ellint_1(p) - std::ellint_1(p, std::asin(std::min(1.0, std::sin(delta / 2) / p))) - std::sqrt(P);
  };
  double low = std::max(delta, 1e-9), high = pi - 1e-9;
  for (int i = 0; i < 200; ++i) (excess((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
  const double p = std::sin(low / 2), chi = std::asin(std::sin(delta / 2) / p), k = std::sqrt(P);
  const double along = 2 * (std::comp_ellint_2(p) - std::ellint_2(p, chi)) / k - 1, across = 2 * p * std::cos(chi) / k;
  return {low - delta, std::cos(delta) * along + std::sin(delta) * across,
          std::cos(delta) * across - std::sin(delta) * along};
}

}  // namespace deflect::test
