// `deflect effects` as a user meets it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/effects.h"
#include "tests/support/program.h"

namespace deflect {
namespace {

using namespace effects;

using nlohmann::json;
using test::contents;

class EffectsProgram : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return "'" + (folder / name).string() + "'";
  }
  test::Folder folder;
};

TEST_F(EffectsProgram, ListsTheCatalogueWithParametersAndScope) {
  const test::Run run = test::deflect("effects");
  ASSERT_EQ(run.code, 0) << run.out;
  for (const Effect& e : test::all_effects()) {
    EXPECT_NE(run.out.find("\n" + e.name + " "), std::string::npos) << e.name;
    EXPECT_NE(run.out.find(e.title), std::string::npos) << e.name;
    for (const EffectParameter& p : e.parameters) EXPECT_NE(run.out.find(p.name), std::string::npos) << e.name;
  }
}

TEST_F(EffectsProgram, ExplainsOne) {
  const test::Run run = test::deflect("effects guide_root_compliance");
  ASSERT_EQ(run.code, 0) << run.out;
  for (const char* text :
       {"The clamp of every guideway yields", "Scope: all legs", "In the machine", "In the data", "On the bench",
        "Cure", "stiffness_Nmm_per_rad", "Nmm/rad", "absent at infinity", "leg.<guide>.rx append"})
    EXPECT_NE(run.out.find(text), std::string::npos) << text << "\n" << run.out;
}

TEST_F(EffectsProgram, ItsFileStartsOnesOwn) {
  const test::Run run = test::deflect("effects carriage_compliance --yaml");
  ASSERT_EQ(run.code, 0) << run.out;
  std::string own = run.out;
  EXPECT_EQ(own, contents(test::effect("carriage_compliance").origin));
  own.replace(own.find("carriage_compliance"), 19, "soft_carriage");
  const test::Run listed = test::deflect("effects --effects " + file("own.yaml", own));
  EXPECT_EQ(listed.code, 0);
  EXPECT_NE(listed.out.find("soft_carriage "), std::string::npos) << listed.out;
  EXPECT_EQ(test::deflect("effects --yaml").code, 2);
}

TEST_F(EffectsProgram, SaysWhichADeviceCanHaveAndWhyNotTheOthers) {
  const std::string out = "'" + (folder / "e.json").string() + "'";
  const test::Run run = test::deflect("effects --device fanuc-r2000ic --json " + out);
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("effects that fanuc-r2000ic can have"), std::string::npos);
  EXPECT_NE(run.out.find("no fixed joint stands at the tip of a member"), std::string::npos);
  const json all = json::parse(contents(folder / "e.json"));
  std::size_t entries = 0, at_places = 0;
  for (const json& e : all) ++(e.contains("place") ? at_places : entries);
  EXPECT_EQ(entries, test::all_effects().size());
  EXPECT_GT(at_places, 20U);
  EXPECT_NE(run.out.find("joint_1.rz               drive     factor clearance"), std::string::npos) << run.out;
  for (const json& e : all) {
    EXPECT_EQ(e["applies"].get<bool>(), !e.contains("reason"));
    if (e["effect"] == "motor_compliance") {
      EXPECT_EQ(e["applies"], true);
    }
    if (e["effect"] == "guide_root_compliance") {
      EXPECT_EQ(e["applies"], false);
      EXPECT_EQ(e["scope"], "all legs");
      const json p = e["parameters"][0];
      EXPECT_EQ(p["name"], "stiffness_Nmm_per_rad");
      EXPECT_EQ(p["unit"], "Nmm/rad");
      EXPECT_EQ(p["vanishes"], "infinity");
      EXPECT_LT(p["low"].get<double>(), p["high"].get<double>());
      EXPECT_EQ(e["pages"].size(), 4u);
    }
  }
}

TEST_F(EffectsProgram, RefusesWhatItCannotRead) {
  const test::Run name = test::deflect("effects guide_rot_compliance");
  EXPECT_EQ(name.code, 2);
  EXPECT_NE(name.out.find("did you mean 'guide_root_compliance'?"), std::string::npos) << name.out;
  const test::Run bad =
      test::deflect("effects --effects " + file("bad.yaml", test::effect_text("law: linear", "law: liner")));
  EXPECT_EQ(bad.code, 2);
  EXPECT_NE(bad.out.find("bad.yaml:7: edits.0.append.law: unknown law 'liner'"), std::string::npos) << bad.out;
  EXPECT_EQ(test::deflect("effects --effects /no/such.yaml").code, 2);
  const test::Run twice = test::deflect("effects --effects " + file("a.yaml", test::effect_text()) + " --effects " +
                                        file("b.yaml", test::effect_text()));
  EXPECT_EQ(twice.code, 2);
  EXPECT_NE(twice.out.find("b.yaml:1: name: there is an effect 'soft_pad' already"), std::string::npos) << twice.out;
}

}  // namespace
}  // namespace deflect
