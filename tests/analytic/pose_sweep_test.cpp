// The closed form for sweeps against the model of one pose, which it must equal.
#include "analytic/pose_sweep.h"

#include <gtest/gtest.h>

#include "analytic/model.h"
#include "tests/support/allocation_count.h"
#include "tests/support/apart.h"
#include "tests/support/devices.h"
#include "tests/support/mechanisms.h"

namespace deflect::analytic {
namespace {

using test::apart;

/// Poses near home, small steps so that every device reaches them.
std::vector<Configuration> near_home(const Mechanism& m, int count) {
  std::mt19937 random(7);
  std::vector<Configuration> out;
  while (static_cast<int>(out.size()) < count) {
    Pose pose = home_pose(m);
    pose.p_WT += test::random_vector(random, 0.01);
    try {
      out.push_back(configure(m, pose));
    } catch (const ModelError&) {
    }
  }
  return out;
}

class SweptDevice : public ::testing::TestWithParam<const char*> {};

TEST_P(SweptDevice, EqualsTheModelAtEachPose) {
  const Mechanism m = test::device(GetParam());
  const std::vector<Configuration> all = near_home(m, 20);
  PoseSweep sweep(all.front());
  ASSERT_TRUE(sweep.applies());
  std::mt19937 random(3);
  for (const Configuration& c : all) {
    const Vector6 F = test::random_wrench(random);
    const AnalyticModel model(c);
    sweep.at(c);
    for (const Vector6& load : {F, Vector6(-0.3 * F.reverse()), F}) {
      ASSERT_TRUE(sweep.solve(load));
      const AnalyticSolution s = model.solve(load);
      EXPECT_LT(apart(sweep.displacement(), s.displacement, c.size), 1e-11);
      EXPECT_LT(apart(sweep.stiffness(), model.stiffness(s), c.size), 1e-11);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Devices, SweptDevice,
                         ::testing::Values("haptic-6psu", "haptic-6psu-ideal-joints", "stewart-6ups", "tripteron"));

TEST(PoseSweep, LeavesToTheModelWhatItDoesNotKnow) {
  for (const char* name : {"delta", "hybrid"}) {
    const Mechanism m = test::device(name);
    EXPECT_FALSE(PoseSweep(configure(m, home_pose(m))).applies()) << name;
  }
  const Mechanism m = test::device("haptic-6psu");
  const Configuration c = configure(m, home_pose(m));
  PoseSweep contacts(c);
  EXPECT_FALSE(contacts.solve(Vector6::Unit(0))) << "no pose yet";
}

// By hand: each leg of the device carries along its link alone, through two contacts in series.
TEST(PoseSweep, ContactsWithoutLoadHaveNoStiffness) {
  const Mechanism m = test::device("haptic-6psu");
  const Configuration c = configure(m, home_pose(m));
  PoseSweep contacts(c);
  contacts.at(c);
  ASSERT_TRUE(contacts.solve(Vector6::Zero()));
  EXPECT_EQ(contacts.stiffness(), Matrix6(Matrix6::Zero()));
  EXPECT_EQ(contacts.displacement(), Vector6(Vector6::Zero()));
  for (const Matrix6& d : contacts.derivatives()) EXPECT_EQ(d, Matrix6(Matrix6::Zero()));
}

/// Six struts that carry one of the six directions of T each, on contacts at their ends: a force along x loads one
/// alone.
Configuration on_single_contacts() {
  const Vector3 heads[] = {{0, 0, 0}, {0, 0, 0}, {0.2, 0, 0}, {0, 0, 0}, {0.2, 0, 0}, {0, 0.2, 0}};
  std::vector<PlacedLeg> legs;
  for (int i = 0; i < 6; ++i) {
    const Vector3 head = heads[i], along = Vector3::Unit(i == 0 ? 0 : i < 3 ? 1 : 2);
    legs.push_back(test::strut("strut", head - 0.25 * along, head, 2e6));
    PlacedJoint contact = test::joint("contact", head, "rrrrrr", test::z_along(along));
    contact.laws[2].push_back(HertzPointLaw{"", 0.004, {210e9, 0.3, {}}});
    legs.back().parts.insert(legs.back().parts.begin() + 2, contact);
  }
  return test::configuration(Vector3::Zero(), legs, 0.5);
}

// The other contacts have no stiffness, and there is a load, however small: the sweep leaves it to the model.
TEST(PoseSweep, ContactsWithoutForceBesideALoadAreLeftToTheModel) {
  const Configuration c = on_single_contacts();
  PoseSweep sweep(c);
  ASSERT_TRUE(sweep.applies());
  sweep.at(c);
  EXPECT_TRUE(sweep.solve(Vector6::Zero()));
  for (const double force : {1e-3, 0.5, 50.0}) EXPECT_FALSE(sweep.solve(force * Vector6::Unit(0))) << force;
  Vector6 everywhere;
  everywhere << 3, 2, 1, 0.1, 0.2, 0.3;
  EXPECT_TRUE(sweep.solve(1e-3 * everywhere));
}

// The platform is held by its legs alone: their stiffnesses at T add up to the whole, and the wrenches to the load.
TEST(PoseSweep, LegsShareStiffnessAndLoad) {
  std::mt19937 random(5);
  for (const char* name : {"haptic-6psu", "stewart-6ups", "tripteron"}) {
    const Mechanism m = test::device(name);
    const Configuration c = configure(m, home_pose(m));
    PoseSweep sweep(c);
    sweep.at(c);
    const Vector6 F = test::random_wrench(random);
    ASSERT_TRUE(sweep.solve(F)) << name;
    Matrix6 stiffness = Matrix6::Zero();
    Vector6 wrench = -F - (Vector6() << c.weight, Vector3::Zero()).finished();
    for (std::size_t i = 0; i < c.legs.size(); ++i) {
      stiffness += sweep.leg_stiffness(i);
      wrench += sweep.leg_wrench(i);
    }
    EXPECT_LT(apart(stiffness, sweep.stiffness(), c.size), 1e-13) << name;
    EXPECT_LT(wrench.norm(), 1e-11 * F.norm()) << name;
  }
}

// Six struts are determinate, more are not; bars that bend carry several wrenches each.
TEST(PoseSweep, StrutsAndBarsOfAnyNumberEqualTheModel) {
  for (unsigned seed = 1; seed <= 10; ++seed)
    for (const int more : {0, 1, 3}) {
      std::mt19937 random(seed);
      std::vector<PlacedLeg> legs;
      for (const auto& [foot, head] : test::hexapod(random))
        legs.push_back(test::strut("strut", foot, head, test::uniform(random, 1e6, 3e6)));
      for (int i = 0; i < more; ++i) {
        const Vector3 foot = test::random_vector(random, 0.3),
                      head = Vector3(0, 0, 0.4) + test::random_vector(random, 0.1);
        legs.push_back({"bar", {test::rod("rod", foot, head, 0.006), test::joint("head", head, "rrrfrf")}});
      }
      const Configuration c = test::configuration({0, 0, 0.4}, legs, 0.5);
      const Vector6 F = test::random_wrench(random);
      PoseSweep sweep(c);
      sweep.at(c);
      ASSERT_TRUE(sweep.solve(F)) << seed;
      const AnalyticModel model(c);
      const AnalyticSolution s = model.solve(F);
      EXPECT_LT(apart(sweep.displacement(), s.displacement, c.size), 1e-11) << seed;
      EXPECT_LT(apart(sweep.stiffness(), model.stiffness(s), c.size), 1e-11) << seed;
    }
}

TEST(PoseSweep, HeatLengthensTheLegs) {
  const Mechanism m = test::with(test::device("haptic-6psu"), "materials.steel.expansion", "12e-6 1/K");
  const Configuration c = configure(m, home_pose(m));
  PoseSweep sweep(c);
  Vector6 F = 50 * Vector6::Unit(0);
  sweep.at(c);
  ASSERT_TRUE(sweep.solve(F, 7));
  Conditions warm;
  warm.warmer = 7;
  EXPECT_LT(apart(sweep.displacement(), AnalyticModel(c).solve(F, warm).displacement, c.size), 1e-11);
}

/// The same with a factor on the stiffness of one part of one leg.
Configuration scaled(Configuration c, const PoseSweep::Part& part, double factor) {
  for (PlacedPart& p : c.legs[part.leg].parts) {
    if (auto* member = std::get_if<PlacedMember>(&p); member && member->part == part.name)
      member->E *= factor, member->G *= factor;
    auto* joint = std::get_if<PlacedJoint>(&p);
    if (!joint || joint->part != part.name) continue;
    for (std::vector<Law>& laws : joint->laws)
      for (Law& law : laws) std::get<LinearLaw>(law).stiffness *= factor;
  }
  return c;
}

TEST(PoseSweep, DerivativesArePartByPart) {
  Mechanism m = test::device("haptic-6psu-ideal-joints");
  m = test::with(m, "leg.ball_joint.tz", "{law: linear, stiffness: 3000 N/mm}", Edit::Action::append);
  const Configuration c = configure(m, home_pose(m));
  const Vector6 F = Vector6::Unit(2);
  PoseSweep sweep(c);
  sweep.at(c);
  ASSERT_TRUE(sweep.solve(F));
  const std::vector<Matrix6> exact = sweep.derivatives();
  const Matrix6 K = sweep.stiffness();
  ASSERT_EQ(exact.size(), sweep.parts().size());
  ASSERT_EQ(exact.size(), 18u);  // guideway, ball joint and link of six legs
  Matrix6 sum = Matrix6::Zero();
  for (const Matrix6& d : exact) sum += d;
  EXPECT_LT(apart(sum, K, c.size), 1e-13);
  constexpr double h = 1e-4;  // what differences leave: h² of the second derivative, and rounding / h
  for (std::size_t i = 0; i < exact.size(); ++i) {
    const auto stiffness = [&](double factor) {
      const Configuration changed = scaled(c, sweep.parts()[i], factor);
      PoseSweep other(changed);
      other.at(changed);
      EXPECT_TRUE(other.solve(F));
      return other.stiffness();
    };
    const Matrix6 slope = (stiffness(1 + h) - stiffness(1 - h)) / (2 * h);
    EXPECT_LT(apart(Matrix6(K + exact[i] - slope), K, c.size), 1e-8) << sweep.parts()[i].name;
  }
}

TEST(PoseSweep, AllocatesNothingFromPoseToPose) {
  const Mechanism m = test::device("haptic-6psu");
  const std::vector<Pose> poses = test::random_poses(m, 5);
  Posing posing(m);
  PoseSweep sweep(posing.at(poses[0]));
  const Vector6 F = 50 * Vector6::Unit(1);
  sweep.at(posing.at(poses[1]));
  sweep.solve(F);
  sweep.derivatives();
  const std::size_t before = test::allocation_count();
  for (const Pose& pose : poses) {
    sweep.at(posing.at(pose));
    ASSERT_TRUE(sweep.solve(F));
    sweep.derivatives();
  }
  EXPECT_EQ(test::allocation_count(), before);
  const std::vector<double> one(1);
  EXPECT_GT(test::allocation_count(), before) << "the count does not count";
}

}  // namespace
}  // namespace deflect::analytic
