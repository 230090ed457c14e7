// Where an effect acts, read off the machine: every effect of the catalogue that is of the machine changes parts of it.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/effects/changed_parts.h"

namespace deflect {
namespace {

using namespace effects;

Configuration at_home(const Mechanism& m) { return configure(m, home_pose(m)); }

std::vector<ChangedPart> changed(const Mechanism& m, const Effect& e, const VectorX& values, std::optional<int> leg) {
  return changed_parts(at_home(m), at_home(with_effect(m, e, values, leg)));
}

TEST(ChangedParts, NothingWithoutAChange) {
  for (const char* name : {"haptic-6psu", "delta", "tripteron", "fanuc-r2000ic"}) {
    const Configuration c = at_home(test::device(name));
    EXPECT_TRUE(changed_parts(c, c).empty()) << name;
  }
}

TEST(ChangedParts, AClampThatYieldsIsTheActuatorOfEveryLeg) {
  const auto parts = changed(test::device("haptic-6psu-ideal-joints"), test::effect("guide_root_compliance"),
                             test::values({5e6}), std::nullopt);
  ASSERT_EQ(parts.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(parts[i], (ChangedPart{"leg " + std::to_string(i + 1), "actuator"}));
}

TEST(ChangedParts, ADamagedLegIsThatLegAlone) {
  const auto parts =
      changed(test::device("haptic-6psu-ideal-joints"), test::effect("leg_defect"), test::values({0.7}), 4);
  EXPECT_EQ(parts, (std::vector<ChangedPart>{{"leg 4", "guideway"}}));
}

TEST(ChangedParts, EffectsOfTheRigChangeNoPartAndThoseOfPartsDo) {
  for (const char* name : {"haptic-6psu-ideal-joints", "haptic-6psu", "delta", "fanuc-r2000ic"}) {
    const Mechanism m = test::device(name);
    for (const Effect& e : test::all_effects())
      for (const PlacedEffect& place : places_of(e, m)) {
        const auto parts = changed(m, e, start_values(e), place.leg);
        const bool of_the_machine = e.scope != Scope::rig && e.name != "geometric_nonlinearity";
        EXPECT_EQ(!parts.empty(), of_the_machine) << name << ", " << e.name;
        for (const ChangedPart& p : parts)
          EXPECT_TRUE(!place.leg || p.leg.starts_with("leg " + std::to_string(*place.leg))) << name << ", " << e.name;
      }
  }
}

}  // namespace
}  // namespace deflect
