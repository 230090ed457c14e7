// `deflect add` as a user meets it: a new device, whole or not at all.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/program.h"
#include "tests/support/same_mechanism.h"

namespace deflect {
namespace {

using namespace effects;

using nlohmann::json;
using test::contents;

class AddProgram : public ::testing::Test {
 protected:
  std::string path(const std::string& name) { return "'" + (folder / name).string() + "'"; }
  std::string file(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return path(name);
  }
  test::Run add(const std::string& arguments) {
    return test::deflect("add " + arguments + " -o " + path("new.yaml") + " --json " + path("added.json"));
  }
  /// The new device under the name of the old one.
  Mechanism added(const Mechanism& before) {
    Mechanism m = read_mechanism(folder / "new.yaml");
    EXPECT_EQ(m.name, "new");
    m.name = before.name;
    m.about = before.about;
    return m;
  }
  void expect_refused(const std::string& arguments, const std::string& message) {
    const test::Run run = add(arguments);
    EXPECT_EQ(run.code, 2) << run.out;
    EXPECT_NE(run.out.find(message), std::string::npos) << run.out;
    EXPECT_FALSE(std::filesystem::exists(folder / "new.yaml"));
  }

  test::Folder folder;
  const Mechanism old = test::device("haptic-6psu");
  const std::string diagnosis = R"({
  "verdict": "effect", "missing": ["guide_root_compliance", "leg_defect"],
  "candidates": [
    {"effect": "guide_root_compliance", "site": "all legs", "probability": 0.9,
     "parameters": [{"name": "stiffness_Nmm_per_rad", "value": 5.0e6, "low95": 4.9e6, "high95": 5.1e6}]},
    {"effect": "leg_defect", "site": "leg 4", "probability": 0.06, "parameters": [{"name": "factor", "value": 0.7}]},
    {"effect": "leg_defect", "site": "leg 2", "probability": 0.03, "parameters": [{"name": "factor", "value": 0.9}]},
    {"effect": "modulus", "site": "machine", "probability": 0.01, "parameters": [{"name": "factor", "value": 0.8}]}
  ]})";
};

TEST_F(AddProgram, WritesTheDeviceWithTheEffectAndSaysSoInIt) {
  const test::Run run = add("haptic-6psu guide_root_compliance --set stiffness_Nmm_per_rad=5e6");
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_EQ(added(old), with_effect(old, test::effect("guide_root_compliance"), test::values({5e6})));
  const std::string text = contents(folder / "new.yaml");
  EXPECT_TRUE(text.starts_with("# haptic-6psu with\n#   guide_root_compliance (stiffness_Nmm_per_rad = 5e+06)\n"))
      << text;
  EXPECT_NE(
      read_mechanism(folder / "new.yaml").about.find("; with guide_root_compliance (stiffness_Nmm_per_rad = 5e+06)"),
      std::string::npos);
  EXPECT_EQ(read_mechanism(folder / "new.yaml").ours, old.ours);
  const json j = json::parse(contents(folder / "added.json"));
  EXPECT_EQ(j["added"][0]["effect"], "guide_root_compliance");
  EXPECT_EQ(j["added"][0]["site"], "all legs");
  EXPECT_EQ(j["added"][0]["parameters"][0]["value"], 5e6);
}

TEST_F(AddProgram, AddsToWhatWasAddedBefore) {
  ASSERT_EQ(add("haptic-6psu modulus --set factor=0.9").code, 0);
  std::filesystem::rename(folder / "new.yaml", folder / "first.yaml");
  ASSERT_EQ(add(path("first.yaml") + " leg_defect --leg 3 --set factor=0.5").code, 0);
  const Mechanism m = read_mechanism(folder / "new.yaml");
  EXPECT_NE(m.about.find("; with modulus (factor = 0.9); with leg_defect of leg 3 (factor = 0.5)"), std::string::npos)
      << m.about;
  EXPECT_EQ(std::get<Member>(*find(leg_parts(m, 3), "guideway")).bending_factor, 0.5);
}

TEST_F(AddProgram, TakesEffectLegAndValuesFromADiagnosis) {
  const std::string from = " --from " + file("d.json", diagnosis);
  const Mechanism root = with_effect(old, test::effect("guide_root_compliance"), test::values({5e6}));
  ASSERT_EQ(add("haptic-6psu guide_root_compliance" + from).code, 0);
  EXPECT_EQ(added(old), root);
  ASSERT_EQ(add("haptic-6psu" + from).code, 0);  // all that is missing
  EXPECT_EQ(added(old), with_effect(root, test::effect("leg_defect"), test::values({0.7}), 4));
  ASSERT_EQ(add("haptic-6psu leg_defect --leg 2" + from).code, 0);
  EXPECT_EQ(added(old), with_effect(old, test::effect("leg_defect"), test::values({0.9}), 2));
  ASSERT_EQ(add("haptic-6psu modulus --set factor=0.85" + from).code, 0);
  EXPECT_EQ(added(old), with_effect(old, test::effect("modulus"), test::values({0.85})));
}

TEST_F(AddProgram, RefusesADiagnosisThatIsNone) {
  const std::string effect = "haptic-6psu modulus --from ";
  expect_refused(effect + file("text.json", "nothing"), "not valid JSON");
  expect_refused(effect + file("other.json", "{}"), "candidates: a list is wanted");
  expect_refused(effect + file("list.json", "[1]"), "candidates: a list is wanted");
  expect_refused(
      effect + file("value.json",
                    R"({"missing": [], "candidates": [{"effect": "modulus", "parameters": [{"name": "factor"}]}]})"),
      "candidates[0].parameters: each is");
  expect_refused(effect + path("none.json"), "cannot be read");
  expect_refused("haptic-6psu joint_complience --from " + file("d.json", diagnosis),
                 "the diagnosis has no effect 'joint_complience'");
  expect_refused("haptic-6psu --from " + file("empty.json", R"({"missing": [], "candidates": []})"),
                 "the diagnosis reports no missing effect");
}

// Two effects that share the misfit: each alone would have to be larger.
TEST_F(AddProgram, TakesValuesThatWereFittedTogether) {
  std::string together = diagnosis;
  together.insert(together.rfind(']') + 1, R"(, "found": [
    {"effect": "guide_root_compliance", "site": "all legs", "parameters": [{"name": "stiffness_Nmm_per_rad", "value": 6e6}]},
    {"effect": "leg_defect", "site": "leg 2", "parameters": [{"name": "factor", "value": 0.8}]}])");
  ASSERT_EQ(add("haptic-6psu --from " + file("d.json", together)).code, 0);
  const Mechanism root = with_effect(old, test::effect("guide_root_compliance"), test::values({6e6}));
  EXPECT_EQ(added(old), with_effect(root, test::effect("leg_defect"), test::values({0.8}), 2));
  std::filesystem::remove(folder / "new.yaml");
  std::string fewer = together;
  fewer.replace(fewer.find(R"(, "leg_defect"])"), 14, "");
  expect_refused("haptic-6psu --from " + file("fewer.json", fewer), "found[1]: 'missing' names 1 effects, 'found' 2");
  std::string other = together;
  other.replace(other.rfind("leg_defect"), 10, "modulus");
  expect_refused("haptic-6psu --from " + file("other.json", other),
                 "other.json: found[1]: is 'modulus', where 'missing' has 'leg_defect'");
}

TEST_F(AddProgram, ADiagnosisThatDoesNotFitIsNamed) {
  const auto from = [&](const std::string& missing, const std::string& candidate) {
    return "haptic-6psu --from " +
           file("d.json", R"({"missing": [")" + missing + R"("], "candidates": [)" + candidate + "]}");
  };
  const auto root = [&](const std::string& parameters) {
    return from("guide_root_compliance",
                R"({"effect": "guide_root_compliance", "site": "all legs")" + parameters + "}");
  };
  const auto value = [&](const std::string& number) {
    return root(R"(, "parameters": [{"name": "stiffness_Nmm_per_rad", "value": )" + number + "}]");
  };
  const auto leg = [&](const std::string& site) {
    return from("leg_defect", R"({"effect": "leg_defect", "site": ")" + site +
                                  R"(", "parameters": [{"name": "factor", "value": 0.7}]})");
  };
  const std::string needs = "d.json: effect 'guide_root_compliance' needs a value: --set stiffness_Nmm_per_rad=1e+07";
  expect_refused(from("guide_rot_compliance", R"({"effect": "guide_rot_compliance"})"),
                 "d.json: there is no effect 'guide_rot_compliance', did you mean 'guide_root_compliance'?");
  expect_refused(from("soft_pad", R"({"effect": "soft_pad"})"),
                 "if it is one of your own, name its file with --effects FILE");
  expect_refused(from("guide_root_compliance", ""), needs);
  expect_refused(root(""), needs);
  expect_refused(root(R"(, "parameters": [])"), needs);
  expect_refused(root(R"(, "parameters": {"stiffness_Nmm_per_rad": 5e6})"),
                 "d.json: candidates[0].parameters: a list is wanted");
  expect_refused(value(R"("5e6")"), "d.json: candidates[0].parameters: each is");
  expect_refused(value("5"), "d.json: stiffness_Nmm_per_rad=5: the value must lie between 10000 and 1e+12");
  expect_refused(value("1e999"), "d.json: a number is beyond what a double holds");
  expect_refused(leg("leg 9"), "d.json: haptic-6psu: there is no leg 9");
  expect_refused(leg("legs"), "d.json: effect 'leg_defect' belongs to one leg: say which, 1 to 6");
  expect_refused("haptic-6psu --from " + file("d.json", R"({"candidates": []})"), "d.json: missing: a list is wanted");
  expect_refused("haptic-6psu --from " + file("d.json", R"({"missing": [3], "candidates": []})"),
                 "d.json: missing[0]: has no 'effect'");
}

// What the diagnosis says against adding is said, with the way out.
TEST_F(AddProgram, SaysWhatTheDiagnosisSays) {
  const auto from = [&](const std::string& verdict, const std::string& missing, const std::string& more = "") {
    return " --from " + file("d.json", R"({"verdict": ")" + verdict + R"(", "missing": )" + missing + more +
                                           diagnosis.substr(diagnosis.find(",\n  \"candidates\"")));
  };
  const auto expect_said = [&](const std::string& arguments, const std::string& words) {
    const test::Run run = add(arguments);
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find(words), std::string::npos) << run.out;
    std::filesystem::remove(folder / "new.yaml");
  };
  const std::string root = R"(["guide_root_compliance"])";
  const std::string pattern = R"(, "unexplained": {"pattern": "these look like degrees"})";
  expect_refused("haptic-6psu" + from("nothing_missing", "[]"),
                 "reports no missing effect (verdict nothing_missing): nothing has to be added");
  expect_refused(
      "haptic-6psu" + from("unknown_effect", "[]", pattern),
      "(verdict unknown_effect): these look like degrees; mend that, or name the effect and give its values");
  expect_refused("haptic-6psu" + from("unknown_effect", "[]", R"(, "unexplained": [1])"),
                 "what is missing has no name");
  expect_said("haptic-6psu modulus" + from("nothing_missing", "[]"),
              "d.json does not report 'modulus' as missing (verdict nothing_missing): it is added as it was tried");
  expect_said("haptic-6psu" + from("unknown_effect", root, pattern),
              "still missing that the diagnosis cannot name (verdict unknown_effect): these look like degrees");
  expect_said("haptic-6psu" + from("ambiguous", root), "(verdict ambiguous): 'indistinguishable' has them");
  const test::Run plain = add("haptic-6psu" + from("effect", root));
  EXPECT_EQ(plain.out.find("note: "), std::string::npos) << plain.out;
}

TEST_F(AddProgram, SaysWhereTheDiagnosisIsOfAnotherMachine) {
  const std::string mine = file("mine.yaml", test::deflect("devices haptic-6psu-ideal-joints").out);
  ASSERT_EQ(test::deflect("simulate " + mine + " --campaign paper --geometry linear -o " + path("data.csv")).code, 0);
  ASSERT_EQ(
      test::deflect("diagnose " + mine + " " + path("data.csv") + " --bootstrap 99 --json " + path("d.json")).code, 0);
  const std::string effect = " modulus --set factor=0.9 --from " + path("d.json");
  EXPECT_NE(add("haptic-6psu" + effect)
                .out.find("note: " + (folder / "d.json").string() + " is of 'haptic-6psu-ideal-joints', and"),
            std::string::npos);
  EXPECT_EQ(add(mine + effect).out.find(" is of "), std::string::npos);
  std::ofstream(folder / "mine.yaml", std::ios::app) << "# changed\n";
  const test::Run changed = add(mine + effect);
  EXPECT_EQ(changed.code, 0) << changed.out;
  EXPECT_NE(changed.out.find("is of another version of 'haptic-6psu-ideal-joints'"), std::string::npos) << changed.out;
}

TEST_F(AddProgram, RefusesValuesThatDoNotFit) {
  const std::string effect = "haptic-6psu guide_root_compliance ";
  expect_refused(effect + "--set stifness_Nmm_per_rad=5e6",
                 "has no parameter 'stifness_Nmm_per_rad', did you mean 'stiffness_Nmm_per_rad'?");
  expect_refused(effect, "needs a value: --set stiffness_Nmm_per_rad=1e+07");
  expect_refused(effect + "--set stiffness_Nmm_per_rad=5", "the value must lie between 10000 and 1e+12");
  expect_refused(effect + "--set stiffness_Nmm_per_rad=nan", "--set 'stiffness_Nmm_per_rad=nan'");
  expect_refused(effect + "--set stiffness_Nmm_per_rad=5e6Nm", "the name gives the unit");
  expect_refused(effect + "--set stiffness_Nmm_per_rad", "write name=value");
  expect_refused(effect + "--set stiffness_Nmm_per_rad=5e6 --set stiffness_Nmm_per_rad=6e6", "is set twice");
  expect_refused(effect + "--set stiffness_Nmm_per_rad=5e6 --leg 3", "it takes no leg");
  expect_refused("haptic-6psu leg_defect --set factor=0.5", "say which, 1 to 6");
  expect_refused("haptic-6psu leg_defect --set factor=0.5 --leg 7", "there is no leg 7");
  expect_refused("haptic-6psu leg_defect --set factor=0.5 --leg four", "--leg 'four'");
  expect_refused("haptic-6psu", "name the effect to add");
}

TEST_F(AddProgram, RefusesWhatTheDeviceCannotHaveAndNamesTheNearest) {
  expect_refused("haptic-6psu guide_rot_compliance --set a=1", "did you mean 'guide_root_compliance'?");
  expect_refused("haptic-6ps modulus --set factor=0.9", "did you mean 'haptic-6psu'?");
  expect_refused("tripteron carriage_compliance --set stiffness_N_per_mm=2000",
                 "no fixed joint stands at the tip of a member");
}

TEST_F(AddProgram, KnowsEffectsOfOnesOwn) {
  const std::string own = file("pad.yaml", test::effect_text());
  const test::Run run = add("fanuc-r2000ic soft_pad --set stiffness_N_per_mm=300 --effects " + own);
  ASSERT_EQ(run.code, 0) << run.out;
  const Mechanism m = read_mechanism(folder / "new.yaml");
  ASSERT_EQ(m.tool.laws[2].size(), 1u);
  EXPECT_EQ(std::get<LinearLaw>(m.tool.laws[2][0]).stiffness, 3e5);
}

}  // namespace
}  // namespace deflect
