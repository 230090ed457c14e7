// Laws of joints in device files: read, written and edited field by field; joints beside the legs.
#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "tests/support/devices.h"
#include "tests/support/same_mechanism.h"

namespace deflect {
namespace {

const char* const ball_laws = R"([
  {law: power, deflection: 2.5 um, force: 1 N, exponent: 0.6667},
  {law: one_sided, pull: 0.001 mm/N},
  {law: one_sided, pull: 0 mm/N, push: 2 um/N},
  {law: hardening, stiffness: 500 N/mm, reference: 0.1 mm},
  {law: clearance, gap: 0.02 mm},
  {law: friction, force: 2 N, stiffness: 1e4 N/mm},
  {law: cable, EA: 1000 N, length: 0.2 m}])";
const char* const turning_laws = R"([
  {law: power, deflection: 1 mrad, moment: 1 Nm, exponent: 1},
  {law: one_sided, push: 0.01 rad/Nm},
  {law: hardening, stiffness: 5 Nm/rad, reference: 1 deg},
  {law: clearance, gap: 0.1 deg},
  {law: friction, moment: 20 Nmm, stiffness: 1e4 Nmm/rad}])";
const char* const beside =
    "{friction: {joint: custom, freedoms: ffrfff, at: C, axes: link, tz: {law: friction, force: 2 N, stiffness: 1e4 "
    "N/mm}}}";

const std::array<std::vector<Law>, 6>& laws_of(const Mechanism& m, const char* part) {
  return std::get<Joint>(*find(m.leg, part)).laws;
}

Mechanism full() {
  Mechanism m = test::with(test::device("haptic-6psu-ideal-joints"), "leg.ball_joint.tz", ball_laws);
  m = test::with(m, "leg.mount.rz", turning_laws);
  m = test::with(m, "beside", beside, Edit::Action::append);
  m = test::with(m, "materials.steel.expansion", "12e-6 1/K");
  return test::with(m, "geometry", "second-order");
}

std::string refusal(const std::string& path, const std::string& value) {
  try {
    test::with(full(), path, value);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(LawFile, HoldsWhatItSays) {
  const Mechanism m = full();
  const std::vector<Law>& along = laws_of(m, "ball_joint")[2];
  ASSERT_EQ(along.size(), 7u);
  const PowerLaw power = std::get<PowerLaw>(along[0]);
  EXPECT_EQ(power.deflection, 2.5e-6);
  EXPECT_EQ(power.force, 1);
  EXPECT_EQ(power.exponent, 0.6667);
  EXPECT_EQ(std::get<OneSidedLaw>(along[1]).pull, 1e-6);
  EXPECT_FALSE(std::get<OneSidedLaw>(along[1]).push);
  EXPECT_EQ(std::get<OneSidedLaw>(along[2]).pull, 0);
  EXPECT_EQ(std::get<OneSidedLaw>(along[2]).push, 2e-6);
  EXPECT_EQ(std::get<HardeningLaw>(along[3]).reference, 1e-4);
  EXPECT_EQ(std::get<ClearanceLaw>(along[4]).gap, 2e-5);
  EXPECT_EQ(std::get<FrictionLaw>(along[5]).force, 2);
  EXPECT_EQ(std::get<FrictionLaw>(along[5]).stiffness, 1e7);
  EXPECT_EQ(std::get<CableLaw>(along[6]).EA, 1000);
  const std::vector<Law>& about = laws_of(m, "mount")[5];
  ASSERT_EQ(about.size(), 5u);
  EXPECT_EQ(std::get<PowerLaw>(about[0]).deflection, 1e-3);
  EXPECT_EQ(std::get<OneSidedLaw>(about[1]).push, 0.01);
  EXPECT_EQ(std::get<HardeningLaw>(about[2]).stiffness, 5);
  EXPECT_EQ(std::get<ClearanceLaw>(about[3]).gap, 0.1 * pi / 180);
  EXPECT_EQ(std::get<FrictionLaw>(about[4]).force, 0.02);
  EXPECT_EQ(find(m.materials, "steel")->expansion, 12e-6);
  EXPECT_EQ(m.geometry, Geometry::second_order);
}

TEST(LawFile, IsWrittenAsItIsRead) {
  const Mechanism m = full();
  const std::string text = write_mechanism(m);
  EXPECT_EQ(parse_mechanism(text, "again"), m);
  for (const char* phrase : {"pull: 0 mm/N", "moment: 20 Nmm", "EA: 1000 N", "geometry: second-order",
                             "freedoms:", "beside:", "expansion: 1.2e-05 1/K"})
    EXPECT_NE(text.find(phrase), text.npos) << phrase << "\n" << text;
  const std::string plain = write_mechanism(test::device("haptic-6psu-ideal-joints"));
  for (const char* absent : {"geometry", "beside", "expansion"}) EXPECT_EQ(plain.find(absent), plain.npos) << absent;
}

TEST(LawFile, IsEdited) {
  Mechanism m = test::with(full(), "leg.ball_joint.tz.0.exponent", "0.5");
  m = test::with(m, "leg.ball_joint.tz.1.push", "0.5 mm/N");
  m = test::with(m, "leg.ball_joint.tz.5.force", "3", Edit::Action::multiply);
  EXPECT_EQ(std::get<PowerLaw>(laws_of(m, "ball_joint")[2][0]).exponent, 0.5);
  EXPECT_EQ(std::get<OneSidedLaw>(laws_of(m, "ball_joint")[2][1]).push, 5e-4);
  EXPECT_EQ(std::get<FrictionLaw>(laws_of(m, "ball_joint")[2][5]).force, 6);
  m = test::with(m, "leg[3].ball_joint.tz.4.gap", "0.1 mm");
  EXPECT_EQ(m.variations.size(), 1u);
  m = test::with(m, "geometry", "linear");
  EXPECT_EQ(m.geometry, Geometry::linear);
}

/// A friction on the last law of ball_laws' place, with more fields.
FrictionLaw friction_with(const std::string& fields) {
  const Mechanism m =
      test::with(full(), "leg.ball_joint.tz", "{law: friction, force: 2 N, stiffness: 1 N/mm" + fields + "}");
  EXPECT_EQ(parse_mechanism(write_mechanism(m), "again"), m) << fields;
  return std::get<FrictionLaw>(laws_of(m, "ball_joint")[2].at(0));
}

TEST(LawFile, FrictionStartsByAWordOrANumber) {
  const FrictionLaw plain = friction_with(""), relaxed = friction_with(", start: relaxed"),
                    kept = friction_with(", start: kept"), unknown = friction_with(", start: unknown"),
                    half = friction_with(", start: -0.5, kept: 0.25");
  EXPECT_EQ(plain.start, 0);
  EXPECT_EQ(plain.kept, 1);
  EXPECT_EQ(relaxed.start, 0);
  EXPECT_EQ(relaxed.kept, 0);
  EXPECT_EQ(kept.kept, 1);
  EXPECT_EQ(unknown.word, FrictionStart::unknown);
  EXPECT_EQ(unknown.kept, 0);
  EXPECT_EQ(half.start, -0.5);
  EXPECT_EQ(half.kept, 0.25);
  const std::string law = "leg.ball_joint.tz", friction = "{law: friction, force: 2 N, stiffness: 1 N/mm, start: ";
  EXPECT_NE(refusal(law, friction + "relaxt}").find("did you mean 'relaxed'"), std::string::npos);
  EXPECT_NE(refusal(law, friction + "2}").find("between -1 and 1"), std::string::npos);
  EXPECT_NE(refusal(law, friction + "relaxed, kept: 0.5}").find("unknown key"), std::string::npos);
}

TEST(LawFile, AWordForTheStartCanBeEdited) {
  Mechanism m = test::with(full(), "leg.ball_joint.tz.5.start", "unknown");
  EXPECT_EQ(std::get<FrictionLaw>(laws_of(m, "ball_joint")[2][5]).word, FrictionStart::unknown);
  m = test::with(m, "leg.ball_joint.tz.5.start", "0.5");
  EXPECT_EQ(std::get<FrictionLaw>(laws_of(m, "ball_joint")[2][5]).start, 0.5);
}

TEST(LawFile, AShareOfTheLoadIsOfLawsSideBySide) {
  EXPECT_NE(refusal("leg.ball_joint.tz", "{law: friction, force: 0 N, share: 0.3, stiffness: 1 N/mm}").find("'beside'"),
            std::string::npos);
  const Mechanism m = test::with(full(), "leg.ball_joint.beside.tz",
                                 "{law: friction, force: 0 N, share: 0.3, stiffness: 1 N/mm}", Edit::Action::append);
  EXPECT_EQ(parse_mechanism(write_mechanism(m), "again"), m);
}

TEST(LawFile, MistakesAreToldWithTheWayOut) {
  const std::string law = "leg.ball_joint.tz";
  EXPECT_NE(refusal(law, "{law: power, deflection: 1 um, force: 1 N, exponent: 1.5}").find("at most 1"),
            std::string::npos);
  EXPECT_NE(refusal(law, "{law: power, deflection: 1 um, force: 1 N, exponent: 0}").find("above 0"), std::string::npos);
  EXPECT_NE(refusal(law, "{law: one_sided}").find("give pull or push, as in 'pull: 0.001 mm/N'"), std::string::npos);
  EXPECT_NE(refusal(law, "{law: one_sided, pull: -1 mm/N}").find("at least 0 mm/N"), std::string::npos);
  EXPECT_NE(
      refusal(law, "{law: one_sided, pull: 1 N/mm}").find("is a stiffness (force per length), where a compliance"),
      std::string::npos);
  EXPECT_NE(refusal(law, "{law: friction, moment: 1 Nm, stiffness: 1 N/mm}").find("unknown key"), std::string::npos);
  EXPECT_NE(refusal("leg.mount.rz", "{law: friction, force: 1 N, stiffness: 1 Nm/rad}").find("unknown key"),
            std::string::npos);
  EXPECT_NE(refusal(law, "{law: clearence, gap: 1 mm}").find("did you mean 'clearance'"), std::string::npos);
  EXPECT_NE(refusal(law, "{law: cable, EA: 1000 N, area: 1 mm^2}").find("unknown key"), std::string::npos);
  EXPECT_NE(
      refusal(law, "{law: cable, EA: 1000 N, material: steel, area: 1 mm^2}").find("only one of 'EA', 'material'"),
      std::string::npos);
  EXPECT_NE(refusal("leg.mount.rz", "{law: cable, EA: 1000 N}").find("a rotation takes 'linear'"), std::string::npos);
  const std::string belt =
      "{law: belt, specific_stiffness: 1 N/mm, width: 1 mm, tight_length: 1 mm, slack_length: 1 mm";
  EXPECT_NE(refusal("leg.mount.rz", belt + "}").find("'pulley_radius' is missing"), std::string::npos);
  EXPECT_NE(refusal("leg.mount.tz", belt + ", pulley_radius: 1 mm}").find("pulley_radius: unknown key"),
            std::string::npos);
  EXPECT_NE(refusal("leg.ball_joint.preload", "{tz: 1 N}").find("friction, which keeps no force"), std::string::npos);
  EXPECT_NE(refusal("geometry", "second_order").find("did you mean 'second-order'"), std::string::npos);
}

TEST(Beside, IsOneMoreLegForEachLeg) {
  const Mechanism m = full();
  const Pose pose = test::home(m);
  const Configuration c = configure(m, pose);
  EXPECT_EQ(leg_count(m), 6);
  ASSERT_EQ(c.legs.size(), 12u);
  for (std::size_t leg = 0; leg < 6; ++leg) {
    EXPECT_FALSE(c.legs[leg].beside);
    const PlacedLeg& beside_leg = c.legs[6 + leg];
    EXPECT_TRUE(beside_leg.beside);
    EXPECT_EQ(beside_leg.name, fmt::format("leg {} friction", leg + 1));
    ASSERT_EQ(beside_leg.parts.size(), 1u);
    const auto& joint = std::get<PlacedJoint>(beside_leg.parts[0]);
    const SixPsuLeg at = leg_at(test::six_psu(m), static_cast<int>(leg) + 1, pose);
    EXPECT_EQ(joint.p_W, at.p_WC);
    EXPECT_LE((joint.R_WJ.col(2) - (at.p_WC - at.p_WB).normalized()).norm(), 1e-15);
    EXPECT_TRUE(joint.free(0) && joint.free(5) && joint.elastic(2));
  }
  Configuration numbered = c;
  EXPECT_EQ(number_slips(numbered), 6 * 2 + 6);  // ball joint and mount of each leg, and beside it
}

TEST(Beside, IsEditedAndRefused) {
  Mechanism m = test::with(full(), "beside.friction.tz.force", "5 N");
  EXPECT_EQ(std::get<FrictionLaw>(m.beside[0].second.laws[2].at(0)).force, 5);
  m = test::with(m, "beside.friction.tz", "{law: linear, stiffness: 1 N/mm}", Edit::Action::append);
  EXPECT_EQ(m.beside[0].second.laws[2].size(), 2u);
  m = test::with(test::device("haptic-6psu-ideal-joints"), "beside", beside);  // set where there was none
  EXPECT_EQ(m.beside.size(), 1u);
  EXPECT_NE(refusal("beside.friction.freedoms", "ffrffa").find("are not six letters r or f"), std::string::npos);
  EXPECT_NE(refusal("beside.friction.at", "D").find("unknown point 'D'"), std::string::npos);
  EXPECT_NE(refusal("beside.friction.joint", "prismatic").find("unknown joint type"), std::string::npos);
  EXPECT_THROW(test::with(test::device("tripteron"), "beside", beside), InputError);
}

}  // namespace
}  // namespace deflect
