// Device files of chains: every field in and out, edits inside mounts and branches, mistakes.
#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "tests/support/chains.h"
#include "tests/support/same_mechanism.h"

namespace deflect {
namespace {

using test::with;

/// Every field of a chain once. The line numbers of the mistakes below count from "name" = 1.
const std::string everything = R"(name: everything
kinematics:
  family: chains
  home: {shift: [0 mm, !ours 0 mm, 1.5 m], turn: [0 deg, 2 deg, 0 rad]}
  controller: [[1, 0, 0], [0.5, !ours 2, 0], [0, 0, -1]]
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {rod: {shape: round, diameter: 20 mm}}
mounts:
  - base: {shift: [1 m, 0 m, 0 m], turn: [0 deg, 0 deg, !ours 90 deg]}
    platform: {shift: [0.1 m, 0 m, 0 m]}
  - {}
  - platform: {turn: [1 deg, 0 deg, 0 deg]}
    leg:
      own_slide: {joint: prismatic}
      own_rod: {member: rod, material: steel, from: own_slide}
leg:
  slide:
    joint: prismatic
    axis: [0, !ours 1, 0.5]
    axes: after
    home: {tz: !ours 120 mm}
    min: {tz: 10 mm}
    max: {tz: 200 mm}
    tz: {law: linear, stiffness: 500 N/mm}
    preload: {tz: -20 N}
  table: {joint: custom, freedoms: rrffrf, home: {tz: 1 mm, rx: 1 deg}, min: {rz: -90 deg}}
  wrist: {joint: revolute, dh: {theta: 10 deg, d: 1 mm, a: 2 mm, alpha: !ours 90 deg}}
  knuckle: {joint: revolute, modified_dh: {a: 2 mm}}
  turn: {offset: [0 mm, 0 mm, 0 mm], turn: [90 deg, 0 deg, 0 deg]}
  step: {offset: [0 mm, !ours 3 mm, 0 mm]}
  block:
    joint: fixed
    stiffness:
      units: N-m
      rows: [[2, 0, 0, 0, 0, 0.5], [0, 2, 0, 0, 0, 0], [0, 0, 3, 0, 0, 0], [0, 0, 0, 4, 0, 0], [0, 0, 0, 0, 5, 0], [0.5, 0, 0, 0, 0, 6]]
  rod: {member: rod, material: steel, along: [0 mm, 0 mm, 1 m], beam: timoshenko, bending_factor: 90 %}
  bars: {joint: parallelogram, bar: [0 mm, 200 mm, 5 mm], home: {tx: 10 mm}, max: {tx: 50 mm}}
  fork:
    mounts:
      - base: {shift: [0 mm, 50 mm, 0 mm]}
        platform: {shift: [0 mm, 50 mm, 0 mm]}
      - base: {shift: [0 mm, -50 mm, 0 mm]}
        leg:
          other: {member: rod, material: steel, from: rod}
    leg:
      ball: {joint: ball, home: {ry: 30 deg}}
      prong: {member: rod, material: steel, along: [!ours 300 mm, 0 mm, 0 mm]}
variations:
  - {leg: 2, path: rod.along, value: [0 mm, 0 mm, 1.01 m]}
  - {leg: 1, path: fork.mounts.0.base.shift, value: [0 mm, !ours 51 mm, 0 mm]}
base: {joint: fixed, rz: {law: linear, stiffness: 1e6 Nmm/rad}, preload: {rz: 3 Nmm}}
payload: !ours 2 kg
misfits:
  - {leg: 3, base: {shift: [0.1 mm, 0 mm, 0 mm]}, platform: {turn: [0 deg, 0.1 deg, 0 deg]}}
workspace: {cube_edge: 50 mm}
)";

template <class T>
const T& part(const Named<Part>& parts, const char* name) {
  return std::get<T>(*find(parts, name));
}

TEST(ChainFile, EverythingIsRead) {
  const Mechanism m = parse_mechanism(everything, "everything");
  const Chains& k = std::get<Chains>(m.kinematics);
  EXPECT_EQ(k.home->shift, Vector3(0, 0, 1.5));
  EXPECT_EQ(k.home->turn, Vector3(0, 2 * pi / 180, 0));
  EXPECT_EQ(k.controller, (Matrix3() << 1, 0, 0, 0.5, 2, 0, 0, 0, -1).finished());
  ASSERT_EQ(m.mounts.size(), 3u);
  EXPECT_EQ(m.mounts[0].base.turn.z(), pi / 2);
  EXPECT_EQ(part<Member>(m.mounts[2].leg, "own_rod").from, "own_slide");
  const Joint& slide = part<Joint>(m.leg, "slide");
  EXPECT_EQ(slide.axis, Vector3(0, 1, 0.5));
  EXPECT_EQ(slide.axes, "after");
  EXPECT_EQ(slide.home[2], 0.12);
  EXPECT_EQ(*slide.min[2], 0.01);
  EXPECT_EQ(*slide.max[2], 0.2);
  EXPECT_EQ(slide.preload[2], -20);
  EXPECT_EQ(part<Joint>(m.leg, "table").freedoms, "rrffrf");
  EXPECT_EQ(part<Joint>(m.leg, "wrist").dh->alpha, pi / 2);
  EXPECT_EQ(part<Joint>(m.leg, "knuckle").modified_dh->a, 0.002);
  EXPECT_EQ(part<Offset>(m.leg, "turn").turn.x(), pi / 2);
  EXPECT_EQ((*part<Joint>(m.leg, "block").stiffness)(0, 5), 0.5);
  EXPECT_EQ(part<Member>(m.leg, "rod").along->z(), 1);
  EXPECT_EQ(part<Joint>(m.leg, "bars").bar, Vector3(0, 0.2, 0.005));
  const Parallel& fork = part<Parallel>(m.leg, "fork");
  EXPECT_EQ(part<Member>(fork.mounts[1].leg, "other").from, "rod");
  EXPECT_EQ(part<Joint>(fork.leg, "ball").home[4], 30 * pi / 180);
  EXPECT_EQ(part<Member>(leg_parts(m, 2), "rod").along->z(), 1.01);
  EXPECT_EQ(part<Parallel>(leg_parts(m, 1), "fork").mounts[0].base.shift.y(), 0.051);
  EXPECT_EQ(m.base.preload[5], 0.003);
  EXPECT_EQ(m.payload, 2);
  EXPECT_EQ(m.misfits[0].platform.turn.y(), 0.1 * pi / 180);
  const std::set<std::string> ours = {"kinematics.home.shift.1", "kinematics.controller.1.1",
                                      "mounts.0.base.turn.2",    "leg.slide.axis.1",
                                      "leg.slide.home.tz",       "leg.wrist.dh.alpha",
                                      "leg.step.offset.1",       "leg.fork.leg.prong.along.0",
                                      "variations.1.value.1",    "payload"};
  EXPECT_EQ(m.ours, ours);
}

TEST(ChainFile, WhatIsWrittenReadsBackTheSame) {
  std::vector<Mechanism> all = {parse_mechanism(everything, "everything")};
  for (const char* name : {"tripteron", "fanuc-r2000ic", "stewart-6ups", "delta", "hybrid"})
    all.push_back(test::device(name));
  for (const Mechanism& m : all) {
    const std::string once = write_mechanism(m);
    const Mechanism again = parse_mechanism(once, "written");
    EXPECT_EQ(write_mechanism(again), once);
    EXPECT_EQ(again.ours, m.ours) << m.name;
  }
}

TEST(ChainFile, EditsReachIntoMountsBranchesAndSingleLegs) {
  const Mechanism m = parse_mechanism(everything, "everything");
  EXPECT_EQ(with(m, "mounts.1.base.shift", "[1 mm, 2 mm, 3 mm]").mounts[1].base.shift, Vector3(1e-3, 2e-3, 3e-3));
  EXPECT_EQ(with(m, "mounts.*.base.shift", "[1 mm, 2 mm, 3 mm]").mounts[2].base.shift, Vector3(1e-3, 2e-3, 3e-3));
  EXPECT_EQ(part<Member>(with(m, "mounts.2.leg.own_rod.from", "own_slide").mounts[2].leg, "own_rod").from, "own_slide");
  const Mechanism longer = with(m, "leg.fork.leg.prong.along.0", "2", Edit::Action::multiply);
  EXPECT_EQ(part<Member>(part<Parallel>(longer.leg, "fork").leg, "prong").along->x(), 0.6);
  EXPECT_EQ(part<Parallel>(with(m, "leg.fork.mounts.1.platform.shift", "[0 mm, 1 mm, 0 mm]").leg, "fork")
                .mounts[1]
                .platform.shift.y(),
            1e-3);
  // One leg: a variation where the legs share their parts, the leg itself where it has its own.
  const Mechanism one = with(m, "leg[2].fork.leg.prong.along", "[301 mm, 0 mm, 0 mm]");
  EXPECT_EQ(part<Member>(part<Parallel>(leg_parts(one, 2), "fork").leg, "prong").along->x(), 0.301);
  EXPECT_EQ(part<Member>(part<Parallel>(leg_parts(one, 1), "fork").leg, "prong").along->x(), 0.3);
  EXPECT_EQ(one.variations.size(), 3u);
  const Mechanism own = with(m, "leg[3].own_rod.bending_factor", "0.5");
  EXPECT_EQ(part<Member>(own.mounts[2].leg, "own_rod").bending_factor, 0.5);
  EXPECT_EQ(own.variations.size(), 2u);
  EXPECT_EQ(with(m, "leg.turn.turn", "[0 deg, 0 deg, 0 deg]"),
            parse_mechanism(write_mechanism(with(m, "leg.turn.turn", "[0 deg, 0 deg, 0 deg]")), "again"));
  EXPECT_THROW(with(m, "leg[4].rod.beam", "timoshenko"), InputError);
  EXPECT_THROW(with(m, "leg[2].other.beam", "timoshenko"), InputError);
}

struct Mistake {
  const char* old_text;
  const char* new_text;
  int line;
  std::vector<const char*> says;
};

const std::vector<Mistake> mistakes = {
    // Kinematics
    {"[[1, 0, 0], [0.5, !ours 2, 0], [0, 0, -1]]",
     "[[1, 0], [0, 1], [1, 1]]",
     5,
     {"kinematics.controller.0", "rows of as many numbers"}},
    {"[[1, 0, 0], [0.5, !ours 2, 0], [0, 0, -1]]",
     "[[1, 2, 0], [2, 4, 0], [0, 0, 1]]",
     5,
     {"kinematics.controller: is singular"}},
    {"[[1, 0, 0], [0.5, !ours 2, 0], [0, 0, -1]]", "[]", 5, {"kinematics.controller: as many rows"}},
    {"[[1, 0, 0],", "[[1, 0, 1 mm],", 5, {"kinematics.controller.0.2"}},
    {"[[1, 0, 0], [0.5, !ours 2, 0], [0, 0, -1]]",
     "[[1, 0], [0, 1]]",
     5,
     {"kinematics.controller: has 2 rows, and the mechanism 3 actuated coordinates (leg 1 slide, leg 2 slide, leg 3 "
      "own_slide)",
      "write as many rows of as many numbers, or leave the controller out"}},
    {"[[1, 0, 0], [0.5, !ours 2, 0], [0, 0, -1]]",
     "[[1]]",
     5,
     {"kinematics.controller: has 1 row, and the mechanism 3 actuated coordinates"}},
    {"home: {shift: [0 mm, !ours 0 mm, 1.5 m]",
     "home: {shift: [0, 0, 1.5]",
     4,
     {"kinematics.home.shift.0: '0' has no unit"}},
    {"turn: [0 deg, 2 deg, 0 rad]}",
     "turn: [0 deg, 2 mm, 0 rad]}",
     4,
     {"kinematics.home.turn.1", "an angle is wanted"}},
    // Mounts
    {"base: {shift: [1 m, 0 m, 0 m], turn",
     "base: {shfit: [1 m, 0 m, 0 m], turn",
     9,
     {"mounts.0.base.shfit: unknown key, did you mean 'shift'?"}},
    {"    platform: {shift: [0.1 m, 0 m, 0 m]}",
     "    platfrom: {shift: [0.1 m, 0 m, 0 m]}",
     10,
     {"mounts.0.platfrom: unknown key, did you mean 'platform'?"}},
    {"from: own_slide",
     "from: slide",
     15,
     {"mounts.2.leg.own_rod.from: unknown earlier part of the leg 'slide' (known: own_slide)"}},
    {"from: own_slide", "from: own_rod", 15, {"mounts.2.leg.own_rod.from: unknown earlier part of the leg 'own_rod'"}},
    // Joints
    {"axis: [0, !ours 1, 0.5]", "axis: [0, 0, 0]", 19, {"leg.slide.axis: is no direction", "'axis: [0, 0, 1]'"}},
    {"axis: [0, !ours 1, 0.5]", "axis: [0 mm, 1 mm, 0 mm]", 19, {"leg.slide.axis.0"}},
    {"axis: [0, !ours 1, 0.5]", "axis: z", 19, {"leg.slide.axis: a list of three values"}},
    {"axes: after", "axes: behind", 20, {"leg.slide.axes: unknown place of the axes 'behind' (known: before, after)"}},
    {"home: {tz: !ours 120 mm}", "home: {tz: 3 deg}", 21, {"leg.slide.home.tz", "a length is wanted"}},
    {"home: {tz: !ours 120 mm}",
     "home: {tx: 120 mm}",
     21,
     {"leg.slide.home: tx is no coordinate of this joint, which moves in tz"}},
    {"min: {tz: 10 mm}",
     "min: {rz: 10 deg}",
     22,
     {"leg.slide.min: rz is no coordinate of this joint, which moves in tz"}},
    {"max: {tz: 200 mm}", "max: {ty: 200 mm}", 23, {"leg.slide.max: ty is no coordinate"}},
    {"max: {tz: 200 mm}", "max: {tz: 5 mm}", 23, {"leg.slide.max: tz must be above that of min"}},
    {"max: {tz: 200 mm}", "max: {tz: 10 mm}", 23, {"leg.slide.max: tz must be above that of min"}},
    {"max: {tz: 200 mm}", "max: {tz: 119 mm}", 21, {"leg.slide.home: tz lies outside of the joint's min … max"}},
    {"preload: {tz: -20 N}",
     "preload: {tx: -20 N}",
     25,
     {"leg.slide.preload: acts in the laws of a freedom: tx has none"}},
    {"preload: {tz: -20 N}", "preload: {tz: -20 mm}", 25, {"leg.slide.preload.tz", "a force is wanted"}},
    {"freedoms: rrffrf, ", "", 26, {"leg.table: 'freedoms' is missing"}},
    {"freedoms: rrffrf", "freedoms: rrffr", 26, {"leg.table.freedoms: 'rrffr' are not six letters r, f or a"}},
    {"freedoms: rrffrf", "freedoms: rrxfrf", 26, {"leg.table.freedoms: 'rrxfrf' are not six letters"}},
    {"joint: custom, freedoms", "joint: fixed, freedoms", 26, {"leg.table.freedoms: unknown key"}},
    {"home: {tz: 1 mm, rx: 1 deg}",
     "home: {tz: 1 mm, ry: 1 deg}",
     26,
     {"leg.table.home: ry is no coordinate of this joint, which moves in tz, rx, rz"}},
    {"dh: {theta: 10 deg, d", "dh: {theta: 10 mm, d", 27, {"leg.wrist.dh.theta"}},
    {"modified_dh: {a: 2 mm}",
     "dh: {a: 1 mm}, modified_dh: {a: 2 mm}",
     28,
     {"leg.knuckle.modified_dh: a joint has one row"}},
    {"modified_dh: {a: 2 mm}", "modified_dh: {r: 2 mm}", 28, {"leg.knuckle.modified_dh.r: unknown key"}},
    {"turn: {offset: [0 mm, 0 mm, 0 mm]",
     "turn: {offset: [0 mm, 0 mm]",
     29,
     {"leg.turn.offset: a list of three values"}},
    {"units: N-m\n", "units: N-cm\n", 34, {"leg.block.stiffness.units: unknown set of units 'N-cm'"}},
    {"[2, 0, 0, 0, 0, 0.5]",
     "[2, 0, 0, 0, 0, 0.4]",
     35,
     {"leg.block.stiffness.rows: a stiffness is symmetric; this one is not"}},
    {"[0, 2, 0, 0, 0, 0]",
     "[0, -2, 0, 0, 0, 0]",
     35,
     {"leg.block.stiffness.rows: a stiffness is positive definite; this one is not"}},
    {"[0, 2, 0, 0, 0, 0]", "[0, 0, 0, 0, 0, 0]", 35, {"leg.block.stiffness.rows: a stiffness is positive definite"}},
    {", [0.5, 0, 0, 0, 0, 6]", "", 35, {"leg.block.stiffness.rows: 6 rows of 6 numbers are wanted"}},
    {"    joint: fixed\n    stiffness:",
     "    joint: fixed\n    tx: {law: linear, stiffness: 1 N/mm}\n    stiffness:",
     35,
     {"leg.block.stiffness: a joint has a stiffness of all freedoms or laws, not both"}},
    {"along: [0 mm, 0 mm, 1 m]", "along: [0 mm, 0 mm, 0 m]", 36, {"leg.rod.along: the member has no length"}},
    {"along: [0 mm, 0 mm, 1 m]", "along: [0 mm, 0 mm, 1 m], from: slide", 36, {"leg.rod: only one of 'along', 'from'"}},
    {", along: [0 mm, 0 mm, 1 m]", "", 36, {"leg.rod: one of 'along', 'from' is wanted"}},
    {"along: [0 mm, 0 mm, 1 m]", "from: fork", 36, {"leg.rod.from: unknown earlier part of the leg 'fork'"}},
    {"bar: [0 mm, 200 mm, 5 mm], ", "", 37, {"leg.bars.bar: needs a length across z"}},
    {"bar: [0 mm, 200 mm, 5 mm]", "bar: [0 mm, 0 mm, 5 mm]", 37, {"leg.bars.bar: needs a length across z"}},
    {"joint: parallelogram, bar", "joint: revolute, bar", 37, {"leg.bars.bar: unknown key"}},
    // Branches
    {"from: rod}", "from: ball}", 44, {"leg.fork.mounts.1.leg.other.from: unknown earlier part of the leg 'ball'"}},
    {"ball: {joint: ball, home: {ry: 30 deg}}",
     "ball: {joint: ball, max: {ry: 30 deg}}",
     46,
     {"leg.fork.leg.ball.max: ry has no limits"}},
    {"      - base: {shift: [0 mm, 50 mm, 0 mm]}\n        platform: {shift: [0 mm, 50 mm, 0 mm]}\n      - base: "
     "{shift: [0 mm, -50 mm, 0 mm]}\n        leg:\n          other: {member: rod, material: steel, from: rod}\n",
     "      []\n",
     40,
     {"leg.fork.mounts: needs at least one branch"}},
    {"    leg:\n      ball: {joint: ball, home: {ry: 30 deg}}\n      prong: {member: rod, material: steel, along: "
     "[!ours 300 mm, 0 mm, 0 mm]}\n",
     "",
     38,
     {"leg.fork.leg: is missing: the parts of every branch"}},
    // Legs
    {"leg: 2, path: rod", "leg: 4, path: rod", 49, {"variations.0.leg: '4' must be a whole number from 1 to 3"}},
    {"leg: 2, path: rod.along, value: [0 mm, 0 mm, 1.01 m]",
     "leg: 3, path: own_rod.bending_factor, value: 2",
     0,
     {"leg 3 has parts of its own: change them in mounts.2.leg"}},
    {"misfits:\n  - {leg: 3", "misfits:\n  - {leg: 5", 54, {"misfits.0.leg: '5' must be a whole number from 1 to 3"}},
    {"payload: !ours 2 kg", "payload: -2 kg", 52, {"payload: '-2 kg' must be at least 0"}},
    {"payload: !ours 2 kg", "payload: 2 N", 52, {"payload"}},
    {"workspace: {cube_edge",
     "workspace: {nominal_slider: 1 mm, cube_edge",
     55,
     {"workspace.nominal_slider: unknown key"}},
};

std::string refusal(const std::string& text) {
  try {
    parse_mechanism(text, "my.yaml");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(ChainFile, MistakesAreToldWithLineAndRemedy) {
  for (const Mistake& m : mistakes) {
    std::string text = everything;
    const std::size_t at = text.find(m.old_text);
    ASSERT_NE(at, text.npos) << m.old_text;
    text.replace(at, std::string(m.old_text).size(), m.new_text);
    const std::string message = refusal(text), place = m.line > 0 ? fmt::format("my.yaml:{}: ", m.line) : "my.yaml: ";
    EXPECT_EQ(message.substr(0, place.size()), place) << message << "\n  for " << m.new_text;
    for (const char* phrase : m.says)
      EXPECT_NE(message.find(phrase), message.npos) << message << "\n  lacks: " << phrase << "\n  for " << m.new_text;
  }
}

TEST(ChainFile, LegsWithoutParts) {
  const std::string head = "name: a\nkinematics: {family: chains}\n";
  const std::string own = "{leg: {s: {joint: prismatic}}}";
  EXPECT_NE(refusal(head).find("leg: is missing: the parts of every leg, or of each in its mount"), std::string::npos);
  EXPECT_NE(refusal(head + "leg: {}\n").find("leg: is missing"), std::string::npos);
  EXPECT_NE(refusal(head + "mounts: [" + own + ", {}]\n").find("leg: is missing"), std::string::npos);
  EXPECT_EQ(refusal(head + "mounts: [" + own + ", " + own + "]\n"), "");
  EXPECT_EQ(refusal(head + "leg: {s: {joint: prismatic}}\n"), "");
}

}  // namespace
}  // namespace deflect
