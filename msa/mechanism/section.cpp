#include "msa/mechanism/section.h"

#include <algorithm>
#include <cmath>

#include "msa/base/spatial.h"

namespace deflect {
namespace {

SectionProperties of(const RoundSection& s, double) {
  const double d = s.diameter, A = pi * d * d / 4, I = pi * std::pow(d, 4) / 64;
  return {A, I, I, 2 * I, 0.9 * A, 0.9 * A};
}

SectionProperties of(const TubeSection& s, double nu) {
  const double D = s.outer_diameter, d = s.inner_diameter;
  const double A = pi * (D * D - d * d) / 4, I = pi * (std::pow(D, 4) - std::pow(d, 4)) / 64;
  const double m2 = (d / D) * (d / D), p2 = (1 + m2) * (1 + m2);
  const double kappa = 6 * (1 + nu) * p2 / ((7 + 6 * nu) * p2 + (20 + 12 * nu) * m2);
  return {A, I, I, 2 * I, kappa * A, kappa * A};
}

SectionProperties of(const RectangleSection& s, double) {
  const double b = s.width_y, h = s.height_z, A = b * h;
  const double wide = std::max(b, h), thin = std::min(b, h);
  double series = 0;  // converges like n⁻⁵
  for (int n = 1; n < 200; n += 2) series += std::tanh(n * pi * wide / (2 * thin)) / std::pow(n, 5);
  const double J = wide * std::pow(thin, 3) * (1.0 / 3 - 64 / std::pow(pi, 5) * thin / wide * series);
  return {A, b * std::pow(h, 3) / 12, h * std::pow(b, 3) / 12, J, A * 5 / 6, A * 5 / 6};
}

SectionProperties of(const GivenSection& s, double) {
  return {s.A, s.Iy, s.Iz, s.J, s.As_y.value_or(0), s.As_z.value_or(0)};
}

}  // namespace

SectionProperties properties(const Section& section, double nu) {
  return std::visit([nu](const auto& shape) { return of(shape, nu); }, section.shape);
}

}  // namespace deflect
