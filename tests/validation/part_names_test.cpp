// Effects of the catalogue find their places by what parts are, not by what they are called.
#include <gtest/gtest.h>

#include <map>

#include "analytic/model.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/stand.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/subject/part_roles.h"

namespace deflect {
namespace {

/// Every part and every section called otherwise: "part-3", "section-1".
Mechanism renamed(Mechanism m) {
  std::map<std::string, std::string> sections;
  for (auto& [name, section] : m.sections) {
    sections[name] = "section-" + std::to_string(sections.size());
    name = sections[name];
  }
  std::size_t count = 0;
  for (auto& [name, part] : m.leg) {
    name = "part-" + std::to_string(count++);
    if (auto* member = std::get_if<Member>(&part)) member->section = sections.at(member->section);
  }
  return parse_mechanism(write_mechanism(m), "renamed");
}

/// K at home under 50 N in the middle of x, y and z.
Matrix6 stiffness(const Mechanism& m) {
  const analytic::AnalyticModel model(configure(m, home_pose(m)));
  Vector6 F = Vector6::Zero();
  F.head<3>().setConstant(50 / std::sqrt(3));
  return model.stiffness(model.solve(F));
}

class OtherNames : public testing::TestWithParam<const char*> {};

TEST_P(OtherNames, HaveTheSameEffects) {
  const Mechanism drawn = test::device(GetParam()), other = renamed(drawn);
  int there = 0;
  for (const effects::Effect& e : test::all_effects()) {
    const std::optional<int> leg = test::some_leg(e);
    const auto why = effects::why_not(e, drawn, leg), otherwise = effects::why_not(e, other, leg);
    EXPECT_EQ(why.has_value(), otherwise.has_value()) << e.name << ": " << otherwise.value_or(why.value_or(""));
    if (why || otherwise) continue;
    ++there;
    const VectorX start = effects::start_values(e);
    EXPECT_EQ(stiffness(effects::with_effect(drawn, e, start, leg)),
              stiffness(effects::with_effect(other, e, start, leg)))
        << e.name;
  }
  EXPECT_GE(there, 26);
}

INSTANTIATE_TEST_SUITE_P(SixPsu, OtherNames, testing::Values("haptic-6psu", "haptic-6psu-ideal-joints"),
                         [](const auto& p) {
                           return std::string(p.param) == "haptic-6psu" ? "Contacts" : "IdealJoints";
                         });

TEST(PartRoles, OfTheSixPsu) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  using Paths = std::vector<std::string>;
  EXPECT_EQ(subject::guides(m), Paths{"leg.actuator"});
  EXPECT_EQ(subject::guided_members(m), Paths{"leg.guideway"});
  EXPECT_EQ(subject::guided_sections(m), Paths{"guide_rod"});
  EXPECT_EQ(subject::carriages(m), Paths{"leg.carriage"});
  EXPECT_EQ(subject::pivots_of_bars(m), Paths{"leg.ball_joint"});
  EXPECT_EQ(subject::seats(m), Paths{"leg.mount"});
}

TEST(PartRoles, OfAMachineWithoutSlides) {
  const Mechanism m = test::device("arm");
  EXPECT_TRUE(subject::guides(m).empty());
  EXPECT_TRUE(subject::guided_sections(m).empty());
  EXPECT_TRUE(subject::carriages(m).empty());
  EXPECT_TRUE(subject::pivots_of_bars(m).empty());
  EXPECT_TRUE(subject::seats(m).empty());
}

}  // namespace
}  // namespace deflect
