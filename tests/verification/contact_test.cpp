// Published Hertz contacts, by the closed form and by the spring that the MSA makes of the same law. N, mm.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analytic/deflection.h"
#include "msa/frame/laws/component.h"

namespace deflect {
namespace {

// Ansys VM63: elastic sphere R 8 mm, E 1000 N/mm², ν 0.3, on a rigid plane, F = 60π N: contact radius 1.0096354 mm
// (theory; printed 1.010), approach 0.1274205 mm, dF/dδ 2218.979 N/mm. Against a rigid plane 2/E' = (1 − ν²)/E; R' =
// R/2.
constexpr double vm63_force = 188.49555921538757;  // 60π

TEST(SphereOnPlaneVm63, ClosedForm) {
  const double R = 4, E = 2 * 1000 / (1 - 0.3 * 0.3);
  EXPECT_NEAR(analytic::point_contact_radius(R, E, vm63_force), 1.0096354, 0.51e-7);
  EXPECT_NEAR(analytic::point_contact_deflection(R, E, vm63_force), 0.1274205, 0.51e-7);
  EXPECT_NEAR(1 / analytic::point_contact_compliance(R, E, vm63_force), 2218.979, 0.51e-3);
  EXPECT_DOUBLE_EQ(analytic::point_contact_deflection(R, E, -vm63_force),
                   -analytic::point_contact_deflection(R, E, vm63_force));
}

TEST(SphereOnPlaneVm63, SpringOfTheMsa) {
  // Two bodies of one material have the compliance of one of them on a rigid plane when each is twice as stiff.
  Material material;
  material.E = 2000;
  material.nu = 0.3;
  const frame::SpringLaw spring = frame::spring_of(HertzPointLaw{"m", 4, material});
  EXPECT_NEAR(force(spring, 0.1274205), vm63_force, 1.5 * vm63_force * 0.51e-7 / 0.1274205);
  EXPECT_NEAR(tangent(spring, 0.1274205), 2218.979, 2e-3);
  EXPECT_DOUBLE_EQ(force(spring, -0.1), -force(spring, 0.1));
}

// Ansys VM191: cylinders R 10 and 13 mm, E 30000 and 29120 N/mm², ν 0.25 and 0.30, 3200 N/mm: half width 1.199714 mm.
// Both have (1 − ν²)/E = 3.125e-5, so that E' = 32000.
TEST(CylindersVm191, HalfWidth) {
  const double R = 10 * 13 / 23.0;
  EXPECT_NEAR(analytic::line_contact_half_width(R, 1, 32000, 3200), 1.199714, 0.51e-6);
}

// The linearised law has the chord of the half width as its approach, b² = 2R'δ (29). The measured approach of VM191 is
// 0.4181 mm, 3.28 times as much: the bulk of the bodies is not in (30).
TEST(CylindersVm191, LinearisedApproachIsTheChordAndLeavesTheBulkOut) {
  const double R = 10 * 13 / 23.0;
  Material material;
  material.E = 32000;
  material.nu = 0;
  const double closed = 3200 / analytic::line_contact_stiffness(1, 32000);
  const double spring = 3200 / tangent(frame::spring_of(HertzLineLaw{"m", R, 1, material}), 0);
  EXPECT_NEAR(closed, 1.199714 * 1.199714 / (2 * R), 1e-6);
  EXPECT_NEAR(spring, closed, 1e-15);
  EXPECT_NEAR(0.4181 / closed, 3.28, 0.01);
}

// With the bulk of both cylinders from their centres Johnson's formula gives 0.3995 mm where VM191 has 0.4181 mm: 4.4 %
// less, since the bodies of VM191 are held farther away.
TEST(CylindersVm191, BulkOfBothCylindersExplainsTheApproach) {
  Material material;  // both cylinders have (1 − ν²)/E = 3.125e-5
  material.E = 32000;
  material.nu = 0;
  const HertzLineBulkLaw law{"m", 10, 13, 1, material};
  const double a = 1.199714;
  const double johnson = 3200 * 3.125e-5 / std::numbers::pi * (2 * std::log(40 / a) + 2 * std::log(52 / a) - 2);
  EXPECT_NEAR(analytic::bulk_line_deflection(law, 3200), johnson, 1e-6);
  EXPECT_NEAR(force(frame::spring_of(law), analytic::bulk_line_deflection(law, 3200)), 3200, 1e-9);
  EXPECT_NEAR(analytic::bulk_line_deflection(law, 3200) / 0.4181, 0.956, 0.001);
}

}  // namespace
}  // namespace deflect
