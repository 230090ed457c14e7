// Theories from pose to pose against those made for one pose, with every effect of the catalogue in the device: laws of
// all kinds, joints anywhere, legs of their own.
#include <gtest/gtest.h>

#include "analytic/pose_sweep.h"
#include "msa/frame/mechanism/msa_sweep.h"
#include "tests/support/apart.h"
#include "tests/support/catalogue_names.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/mechanisms.h"
#include "validation/theories/theory.h"

namespace deflect {
namespace {

using namespace effects;
using namespace theories;

double apart(const Answer& a, const Answer& b, double length) {
  return std::max(test::apart(a.displacement, b.displacement, length), test::apart(a.stiffness, b.stiffness, length));
}

void expect_equal(const Mechanism& m) {
  std::vector<std::unique_ptr<TheoryAt>> swept;
  const Vector6 F = (Vector6() << 30, -20, 35, 0.4, 0.3, -0.5).finished();
  for (const Vector3& step : {Vector3(0, 0, 0), Vector3(0.012, -0.007, 0.009)}) {
    Pose pose = home_pose(m);
    pose.p_WT += step;
    const Configuration c = configure(m, pose);
    TheoryOptions condensed{m.name};
    condensed.condense = true;
    for (std::size_t t = 0; t < all_theories().size(); ++t) {
      const Theory& theory = *all_theories()[t];
      if (swept.size() == t) swept.push_back(theory.at(c, condensed));
      swept[t]->move_to(c);
      const auto alone = theory.at(c, {m.name});
      const Answer loaded = alone->answer(F);
      EXPECT_LT(apart(swept[t]->answer(F), loaded, c.size), 1e-9) << theory.name;
      // Without load contacts have no stiffness: what they hold alone is free, and of that only rounding may be left.
      const Answer expected = alone->answer(Vector6::Zero()), unloaded = swept[t]->answer(Vector6::Zero());
      EXPECT_LT((unloaded.stiffness - expected.stiffness).norm(), 1e-9 * loaded.stiffness.norm()) << theory.name;
      EXPECT_LT((unloaded.displacement - expected.displacement).norm(), 1e-9 * loaded.displacement.norm());
    }
  }
}

class SweptWithEffect : public ::testing::TestWithParam<std::string> {};

TEST_P(SweptWithEffect, EqualsTheTheoriesOfOnePose) {
  const Effect& e = test::effect(GetParam());
  for (const char* name : {"haptic-6psu-ideal-joints", "haptic-6psu"}) {
    const Mechanism m = test::device(name);
    const std::vector<PlacedEffect> places = places_of(e, m);
    if (!places.empty()) expect_equal(with_effect(m, e, start_values(e), places.back().leg));
  }
}
INSTANTIATE_TEST_SUITE_P(Catalogue, SweptWithEffect, ::testing::ValuesIn([] {
                           std::vector<std::string> names;
                           for (const std::string& name : test::catalogue_names())
                             if (name != "geometric_nonlinearity") names.push_back(name);
                           return names;
                         }()),
                         [](const auto& named) { return named.param; });

// An arm carries six wrenches. By hand: without load the contacts of its elbow are two free joints, whose motions of T
// meet no resistance, and the other four meet that of the rods.
TEST(Swept, AnArmWithContactsWithoutLoad) {
  const Vector3 root(0.1, -0.2, 0), elbow(0.35, 0.1, 0.2), tip(0.3, 0.4, 0.55);
  PlacedJoint contacts = test::joint("elbow", elbow, "rrrrrr", test::z_along({1, 2, -0.5}));
  contacts.laws[2].emplace_back(PowerLaw{2e-6, 10, 2.0 / 3});
  contacts.laws[3].emplace_back(PowerLaw{1e-4, 5, 2.0 / 3});
  contacts.laws[5].emplace_back(LinearLaw{3e4});
  const PlacedLeg arm = {"arm",
                         {test::rod("upper", root, elbow, 0.02), contacts, test::rod("fore", elbow, tip, 0.015)}};
  const Configuration c = test::configuration(tip, {arm}, 0.5);
  Matrix6X free = Matrix6X::Zero(6, 2);
  const Vector3 z = contacts.R_WJ.col(2), x = contacts.R_WJ.col(0);
  free.col(0).head<3>() = z;
  free.col(1) << x.cross(tip - elbow), x;
  analytic::PoseSweep closed_form(c);
  closed_form.at(c);
  ASSERT_TRUE(closed_form.applies() && closed_form.solve(Vector6::Zero()));
  frame::MsaSweep msa(c);
  msa.at(c);
  ASSERT_TRUE(msa.applies() && msa.solve(Vector6::Zero()));
  TheoryOptions condensed{"arm"};
  condensed.condense = true;
  std::vector<Answer> unloaded;
  for (const Theory* theory : all_theories()) {
    const auto swept = theory->at(c, condensed), alone = theory->at(c, {"arm"});
    unloaded.push_back(swept->answer(Vector6::Zero()));
    const Matrix6& K = unloaded.back().stiffness;
    EXPECT_LT(test::apart(K, alone->answer(Vector6::Zero()).stiffness, c.size), 1e-9) << theory->name;
    EXPECT_LT((K * free).norm(), 1e-9 * K.norm() * free.norm()) << theory->name;
    EXPECT_EQ(Eigen::FullPivLU<Matrix6>(K).setThreshold(1e-9).rank(), 4) << theory->name;
    EXPECT_TRUE(unloaded.back().displacement.isZero(0)) << theory->name;
  }
  EXPECT_LT(test::apart(unloaded[0].stiffness, unloaded[1].stiffness, c.size), 1e-9);
}

TEST(Swept, EveryDeviceEqualsTheTheoriesOfOnePose) {
  for (const char* name : {"stewart-6ups", "tripteron", "delta", "hybrid"}) {
    SCOPED_TRACE(name);
    expect_equal(test::device(name));
  }
}

}  // namespace
}  // namespace deflect
