#include "msa/mechanism/sections/section.h"

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

/// Midpoint rule over all that `inside` holds, in a square of that half side; principal moments, larger first. The
/// boundary is missed by half a cell at the most: relative error below perimeter · cell / area, and far below where
/// edges lie on cells.
struct Principal {
  double A = 0, major = 0, minor = 0;
};
template <class Inside>
Principal over(double half, int n, const Inside& inside) {
  const double d = 2 * half / n;
  double A = 0, y1 = 0, z1 = 0, yy = 0, zz = 0, yz = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double y = (i + 0.5) * d - half, z = (j + 0.5) * d - half;
      if (!inside(y, z)) continue;
      A += d * d, y1 += y * d * d, z1 += z * d * d;
      yy += (y * y + d * d / 12) * d * d, zz += (z * z + d * d / 12) * d * d, yz += y * z * d * d;
    }
  yy -= y1 * y1 / A, zz -= z1 * z1 / A, yz -= y1 * z1 / A;
  const double mean = (yy + zz) / 2, radius = std::hypot((yy - zz) / 2, yz);
  return {A, mean + radius, mean - radius};
}

// Edges on cells of 1 mm: the sums are exact.
TEST(Section, BuiltUpShapesAreTheIntegrals) {
  const auto expect = [](const Shape& shape, const Principal& i) {
    const SectionProperties p = of(shape);
    EXPECT_NEAR(p.A / i.A, 1, 1e-12);
    EXPECT_NEAR(p.Iy / i.major, 1, 1e-12);
    EXPECT_NEAR(p.Iz / i.minor, 1, 1e-12);
  };
  const auto in = [](double x, double low, double high) { return low < x && x < high; };
  const double mm = 1e-3;
  expect(BoxSection{60 * mm, 100 * mm, 6 * mm}, over(0.06, 120, [&](double y, double z) {
           return std::abs(y) < 0.03 && std::abs(z) < 0.05 && !(std::abs(y) < 0.024 && std::abs(z) < 0.044);
         }));
  expect(ISection{80 * mm, 120 * mm, 6 * mm, 8 * mm}, over(0.06, 120, [&](double y, double z) {
           return std::abs(z) < 0.06 && std::abs(y) < (std::abs(z) > 0.052 ? 0.04 : 0.003);
         }));
  expect(ChannelSection{50 * mm, 120 * mm, 6 * mm, 8 * mm}, over(0.06, 120, [&](double y, double z) {
           return std::abs(z) < 0.06 && in(y, 0, std::abs(z) > 0.052 ? 0.05 : 0.006);
         }));
  for (const auto& [a, b] : {std::pair(100, 50), std::pair(70, 70)})
    expect(AngleSection{a * mm, b * mm, 6 * mm}, over(0.1, 200, [&, a = a * mm, b = b * mm](double y, double z) {
             return (in(y, 0, a) && in(z, 0, 0.006)) || (in(y, 0, 0.006) && in(z, 0, b));
           }));
}

// Published tables; what the fillets of radius r add (4 (1 − π/4) r² of an I, half of it of a channel) is known for A
// and bounds the rest: it lies inside the height, far from y.
TEST(Section, RolledProfilesWithoutTheirFillets) {
  const double mm = 1e-3, cm2 = 1e-4, cm4 = 1e-8, corner = 1 - pi / 4;
  const SectionProperties ipe = of(ISection{100 * mm, 200 * mm, 5.6 * mm, 8.5 * mm});  // IPE 200, EN 10365, r 12 mm
  EXPECT_NEAR(ipe.A + 4 * corner * std::pow(12 * mm, 2), 28.48 * cm2, 0.005 * cm2);
  EXPECT_LT(ipe.Iy, 1943 * cm4);
  EXPECT_GT(ipe.Iy, 1943 * cm4 - 4 * corner * std::pow(12 * mm, 2) * std::pow(91.5 * mm, 2));
  EXPECT_NEAR(ipe.Iz, 142.4 * cm4, 0.5 * cm4);
  EXPECT_NEAR(ipe.J / (6.98 * cm4), 0.74, 0.005) << "fillets make up a quarter of the torsion constant";

  const SectionProperties upe = of(ChannelSection{80 * mm, 200 * mm, 6 * mm, 11 * mm});  // UPE 200, DIN 1026-2, r 13 mm
  EXPECT_NEAR(upe.A + 2 * corner * std::pow(13 * mm, 2), 29.0 * cm2, 0.05 * cm2);
  EXPECT_NEAR(upe.Iy + 2 * corner * std::pow(13 * mm, 2) * std::pow(86 * mm, 2), 1910 * cm4, 10 * cm4);
  EXPECT_NEAR(upe.Iz / (187 * cm4), 1, 0.02);

  // RHS 60 x 40 x 3, EN 10219: corners of outer radius 2t and inner radius t; 1.5 t at the midline.
  const double t = 3 * mm, less = (4 - pi) * 2.25 * t * t, around = 2 * (57 + 37) * mm;
  const SectionProperties rhs = of(BoxSection{40 * mm, 60 * mm, t});
  EXPECT_NEAR(rhs.A - (4 - pi) * 3 * t * t, 5.41 * cm2, 0.01 * cm2);
  EXPECT_GT(rhs.Iy, 25.38 * cm4);
  EXPECT_LT(rhs.Iy, 25.38 * cm4 + (4 - pi) * 3 * t * t * std::pow(30 * mm, 2));
  const double round = around - 2 * 1.5 * t * (4 - pi), enclosed = 57 * 37 * mm * mm - less;
  const double J_round = 4 * enclosed * enclosed * t / round + round * t * t * t / 3;
  EXPECT_NEAR(J_round / (29.28 * cm4), 1, 2e-3) << "the table's formula with its corners";
  EXPECT_NEAR(rhs.J / J_round, 1, 0.04) << "and sharp ones";
}

// Thin walls: b t³/3 of a plate, Bredt's 4 A²t/s; a solid square by the same formula of the box is wrong by 4 % only.
TEST(Section, TorsionOfThinShapes) {
  const double t = 1e-6;
  EXPECT_NEAR(of(AngleSection{0.1, 0.05, t}).J / (0.15 * t * t * t / 3), 1, 1e-4);
  EXPECT_NEAR(of(ISection{0.1, 0.2, t, 2 * t}).J / ((0.2 * 8 + 0.2) * t * t * t / 3), 1, 1e-4);
  EXPECT_NEAR(of(BoxSection{0.1, 0.2, t}).J / (4 * 0.02 * 0.02 * t / 0.6), 1, 1e-4);
  EXPECT_NEAR(of(BoxSection{0.01, 0.01, 0.005 * (1 - 1e-9)}).J / (0.1405770 * std::pow(0.01, 4)), 1, 0.04);
}

// Energy of the shear flow. An I whose flanges are empty is its web, 5/6; across, its flanges alone carry, 5/6 each. A
// thin square box: q = V S/I, S = t b x/2 in half a flange, t b²/4 + t (b²/4 − z²)/2 in a web, I = 2 t b³/3:
// ∫S²/t = t b⁵ (4/96 + 2 (1/16 + 1/24 + 1/120)) = 4/15 t b⁵, A_s = (4/9)/(4/15) t b = 5/12 A.
TEST(Section, ShearAreasOfThinShapes) {
  const double t = 1e-6, b = 0.1;
  const SectionProperties web = of(ISection{2 * t, b, t, 1e-3 * t});
  EXPECT_NEAR(web.As_z / (b * t), 5.0 / 6, 1e-4);
  const SectionProperties beam = of(ISection{b, 2 * b, t, 3 * t});
  EXPECT_NEAR(beam.As_y / (2 * b * 3 * t), 5.0 / 6, 1e-4);
  EXPECT_LT(beam.As_z, 2 * b * t);
  EXPECT_GT(beam.As_z, 0.9 * 2 * b * t) << "flanges leave the web nearly even";
  const SectionProperties box = of(BoxSection{b, b, t});
  EXPECT_NEAR(box.As_z / box.A, 5.0 / 12, 1e-4);
  EXPECT_NEAR(box.As_y / box.As_z, 1, 1e-12);
  // An angle of equal legs, x from a tip. Along y: S = t x (b − x)/√8, I = t b³/12, ∫S²/t = t b⁵/120. Along z:
  // S = t (b x − x²/2)/√2, I = t b³/3, ∫S²/t = 2 t b⁵/15. Both give A_s = 5/6 b t.
  const SectionProperties angle = of(AngleSection{b, b, t});
  EXPECT_NEAR(angle.Iy / angle.Iz, 4, 1e-3);
  EXPECT_NEAR(angle.As_y / (b * t), 5.0 / 6, 1e-4);
  EXPECT_NEAR(angle.As_z / (b * t), 5.0 / 6, 1e-4);
  const SectionProperties channel = of(ChannelSection{t, b, t, 1e-3 * t});
  EXPECT_NEAR(channel.As_z / (b * t), 5.0 / 6, 1e-4);
}

TEST(Section, PropertiesGoWithTheSquareAndTheFourthPowerOfSize) {
  for (const Shape& shape : {Shape(RoundSection{1}), Shape(TubeSection{1, 0.6}), Shape(RectangleSection{1, 0.3}),
                             Shape(BoxSection{1, 0.5, 0.125}), Shape(ISection{0.5, 1, 0.125, 0.25})}) {
    Shape twice = shape;
    std::visit(
        [](auto& s) {
          if constexpr (requires { s.diameter; }) s.diameter *= 2;
          if constexpr (requires { s.inner_diameter; }) s.outer_diameter *= 2, s.inner_diameter *= 2;
          if constexpr (requires { s.width_y; }) s.width_y *= 2, s.height_z *= 2;
          if constexpr (requires { s.wall; }) s.wall *= 2;
          if constexpr (requires { s.web; }) s.web *= 2, s.flange *= 2;
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
