#include "msa/mechanism/section.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msa/base/spatial.h"

namespace deflect {
namespace {

constexpr double nu = 0.3;

SectionProperties of(const Shape& shape) { return properties({shape}, nu); }

struct Integrals {
  double A = 0, Iy = 0, Iz = 0;
};

/// Midpoint rule in polar coordinates: exact over the angle, relative error near 1/n² over the radius.
Integrals over_ring(double inner, double outer, int n) {
  Integrals sum;
  const double dr = (outer - inner) / n, da = 2 * pi / 16;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 16; ++j) {
      const double r = inner + (i + 0.5) * dr, a = (j + 0.5) * da, dA = r * dr * da;
      sum.A += dA;
      sum.Iy += std::pow(r * std::sin(a), 2) * dA;
      sum.Iz += std::pow(r * std::cos(a), 2) * dA;
    }
  return sum;
}

Integrals over_rectangle(double width_y, double height_z, int n) {
  Integrals sum;
  const double dy = width_y / n, dz = height_z / n;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double y = (i + 0.5) * dy - width_y / 2, z = (j + 0.5) * dz - height_z / 2;
      sum.A += dy * dz;
      sum.Iy += z * z * dy * dz;
      sum.Iz += y * y * dy * dz;
    }
  return sum;
}

void expect_same(const SectionProperties& p, const Integrals& i, double relative) {
  EXPECT_NEAR(p.A / i.A, 1, relative);
  EXPECT_NEAR(p.Iy / i.Iy, 1, relative);
  EXPECT_NEAR(p.Iz / i.Iz, 1, relative);
}

TEST(Section, AreaAndSecondMomentsAreTheIntegrals) {
  const int n = 400;
  const double relative = 1.1 / (n * n);
  expect_same(of(RoundSection{0.008}), over_ring(0, 0.004, n), relative);
  expect_same(of(TubeSection{0.008, 0.005}), over_ring(0.0025, 0.004, n), relative);
  expect_same(of(RectangleSection{0.010, 0.004}), over_rectangle(0.010, 0.004, n), relative);
}

TEST(Section, TorsionOfRoundSectionsIsThePolarMoment) {
  const SectionProperties rod = of(RoundSection{0.008}), tube = of(TubeSection{0.008, 0.005});
  EXPECT_DOUBLE_EQ(rod.J, pi * std::pow(0.008, 4) / 32);
  EXPECT_DOUBLE_EQ(tube.J, tube.Iy + tube.Iz);
}

// J = k·b·a³ with b ≥ a: Timoshenko and Goodier, Theory of Elasticity, table in §109, three digits there.
TEST(Section, TorsionOfRectanglesIsThePublishedOne) {
  const double table[][2] = {{1, 0.1406}, {1.2, 0.166}, {1.5, 0.196}, {2, 0.229}, {2.5, 0.249},
                             {3, 0.263},  {4, 0.281},   {5, 0.291},   {10, 0.312}};
  for (const auto& [ratio, k] : table) {
    const double a = 0.003, b = ratio * a;
    EXPECT_NEAR(of(RectangleSection{a, b}).J / (b * a * a * a), k, 0.0006) << "b/a = " << ratio;
    EXPECT_EQ(of(RectangleSection{a, b}).J, of(RectangleSection{b, a}).J);
  }
}

/// By Prandtl's stress function as a double sine series, cut where its tail is below 1e-8 of the sum:
/// J = 256 ab/π⁶ ∑∑ 1/(m²n²(m²/a² + n²/b²)) over odd m and n.
double torsion_by_double_series(double a, double b) {
  double sum = 0;
  for (int m = 1; m < 1000; m += 2)
    for (int n = 1; n < 1000; n += 2) {
      const double m2 = 1.0 * m * m, n2 = 1.0 * n * n;
      sum += 1 / (m2 * n2 * (m2 / (a * a) + n2 / (b * b)));
    }
  return 256 * a * b / std::pow(pi, 6) * sum;
}

TEST(Section, TorsionOfRectanglesByASecondRoute) {
  EXPECT_NEAR(of(RectangleSection{0.01, 0.01}).J / std::pow(0.01, 4), 0.1405770, 0.5e-7);
  for (const double b : {0.01, 0.012, 0.02, 0.05})
    EXPECT_NEAR(of(RectangleSection{0.01, b}).J / torsion_by_double_series(0.01, b), 1, 1e-7) << b;
}

// For b ≫ a the ends cost J = b a³/3 · (1 − 0.630249 a/b), the next term being exponentially small.
TEST(Section, TorsionOfAThinRectangle) {
  for (const double ratio : {10.0, 100.0, 1000.0}) {
    const double a = 0.001, b = ratio * a;
    EXPECT_NEAR(of(RectangleSection{b, a}).J / (b * a * a * a / 3), 1 - 0.630249 / ratio, 1e-7);
  }
}

TEST(Section, TubeWithoutABoreIsARod) {
  const SectionProperties rod = of(RoundSection{0.008}), tube = of(TubeSection{0.008, 0.008e-9});
  EXPECT_NEAR(tube.A / rod.A, 1, 1e-15);
  EXPECT_NEAR(tube.Iy / rod.Iy, 1, 1e-15);
  EXPECT_NEAR(tube.Iz / rod.Iz, 1, 1e-15);
  EXPECT_NEAR(tube.J / rod.J, 1, 1e-15);
}

// Cowper (1966): thin tube 2(1 + ν)/(4 + 3ν), solid round 6(1 + ν)/(7 + 6ν).
TEST(Section, ShearCoefficientsAtTheirLimits) {
  const SectionProperties thin = of(TubeSection{0.1, 0.1 * (1 - 1e-7)}), solid = of(TubeSection{0.1, 1e-10});
  EXPECT_NEAR(thin.As_y / thin.A, 2 * (1 + nu) / (4 + 3 * nu), 1e-7);
  EXPECT_NEAR(solid.As_z / solid.A, 6 * (1 + nu) / (7 + 6 * nu), 1e-9);
  EXPECT_DOUBLE_EQ(of(RoundSection{0.008}).As_y / of(RoundSection{0.008}).A, 0.9);
  EXPECT_DOUBLE_EQ(of(RectangleSection{0.01, 0.02}).As_z / 2e-4, 5.0 / 6);
}

TEST(Section, GivenPropertiesAreTakenAsTheyAre) {
  const SectionProperties p = of(GivenSection{1, 2, 3, 4, 5, std::nullopt});
  EXPECT_EQ(p.A, 1);
  EXPECT_EQ(p.Iy, 2);
  EXPECT_EQ(p.Iz, 3);
  EXPECT_EQ(p.J, 4);
  EXPECT_EQ(p.As_y, 5);
  EXPECT_EQ(p.As_z, 0);
}

TEST(Section, PropertiesGoWithTheSquareAndTheFourthPowerOfSize) {
  for (const Shape& shape : {Shape(RoundSection{1}), Shape(TubeSection{1, 0.6}), Shape(RectangleSection{1, 0.3})}) {
    Shape twice = shape;
    std::visit(
        [](auto& s) {
          if constexpr (requires { s.diameter; }) s.diameter *= 2;
          if constexpr (requires { s.inner_diameter; }) s.outer_diameter *= 2, s.inner_diameter *= 2;
          if constexpr (requires { s.width_y; }) s.width_y *= 2, s.height_z *= 2;
        },
        twice);
    EXPECT_EQ(of(twice).A, 4 * of(shape).A);
    EXPECT_EQ(of(twice).As_y, 4 * of(shape).As_y);
    EXPECT_EQ(of(twice).Iz, 16 * of(shape).Iz);
    EXPECT_EQ(of(twice).J, 16 * of(shape).J);
  }
}

}  // namespace
}  // namespace deflect
