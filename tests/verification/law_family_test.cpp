// Every law of the table, on a translation and on a rotation of a drive, by every theory: what a new row must fulfil. A
// new law is tested here without another line.
#include <gtest/gtest.h>

#include "msa/mechanism/device_file.h"
#include "tests/support/laws.h"
#include "validation/studies/solve.h"
#include "validation/studies/workspace.h"

namespace deflect {
namespace {

using namespace studies;
using namespace theories;

using test::law_of;
using test::LawSite;
using test::with_law;

class LawFamily : public ::testing::TestWithParam<LawSite> {};

TEST_P(LawFamily, IsReadAsItsRowAndReadsBackAsItWasWritten) {
  const Mechanism m = with_law(GetParam());
  const Law& law = law_of(m, GetParam());
  EXPECT_EQ(&row_of(law), GetParam().law);
  EXPECT_TRUE(law_of(parse_mechanism(write_mechanism(m), "written"), GetParam()) == law);
}

TEST_P(LawFamily, HasOneAnswerInAllTheoriesInEveryGeometry) {
  const Mechanism m = with_law(GetParam());
  const ValidationPoint point = workspace_points(m)[3];
  const Vector6 load = (Vector6() << 30, -20, 35, 400, 300, -500).finished();
  for (const Geometry geometry : {Geometry::linear, Geometry::second_order, Geometry::finite})
    EXPECT_NO_THROW(solve(m, stand(m, point.pose_mm_deg), load, {}, geometry))
        << geometry_names[static_cast<int>(geometry)];
}

// K is what a small change of the load meets: K (d(F + hF) − d(F − hF)) / 2h = F, to the square of h for a law without
// a kink there, and to what equilibrium is known to. In second order forces change with the load and K does not know
// it.
TEST_P(LawFamily, TheStiffnessIsTheDerivativeOfTheForce) {
  const Mechanism m = with_law(GetParam());
  const Configuration c = stand(m, workspace_points(m)[3].pose_mm_deg).configuration;
  const Vector6 F = (Vector6() << 30, -20, 35, 0, 0, 0).finished();
  constexpr double h = 1e-4;
  for (const Theory* theory : all_theories())
    for (const Geometry geometry : {Geometry::linear, Geometry::finite}) {
      // The closed form takes jumps, in the deformed shape, as in the straight one: K is the linear one there.
      if (GetParam().law->curve == Curve::jumps && geometry != Geometry::linear) continue;
      const auto machine = theory->at(c, {m.name, frame::equal_division(c, 8)});
      const Vector6 more = machine->answer((1 + h) * F, geometry).displacement,
                    less = machine->answer((1 - h) * F, geometry).displacement;
      Vector6 change = more - less;
      if (geometry == Geometry::finite) {  // the rotation is a vector, K is per spin
        const Eigen::AngleAxisd spin(rotation_from_vector(more.tail<3>()) *
                                     rotation_from_vector(less.tail<3>()).transpose());
        change.tail<3>() = spin.angle() * spin.axis();
      }
      const Vector6 met = machine->answer(F, geometry).stiffness * change / (2 * h);
      EXPECT_LE((met - F).head<3>().norm(), 1e-5 * F.norm()) << theory->name;
      EXPECT_LE((met - F).tail<3>().norm(), 1e-5 * F.norm() * c.size) << theory->name;
    }
}

// Work equals the energy that all parts store, U = ∫ d·dF on the way: trapezes of 1/20 of the load leave (1/20)² of it.
TEST_P(LawFamily, TheEnergyIsTheWorkOfTheLoad) {
  if (GetParam().law->has_history) GTEST_SKIP() << "friction turns work into heat";
  const Mechanism m = with_law(GetParam());
  const Configuration c = stand(m, workspace_points(m)[3].pose_mm_deg).configuration;
  const Vector6 F = (Vector6() << 30, -20, 35, 0, 0, 0).finished();
  for (const Theory* theory : all_theories()) {
    const auto machine = theory->at(c, {m.name});
    constexpr int steps = 20;
    // The gap closes at no load; its travel stores nothing.
    double stored = total(machine->answer(F / steps).energies), work = stored;
    Vector6 before = machine->answer(F / steps).displacement;
    for (int k = 2; k <= steps; ++k) {
      const Vector6 here = machine->answer(F * k / steps).displacement;
      work += (k - 0.5) / steps * F.dot(here - before);
      before = here;
    }
    stored = total(machine->answer(F).energies);
    EXPECT_NEAR(stored / work, 1, 1.0 / (steps * steps)) << theory->name;
  }
}

INSTANTIATE_TEST_SUITE_P(Table, LawFamily, ::testing::ValuesIn(test::law_sites()),
                         [](const auto& site) { return test::name_of(site.param); });

}  // namespace
}  // namespace deflect
