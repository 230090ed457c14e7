// Edits of a description: what they change, what they leave, what they refuse.
#include <gtest/gtest.h>

#include <cmath>

#include "msa/base/error.h"
#include "msa/fields/yaml_tree.h"
#include "tests/support/devices.h"
#include "tests/support/same_mechanism.h"

namespace deflect {
namespace {

using test::with;
using Action = Edit::Action;

const Mechanism& haptic() {
  static const Mechanism m = test::device("haptic-6psu");
  return m;
}

std::string refusal(const Edit& edit, const Mechanism& m = haptic()) {
  try {
    edited(m, edit);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

void expect_refusal(const Edit& edit, const std::vector<const char*>& says, const Mechanism& m = haptic()) {
  const std::string message = refusal(edit, m);
  EXPECT_EQ(message.find("edit '" + edit.path), 0u) << message << "\n  for " << edit.path << " " << edit.value;
  EXPECT_NE(message.find(edit.value), message.npos) << message;
  for (const char* phrase : says) EXPECT_NE(message.find(phrase), message.npos) << message << "\n  lacks " << phrase;
}

template <class T>
const T& part(const Named<Part>& parts, const char* name) {
  return std::get<T>(*find(parts, name));
}

double factor(const Mechanism& m, int leg) { return part<Member>(leg_parts(m, leg), "guideway").bending_factor; }

const std::vector<Law>& ball_tz(const Named<Part>& parts) { return part<Joint>(parts, "ball_joint").laws[2]; }

TEST(Edit, SettingANumberChangesItAlone) {
  const std::string before = write_mechanism(haptic());
  const Mechanism m = with(haptic(), "sections.guide_rod.diameter", "9 mm");
  EXPECT_EQ(std::get<RoundSection>(find(m.sections, "guide_rod")->shape).diameter, 0.009);
  std::string expected = before;
  const std::string old_text = "guide_rod: {shape: round, diameter: !ours 8 mm}";
  expected.replace(expected.find(old_text), old_text.size(), "guide_rod: {shape: round, diameter: 9 mm}");
  EXPECT_EQ(write_mechanism(m), expected);
  EXPECT_EQ(write_mechanism(haptic()), before);
}

/// A home pose at the origin is all defaults, but that it is given counts: without it the loops would have to close
/// from the joints' home coordinates.
TEST(Edit, AHomePoseAtTheOriginStaysGiven) {
  const Mechanism m = with(test::device("stewart-6ups"), "kinematics.home", "{shift: [0 mm, 0 mm, 0 mm]}");
  ASSERT_TRUE(std::get<Chains>(m.kinematics).home);
  const Mechanism again = parse_mechanism(write_mechanism(m), "again.yaml");
  ASSERT_TRUE(std::get<Chains>(again.kinematics).home);
  EXPECT_EQ(write_mechanism(again), write_mechanism(m));
  EXPECT_TRUE(std::get<Chains>(with(again, "materials.steel.E", "200 GPa").kinematics).home);
  Mechanism none = m;
  std::get<Chains>(none.kinematics).home.reset();
  EXPECT_FALSE(std::get<Chains>(parse_mechanism(write_mechanism(none), "none.yaml").kinematics).home);
}

TEST(Edit, WhatIsEditedIsNoLongerAssumed) {
  EXPECT_TRUE(haptic().ours.contains("sections.guide_rod.diameter"));
  for (const Action action : {Action::set, Action::multiply}) {
    const Mechanism m = edited(haptic(), {"sections.guide_rod.diameter", action == Action::set ? "8 mm" : "1", action});
    EXPECT_FALSE(m.ours.contains("sections.guide_rod.diameter"));
    EXPECT_EQ(m.ours.size(), haptic().ours.size() - 1);
  }
}

TEST(Edit, AnAssumptionAboutTheWholePassesToWhatIsNotEdited) {
  const Mechanism whole = with(haptic(), "materials", "{steel: !ours {E: 70 GPa, nu: 0.3}}");
  EXPECT_TRUE(whole.ours.contains("materials.steel"));
  const Mechanism m = with(whole, "materials.steel.E", "71 GPa");
  EXPECT_FALSE(m.ours.contains("materials.steel"));
  EXPECT_FALSE(m.ours.contains("materials.steel.E"));
  EXPECT_TRUE(m.ours.contains("materials.steel.nu"));
}

TEST(Edit, MarksMoveWithTheirListElements) {
  const Mechanism m = with(haptic(), "leg.universal_joint.tz", "[{law: linear, stiffness: 1 N/mm}]");
  EXPECT_FALSE(m.ours.contains("leg.universal_joint.tz.0.length"));
  const Mechanism longer =
      edited(haptic(), {"leg.universal_joint.tz", "{law: linear, stiffness: 1 N/mm}", Action::append});
  EXPECT_EQ(longer.ours, haptic().ours);
}

TEST(Edit, DefaultsAndAbsentFieldsCanBeSet) {
  const Mechanism m =
      with(with(with(with(haptic(), "rig.load_cell.gain", "1.02"), "rig.sensor.drift", "[0 mm, 1 mm, 0 mm]"), "base.rx",
                "{law: linear, stiffness: 1e5 Nmm/rad}"),
           "leg.link.beam", "timoshenko");
  EXPECT_EQ(m.load_cell.gain, 1.02);
  EXPECT_EQ(m.sensor.drift(1), 1e-3);
  EXPECT_EQ(std::get<LinearLaw>(m.base.laws[3].at(0)).stiffness, 100);
  EXPECT_EQ(part<Member>(m.leg, "link").beam, BeamTheory::timoshenko);
  EXPECT_EQ(parse_mechanism(write_mechanism(m), "again"), m);
}

TEST(Edit, MultiplyingActsOnTheValueInSI) {
  const Mechanism m = with(haptic(), "materials.*.E", "1.01", Action::multiply);
  EXPECT_EQ(find(m.materials, "steel")->E, 210e9 * 1.01);
  const Mechanism angle = with(haptic(), "kinematics.base_angle", "0.9", Action::multiply);
  EXPECT_EQ(test::six_psu(angle).base_angle, 25 * pi / 180 * 0.9);
  const Mechanism back = with(m, "materials.steel.E", "2", Action::multiply);
  EXPECT_EQ(find(back.materials, "steel")->E, 210e9 * 1.01 * 2);
}

TEST(Edit, StarStandsForEveryEntryThatHasTheField) {
  const Mechanism m = with(haptic(), "sections.*.diameter", "7 mm");
  for (const auto& [name, section] : m.sections)
    EXPECT_EQ(std::get<RoundSection>(section.shape).diameter, 0.007) << name;
  const Mechanism soft = with(haptic(), "leg.*.bending_factor", "0.8", Action::multiply);
  for (const auto& [name, p] : soft.leg)
    EXPECT_EQ(std::holds_alternative<Member>(p) ? std::get<Member>(p).bending_factor : 0.8, 0.8) << name;
  const Mechanism pins = with(haptic(), "leg.universal_joint.tz.*.length", "2", Action::multiply);
  EXPECT_EQ(std::get<HertzLineLaw>(part<Joint>(pins.leg, "universal_joint").laws[2][0]).length, 0.02);
  EXPECT_EQ(std::get<PinBendingLaw>(part<Joint>(pins.leg, "universal_joint").laws[2][1]).length, 0.02);
}

TEST(Edit, LawsAreSetAndAppended) {
  const std::string spring = "{law: linear, stiffness: 500 N/mm}";
  const Mechanism one = with(haptic(), "leg.ball_joint.tz", spring);
  ASSERT_EQ(ball_tz(one.leg).size(), 1u);
  const Mechanism two = with(haptic(), "leg.ball_joint.tz", spring, Action::append);
  ASSERT_EQ(ball_tz(two.leg).size(), 2u);
  EXPECT_TRUE(std::holds_alternative<HertzPointLaw>(ball_tz(two.leg)[0]));
  EXPECT_EQ(std::get<LinearLaw>(ball_tz(two.leg)[1]).stiffness, 500e3);
  const Mechanism first = with(haptic(), "leg.carriage.tx", spring, Action::append);
  EXPECT_EQ(part<Joint>(first.leg, "carriage").laws[0].size(), 1u);
  EXPECT_TRUE(ball_tz(with(haptic(), "leg.ball_joint.tz", "[]").leg).empty());
}

TEST(Edit, TheIndexOfASingleLawMayBeLeftOut) {
  EXPECT_EQ(with(haptic(), "leg.ball_joint.tz.radius", "5 mm"), with(haptic(), "leg.ball_joint.tz.0.radius", "5 mm"));
}

TEST(Edit, EntriesAreAppended) {
  const Mechanism m = with(with(haptic(), "materials", "{brass: {E: 100 GPa, nu: 0.34}}", Action::append),
                           "leg.link.material", "brass");
  EXPECT_EQ(m.materials.size(), 2u);
  EXPECT_EQ(part<Member>(m.leg, "link").material, "brass");
}

TEST(Edit, OneLegIsAVariation) {
  const Mechanism m = with(haptic(), "leg[4].guideway.bending_factor", "0.8");
  ASSERT_EQ(m.variations.size(), 1u);
  EXPECT_EQ(m.variations[0].leg, 4);
  EXPECT_EQ(m.variations[0].path, "guideway.bending_factor");
  EXPECT_EQ(m.variations[0].value, "0.8");
  EXPECT_EQ(part<Member>(m.leg, "guideway").bending_factor, 1);
  for (int leg = 1; leg <= 6; ++leg) EXPECT_EQ(factor(m, leg), leg == 4 ? 0.8 : 1);
  EXPECT_EQ(parse_mechanism(write_mechanism(m), "again"), m);
}

TEST(Edit, TheSameFieldOfALegVariesOnce) {
  Mechanism m = with(haptic(), "leg[4].guideway.bending_factor", "0.8");
  m = with(m, "leg[2].guideway.bending_factor", "0.7");
  m = with(m, "leg[4].guideway.bending_factor", "0.5", Action::multiply);
  EXPECT_EQ(m.variations.size(), 2u);
  EXPECT_EQ(factor(m, 4), 0.8 * 0.5);
  EXPECT_EQ(factor(m, 2), 0.7);
  m = with(m, "leg[4].guideway", "{member: link_rod, material: steel, from: A, to: B}");
  EXPECT_EQ(m.variations.size(), 2u);
  EXPECT_EQ(factor(m, 4), 1);
}

TEST(Edit, ALaterVariationHoldsOverAnEarlierOneAboutTheWhole) {
  Mechanism m =
      with(haptic(), "leg[4].guideway", "{member: guide_rod, material: steel, from: A, to: B, bending_factor: 0.6}");
  m = with(m, "leg[4].guideway.bending_factor", "0.5", Action::multiply);
  EXPECT_EQ(m.variations.size(), 2u);
  EXPECT_EQ(factor(m, 4), 0.6 * 0.5);
}

TEST(Edit, LawsOfOneLeg) {
  const Mechanism m = with(haptic(), "leg[2].ball_joint.tz", "{law: linear, stiffness: 1 kN/mm}", Action::append);
  EXPECT_EQ(ball_tz(m.leg).size(), 1u);
  EXPECT_EQ(ball_tz(leg_parts(m, 1)).size(), 1u);
  ASSERT_EQ(ball_tz(leg_parts(m, 2)).size(), 2u);
  EXPECT_EQ(std::get<LinearLaw>(ball_tz(leg_parts(m, 2))[1]).stiffness, 1e6);
  const Mechanism stiffer = with(m, "leg[2].ball_joint.tz.1.stiffness", "2", Action::multiply);
  EXPECT_EQ(std::get<LinearLaw>(ball_tz(leg_parts(stiffer, 2))[1]).stiffness, 2e6);
}

TEST(Edit, WhatALegTakesOverStaysAssumed) {
  const Mechanism m = with(haptic(), "leg[2].universal_joint.tz", "{law: linear, stiffness: 1 kN/mm}", Action::append);
  EXPECT_TRUE(m.ours.contains("variations.0.value.0.length"));
  const Mechanism known = with(m, "leg[2].universal_joint.tz.0.length", "12 mm");
  const Mechanism more = with(known, "leg[2].universal_joint.tz", "{law: linear, stiffness: 2 kN/mm}", Action::append);
  EXPECT_EQ(more.variations.size(), 1u);
  EXPECT_FALSE(more.ours.contains("variations.0.value.0.length"));
  EXPECT_TRUE(more.ours.contains("variations.0.value.1.diameter"));
}

TEST(Edit, RefusalsNamePathValueAndTheNearestName) {
  expect_refusal({"sections.guide_rod.diametre", "9 mm"}, {"did you mean 'diameter'?"});
  expect_refusal({"sections.guide_rd.diameter", "9 mm"}, {"there is no 'guide_rd', did you mean 'guide_rod'?"});
  expect_refusal({"secions.guide_rod.diameter", "9 mm"}, {"did you mean 'sections'?"});
  expect_refusal({"sections.guide_rod.diameter.value", "9 mm"}, {"'sections.guide_rod.diameter' has no fields"});
  expect_refusal({"sections.guide_rod.diameter", "-1 mm"}, {"must be above 0 mm"});
  expect_refusal({"sections.guide_rod.diameter", "9"}, {"has no unit"});
  expect_refusal({"sections.guide_rod.diameter", ""}, {"has no value"});
  expect_refusal({"sections.guide_rod.diameter", "{a: b"}, {"not valid YAML"});
  expect_refusal({"sections.guide_rod", "{shape: tube, outer_diameter: 5 mm, inner_diameter: 6 mm}"},
                 {"below outer_diameter"});
  expect_refusal({"leg.guideway.member", "guide_rd"}, {"unknown section 'guide_rd', did you mean 'guide_rod'?"});
  expect_refusal({"kinematics.slider_min", "300 mm"}, {"slider_max: must be above slider_min"});
  expect_refusal({"materials.steel.G", "80 GPa"}, {"nu and G are both given"});
  expect_refusal({"materials", "{}"}, {"unknown material 'steel'"});
  expect_refusal({"kinematics.*", "1 mm"}, {"'*' stands for named entries"});
  expect_refusal({"leg.*.bendin_factor", "1"}, {"there is no 'bendin_factor'"});
  expect_refusal({"leg.universal_joint.tz.2.length", "1 mm"}, {"an index from 0 to 1"});
  expect_refusal({"leg.universal_joint.tz.length", "1 mm"}, {"an index from 0 to 1"});
  expect_refusal({"leg.carriage.tz.0.stiffness", "1 N/mm"}, {"'leg.carriage.tz' is empty"});
  expect_refusal({"", "1"}, {"the path is empty"});
  expect_refusal({"leg..joint", "ball"}, {"there is no ''"});
  expect_refusal({"base.joint", "ball"}, {"known: fixed"});
}

TEST(Edit, RefusalsOfAppendAndMultiply) {
  expect_refusal({"leg.ball_joint.rz", "{law: linear, stiffness: 5 N/mm}", Action::append}, {"rotational stiffness"});
  expect_refusal({"leg.ball_joint.tz", "[]", Action::append}, {"leg.ball_joint.tz.1: a map of fields"});
  expect_refusal({"sections.guide_rod.diameter", "1 mm", Action::append}, {"is not a list"});
  expect_refusal({"sections.guide_rod", "{a: b}", Action::append}, {"is not a list"});
  expect_refusal({"materials", "{steel: {E: 1 GPa, nu: 0}}", Action::append}, {"'steel' is there already"});
  expect_refusal({"materials", "steel", Action::append}, {"a map of new entries"});
  expect_refusal({"name", "2", Action::multiply}, {"is not a number"});
  expect_refusal({"materials.steel.G", "2", Action::multiply}, {"is not a number"});
  expect_refusal({"materials.steel.E", "2 GPa", Action::multiply}, {"'2 GPa' is not a finite number"});
  expect_refusal({"materials.steel.E", "nan", Action::multiply}, {"not a finite number"});
  expect_refusal({"materials.steel.E", "1e308", Action::multiply}, {"not finite"});
  expect_refusal({"materials.steel.E", "-1", Action::multiply}, {"must be above 0"});
  expect_refusal({"materials.steel.nu", "2", Action::multiply}, {"strictly between -1 and 0.5"});
}

TEST(Edit, AddsInTheUnitOfTheField) {
  EXPECT_EQ(with(haptic(), "payload", "500 g", Action::add).payload, 0.5);
  const Mechanism twice = with(with(haptic(), "payload", "0.5 kg", Action::add), "payload", "0.25 kg", Action::add);
  EXPECT_EQ(twice.payload, 0.75);
  EXPECT_EQ(with(haptic(), "rig.sensor.drift.1", "-3 mm", Action::add).sensor.drift.y(), -0.003);
  EXPECT_EQ(factor(with(haptic(), "leg[2].guideway.bending_factor", "0.5", Action::add), 2), 1.5);
  expect_refusal({"payload", "1 N", Action::add}, {"'1 N' is a force"});
  expect_refusal({"payload", "-1 kg", Action::add}, {"must be at least 0 kg"});
  expect_refusal({"payload", "[1 kg]", Action::add}, {"a single value is wanted"});
  expect_refusal({"materials.steel.G", "1 GPa", Action::add}, {"is not a number that is there"});
  expect_refusal({"name", "1", Action::add}, {"is not a number"});
}

TEST(Edit, SeveralAtOnceAreAsOneAfterTheOther) {
  const std::vector<Edit> edits = {{"materials.steel.E", "0.9", Action::multiply},
                                   {"leg.ball_joint.tz", "{law: linear, stiffness: 7 N/mm}", Action::append},
                                   {"leg[4].ball_joint.tz", "{law: linear, stiffness: 5 N/mm}", Action::append},
                                   {"leg[4].guideway.bending_factor", "0.5"},
                                   {"materials.steel.E", "0.9", Action::multiply}};
  Mechanism one_by_one = haptic();
  for (const Edit& edit : edits) one_by_one = edited(one_by_one, edit);
  EXPECT_EQ(edited_in_turn(haptic(), edits), one_by_one);
  EXPECT_EQ(ball_tz(leg_parts(one_by_one, 4)).size(), 3u);
  EXPECT_EQ(edited_in_turn(haptic(), {}), haptic());
  EXPECT_THROW(edited_in_turn(haptic(), {edits[0], {"materials.iron.E", "1 GPa"}}), InputError);
}

TEST(Edit, ResolvedLegsAreThoseOfTheVariationsAndForModelsOnly) {
  const Mechanism m = with(haptic(), "leg[4].guideway.bending_factor", "0.5"), quick = resolved(m);
  for (int leg = 1; leg <= 6; ++leg) EXPECT_EQ(factor(quick, leg), leg == 4 ? 0.5 : 1);
  const Pose pose = test::home(m);
  EXPECT_EQ(std::get<PlacedMember>(configure(quick, pose).legs[3].parts[1]).section.Iy,
            std::get<PlacedMember>(configure(m, pose).legs[3].parts[1]).section.Iy);
  EXPECT_THROW(write_mechanism(quick), std::logic_error);
  EXPECT_THROW(edited(quick, {"payload", "1 kg"}), std::logic_error);
}

TEST(Edit, RefusalsForOneLeg) {
  expect_refusal({"leg[7].guideway.bending_factor", "1"}, {"leg[1] to leg[6]"});
  expect_refusal({"leg[0].guideway.bending_factor", "1"}, {"leg[1] to leg[6]"});
  expect_refusal({"leg[4]", "1"}, {"leg[1] to leg[6]"});
  expect_refusal({"leg[4].guidway.bending_factor", "1"},
                 {"leg[4].guidway: there is no 'guidway', did you mean 'guideway'?"});
  expect_refusal({"leg[4].guideway.bending_factor", "-1"}, {"leg[4].guideway.bending_factor: '-1' must be above 0"});
  expect_refusal({"leg[4].guideway.member", "rod"}, {"leg[4].guideway.member: unknown section 'rod'"});
  const Mechanism m = with(haptic(), "leg[4].universal_joint.tz.1.length", "12 mm");
  expect_refusal({"leg.universal_joint.tz", "{law: linear, stiffness: 1 N/mm}"}, {"leg[4].universal_joint.tz.1"}, m);
  EXPECT_THROW(leg_parts(m, 0), InputError);
  EXPECT_THROW(leg_parts(m, 7), InputError);
}

TEST(Suggestion, NamesSixtyWordsAtMost) {
  std::vector<std::string> known;
  for (int i = 1; i <= 100; ++i) known.push_back("node_" + std::to_string(i));
  const std::string text = suggestion("node_7x", known);
  EXPECT_NE(text.find("did you mean 'node_7'?"), text.npos) << text;
  EXPECT_NE(text.find("node_60, … and 40 more)"), text.npos) << text;
  EXPECT_EQ(text.find("node_61"), text.npos) << text;
}

}  // namespace
}  // namespace deflect
