// What the README shows as a whole works as it stands there.
#include <gtest/gtest.h>

#include <algorithm>

#include "msa/base/files.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/compare/solve_result.h"
#include "validation/compare/theories.h"

namespace deflect {
namespace {

/// The first block of YAML behind a heading.
std::string yaml_after(const std::string& text, const std::string& heading) {
  const std::string fence = "```yaml\n";
  const std::size_t from = text.find(fence, text.find(heading)) + fence.size();
  return text.substr(from, text.find("```", from) - from);
}

TEST(Readme, ItsFirstDeviceHasAtMostTwentyLinesAndIsSolvedByBothTheories) {
  const std::string yaml = yaml_after(read_text(DEFLECT_SOURCE_DIR "/README.md"), "### A device of your own");
  EXPECT_LE(std::count(yaml.begin(), yaml.end(), '\n'), 20);
  const Mechanism m = parse_mechanism(yaml, "README.md");
  Vector6 load = Vector6::Zero();
  load(2) = -100;
  const Configuration c = configure_joints(m, Eigen::Vector2d(0.3, 1.2));
  const SolveResult r = solve(m, {mm_deg_from(c.pose), c}, load, {});
  EXPECT_LT(r.relative_difference, 1e-9);
  EXPECT_LT(r.msa.displacement_mm_rad(2), 0);
}

TEST(Readme, ItsEffectIsOneThatEveryDeviceCanHave) {
  const Effect e =
      parse_effect(yaml_after(read_text(DEFLECT_SOURCE_DIR "/README.md"), "### An effect of your own"), "README.md");
  for (const char* name : {"haptic-6psu", "delta", "fanuc-r2000ic"}) {
    const Mechanism m = with_effect(test::device(name), e, test::values({300, 2e5}));
    EXPECT_EQ(std::get<LinearLaw>(m.tool.laws[2].at(0)).stiffness, 3e5);
    EXPECT_EQ(std::get<LinearLaw>(m.tool.laws[4].at(0)).stiffness, 200);
  }
}

}  // namespace
}  // namespace deflect
