// A machine as a measured thing; frames are in measured_frame_test.cpp.
#include "validation/subject/subject.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "msa/frame/file/frame_file.h"
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

}  // namespace
}  // namespace deflect
