// Every mistake in a device file is told with its line, its path and the way out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "msa/base/error.h"
#include "msa/mechanism/device_file.h"

namespace deflect {
namespace {

// The line numbers below count from "name" = 1.
const std::string good = R"(name: small
kinematics:
  family: 6-psu
  base_radius: 118 mm
  platform_radius: 55 mm
  link_length: 125.5 mm
  base_angle: 25 deg
  platform_angle: 16 deg
  slider_min: 10 mm
  slider_max: 200 mm
materials:
  steel: {E: 210 GPa, nu: 0.3}
sections:
  guide_rod:
    shape: round
    diameter: 8 mm
  tube: {shape: tube, outer_diameter: 8 mm, inner_diameter: 6 mm}
  given: {shape: given, A: 1 mm^2, Iy: 1 mm^4, Iz: 1 mm^4, J: 2 mm^4}
leg:
  actuator: {joint: prismatic, at: A, axes: guide}
  guideway: {member: guide_rod, material: steel, from: A, to: B}
  ball_joint:
    joint: ball
    at: B
    axes: link
    tz: {law: linear, stiffness: 500 N/mm}
  link: {member: guide_rod, material: steel, from: B, to: C}
variations:
  - {leg: 4, path: guideway.bending_factor, value: 0.5}
tolerances:
  modulus: 1 %
)";

struct Mistake {
  const char* old_text;
  const char* new_text;
  int line;
  std::vector<const char*> says;
};

const std::vector<Mistake> mistakes = {
    // Keys
    {"    diameter",
     "    diametre",
     16,
     {"sections.guide_rod.diametre: unknown key, did you mean 'diameter'? (known: shape, diameter)"}},
    {"    diameter: 8 mm\n", "", 14, {"sections.guide_rod: 'diameter' is missing", "'diameter: 10 mm'"}},
    {"tolerances:", "tolerance:", 30, {"tolerance: unknown key, did you mean 'tolerances'?"}},
    {"name: small\n", "", 1, {"'name' is missing", "name: \"text\""}},
    {"  base_radius: 118 mm\n",
     "  base_radius: 118 mm\n  base_radius: 118 mm\n",
     5,
     {"kinematics.base_radius: given twice, first on line 4"}},
    {"{E: 210 GPa, nu: 0.3}", "{E: 210 GPa, nu: 0.3, E: 200 GPa}", 12, {"materials.steel.E: given twice"}},
    {"  link: {", "  guideway: {", 27, {"leg.guideway: given twice, first on line 21"}},
    {"shape: round", "shap: round", 15, {"sections.guide_rod.shap: unknown key, did you mean 'shape'?"}},
    {"    shape: round\n", "", 14, {"sections.guide_rod: 'shape' is missing", "'shape: round'"}},
    {"{joint: prismatic, at", "{jiont: prismatic, at", 20, {"leg.actuator.jiont: unknown key, did you mean 'joint'?"}},
    {"{joint: prismatic, at", "{at", 20, {"leg.actuator: one of 'joint', 'member' is wanted"}},
    {"{joint: prismatic, at",
     "{member: guide_rod, joint: prismatic, at",
     20,
     {"leg.actuator: only one of 'joint', 'member'"}},
    {"    at: B\n", "    at: B\n    member: guide_rod\n", 22, {"leg.ball_joint: only one of"}},
    {"  family: 6-psu\n", "  family: 6-psu\n  <<: {a: b}\n", 4, {"kinematics.<<: unknown key"}},
    {"  family: 6-psu\n", "  family: 6-psu\n  [a, b]: c\n", 4, {"a key must be a name"}},
    {"  family: 6-psu\n", "  family: 6-psu\n  ~: c\n", 4, {"a key is missing"}},
    {"  guideway:", "  guide.way:", 21, {"leg.guide.way: a name begins with a letter"}},
    {"  guideway:", "  4:", 21, {"leg.4: a name begins with a letter"}},
    // Quantities
    {"diameter: 8 mm", "diameter: 8", 16, {"sections.guide_rod.diameter: '8' has no unit", "'8 mm'"}},
    {"diameter: 8 mm", "diameter: 8 N", 16, {"is a force, where a length is wanted"}},
    {"diameter: 8 mm", "diameter: 8 mn", 16, {"unknown unit 'mn', did you mean 'mm'?"}},
    {"diameter: 8 mm", "diameter: -8 mm", 16, {"'-8 mm' must be above 0 mm"}},
    {"diameter: 8 mm", "diameter: 0 mm", 16, {"'0 mm' must be above 0 mm"}},
    {"diameter: 8 mm", "diameter: .nan", 16, {"'.nan' is not a length"}},
    {"diameter: 8 mm", "diameter: 1e400 mm", 16, {"'1e400 mm' is not a length"}},
    {"diameter: 8 mm", "diameter: 010", 16, {"'010' has no unit"}},
    {"diameter: 8 mm", "diameter: no", 16, {"'no' is not a length"}},
    {"diameter: 8 mm", "diameter:", 16, {"sections.guide_rod.diameter: has no value", "'diameter: 10 mm'"}},
    {"diameter: 8 mm", "diameter: ~", 16, {"sections.guide_rod.diameter: has no value"}},
    {"diameter: 8 mm", "diameter: !ours", 16, {"sections.guide_rod.diameter: has no value"}},
    {"diameter: 8 mm", "diameter: \"\"", 16, {"'' is not a length"}},
    {"diameter: 8 mm", "diameter: [8 mm]", 16, {"a single value is wanted, not a list"}},
    {"diameter: 8 mm", "diameter: {mm: 8}", 16, {"a single value is wanted, not a map"}},
    {"diameter: 8 mm", "diameter: 8 mm\n      and more", 16, {"unknown unit 'mm and more'"}},
    {"base_angle: 25 deg", "base_angle: 125 deg", 7, {"kinematics.base_angle", "between 0 deg and 120 deg"}},
    {"base_angle: 25 deg", "base_angle: 25", 7, {"kinematics.base_angle", "has no unit", "'25 deg'"}},
    {"stiffness: 500 N/mm", "stiffness: 500 Nmm/rad", 26, {"leg.ball_joint.tz.0.stiffness", "rotational stiffness"}},
    {"    tz: {law",
     "    rz: {law",
     26,
     {"leg.ball_joint.rz.0.stiffness", "a rotational stiffness (moment per angle) is wanted"}},
    {"modulus: 1 %", "modulus: -1 %", 31, {"tolerances.modulus: '-1 %' must be between 0 and 1"}},
    {"modulus: 1 %", "modulus: 1 mm", 31, {"tolerances.modulus"}},
    {"modulus: 1 %", "modulus: 1 %\n  load_position: 1 mm", 32, {"unknown key, did you mean 'joint_position'?"}},
    // Conditions across fields
    {"nu: 0.3}", "nu: 0.5}", 12, {"materials.steel.nu: '0.5' must be strictly between -1 and 0.5"}},
    {"nu: 0.3}", "nu: 0.3, G: 80 GPa}", 12, {"materials.steel.G: nu and G are both given"}},
    {", nu: 0.3}", "}", 12, {"materials.steel.nu: is missing: give nu or G"}},
    {"nu: 0.3}", "G: 60 GPa}", 12, {"materials.steel.G: gives Poisson's ratio 0.75"}},
    {"inner_diameter: 6 mm",
     "inner_diameter: 8 mm",
     17,
     {"sections.tube.inner_diameter: must be below outer_diameter"}},
    {"slider_min: 10 mm", "slider_min: 300 mm", 10, {"kinematics.slider_max: must be above slider_min"}},
    {"slider_min: 10 mm", "slider_min: 0 mm", 9, {"kinematics.slider_min: '0 mm' must be above 0 mm"}},
    {"member: guide_rod, material: steel, from: A, to: B",
     "member: given, material: steel, from: A, to: B, beam: timoshenko",
     21,
     {"leg.guideway.beam: timoshenko needs As_y and As_z in section 'given'"}},
    {"from: A, to: B", "from: A, to: A", 21, {"leg.guideway.to: must be another point than 'from'"}},
    {"from: A, to: B", "from: A, to: B, bending_factor: 0", 21, {"leg.guideway.bending_factor: '0' must be above 0"}},
    // Names
    {"member: guide_rod, material: steel, from: A",
     "member: guide_rd, material: steel, from: A",
     21,
     {"leg.guideway.member: unknown section 'guide_rd', did you mean 'guide_rod'?"}},
    {"material: steel, from: A", "material: steal, from: A", 21, {"unknown material 'steal', did you mean 'steel'?"}},
    {"from: A, to: B", "from: A, to: D", 21, {"leg.guideway.to: unknown point 'D'", "known: A, B, C"}},
    {"axes: guide}", "axes: giude}", 20, {"unknown set of axes 'giude', did you mean 'guide'?"}},
    {"joint: ball", "joint: bal", 23, {"leg.ball_joint.joint: unknown joint type 'bal', did you mean 'ball'?"}},
    {"law: linear", "law: liner", 26, {"leg.ball_joint.tz.0.law: unknown law 'liner', did you mean 'linear'?"}},
    {"    tz: {law: linear, stiffness: 500 N/mm}",
     "    rx: {law: hertz_point, material: steel, radius: 4 mm}",
     26,
     {"leg.ball_joint.rx.0.law: 'hertz_point' acts along a translation", "'linear'"}},
    {"family: 6-psu", "family: 6-pus", 3, {"unknown family '6-pus', did you mean '6-psu'?"}},
    {"from: B, to: C", "from: B, to: C, beam: timoshenk", 27, {"did you mean 'timoshenko'?"}},
    {"shape: round", "shape: around", 15, {"unknown shape 'around', did you mean 'round'?"}},
    // Shapes of the tree
    {"  ball_joint:\n    joint: ball\n    at: B\n    axes: link\n    tz: {law: linear, stiffness: 500 N/mm}\n",
     "  ball_joint: ball\n",
     22,
     {"leg.ball_joint: a map of fields"}},
    {"tz: {law: linear, stiffness: 500 N/mm}", "tz: 500 N/mm", 26, {"leg.ball_joint.tz.0: a map of fields"}},
    {"tz: {law: linear, stiffness: 500 N/mm}", "tz: [[]]", 26, {"leg.ball_joint.tz.0: a map of fields"}},
    {"tz: {law: linear, stiffness: 500 N/mm}", "tz:", 26, {"leg.ball_joint.tz.0: is empty"}},
    {"tolerances:\n  modulus: 1 %\n", "tolerances:\n", 30, {"tolerances: is empty"}},
    {"tolerances:\n  modulus: 1 %\n",
     "workspace: {cube_edge: 50 mm}\n",
     30,
     {"workspace: 'nominal_slider' is missing"}},
    {"tolerances:\n  modulus: 1 %\n",
     "rig: {sensor: {drift: [0 mm, 0 mm]}}\n",
     30,
     {"rig.sensor.drift: a list of three values"}},
    {"tolerances:\n  modulus: 1 %\n",
     "rig: {sensor: {drift: [0 mm, 0 mm, 1]}}\n",
     30,
     {"rig.sensor.drift.2: '1' has no unit"}},
    {"tolerances:\n  modulus: 1 %\n",
     "base: {joint: ball}\n",
     30,
     {"base.joint: unknown joint type of base or tool 'ball' (known: fixed)"}},
    {"tolerances:\n  modulus: 1 %\n", "base: {at: A}\n", 30, {"base.at: unknown key"}},
    {"tolerances:\n  modulus: 1 %\n",
     "tool: {tz: {law: cable, material: steel, area: 1 mm^2}}\n",
     30,
     {"tool.tz.0.length: is needed here"}},
    {"{E: 210 GPa, nu: 0.3}", "steel", 12, {"materials.steel: a map of fields"}},
    {"name: small", "name:", 1, {"name: has no value"}},
    {"name: small", "name: ''", 1, {"name: is empty"}},
    {"name: small", "name: [small]", 1, {"name: a single value is wanted, not a list"}},
    // Variations
    {"leg: 4", "leg: 7", 29, {"variations.0.leg: '7' must be a whole number from 1 to 6"}},
    {"leg: 4", "leg: 4.0", 29, {"variations.0.leg: '4.0' must be a whole number"}},
    {"path: guideway.", "path: guidway.", 29, {"leg[4].guidway: there is no 'guidway', did you mean 'guideway'?"}},
    {"bending_factor, value",
     "bendin_factor, value",
     29,
     {"leg[4].guideway.bendin_factor", "did you mean 'bending_factor'?"}},
    {"value: 0.5", "value: -0.5", 29, {"leg[4].guideway.bending_factor: '-0.5' must be above 0"}},
    {"value: 0.5", "value: ~", 29, {"variations.0.value: has no value"}},
    {"path: guideway.bending_factor, value: 0.5",
     "path: guideway, value: {member: guide_rod, material: steel, from: A}",
     29,
     {"leg[4].guideway: 'to' is missing"}},
    {"path: guideway.bending_factor, value: 0.5",
     "path: guideway.member, value: rod",
     29,
     {"leg[4].guideway.member: unknown section 'rod'"}},
    // YAML
    {"diameter: 8 mm", "diameter: &d 8 mm", 16, {"sections.guide_rod.diameter: anchors and aliases"}},
    {"diameter: 8 mm", "diameter: *d", 16, {"not valid YAML"}},
    {"diameter: 8 mm", "diameter: !theirs 8 mm", 16, {"sections.guide_rod.diameter: unknown tag '!theirs'", "!ours"}},
    {"diameter: 8 mm", "diameter: !!float 8", 16, {"unknown tag"}},
    {"    diameter: 8 mm", "    !ours diameter: 8 mm", 16, {"a tag stands before the value"}},
    {"    diameter: 8 mm",
     "\tdiameter: 8 mm",
     16,
     {"not valid YAML: the line is indented with a tab; YAML wants spaces"}},
    {"{E: 210 GPa, nu: 0.3}", "{E: 210 GPa, nu: 0.3", 13, {"not valid YAML"}},
    {"modulus: 1 %", "modulus: \"1 %", 31, {"a quotation is not closed"}},
    {"modulus: 1 %\n", "modulus: 1 %\n---\nname: other\n", 32, {"a second document"}},
    {"modulus: 1 %\n", "modulus: 1 %\n...\nname: other\n", 33, {"a second document"}},
    // yaml-cpp finds empty documents here for ever.
    {"modulus: 1 %\n", "modulus: 1 %\n...\n,name: other\n", 33, {"not valid YAML", "expected here"}},
    {"name: small",
     "name: sm\x04"
     "all",
     1,
     {"control character 0x04"}},
    {"name: small",
     "name: sm\xff"
     "all",
     1,
     {"byte 0xff is not UTF-8"}},
    {"name: small", "name: sm\xc0\xaf", 1, {"byte 0xc0 is not UTF-8"}},
};

std::string refusal(const std::string& text) {
  try {
    parse_mechanism(text, "my.yaml");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(BadDevice, TheDeviceWithoutMistakesIsRead) { EXPECT_EQ(refusal(good), ""); }

TEST(BadDevice, MistakesAreToldWithLineAndRemedy) {
  for (const Mistake& m : mistakes) {
    std::string text = good;
    const std::size_t at = text.find(m.old_text);
    ASSERT_NE(at, text.npos) << m.old_text;
    text.replace(at, std::string(m.old_text).size(), m.new_text);
    const std::string message = refusal(text), place = "my.yaml:" + std::to_string(m.line) + ": ";
    EXPECT_EQ(message.substr(0, place.size()), place) << message << "\n  for " << m.new_text;
    for (const char* phrase : m.says)
      EXPECT_NE(message.find(phrase), message.npos) << message << "\n  lacks: " << phrase << "\n  for " << m.new_text;
  }
}

TEST(BadDevice, TextsThatAreNoDevice) {
  for (const char* text : {"",
                           "\n\n",
                           "# nothing\n",
                           "~",
                           "[]",
                           "- a\n- b\n",
                           "name",
                           "42",
                           "{",
                           "}",
                           ":",
                           "!ours {name: a}",
                           "\xff\xfe"
                           "n",
                           "{name: a} b",
                           "\"",
                           "'",
                           "a: |",
                           "&a",
                           "*a",
                           "%",
                           "@",
                           "\t",
                           "? a",
                           "name: a\nname"}) {
    const std::string message = refusal(text);
    EXPECT_EQ(message.substr(0, 8), "my.yaml:") << "'" << text << "': " << message;
  }
}

TEST(BadDevice, AnyCutOrSwappedByteIsReadOrRefusedWithALine) {
  const int lines = static_cast<int>(std::count(good.begin(), good.end(), '\n'));
  for (std::size_t i = 0; i < good.size(); ++i)
    for (const char* with : {"", ":", "\"", "{", "\n", "\t", "!", "0", "]"}) {
      std::string text = good;
      text.replace(i, 1, with);
      const std::string message = refusal(text);  // any other kind of exception fails the test
      if (message.empty()) continue;
      ASSERT_EQ(message.substr(0, 8), "my.yaml:") << message;
      const int line = std::atoi(message.c_str() + 8);
      ASSERT_TRUE(line >= 1 && line <= lines + 1) << message << "\n" << text;
    }
  for (std::size_t i = 0; i < good.size(); ++i) refusal(good.substr(0, i));
}

}  // namespace
}  // namespace deflect
