// Mechanisms that are solved although they are strained before any load: misfits, and a payload that always acts.
#include <gtest/gtest.h>

#include "tests/support/devices.h"
#include "tests/support/paths.h"
#include "tests/support/theories.h"
#include "validation/studies/solve.h"
#include "validation/theories/agreement.h"

namespace deflect {
namespace {

using namespace studies;
using namespace theories;

Mechanism tripteron() { return read_mechanism(test::source_dir() + "/validation/devices/tripteron.yaml"); }

SolveResult at_home(const Mechanism& m, const Vector6& load) {
  return solve(m, stand(m, mm_deg_from(home_pose(m))), load, {});
}

TEST(Assembly, MisfitsStrainTheTripteronAndBothTheoriesSayBy) {
  const Mechanism m = test::with(tripteron(), "misfits", "[{leg: 1, base: {turn: [0 mrad, 1 mrad, 0 mrad]}}]");
  const SolveResult r = at_home(m, Vector6::Unit(0) * 100);
  ASSERT_TRUE(r.assembly);
  EXPECT_EQ(r.redundant_constraints, 3);
  const double size = test::analytic(*r.assembly).norm();
  EXPECT_GT(size, 1e-6);
  EXPECT_LT((test::analytic(*r.assembly) - test::msa(*r.assembly)).norm(), 1e-9 * size);
  Vector6 sum = Vector6::Zero();
  double largest = 0;
  for (const auto& [leg, wrench] : r.assembly->leg_wrenches_N_Nmm) {
    sum += wrench;
    largest = std::max(largest, wrench.norm());
  }
  EXPECT_GT(largest, 100);                // Nmm: the legs hold a turned seat
  EXPECT_LT(sum.norm(), 1e-9 * largest);  // and each other: nothing else is there
  EXPECT_LT(r.relative_difference, 1e-9);
  // Everything is linear: what the load does is what it does to the mechanism that fits.
  const SolveResult fits = at_home(tripteron(), Vector6::Unit(0) * 100);
  EXPECT_FALSE(fits.assembly);
  EXPECT_LT(relative_difference(test::analytic(r).displacement_mm_rad, test::analytic(fits).displacement_mm_rad), 1e-9);
}

TEST(Assembly, DeterminateMechanismTakesAMisfitWithoutForce) {
  const Mechanism m = test::with(test::device("haptic-6psu-ideal-joints"), "misfits",
                                 "[{leg: 2, platform: {shift: [0.1 mm, 0 mm, 0.05 mm]}}]");
  const SolveResult r = at_home(m, Vector6::Unit(2) * 50);
  ASSERT_TRUE(r.assembly);
  EXPECT_EQ(r.redundant_constraints, 0);
  EXPECT_LT((test::analytic(*r.assembly) - test::msa(*r.assembly)).norm(), 1e-9 * test::msa(*r.assembly).norm());
  for (const auto& [leg, wrench] : r.assembly->leg_wrenches_N_Nmm) EXPECT_LT(wrench.norm(), 1e-6) << leg;
}

TEST(Payload, ActsAsAForceOfItsWeightWithEveryLoad) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  Vector6 weight = Vector6::Zero(), load = Vector6::Unit(0) * 50;
  weight(2) = -2 * 9.80665;
  const SolveResult loaded = at_home(test::with(m, "payload", "2 kg"), load), same = at_home(m, load + weight);
  EXPECT_LT(relative_difference(test::analytic(loaded).displacement_mm_rad, test::analytic(same).displacement_mm_rad),
            1e-12);
  EXPECT_LT(relative_difference(test::msa(loaded).displacement_mm_rad, test::msa(same).displacement_mm_rad), 1e-12);
}

}  // namespace
}  // namespace deflect
