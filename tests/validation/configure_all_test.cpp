#include "validation/measurement/configure_all.h"

#include <gtest/gtest.h>

#include "tests/support/devices.h"
#include "tests/support/measurements.h"

namespace deflect {
namespace {

using namespace measurement;

template <class Error>
std::string message(const Mechanism& m, const std::string& text) {
  try {
    configure_all(m, parse_measurements(text, "data.csv"));
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(ConfigureAll, OncePerPose) {
  const Mechanism m = test::device("haptic-6psu");
  const auto configurations = configure_all(m, parse_measurements(test::usual_file("b,0,0,174,0,0,0,50,0,0,1,1,1\n"
                                                                                   "a,5,0,174,0,0,9,50,0,0,1,1,1\n"
                                                                                   "b,0,0,174,0,0,0,-50,0,0,1,1,1\n"),
                                                                  "data.csv"));
  ASSERT_EQ(configurations.size(), 2u);
  EXPECT_EQ(configurations[0].pose.p_WT, Vector3(0, 0, 0.174));
  EXPECT_EQ(configurations[1].pose.p_WT, Vector3(0.005, 0, 0.174));
  EXPECT_TRUE(configurations[1].pose.R_WT.isApprox(rotation_from_rpy(0, 0, 9 * pi / 180), 1e-15));
}

TEST(ConfigureAll, FromJointCoordinates) {
  const Mechanism m = test::device("tripteron");
  const std::vector<Actuator> home = actuators_of(m);
  const auto configurations = configure_all(
      m, parse_measurements(fmt::format("pose,q1_mm,q2_mm,q3_mm,fx_N,fy_N,fz_N,ux_mm\n1,{},{},{},1,0,0,1\n",
                                        1e3 * home[0].value, 1e3 * home[1].value, 1e3 * home[2].value),
                            "data.csv"));
  ASSERT_EQ(configurations.size(), 1u);
  EXPECT_TRUE(configurations[0].pose.p_WT.isApprox(home_pose(m).p_WT, 1e-9));
}

TEST(ConfigureAll, PosesOutOfReachAreNamedWithTheirLine) {
  const Mechanism m = test::device("haptic-6psu");
  const std::string good = "a,0,0,174,0,0,0,50,0,0,1,1,1\n";
  for (const char* z : {"900", "-1e12", "1e11", "1e-300"}) {
    const std::string said =
        message<ModelError>(m, test::usual_file(good + fmt::format("far,0,0,{},0,0,0,50,0,0,1,1,1\n", z)));
    EXPECT_TRUE(said.starts_with("data.csv:3: column 'pose': 'far': haptic-6psu at (0, 0, ")) << said;
  }
}

TEST(ConfigureAll, JointCoordinatesMustBeTheDevices) {
  const Mechanism arm = test::device("fanuc-r2000ic");
  EXPECT_EQ(message<InputError>(arm, "pose,q1_rad,q2_mm,fx_N,fy_N,fz_N,ux_mm\n1,0,0,1,0,0,1\n"),
            "data.csv:1: joint coordinates q1_rad, q2_mm are given, but fanuc-r2000ic has q1_rad, q2_rad, q3_rad, "
            "q4_rad, q5_rad, q6_rad");
  EXPECT_NE(
      message<InputError>(test::device("tripteron"), "pose,q1_mm,q2_rad,q3_mm,fx_N,fy_N,fz_N,ux_mm\n1,0,0,0,1,0,0,1\n"),
      "");
}

}  // namespace
}  // namespace deflect
