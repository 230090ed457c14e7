// Tolerances of single numbers: what a key means, by how much it moves what, and what is refused.
#include "msa/mechanism/tolerances.h"

#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/numbers.h"
#include "tests/support/devices.h"
#include "tests/support/same_mechanism.h"

namespace deflect {
namespace {

const std::string arm = R"(name: arm
kinematics: {family: chains}
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {rod: {shape: box, width_y: 20 mm, height_z: 30 mm, wall: 2 mm}}
mounts:
  - base: {shift: [100 mm, 0 mm, 0 mm]}
  - base: {shift: [-100 mm, 0 mm, 50 mm]}
leg:
  motor: {joint: motor, rz: {law: linear, stiffness: 100 Nm/rad}}
  rod: {member: rod, material: steel, along: [0 mm, 300 mm, 400 mm]}
  elbow: {joint: custom, freedoms: ffffff, rx: [{law: linear, stiffness: 20 Nm/rad}, {law: clearance, gap: 1 mrad}]}
workspace: {cube_edge: 1 mm}
)";

Mechanism with_tolerances(const std::string& text) {
  return resolved(parse_mechanism(arm + "tolerances: {" + text + "}\n", "arm.yaml"));
}

std::vector<std::string> names(const std::vector<NumberMove>& moves) {
  std::vector<std::string> out;
  for (const NumberMove& move : moves) out.push_back(move.name);
  return out;
}

double value(const Mechanism& m, const std::string& path) {
  for (const DescribedNumber& n : described_numbers(m))
    if (n.path == path) return n.value;
  ADD_FAILURE() << "no number " << path;
  return 0;
}

using Names = std::vector<std::string>;

TEST(NumberTolerances, OfALegsNumberIsOneForEachLeg) {
  const Mechanism m = with_tolerances("drive.stiffness: 10 %");
  const std::vector<NumberMove> moves = number_moves(m);
  ASSERT_EQ(names(moves), (Names{"leg 1 motor rz stiffness", "leg 2 motor rz stiffness"}));
  EXPECT_EQ(moves[1].sigma, 0.1);
  const Mechanism off = moved(m, moves[1], 2);
  EXPECT_EQ(value(off, "leg[1].motor.rz.0.stiffness"), 100);
  EXPECT_NEAR(value(off, "leg[2].motor.rz.0.stiffness"), 120, 1e-12);
}

TEST(NumberTolerances, KeysMeanKindsOfPlaceOrPaths) {
  const auto meant = [](const std::string& text) { return names(number_moves(with_tolerances(text))); };
  EXPECT_EQ(meant("joint.stiffness: 5 %"), (Names{"leg 1 elbow rx stiffness", "leg 2 elbow rx stiffness"}));
  EXPECT_EQ(meant("joint.gap: 5 %"), (Names{"leg 1 elbow rx gap", "leg 2 elbow rx gap"}));
  EXPECT_EQ(meant("leg.elbow.rx.stiffness: 5 %"), (Names{"leg 1 elbow rx stiffness", "leg 2 elbow rx stiffness"}));
  EXPECT_EQ(meant("\"leg[2].elbow.rx.stiffness\": 5 %"), Names{"leg 2 elbow rx stiffness"});
  EXPECT_EQ(meant("section.wall: 5 %"), Names{"rod wall"});
  EXPECT_EQ(meant("sections.rod.wall: 0.1 mm"), Names{"rod wall"});
  EXPECT_EQ(meant("material.E: 1 %"), Names{"steel E"});
  EXPECT_EQ(meant("mounts.1.base.shift: 1 %"), (Names{"leg 2 base shift x", "leg 2 base shift z"}));
  EXPECT_EQ(meant("joint.position: 0.1 mm").size(), 12u);  // two seats of each leg, three axes
  EXPECT_EQ(meant("member.bending_factor: 3 %"), (Names{"leg 1 rod bending_factor", "leg 2 rod bending_factor"}));
}

TEST(NumberTolerances, AMemberIsLongerAlongItself) {
  const Mechanism m = with_tolerances("member.length: 0.5 mm");
  const std::vector<NumberMove> moves = number_moves(m);
  ASSERT_EQ(names(moves), (Names{"leg 1 rod length", "leg 2 rod length"}));
  const Mechanism longer = moved(m, moves[0]);
  EXPECT_NEAR(value(longer, "leg[1].rod.along.1"), 0.3 + 0.6 * 0.5e-3, 1e-15);
  EXPECT_NEAR(value(longer, "leg[1].rod.along.2"), 0.4 + 0.8 * 0.5e-3, 1e-15);
  const Mechanism share = with_tolerances("member.length: 1 %");
  EXPECT_NEAR(value(moved(share, number_moves(share)[0]), "leg[1].rod.along.2"), 0.404, 1e-15);
}

TEST(NumberTolerances, OfA6PsuLinksAndJointsAreThoseOfTheNamedOnes) {
  Mechanism m = test::device("haptic-6psu");
  m.tolerances.link_length = 3e-6;
  m.tolerances.joint_position = 0;
  m.tolerances.numbers = {{"member.length", "4 um"}, {"joint.position", "10 um"}};
  EXPECT_NEAR(named_tolerances(m).link_length, 5e-6, 1e-20);
  EXPECT_NEAR(named_tolerances(m).joint_position, 1e-5, 1e-20);
  EXPECT_TRUE(number_moves(resolved(m)).empty());
}

TEST(NumberTolerances, AreKeptInTheFile) {
  const Mechanism m = parse_mechanism(arm + "tolerances: {modulus: 1 %, leg.motor.rz.stiffness: 20 %}\n", "arm.yaml");
  EXPECT_EQ(m.tolerances.modulus, 0.01);
  EXPECT_EQ(parse_mechanism(write_mechanism(m), "again"), m);
}

TEST(NumberTolerances, AreLeftOutWhereAnEffectTookTheirNumberAway) {
  const Mechanism m = parse_mechanism(arm + "tolerances: {drive.stiffness: 10 %}\n", "arm.yaml");
  const Mechanism rigid = edited(m, {"leg.motor.rz", "[]"});
  EXPECT_TRUE(number_moves(resolved(rigid)).empty());
  const Mechanism softer = edited(m, {"leg.motor.rz", "{law: linear, stiffness: 50 Nm/rad}", Edit::Action::append});
  EXPECT_EQ(number_moves(resolved(softer)).size(), 4u);
}

TEST(NumberTolerances, MistakesAreToldWithTheirLine) {
  const std::pair<const char*, std::vector<const char*>> mistakes[] = {
      {"modulos: 1 %", {"tolerances.modulos: unknown key", "did you mean 'modulus'?"}},
      {"leg.elbov.rx.stiffness: 1 %", {"tolerances.leg.elbov.rx.stiffness", "did you mean 'leg.elbow.rx.stiffness'?"}},
      {"drive.stifness: 1 %", {"did you mean 'drive.stiffness'?"}},
      {"drive.stiffness: 1 mm", {"tolerances.drive.stiffness", "'1 mm'"}},
      {"drive.stiffness: -1 %", {"must be at least 0"}},
      {"drive.stiffness: 1e300 %", {"'1e300 %' is a standard deviation larger than the number itself: at most 100 %"}},
      {"member.length: 1e300 m", {"'1e300 m' is too large for a length"}},
      {"modulus: 1e300 %", {"tolerances.modulus: '1e300 %' must be"}},
      {"drive.stiffness: 5", {"tolerances.drive.stiffness", "'5'"}},
      {"drive.stiffness: [1 %]", {"a single value is wanted"}},
      {"mounts.0.platform.shift: 1 %", {"is a share of a number that is zero"}},
  };
  for (const auto& [text, says] : mistakes) try {
      with_tolerances(text);
      ADD_FAILURE() << text << " was taken";
    } catch (const InputError& e) {
      const std::string message = e.what();
      EXPECT_EQ(message.find("arm.yaml:13: "), 0u) << message;
      for (const char* phrase : says)
        EXPECT_NE(message.find(phrase), message.npos) << message << "\n  lacks " << phrase;
    }
}

TEST(NumberTolerances, AreTheSameOfAMechanismWhoseLegsAreWorkedOut) {
  Mechanism m = test::device("arm");
  m.tolerances.numbers = {{"drive.stiffness", "2 %"}, {"joint.position", "0.1 mm"}};
  const Mechanism once = resolved(m);
  const std::size_t count = number_moves(once).size();
  EXPECT_GT(count, 0u);
  EXPECT_EQ(number_moves(resolved(once)).size(), count);
  EXPECT_EQ(resolved(once).legs.size(), once.legs.size());
}

}  // namespace
}  // namespace deflect
