#include "msa/mechanism/sections/section.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

#include "msa/base/spatial.h"
#include "msa/mechanism/sections/thin_walls.h"

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

/// Walls of the box from where the flow of a force along z is zero, the middles of the walls along y, to the middles of
/// the others: four quarters.
std::vector<Wall> quarters(double width_y, double height_z, double t) {
  std::vector<Wall> walls;
  for (const double y : {-width_y / 2, width_y / 2})
    for (const double z : {-height_z / 2, height_z / 2}) {
      walls.push_back({{0, z}, {y, z}, t, {}});
      walls.push_back({{y, z}, {y, 0}, t, {walls.size() - 1}});
    }
  return walls;
}

SectionProperties of(const BoxSection& s, double) {
  const double b = s.width_y, h = s.height_z, t = s.wall, bi = b - 2 * t, hi = h - 2 * t;
  const double bm = b - t, hm = h - t, enclosed = bm * hm, around = 2 * (bm + hm);
  const double J = 4 * enclosed * enclosed * t / around + around * std::pow(t, 3) / 3;
  return {b * h - bi * hi,
          (b * std::pow(h, 3) - bi * std::pow(hi, 3)) / 12,
          (h * std::pow(b, 3) - hi * std::pow(bi, 3)) / 12,
          J,
          shear_area(quarters(hm, bm, t), 1),
          shear_area(quarters(bm, hm, t), 1)};
}

SectionProperties of(const ISection& s, double) {
  const double b = s.width_y, h = s.height_z, tw = s.web, tf = s.flange, clear = h - 2 * tf, z = (h - tf) / 2;
  const std::vector<Wall> walls = {{{-b / 2, z}, {0, z}, tf, {}},
                                   {{b / 2, z}, {0, z}, tf, {}},
                                   {{0, z}, {0, -z}, tw, {0, 1}},
                                   {{-b / 2, -z}, {0, -z}, tf, {}},
                                   {{b / 2, -z}, {0, -z}, tf, {}}};
  return {2 * b * tf + clear * tw,
          (b * std::pow(h, 3) - (b - tw) * std::pow(clear, 3)) / 12,
          (2 * tf * std::pow(b, 3) + clear * std::pow(tw, 3)) / 12,
          (2 * b * std::pow(tf, 3) + clear * std::pow(tw, 3)) / 3,
          shear_area(walls, 0),
          shear_area(walls, 1)};
}

SectionProperties of(const ChannelSection& s, double) {
  const double b = s.width_y, h = s.height_z, tw = s.web, tf = s.flange, clear = h - 2 * tf, z = (h - tf) / 2;
  const std::vector<Wall> walls = {
      {{b - tw / 2, z}, {0, z}, tf, {}}, {{0, z}, {0, -z}, tw, {0}}, {{b - tw / 2, -z}, {0, -z}, tf, {}}};
  // From the back of the web.
  const double A = 2 * b * tf + clear * tw, centroid = (b * b * tf + clear * tw * tw / 2) / A;
  const double Iz = (2 * tf * std::pow(b, 3) + clear * std::pow(tw, 3)) / 3 - A * centroid * centroid;
  return {A,
          (b * std::pow(h, 3) - (b - tw) * std::pow(clear, 3)) / 12,
          Iz,
          (2 * b * std::pow(tf, 3) + clear * std::pow(tw, 3)) / 3,
          shear_area(walls, 0),
          shear_area(walls, 1)};
}

/// In axes along the legs from the heel: second moments [∫ξ², ∫ξη; ∫ξη, ∫η²] about the centroid.
struct LegMoments {
  double area = 0;
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();

  void add(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    const Eigen::Vector2d size = high - low, middle = (low + high) / 2;
    const double dA = size.prod();
    area += dA;
    first += dA * middle;
    second += dA * middle * middle.transpose();
    second.diagonal() += dA * size.cwiseAbs2() / 12;
  }
  Eigen::Matrix2d about_centroid() const { return second - first * first.transpose() / area; }
};

SectionProperties of(const AngleSection& s, double) {
  const double a = s.long_leg, b = s.short_leg, t = s.wall;
  LegMoments m;
  m.add({0, 0}, {a, t});
  m.add({0, t}, {t, b});
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> principal(m.about_centroid());
  // Along z material lies farther out: ∫z² = Iy is the larger.
  Eigen::Matrix2d to_yz;
  to_yz << principal.eigenvectors().col(0).transpose(), principal.eigenvectors().col(1).transpose();
  const auto at = [&](double along, double across) { return Eigen::Vector2d(to_yz * Eigen::Vector2d(along, across)); };
  const std::vector<Wall> walls = {{at(a - t / 2, 0), at(0, 0), t, {}}, {at(0, b - t / 2), at(0, 0), t, {}}};
  return {m.area,
          principal.eigenvalues()(1),
          principal.eigenvalues()(0),
          (a + b - t) * std::pow(t, 3) / 3,
          shear_area(walls, 0),
          shear_area(walls, 1)};
}

}  // namespace

SectionProperties properties(const Section& section, double nu) {
  return std::visit([nu](const auto& shape) { return of(shape, nu); }, section.shape);
}

}  // namespace deflect
