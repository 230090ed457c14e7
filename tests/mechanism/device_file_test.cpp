// Devices in and out: what a file may say, and that writing and reading are inverse to the last bit.
#include "msa/mechanism/device_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/mechanism/law.h"
#include "tests/support/devices.h"
#include "tests/support/paths.h"
#include "tests/support/same_mechanism.h"

namespace deflect {
namespace {

/// Every field, law, shape and way of writing once.
const char* const everything = R"(
name: "everything"
about: 'it''s all: here # and there'
source: |
  first line
  second line
kinematics: {family: 6-psu, base_radius: 118 mm, platform_radius: 0.055 m, link_length: 12.55 cm, base_angle: 25 deg,
  platform_angle: 0.28 rad, slider_min: 10 mm, slider_max: !ours 200 mm}
materials:
  steel: {E: 210 GPa, nu: 0.3}
  rope: !ours {E: 70000 N/mm^2, G: 26 GPa}
sections:
  rod: {shape: round, diameter: 8 mm}
  pipe: {shape: tube, outer_diameter: 8 mm, inner_diameter: 5 mm}
  bar: {shape: rectangle, width_y: 4 mm, height_z: 0.25 in}
  profile: {shape: given, A: 50 mm^2, Iy: 200 mm^4, Iz: 100 mm^4, J: 300 mm^4, As_y: 40 mm^2, As_z: !ours 41 mm^2}
leg:
  actuator:
    joint: prismatic
    at: A
    axes: guide
    tx: {law: hertz_line, material: steel, radius: 1.5 mm, length: 10 mm}
    ty: []
    tz:
      - {law: motor_shaft, material: steel, diameter: 5 mm, length: 40 mm, pulley_radius: 10 mm}
      - {law: cable, material: rope, area: 1 mm^2}
      - !ours {law: cable, material: rope, area: 1 mm^2, length: 200 mm}
      - {law: cable_pair, material: rope, area_1: 1 mm^2, length_1: 1 m, area_2: 2 mm^2, length_2: 2 m}
      - {law: belt, specific_stiffness: 600 kN/mm, width: 6 mm, tight_length: 0.2 m, slack_length: 0.3 m}
    rx: {law: linear, stiffness: 1e5 Nmm/rad}
  guide: {member: profile, material: steel, from: A, to: B, beam: timoshenko, bending_factor: 90 %}
  ball: {joint: ball, at: B, axes: link, tz: {law: hertz_point, material: steel, radius: !ours 4 mm}}
  link: {member: bar, material: steel, from: B, to: C, beam: euler-bernoulli, bending_factor: 1}
  top: {joint: universal, at: C, axes: platform, tx: [{law: pin_bending, material: steel, diameter: 3 mm, length: 9 mm}]}
variations:
  - {leg: 4, path: guide.bending_factor, value: !ours 0.5}
  - {leg: 2, path: ball.tz, value: [{law: linear, stiffness: !ours 500 N/mm}, {law: linear, stiffness: 2 kN/mm}]}
  - leg: 4
    path: link
    value:
      member: pipe
      material: rope
      from: B
      to: C
base: {joint: fixed, rx: {law: linear, stiffness: 1e6 Nmm/rad}}
tool: {tz: {law: linear, stiffness: 3 kN/mm}}
workspace: {nominal_slider: 80 mm, cube_edge: 50 mm}
rig:
  load_cell: {gain: 101 %, rotation: [0 deg, 1 deg, !ours -0.5 deg]}
  sensor: {rotation: [1 mrad, 0 rad, 0 rad], drift: [0 mm, 0.01 mm, 0 mm]}
tolerances: {modulus: 1 %, joint_position: !ours 0.03 mm}
)";

const Joint& joint(const Mechanism& m, const char* name) { return std::get<Joint>(*find(m.leg, name)); }
const Member& member(const Mechanism& m, const char* name) { return std::get<Member>(*find(m.leg, name)); }

TEST(DeviceFile, BuiltInDeviceHoldsWhatItSays) {
  const Mechanism m = test::device("haptic-6psu");
  EXPECT_EQ(m.name, "haptic-6psu");
  const SixPsu& k = test::six_psu(m);
  EXPECT_EQ(k.link_length, 0.1255);
  EXPECT_EQ(k.base_angle, 25 * pi / 180);
  EXPECT_EQ(find(m.materials, "steel")->E, 210e9);
  EXPECT_EQ(find(m.materials, "steel")->nu, 0.3);
  EXPECT_EQ(m.leg.size(), 7u);
  EXPECT_EQ(m.leg[3].first, "ball_joint");
  EXPECT_EQ(joint(m, "ball_joint").type, "ball");
  EXPECT_EQ(std::get<HertzPointLaw>(joint(m, "ball_joint").laws[2].at(0)).radius, 0.004);
  EXPECT_EQ(std::get<PinBendingLaw>(joint(m, "universal_joint").laws[2].at(1)).length, 0.010);
  EXPECT_EQ(member(m, "link").section, "link_rod");
  EXPECT_EQ(m.base.type, "fixed");
  EXPECT_EQ(m.base.axes, "base");
  EXPECT_EQ(m.tool.axes, "platform");
  EXPECT_EQ(m.tolerances.modulus, 0.01);
  EXPECT_EQ(m.ours.size(), 15u);
  EXPECT_TRUE(m.ours.contains("leg.universal_joint.tz.0.length"));
  EXPECT_TRUE(m.ours.contains("sections.guide_rod.diameter"));
}

TEST(DeviceFile, EverythingIsRead) {
  const Mechanism m = parse_mechanism(everything, "everything");
  EXPECT_EQ(m.about, "it's all: here # and there");
  EXPECT_EQ(m.source, "first line\nsecond line\n");
  EXPECT_EQ(test::six_psu(m).platform_angle, 0.28);
  EXPECT_EQ(find(m.materials, "rope")->E, 70e9);
  EXPECT_FALSE(find(m.materials, "rope")->nu);
  EXPECT_EQ(std::get<RectangleSection>(find(m.sections, "bar")->shape).height_z, 0.25 * 0.0254);
  EXPECT_EQ(std::get<GivenSection>(find(m.sections, "profile")->shape).As_z, 41 / 1e6);
  const auto& laws = joint(m, "actuator").laws;
  EXPECT_EQ(laws[0].size(), 1u);
  EXPECT_TRUE(laws[1].empty());
  ASSERT_EQ(laws[2].size(), 5u);
  const char* kinds[] = {"motor_shaft", "cable", "cable", "cable_pair", "belt"};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_STREQ(law_names[laws[2][i].index()], kinds[i]);
  EXPECT_FALSE(std::get<CableLaw>(laws[2][1]).length);
  EXPECT_EQ(std::get<CableLaw>(laws[2][2]).length, 0.2);
  EXPECT_EQ(std::get<LinearLaw>(laws[3][0]).stiffness, 100);
  EXPECT_EQ(member(m, "guide").beam, BeamTheory::timoshenko);
  EXPECT_EQ(member(m, "guide").bending_factor, 0.9);
  EXPECT_EQ(std::get<LinearLaw>(m.base.laws[3][0]).stiffness, 1000);
  EXPECT_EQ(std::get<LinearLaw>(m.tool.laws[2][0]).stiffness, 3e6);
  EXPECT_EQ(m.load_cell.gain, 1.01);
  EXPECT_EQ(m.load_cell.rotation(1), pi / 180);
  EXPECT_EQ(m.sensor.drift(1), 1e-5);
  EXPECT_EQ(m.tolerances.load, 0);
  ASSERT_EQ(m.variations.size(), 3u);
  EXPECT_EQ(m.variations[0].value, "0.5");
  EXPECT_EQ(m.variations[2].value, "{member: pipe, material: rope, from: B, to: C}");
  const std::set<std::string> ours = {
      "kinematics.slider_max",    "materials.rope",     "sections.profile.As_z",          "leg.actuator.tz.2",
      "leg.ball.tz.0.radius",     "variations.0.value", "variations.1.value.0.stiffness", "rig.load_cell.rotation.2",
      "tolerances.joint_position"};
  EXPECT_EQ(m.ours, ours);
}

TEST(DeviceFile, WhatIsWrittenReadsBackTheSame) {
  for (const Mechanism& m : {test::device("haptic-6psu"), test::device("haptic-6psu-ideal-joints"),
                             parse_mechanism(everything, "everything")}) {
    const std::string once = write_mechanism(m);
    const Mechanism again = parse_mechanism(once, "written");
    EXPECT_EQ(write_mechanism(again), once);
    EXPECT_EQ(again.ours, m.ours);
    EXPECT_EQ(again.leg.size(), m.leg.size());
    EXPECT_EQ(again.base.at, m.base.at);
  }
}

/// The line without its comment; empty for a line that says nothing.
std::string said(std::string line) {
  line.erase(std::min(line.find(" #"), line.starts_with('#') ? 0 : line.size()));
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

TEST(DeviceFile, BuiltInDevicesAreWrittenAsTheyStandBesidesCommentsAndPercents) {
  for (const char* name : {"haptic-6psu", "haptic-6psu-ideal-joints"}) {
    const std::string file = read_text(test::source_dir() + "/validation/devices/" + name + ".yaml");
    std::istringstream in(file), out(write_mechanism(test::device(name)));
    for (std::string a, b; std::getline(in, a);) {
      if (said(a).empty()) continue;
      while (std::getline(out, b) && b.empty()) {
      }
      if (a.find('%') == a.npos) {
        EXPECT_EQ(b, said(a));
      }
    }
  }
}

TEST(DeviceFile, RandomNumbersComeBackToTheLastBit) {
  std::mt19937 random(3);
  const auto number = [&] { return std::ldexp(test::uniform(random, 1, 2), static_cast<int>(random() % 39) - 20); };
  for (int i = 0; i < 200; ++i) {
    Mechanism m = parse_mechanism(everything, "everything");
    SixPsu& k = std::get<SixPsu>(m.kinematics);
    k.base_radius = number(), k.slider_max = k.slider_min + number(), k.base_angle = test::uniform(random, 0, 2);
    m.materials[0].second.E = number() * 1e9;
    m.materials[0].second.nu = test::uniform(random, -0.9, 0.49);
    std::get<GivenSection>(m.sections[3].second.shape).Iy = number() * 1e-9;
    std::get<LinearLaw>(std::get<Joint>(m.leg[0].second).laws[3][0]).stiffness = number();
    std::get<Member>(m.leg[1].second).bending_factor = number();
    m.load_cell = {number(), test::random_vector(random, 0.1), test::random_vector(random, 0.05)};
    m.sensor = {test::random_vector(random, 0.1), test::random_vector(random, 0.05), test::random_vector(random, 1e-3)};
    m.tolerances.load = std::ldexp(test::uniform(random, 1, 2), -1 - static_cast<int>(random() % 20));  // a share of 1

    const Mechanism r = parse_mechanism(write_mechanism(m), "written");
    const SixPsu& s = test::six_psu(r);
    ASSERT_EQ(s.base_radius, k.base_radius);
    ASSERT_EQ(s.slider_max, k.slider_max);
    ASSERT_EQ(s.base_angle, k.base_angle);
    ASSERT_EQ(r.materials[0].second.E, m.materials[0].second.E);
    ASSERT_EQ(r.materials[0].second.nu, m.materials[0].second.nu);
    ASSERT_EQ(std::get<GivenSection>(r.sections[3].second.shape).Iy,
              std::get<GivenSection>(m.sections[3].second.shape).Iy);
    ASSERT_EQ(std::get<LinearLaw>(joint(r, "actuator").laws[3][0]).stiffness,
              std::get<LinearLaw>(joint(m, "actuator").laws[3][0]).stiffness);
    ASSERT_EQ(member(r, "guide").bending_factor, member(m, "guide").bending_factor);
    ASSERT_EQ(r.load_cell.gain, m.load_cell.gain);
    ASSERT_EQ(r.load_cell.rotation, m.load_cell.rotation);
    ASSERT_EQ(r.load_cell.point, m.load_cell.point);
    ASSERT_EQ(r.sensor.rotation, m.sensor.rotation);
    ASSERT_EQ(r.sensor.point, m.sensor.point);
    ASSERT_EQ(r.sensor.drift, m.sensor.drift);
    ASSERT_EQ(r.tolerances.load, m.tolerances.load);
  }
}

TEST(DeviceFile, AnyTextComesBack) {
  std::vector<std::string> texts = {"yes",          "No",    "1",      "010",         "1e5",      "0x1F",
                                    ".nan",         "~",     "null",   "2001-01-01",  "12:30:00", "-",
                                    "- a",          "---",   "...",    "a: b",        "a #b",     "#a",
                                    "a:",           "'a'",   "\"a\"",  "\\",          "a\\nb",    " a",
                                    "a ",           "[a]",   "{a}",    "a, b",        "&a",       "*a",
                                    "!a",           "|",     ">",      "%a",          "@a",       "`a",
                                    "? a",          "<<",    "=",      "a\nb",        "a\n",      "\n",
                                    "\ta",          "a\tb",  "Müller", "€ 日本語 😀",  "\xc2\x85", "\xe2\x80\xa8",
                                    "\x01\x04\x1b", "6-psu", "a\r\nb", "\xef\xbb\xbf"};
  std::mt19937 random(4);
  const std::string letters = "ab 1-:#,[]{}&*!|>'\"%@`~\\\n\t.e";
  for (int i = 0; i < 500; ++i) {
    texts.emplace_back();
    for (unsigned n = 1 + random() % 6; n > 0; --n) texts.back() += letters[random() % letters.size()];
  }
  Mechanism m = test::device("haptic-6psu");
  for (const std::string& text : texts) {
    m.source = text;
    if (std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < ' '; })) m.name = text;  // one line
    const Mechanism r = parse_mechanism(write_mechanism(m), "written");
    ASSERT_EQ(r.name, m.name);
    ASSERT_EQ(r.source, text);
  }
  for (const char* text : {"yes", "1", "2001-01-01", "1e5", ""}) {  // also for readers that know more types
    m.name = text;
    EXPECT_EQ(write_mechanism(m).find("name: \"" + m.name + "\"\n"), 0u) << write_mechanism(m).substr(0, 40);
  }
}

TEST(DeviceFile, DefaultsAreNotWrittenUnlessMarked) {
  std::string text = read_text(test::source_dir() + "/validation/devices/haptic-6psu.yaml");
  const Mechanism plain = parse_mechanism(text, "plain");
  Mechanism spelt = parse_mechanism(
      text + "base: {joint: fixed}\nrig: {load_cell: {gain: 1}, sensor: {}}\nvariations: []\n", "spelt");
  EXPECT_EQ(spelt, plain);
  const Mechanism marked = parse_mechanism(text + "rig: {load_cell: {gain: !ours 1}}\n", "marked");
  EXPECT_NE(write_mechanism(marked).find("\nrig:\n  load_cell: {gain: !ours 1}\n"), std::string::npos);
  EXPECT_EQ(parse_mechanism(write_mechanism(marked), "again").ours, marked.ours);
}

TEST(DeviceFile, LineEndingsAndByteOrderMarkDoNotMatter) {
  const std::string text = read_text(test::source_dir() + "/validation/devices/haptic-6psu.yaml");
  std::string dos = "\xef\xbb\xbf";
  for (const char c : text) dos += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_EQ(parse_mechanism(dos, "dos"), parse_mechanism(text, "unix"));
  EXPECT_EQ(parse_mechanism("---\n" + text + "...\n", "marked"), parse_mechanism(text, "unix"));
}

TEST(DeviceFile, MissingFileIsNamed) { EXPECT_THROW(read_mechanism("/nowhere/device.yaml"), InputError); }

}  // namespace
}  // namespace deflect
