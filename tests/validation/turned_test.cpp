// No theory knows where the axes of the base point: a machine that is turned as a whole has the same answer, turned.
#include "validation/theories/turned.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/devices.h"
#include "validation/theories/agreement.h"

namespace deflect {
namespace {

using namespace theories;

class TurnedDevice : public ::testing::TestWithParam<std::string> {};

TEST_P(TurnedDevice, HasTheSameAnswerTurned) {
  const Mechanism m = test::device(GetParam());
  const Configuration c = configure(m, home_pose(m));
  const Vector6 F = (Vector6() << 30, -20, 35, 0.4, 0.3, -0.5).finished();
  for (const Theory* theory : all_theories())
    EXPECT_LT(changed_by_turning(*theory, theory->at(c, {})->answer(F), c, F), all_linear(c) ? 1e-9 : 1e-7)
        << theory->name;
}
INSTANTIATE_TEST_SUITE_P(Devices, TurnedDevice, ::testing::ValuesIn(test::device_names()), [](const auto& device) {
  std::string name = device.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// What is not turned is seen: a machine of which a part stays behind is another one.
TEST(Turned, APartThatStaysBehindIsSeen) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const Configuration c = configure(m, home_pose(m));
  const Vector6 F = 50 * Vector6::Unit(0);
  const Theory& theory = theories::theory("analytic");
  const Matrix3 R = Eigen::AngleAxisd(0.5, Vector3::UnitY()).toRotationMatrix();
  Configuration there = turned(c, R);
  const auto answer = [&] {
    Vector6 load = Vector6::Zero();
    load.head<3>() = R * F.head<3>();
    return turned_back(theory.at(there, {})->answer(load), R);
  };
  const Answer here = theory.at(c, {})->answer(F);
  EXPECT_LT(difference(answer(), here, c.size).largest(), 1e-9);
  std::get<PlacedMember>(there.legs[2].parts[1]).section.Iy *= 1.01;
  EXPECT_GT(difference(answer(), here, c.size).largest(), 1e-5);
}

}  // namespace
}  // namespace deflect
