// Both theories agree: on every built-in device all over its workspace, where the checks that at_pose.h enforces hold
// too, and on mechanisms by the dice.
#include <gtest/gtest.h>

#include "analytic/model.h"
#include "msa/frame/mechanism/msa.h"
#include "tests/support/random_mechanisms.h"
#include "validation/studies/solve.h"
#include "validation/theories/agreement.h"
#include "validation/theories/analytic_theory.h"
#include "validation/theories/msa_theory.h"

namespace deflect {
namespace {

using namespace theories;

class Agreement : public ::testing::TestWithParam<std::string> {};

// Contacts are solved to equilibrium by each theory to 1e-11 of its own; 1e-7 is asked for where they are, 1e-9 of laws
// that are linear.
TEST_P(Agreement, HoldsAllOverTheWorkspace) {
  const Mechanism m = test::device(GetParam());
  std::mt19937 random(12);
  const std::vector<Pose> poses = test::workspace_poses(m, 200, 0.08);
  ASSERT_EQ(poses.size(), 200u);
  double worst = 0, bound = 1e-9;
  for (const Pose& pose : poses) {
    const Configuration c = configure(m, pose);
    const Vector6 F = test::random_wrench(random);
    const Answer analytic = AnalyticAt(c).answer(F), msa = MsaAt(c).answer(F);
    if (!all_linear(c)) bound = 1e-7;
    worst = std::max({worst, relative_difference(twist_in_mm(analytic.displacement), twist_in_mm(msa.displacement)),
                      test::stiffness_difference(analytic.stiffness, msa.stiffness, c.size)});
  }
  EXPECT_LE(worst, bound);
}

INSTANTIATE_TEST_SUITE_P(Devices, Agreement, ::testing::ValuesIn(test::device_names()), [](const auto& p) {
  std::string name = p.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(RandomMechanisms, HaveOneComplianceByBothTheories) {
  std::mt19937 random(9);
  const std::vector<Mechanism> all = test::mechanisms(25);
  std::size_t nearly_falling = 0;
  for (const Mechanism& m : all) {
    const Configuration c = configure(m, home_pose(m));
    const Vector6 F = test::random_wrench(random);
    frame::MsaModel msa(c);
    const double difference = relative_difference(twist_in_mm(analytic::AnalyticModel(c).solve(F).displacement),
                                                  twist_in_mm(msa.solve(F).displacement));
    const double allowed = test::rounding(test::compliance_by(msa), c.size);
    EXPECT_LE(difference, std::max(1e-9, allowed)) << m.name;
    nearly_falling += allowed > 1e-9;
  }
  EXPECT_LE(nearly_falling, all.size() / 5);
}

}  // namespace
}  // namespace deflect
