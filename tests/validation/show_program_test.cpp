// `deflect show` and the schemas, as a user meets them.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/support/page.h"
#include "tests/support/paths.h"
#include "validation/page/page.h"

namespace deflect {
namespace {

using namespace page;

using nlohmann::json;
using test::contents;

class ShowProgram : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return "'" + (folder / name).string() + "'"; }
  void write(const std::string& name, const std::string& text) const { std::ofstream(folder / name) << text; }
  json shown(const std::string& arguments) const {
    const test::Run run = test::deflect("show " + arguments + " --json " + path("d.json"));
    EXPECT_EQ(run.code, 0) << run.out;
    out = run.out;
    return json::parse(contents(folder / "d.json"));
  }

  test::Folder folder;
  mutable std::string out;
};

/// Two links in a plane, of which nothing holds the second.
const std::string loose = R"(
name: loose
kinematics: {family: chains}
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {bar: {shape: rectangle, width_y: 10 mm, height_z: 30 mm}}
leg:
  lower: {member: bar, material: steel, along: [300 mm, 0 mm, 0 mm]}
  hinge: {joint: revolute}
  upper: {member: bar, material: steel, along: [0 mm, 200 mm, 0 mm]}
)";

TEST_F(ShowProgram, SensorsAndPointsOfLoadAreShown) {
  const std::string held = std::regex_replace(loose, std::regex("revolute"), "fixed");
  write("d.yaml", held +
                      "sensors: {probe: {point: [50 mm, 0 mm, 0 mm], direction: [0.6, 0, 0.8]}}\n"
                      "loads: {handle: {body: tool, point: [0 mm, 0 mm, 25 mm]}}\n");
  const json d = shown(path("d.yaml"));
  ASSERT_EQ(d.at("instruments").size(), 2u) << d;
  EXPECT_EQ(d["instruments"][0], json({{"name", "probe"},
                                       {"words", "sensor on the platform"},
                                       {"at_mm", {350.0, 200.0, 0.0}},
                                       {"axis", {0.6, 0.0, 0.8}}}));
  EXPECT_EQ(d["instruments"][1],
            json({{"name", "handle"}, {"words", "load on the tool"}, {"at_mm", {300.0, 200.0, 25.0}}}));
  EXPECT_NE(out.find("sensor on the platform"), std::string::npos) << out;
}

TEST_F(ShowProgram, MembersAndJointsStandAsTheyAreDrawn) {
  const json d = shown("scara");
  EXPECT_EQ(d.at("drawing"), "device");
  EXPECT_EQ(d.at("trouble"), "");
  ASSERT_EQ(d.at("members").size(), 4u);
  const json& upper = d.at("members").at(1);
  EXPECT_EQ(upper.at("part"), "upper_link");
  EXPECT_NEAR(upper.at("length_mm").get<double>(), 300, 1e-9);
  EXPECT_EQ(upper.at("size_mm"), json({100.0, 70.0}));
  EXPECT_NEAR(upper.at("start_mm").at(2).get<double>(), 300, 1e-6);
  EXPECT_NEAR(upper.at("axes").at(2).at(2).get<double>(), 1, 1e-12) << "local z points up";
  std::vector<std::string> driven;
  for (const json& joint : d.at("joints"))
    if (joint.at("driven")) driven.push_back(joint.at("part"));
  EXPECT_EQ(driven, (std::vector<std::string>{"shoulder", "elbow", "screw", "wrist"}));
  for (const char* word : {"upper_link", "link, aluminium", "drives rz; laws on rx ry rz", "driven: shoulder", "300"})
    EXPECT_NE(out.find(word), out.npos) << word << "\n" << out;
  // Where it is told to stand.
  const json moved = shown("scara --pose 380,50,160");
  EXPECT_NEAR(moved.at("pose_mm_deg").at(0).get<double>(), 380, 1e-9);
}

TEST_F(ShowProgram, FramesShowTheirNodesAndWhatHoldsThem) {
  const json d = shown("portal");
  EXPECT_EQ(d.at("drawing"), "frame");
  EXPECT_EQ(d.at("members").size(), 3u);
  EXPECT_EQ(d.at("frames").size(), 4u);
  EXPECT_EQ(d.at("frames").at(0).at("held"), "ux uy uz rx ry rz");
  EXPECT_EQ(d.at("frames").at(1).at("held"), "");
  EXPECT_NEAR(d.at("members").at(1).at("axes").at(2).at(2).get<double>(), 1, 1e-12) << "its web stands upright";
}

TEST_F(ShowProgram, FramesShowTheirSpringsLawsLoadCasesAndSensors) {
  const json portal = shown("portal-semi-rigid"), rail = shown("beam-on-springs");
  EXPECT_EQ(rail.at("springs").at(1).at("name"), "pad1");
  EXPECT_EQ(rail.at("springs").at(1).at("words"), "N2 to the ground; uz: 20000 N/mm");
  EXPECT_EQ(rail.at("loads").at(0).at("words"), "N1: fz -20000 N");
  EXPECT_EQ(rail.at("sensors").size(), 8u);
  EXPECT_EQ(rail.at("sensors").at(7).at("words"), "strain of member rail4 at 1 of its length, y = 0 mm, z = -70 mm");
  ASSERT_FALSE(portal.at("laws").empty());
  EXPECT_NE(portal.at("laws").at(0).at("words").get<std::string>().find("linear"), std::string::npos);
  for (const char* word : {"pad1", "N2 to the ground; uz: 20000 N/mm", "load case", "at 9", "S_mid"})
    EXPECT_NE(out.find(word), out.npos) << word << "\n" << out;
}

TEST_F(ShowProgram, WhatCannotStandIsDrawnWithItsMotions) {
  write("loose.yaml", loose);
  const json d = shown(path("loose.yaml"));
  ASSERT_EQ(d.at("motions").size(), 1u);
  EXPECT_NE(d.at("trouble").get<std::string>().find("it cannot stand: 1 motion that nothing resists"),
            std::string::npos);
  // The upper bar turns about z at (300, 0, 0): its end moves along x, by a tenth of the machine's diagonal.
  const json& u = d.at("motions").at(0).at("displacement_mm");
  double largest = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double y = d.at("points_mm").at(i).at(1), dx = u.at(i).at(0), dy = u.at(i).at(1), dz = u.at(i).at(2);
    EXPECT_NEAR(std::abs(dx), y / 200 * std::hypot(300, 200) / 10, 1e-6);
    EXPECT_NEAR(std::hypot(dy, dz), 0, 1e-6);
    largest = std::max(largest, std::abs(dx));
  }
  EXPECT_NEAR(largest, std::hypot(300, 200) / 10, 1e-6);
  EXPECT_NE(out.find("upper"), out.npos) << out;
}

TEST_F(ShowProgram, LoopsThatDoNotCloseShowEachLegAlone) {
  std::string text = contents(test::source_dir() + "/validation/devices/3-rrr.yaml");
  const std::size_t at = text.find("180 mm");
  write("open.yaml", text.replace(at, 6, "30 mm"));  // cranks that cannot reach
  const json d = shown(path("open.yaml"));
  EXPECT_NE(d.at("trouble").get<std::string>().find("Each leg is drawn alone"), std::string::npos) << d.at("trouble");
  EXPECT_EQ(d.at("members").size(), 6u);
  EXPECT_EQ(d.at("frames").size(), 4u);  // the base and the end of each leg
  ASSERT_EQ(d.at("driven").size(), 3u);
  EXPECT_EQ(out.find("nothing is driven"), out.npos) << out;
  for (const json& member : d.at("members")) {  // local x runs along the member
    double across = 0;
    for (std::size_t i = 0; i < 3; ++i)
      across += (member.at("end_mm").at(i).get<double>() - member.at("start_mm").at(i).get<double>()) *
                member.at("axes").at(1).at(i).get<double>();
    EXPECT_NEAR(across, 0, 1e-9) << member;
  }
}

TEST_F(ShowProgram, ThePictureIsDrawn) {
  write("loose.yaml", loose);
  for (const std::string& file : {std::string("hexapod"), std::string("truss"), path("loose.yaml")}) {
    const std::string name = file == "hexapod" ? "stewart-6ups" : file;
    const test::Run run = test::deflect("show " + name + " --out " + path("drawn"));
    ASSERT_EQ(run.code, 0) << run.out;
    for (const char* suffix : {"svg", "pdf", "png", "txt"})
      EXPECT_TRUE(std::filesystem::exists(folder / ("drawn/drawing." + std::string(suffix)))) << suffix;
    EXPECT_NE(contents(folder / "drawn/drawing.txt").find("as its file draws it, unloaded"), std::string::npos);
  }
}

TEST_F(ShowProgram, ThePageShowsTheMachine) {
  if (!pages_are_built()) GTEST_SKIP() << "built without pages";
  const test::Run run = test::deflect("show gantry --report " + path("page.html"));
  ASSERT_EQ(run.code, 0) << run.out;
  const json data = test::page_data(contents(folder / "page.html"));
  EXPECT_EQ(data.at("results").at(0).at("kind"), "drawing");
  if (test::browser().empty()) GTEST_SKIP() << "no Chromium here";
  const auto seen = test::used_page(folder / "page.html", folder);
  ASSERT_TRUE(seen) << "the browser said nothing";
  EXPECT_EQ(seen->at("failures"), json::array()) << seen->at("failures").dump(1);
  EXPECT_FALSE(seen->at("still"));
  EXPECT_TRUE(seen->at("dragged"));
  EXPECT_FALSE(seen->at("wide"));
  for (const json& notes : seen->at("notes")) EXPECT_FALSE(notes.empty()) << "nothing to read under the pointer";
  EXPECT_NE(seen->at("saved").at("members.csv").get<std::string>().find("arm ram,ram,aluminium"), std::string::npos)
      << seen->at("saved").at("members.csv");
  write("loose.yaml", loose);
  ASSERT_EQ(test::deflect("show " + path("loose.yaml") + " --report " + path("loose.html")).code, 0);
  const auto moving = test::used_page(folder / "loose.html", folder);
  ASSERT_TRUE(moving);
  EXPECT_EQ(moving->at("failures"), json::array());
  EXPECT_TRUE(moving->at("still")) << "the free motion goes to and fro by itself";
  EXPECT_NE(moving->at("verdict").get<std::string>().find("cannot stand"), std::string::npos);
}

/// What a JSON Schema of ours refuses, "" where it takes the value.
std::string refused(const json& schema, const json& whole, const json& value) {
  if (schema.contains("$ref"))
    return refused(whole.at("$defs").at(schema.at("$ref").get<std::string>().substr(8)), whole, value);
  if (schema.contains("anyOf")) {
    std::string last;
    for (const json& each : schema.at("anyOf"))
      if ((last = refused(each, whole, value)).empty()) return "";
    return last;
  }
  if (schema.contains("enum") &&
      std::find(schema.at("enum").begin(), schema.at("enum").end(), value) == schema.at("enum").end())
    return value.dump() + " is none of " + schema.at("enum").dump();
  if (schema.contains("pattern") &&
      !(value.is_string() &&
        std::regex_match(value.get<std::string>(), std::regex(schema.at("pattern").get<std::string>()))))
    return value.dump() + " is not like " + schema.at("pattern").dump();
  if (schema.value("type", json()) == "array") {
    if (!value.is_array()) return value.dump() + " is no list";
    for (const json& each : value)
      if (const std::string why = refused(schema.at("items"), whole, each); !why.empty()) return why;
  }
  if (schema.value("type", json()) != "object") return "";
  if (!value.is_object()) return value.dump() + " is no map";
  for (const json& key : schema.value("required", json::array()))
    if (!value.contains(key.get<std::string>())) return key.dump() + " is missing in " + value.dump();
  const json patterns = schema.value("patternProperties", json::object());
  for (const auto& [key, each] : value.items()) {
    const bool known = schema.contains("properties") && schema.at("properties").contains(key);
    json more = schema.value("additionalProperties", json(true));
    for (const auto& [pattern, of_such] : patterns.items())
      if (std::regex_search(key, std::regex(pattern))) more = of_such;
    if (!known && more == false) return key + " is unknown";
    const std::string why = known              ? refused(schema.at("properties").at(key), whole, each)
                            : more.is_object() ? refused(more, whole, each)
                                               : "";
    if (!why.empty()) return key + ": " + why;
  }
  return "";
}

TEST_F(ShowProgram, SchemasAreTablesForPeopleAndForEditors) {
  const test::Run devices = test::deflect("devices --schema --json " + path("device.json"));
  ASSERT_EQ(devices.code, 0) << devices.out;
  for (const char* words : {"pulley_radius", "mm, m, cm, um, in, ft", "required", "default 0 kg", "with law: belt",
                            "which move in this order", "mass at the tool point"})
    EXPECT_NE(devices.out.find(words), devices.out.npos) << words;
  const json schema = json::parse(contents(folder / "device.json"));
  const json good = json::parse(R"({"name": "x", "kinematics": {"family": "chains"},
    "materials": {"s": {"E": "210 GPa", "nu": 0.3}}, "sections": {"r": {"shape": "round", "diameter": "8 mm"}},
    "leg": {"j": {"joint": "motor", "rz": {"law": "linear", "stiffness": "1e5 Nm/rad"}},
            "m": {"member": "r", "material": "s", "along": ["0 mm", "0 mm", "100 mm"]}},
    "workspace": {"disc": {"radius": "10 mm"}}})");
  EXPECT_EQ(refused(schema, schema, good), "");
  json bad = good;
  bad["leg"]["m"]["along"][0] = "0 N";
  EXPECT_NE(refused(schema, schema, bad), "");
  bad = good;
  bad["leg"]["j"]["rz"]["law"] = "cable";
  EXPECT_NE(refused(schema, schema, bad), "");
  bad = good;
  bad["leg"]["m"]["alng"] = "0 N";
  EXPECT_NE(refused(schema, schema, bad), "");

  const test::Run frames = test::deflect("frame --schema --json " + path("frame.json"));
  ASSERT_EQ(frames.code, 0) << frames.out;
  EXPECT_NE(frames.out.find("bending_factor"), frames.out.npos);
  const json frame = json::parse(contents(folder / "frame.json"));
  EXPECT_EQ(refused(frame, frame, json::parse(R"({"name": "x", "materials": {"s": {"E": "210 GPa", "nu": 0.3}},
    "sections": {"r": {"shape": "round", "diameter": "8 mm"}}, "nodes": {"A": ["0 m", "0 m", "0 m"], "B": ["1 m", "0 m",
    "0 m"]}, "members": {"m": {"from": "A", "to": "B", "section": "r", "material": "s"}}, "supports": {"A": "clamped"},
    "loads": {"tip": {"nodes": {"B": {"fz": "1 N"}}}}})")),
            "");

  const std::string help = test::deflect("devices --help").out;
  for (const char* words :
       {"belt: specific_stiffness N/mm", "pulley_radius mm",
        "friction: force N, stiffness N/mm, share (may be absent), start (may be absent), kept (may be "
        "absent); about"})
    EXPECT_NE(help.find(words), help.npos) << words << "\n" << help;
}

}  // namespace
}  // namespace deflect
