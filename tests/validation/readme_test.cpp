// What the READMEs show as a whole works as it stands there.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "msa/base/files.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/frames.h"
#include "tests/support/paths.h"
#include "tests/support/theories.h"
#include "validation/measurement/configure_all.h"
#include "validation/measurement/measurements.h"
#include "validation/studies/solve.h"

namespace deflect {
namespace {

using namespace effects;
using namespace measurement;
using namespace studies;

/// The blocks of code of a language in the README of a room, from a heading on.
std::vector<std::string> blocks(const std::string& room, const std::string& heading, const std::string& language) {
  const std::string text = read_text(test::source_dir() + "/" + room + "/README.md"), fence = "```" + language + "\n";
  std::vector<std::string> found;
  for (std::size_t at = text.find("\n" + heading + "\n"); (at = text.find(fence, at)) != text.npos;) {
    at += fence.size();
    found.push_back(text.substr(at, text.find("```", at) - at));
  }
  return found;
}

TEST(Readme, ItsFirstDeviceHasAtMostTwentyLinesAndIsSolvedByBothTheories) {
  const std::string yaml = blocks("msa/mechanism", "## A device of your own", "yaml").at(0);
  EXPECT_LE(std::count(yaml.begin(), yaml.end(), '\n'), 20);
  const Mechanism m = parse_mechanism(yaml, "README.md");
  Vector6 load = Vector6::Zero();
  load(2) = -100;
  const Configuration c = configure_joints(m, Eigen::Vector2d(0.3, 1.2));
  const SolveResult r = solve(m, {mm_deg_from(c.pose), c}, load, {});
  EXPECT_LT(r.relative_difference, 1e-9);
  EXPECT_LT(test::msa(r).displacement_mm_rad(2), 0);
}

TEST(Readme, ItsFrameIsSolved) {
  const std::string yaml = blocks("msa/frame", "## A frame of your own", "yaml").at(0);
  const test::Solved s(frame::parse_frame(yaml, "README.md"));
  EXPECT_EQ(frame::failed_check(s.result), "");
  ASSERT_EQ(s.result.cases.size(), 2u);
  EXPECT_GT(s.u("B", 0)(0), 0);
  EXPECT_NEAR(s.reaction("A", 1)(2) + s.reaction("D", 1)(2), 1200, 1e-6);
}

TEST(Readme, ItsEffectIsOneThatEveryDeviceCanHave) {
  const Effect e = parse_effect(blocks("validation/effects", "## An effect of your own", "yaml").at(0), "README.md");
  for (const char* name : {"haptic-6psu", "delta", "fanuc-r2000ic"}) {
    const Mechanism m = with_effect(test::device(name), e, test::values({300, 2e5}));
    EXPECT_EQ(std::get<LinearLaw>(m.tool.laws[2].at(0)).stiffness, 3e5);
    EXPECT_EQ(std::get<LinearLaw>(m.tool.laws[4].at(0)).stiffness, 200);
  }
}

TEST(Readme, ItsMeasurementsAreReadForADevice) {
  const std::vector<std::string> files = blocks("validation/measurement", "## A measurement file", "csv");
  ASSERT_EQ(files.size(), 2u);
  const Mechanism device = test::device("haptic-6psu-ideal-joints");
  const Measurements plain = parse_measurements(files[0], "README.md"),
                     other = parse_measurements(files[1], "README.md");
  EXPECT_EQ(plain.how_read, std::vector<std::string>());
  EXPECT_EQ(configure_all(device, plain).size(), 2u);
  EXPECT_EQ(plain.readings.size(), 5u);
  EXPECT_FALSE(plain.readings[2].displacement[2]);

  // The last two readings once more, in a laboratory's units.
  EXPECT_EQ(configure_all(device, other).size(), 1u);
  ASSERT_EQ(other.readings.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const Reading &a = plain.readings[3 + i], &b = other.readings[i];
    EXPECT_LT((a.load - b.load).norm(), 1e-3);
    EXPECT_NEAR(*a.displacement[0], *b.displacement[0], 1e-12);
    EXPECT_NEAR(*a.sigma_u, *b.sigma_u, 1e-12);
    EXPECT_NEAR(a.temperature_C, b.temperature_C, 1e-9);
  }
  EXPECT_FALSE(other.readings[1].displacement[2]);
  EXPECT_GT(other.how_read.size(), 10u);
}

}  // namespace
}  // namespace deflect
