// Where effects can act in machines, and the laws there that no entry of the catalogue names.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "msa/base/error.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/place_effects.h"
#include "validation/effects/with_effect.h"
#include "validation/subject/machine_places.h"

namespace deflect {
namespace {

using namespace effects;
using namespace subject;

std::vector<Place> with_id(const Mechanism& m, const std::string& id) {
  std::vector<Place> out;
  for (const Place& p : places_of(m))
    if (id_of(p) == id) out.push_back(p);
  return out;
}

Place only(const Mechanism& m, const std::string& id) {
  const std::vector<Place> found = with_id(m, id);
  EXPECT_EQ(found.size(), 1U) << id;
  return found.empty() ? Place() : found.front();
}

const std::vector<Effect>& laws_of(const std::string& device) {
  static std::map<std::string, std::vector<Effect>> all;
  if (!all.contains(device)) all[device] = place_effects(test::device(device), test::all_effects());
  return all[device];
}

TEST(Places, AreWhatAPartIsNotWhatItIsCalled) {
  const Mechanism delta = test::device("delta"), arm = test::device("arm"), flexure = test::device("flexure");
  EXPECT_EQ(only(delta, "motor.rz").kind, PlaceKind::drive);
  EXPECT_EQ(only(delta, "motor.rz").hold, Hold::elastic);
  EXPECT_EQ(only(delta, "motor.tilt").kind, PlaceKind::clamp);  // the root of the arm
  EXPECT_EQ(only(delta, "forearm.knee.rx").hold, Hold::free);
  EXPECT_EQ(only(delta, "forearm.knee.rx").path, "leg.forearm.leg.knee");
  EXPECT_EQ(only(delta, "forearm.rod.start.tx").kind, PlaceKind::line);
  EXPECT_EQ(only(flexure, "leaf.start.rz").kind, PlaceKind::clamp);
  EXPECT_EQ(only(flexure, "leaf.end.rz").kind, PlaceKind::member_end);
  EXPECT_EQ(only(flexure, "mounts.4.stack.tx").hold, Hold::elastic);
  EXPECT_TRUE(only(arm, "joint_1.rx").one_stiffness);
  EXPECT_TRUE(only(arm, "joint_1.tilt").one_stiffness);  // of one bearing
  EXPECT_EQ(only(arm, "tool.across").freedoms, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(only(arm, "sections.fore_tube.inner_diameter").kind, PlaceKind::member);
}

// A part's name decides nothing: the same machine under other names has the same places of the same kinds.
TEST(Places, DoNotHangOnNames) {
  Mechanism m = test::device("tripteron");
  const std::vector<Place> before = places_of(m);
  for (auto& [name, part] : m.leg) name = "part_" + name;
  const std::vector<Place> after = places_of(m);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].kind, after[i].kind);
    EXPECT_EQ(before[i].freedoms, after[i].freedoms);
    EXPECT_EQ(before[i].hold, after[i].hold);
  }
}

class LawsAtPlaces : public testing::TestWithParam<std::string> {};

TEST_P(LawsAtPlaces, StandInEveryMachineWithIdsOfTheirOwn) {
  const Mechanism m = test::device(GetParam());
  std::set<std::string> ids;
  for (const Effect& e : test::all_effects()) ids.insert(e.name);
  for (const Effect& e : laws_of(GetParam())) {
    EXPECT_TRUE(ids.insert(e.name).second) << e.name;
    EXPECT_FALSE(places_of(e, m).empty()) << e.name << ": " << why_not(e, m).value_or("");
    EXPECT_EQ(e.pages.machine.find("{}"), std::string::npos);
  }
  EXPECT_GE(laws_of(GetParam()).size(), 20U);
}

// Each is also a file to start one's own from, which says the same.
TEST_P(LawsAtPlaces, AreFilesOfTheirOwn) {
  const std::vector<Effect>& all = laws_of(GetParam());
  for (std::size_t i = 0; i < all.size(); i += 7) {
    const Effect read = parse_effect(write_effect(all[i]), all[i].name);
    ASSERT_EQ(read.parameters.size(), all[i].parameters.size());
    for (std::size_t k = 0; k < read.parameters.size(); ++k) {
      EXPECT_EQ(read.parameters[k].start, all[i].parameters[k].start);
      EXPECT_EQ(read.parameters[k].vanishes, all[i].parameters[k].vanishes);
    }
    ASSERT_EQ(read.edits.size(), all[i].edits.size());
    EXPECT_EQ(read.edits.front().paths, all[i].edits.front().paths);
  }
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, LawsAtPlaces,
                         testing::Values("haptic-6psu-ideal-joints", "haptic-6psu", "tripteron", "delta",
                                         "stewart-6ups", "hybrid", "fanuc-r2000ic", "arm", "scara", "gantry", "flexure",
                                         "3-rrr", "3-upu"),
                         [](const auto& at) { return std::regex_replace(at.param, std::regex("-"), "_"); });

// What an entry does is not offered a second time under another name.
TEST(LawsAtPlacesOfTheHapticDevice, DoNotRepeatEntries) {
  for (const Effect& e : laws_of("haptic-6psu-ideal-joints"))
    for (const char* same :
         {"linear@actuator.tz", "linear@ball_joint.tz", "linear@leg.ball_joint.tz", "clearance@ball_joint.tz",
          "clearance@actuator.tz", "linear@mount.tz", "linear@actuator.tilt", "linear@carriage.across",
          "factor@leg.guideway", "factor@sections.guide_rod.diameter", "pull@actuator.tz", "hardening@actuator.tz"})
      EXPECT_NE(e.name, same);
}

const Effect* named(const std::string& device, const std::string& id) {
  const std::vector<Effect>& all = laws_of(device);
  const auto found = std::find_if(all.begin(), all.end(), [&](const Effect& e) { return e.name == id; });
  return found == all.end() ? nullptr : &*found;
}

// Wear takes one leg: play, friction and hardening are laws of one leg wherever they are of all, with a title, pages
// and edits of their own.
TEST(LawsInOneLeg, AreThoseThatWear) {
  for (const auto& [device, part] :
       {std::pair{"stewart-6ups", "slide.tz"}, {"delta", "motor.rz"}, {"3-rrr", "motor.rz"}})
    for (const char* law : {"clearance", "hardening", "friction"}) {
      const std::string id = std::string(law) + "@leg." + part;
      const Effect* e = named(device, id);
      ASSERT_TRUE(e) << device << ": " << id;
      EXPECT_EQ(e->scope, Scope::one_leg) << id;
      EXPECT_NE(e->title.find(" of one leg "), std::string::npos) << e->title;
      EXPECT_EQ(places_of(*e, test::device(device)).size(), device == std::string("stewart-6ups") ? 6U : 3U) << id;
    }
  for (const char* id : {"friction@leg.universal_joint.ry", "clearance@leg.ball_joint.tz", "hardening@leg.actuator.tz"})
    EXPECT_TRUE(named("haptic-6psu", id)) << id;
}

// What yields alike in many parts of a leg is of one make; wear is of one part.
TEST(LawsInOneLeg, OfAGroupAreWhatItsMakeIs) {
  for (const char* device : {"haptic-6psu", "tripteron", "delta", "stewart-6ups", "3-upu"})
    for (const Effect& e : laws_of(device))
      if (e.scope == Scope::one_leg && !e.place->others.empty()) {
        EXPECT_TRUE(e.name.starts_with("linear@") || e.name.starts_with("factor@")) << device << ": " << e.name;
      }
}

TEST(LawsInOneLeg, AreNoneWhereThereIsOneLeg) {
  for (const char* device : {"arm", "scara", "gantry", "fanuc-r2000ic"})
    for (const Effect& e : laws_of(device)) EXPECT_NE(e.scope, Scope::one_leg) << device << ": " << e.name;
}

// The entries that name a kind of place find it in machines of other makes.
TEST(EntriesByKindOfPlace, ActOnOtherMachines) {
  for (const auto& [entry, device] : {std::pair{"joint_compliance", "delta"},
                                      {"joint_clearance", "stewart-6ups"},

                                      {"guide_root_compliance", "gantry"},
                                      {"leg_joint_compliance", "stewart-6ups"},
                                      {"hertz_contact", "delta"}})
    EXPECT_FALSE(places_of(test::effect(entry), test::device(device)).empty())
        << entry << " in " << device << ": " << why_not(test::effect(entry), test::device(device)).value_or("");
}

}  // namespace
}  // namespace deflect
