// A machine as a measured thing; frames are in measured_frame_test.cpp.
#include "validation/subject/subject.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "msa/base/error.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/devices.h"
#include "tests/support/measurements.h"
#include "validation/compare/comparison.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/measurement/configure_all.h"

namespace deflect {
namespace {

using namespace compare;
using namespace diagnosis;
using namespace measurement;
using namespace prediction;
using namespace subject;

TEST(MachineSubject, PredictsWhatTheMachineDoes) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const Measurements data = parse_measurements(test::usual_file("a,0,0,174,0,0,0,50,0,0,1,1,1\n"
                                                                "b,10,0,180,0,0,0,0,20,-30,1,1,1\n"),
                                               "data.csv");
  const Subject subject = m;
  const std::shared_ptr<const Standing> standing = subject.stand(data);
  EXPECT_EQ(standing->predict(data, {}), predict(m, configure_all(m, data), data, {}));
  EXPECT_EQ(standing->poses(), 2u);
  EXPECT_EQ(standing->sites(0).size(), 6u);
  EXPECT_EQ(subject.legs(), 6);
  const Subject soft = subject.edited({{"materials.*.E", "0.5", Edit::Action::multiply}});
  EXPECT_GT(soft.stand(data)->predict(data, {})[0](0), standing->predict(data, {})[0](0));
}

// A tolerance is a difference of predictions: twice the modulus' deviation in the Young's modulus of all members is
// what the prediction changes by, to first order.
TEST(MachineSubject, IsOffByItsTolerances) {
  Mechanism m = test::device("haptic-6psu-ideal-joints");
  m.tolerances = {};
  m.tolerances.modulus = 1e-4;
  m.tolerances.actuator_repeatability = 1e-5;
  const Measurements data = parse_measurements(test::usual_file("a,0,0,174,0,0,0,50,0,0,1,1,1\n"
                                                                "b,10,0,180,0,0,0,0,20,-30,1,1,1\n"),
                                               "data.csv");
  const std::shared_ptr<const Standing> standing = Subject(m).stand(data);
  const std::unique_ptr<const Deviations> off = standing->deviations(data);
  ASSERT_EQ(off->tolerances().size(), 13u);
  EXPECT_EQ(off->tolerances()[0].name, "modulus");
  EXPECT_FALSE(off->tolerances()[0].pose);
  EXPECT_EQ(off->tolerances()[7].pose, 1u);
  EXPECT_EQ(off->with(7)->poses(), 1u);
  const Subject stiffer = Subject(m).edited({{"materials.*.E", "1.0001", Edit::Action::multiply}});
  const std::vector<VectorX> expected = stiffer.stand(data)->predict(data, {}), d = off->with(0)->predict(data, {});
  for (std::size_t i = 0; i < d.size(); ++i) EXPECT_LE((d[i] - expected[i]).norm(), 1e-12 * d[i].norm());
}

// A tolerance of a number is the difference that the same edit of the description makes: a gear's stiffness where the
// geometry stays, an arm's length where the drives stay and the platform goes elsewhere.
TEST(MachineSubject, IsOffByTolerancesOfItsNumbers) {
  Mechanism m = test::device("delta");
  m.tolerances = {};
  m.tolerances.numbers = {
      {"drive.stiffness", "1 %"}, {"materials.carbon_tube.E", "1 %"}, {"leg[2].arm.along.0", "1 um"}};
  const Pose home = home_pose(m);
  const Measurements data = parse_measurements(
      test::usual_file(fmt::format("a,0,0,{:.17g},0,0,0,50,0,20,1,1,1\n", 1e3 * home.p_WT.z())), "d.csv");
  const std::unique_ptr<const Deviations> off = Subject(m).stand(data)->deviations(data);
  ASSERT_EQ(off->tolerances().size(), 5u);
  EXPECT_EQ(off->tolerances()[1].name, "leg 2 motor rz stiffness");
  EXPECT_EQ(off->tolerances()[4].name, "leg 2 arm along x");
  const std::vector<std::pair<std::size_t, Edit>> same = {
      {1, {"leg[2].motor.rz.stiffness", "1.01", Edit::Action::multiply}},
      {3, {"materials.carbon_tube.E", "1.01", Edit::Action::multiply}}};
  for (const auto& [k, edit] : same) {
    const Vector6 expected = Subject(m).edited({edit}).stand(data)->predict(data, {})[0];
    EXPECT_LE((off->with(k)->predict(data, {})[0] - expected).norm(), 1e-9 * expected.norm()) << k;
  }
  // The drives stay: the tool point itself has moved, by about as much as the arm is longer.
  const double moved = (off->with(4)->tool(0).p_W - home.p_WT).norm();
  EXPECT_GT(moved, 0.2e-6);
  EXPECT_LT(moved, 3e-6);
}

// A motor of K = 1e5 Nm/rad beside a rigid friction of F = 1 Nm. A load of ±10 Nm that comes and goes leaves δ = F/K,
// which readings count from: an unknown start moves all readings beyond the friction by ∓F/K, one standard deviation of
// it (1/√3 of the largest load, far beyond F) as much as the largest load.
TEST(MachineSubject, AnUnknownStartOfFrictionIsATolerance) {
  const auto device = [](const std::string& start) {
    return Subject(parse_mechanism(R"(
name: motor
kinematics: {family: chains}
leg:
  drive:
    joint: motor
    rz: {law: linear, stiffness: 1e5 Nm/rad}
    beside: {rz: {law: friction, moment: 1 Nm, stiffness: 1e12 Nm/rad, start: )" +
                                       start + "}}\n",
                                   "motor.yaml"));
  };
  const std::string csv = "pose,q1_rad,fx_N,fy_N,fz_N,mz_Nmm,thz_rad,sequence\n1,0,0,0,0,1e4,0,1\n1,0,0,0,0,-1e4,0,2\n";
  const measurement::Measurements data = measurement::parse_measurements(csv, "data.csv");
  const Subject s = device("unknown");
  const auto standing = s.stand(data);
  const auto deviations = standing->deviations(data);
  ASSERT_EQ(deviations->tolerances().size(), 1u);
  EXPECT_EQ(deviations->tolerances()[0].name, "pose 1 start of friction");
  EXPECT_NEAR(deviations->tolerances()[0].sigma, std::sqrt(1.0 / 3), 1e-15);  // of a uniform number from −1 to 1
  const std::vector<VectorX> drawn = deviations->drawn().predict(data), moved = deviations->with(0)->predict(data);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(drawn[i](5), (i == 0 ? 9 : -9) * 1e-5, 1e-12);
    EXPECT_NEAR(moved[i](5) - drawn[i](5), -1e-5, 1e-12);
  }
  EXPECT_TRUE(device("relaxed").stand(data)->deviations(data)->tolerances().empty());
}

}  // namespace
}  // namespace deflect
