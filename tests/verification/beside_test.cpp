// Laws side by side with those of a joint's freedom, and members whose ends yield: both theories, against hand values
// and against the same machine written in another way.
#include <gtest/gtest.h>

#include "analytic/model.h"
#include "msa/base/error.h"
#include "msa/frame/mechanism/msa.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/chains.h"
#include "tests/support/devices.h"

namespace deflect {
namespace {

using test::with;
constexpr auto append = Edit::Action::append;

/// Largest difference of what two machines do under six loads, relative, by both theories, in a geometry.
void expect_same(const Mechanism& a, const Mechanism& b, double to, Geometry geometry = Geometry::linear) {
  const Pose pose = home_pose(a);
  const Configuration ca = configure(a, pose), cb = configure(b, pose);
  const analytic::AnalyticModel analytic_a(ca), analytic_b(cb);
  frame::MsaModel msa_a(ca), msa_b(cb);
  for (Eigen::Index i = 0; i < 6; ++i) {
    const Vector6 F = Vector6::Unit(i) * (i < 3 ? 20 : 5);
    const Vector6 d = analytic_a.solve(F, geometry).displacement;
    const double size = d.head<3>().norm() + ca.size * d.tail<3>().norm();
    const auto expect = [&](const Vector6& other, const char* who) {
      const Vector6 off = other - d;
      EXPECT_LE(off.head<3>().norm() + ca.size * off.tail<3>().norm(), to * size) << who << ", load " << i;
    };
    expect(analytic_b.solve(F, geometry).displacement, "closed form");
    if (geometry != Geometry::linear) continue;  // discretised there
    expect(msa_a.solve(F).displacement, "MSA of the first");
    expect(msa_b.solve(F).displacement, "MSA of the second");
  }
}

TEST(SideBySide, SpringsAddUpInEveryFamily) {
  const Mechanism tripteron = test::device("tripteron");
  expect_same(with(tripteron, "leg.slide.beside.tz", "{law: linear, stiffness: 500 N/mm}", append),
              with(tripteron, "leg.slide.tz.stiffness", "1500 N/mm"), 1e-9);
  const Mechanism delta = test::device("delta");
  expect_same(with(delta, "leg.motor.beside.rz", "{law: linear, stiffness: 3e7 Nmm/rad}", append),
              with(delta, "leg.motor.rz.stiffness", "5e7 Nmm/rad"), 1e-9);
  const Mechanism haptic =
      with(test::device("haptic-6psu-ideal-joints"), "leg.actuator.tz", "{law: linear, stiffness: 700 N/mm}", append);
  expect_same(with(haptic, "leg.actuator.beside.tz", "{law: linear, stiffness: 300 N/mm}", append),
              with(haptic, "leg.actuator.tz.stiffness", "1000 N/mm"), 1e-9);
}

TEST(SideBySide, SpringsAddUpInTheDeformedShape) {
  const Mechanism arm = test::device("arm");
  expect_same(with(arm, "leg.joint_2.beside.rz", "{law: linear, stiffness: 1e4 Nm/rad}", append),
              with(arm, "leg.joint_2.rz.stiffness", "5e4 Nm/rad"), 1e-6, Geometry::finite);
}

// On a freedom that is free a law side by side with it is the law alone.
TEST(SideBySide, OfAFreeFreedomIsTheLawItself) {
  const Mechanism m = test::device("tripteron");
  expect_same(with(m, "leg.elbow.beside.rz", "{law: linear, stiffness: 1e6 Nmm/rad}", append),
              with(m, "leg.elbow.rz", "{law: linear, stiffness: 1e6 Nmm/rad}", append), 1e-12);
}

TEST(SideBySide, ASeriesStandsBesideAsAWhole) {
  const Mechanism m = test::device("tripteron");
  // 1000 and 1000 N/mm in series are 500; with 250 beside 750.
  const Mechanism series = with(m, "leg.slide.tz", "{law: linear, stiffness: 1000 N/mm}", append);
  expect_same(with(series, "leg.slide.beside.tz", "{law: linear, stiffness: 250 N/mm}", append),
              with(m, "leg.slide.tz.stiffness", "750 N/mm"), 1e-9);
}

const char* actuator = R"(name: drive
kinematics: {family: chains}
leg:
  drive: {joint: motor, rz: {law: linear, stiffness: 200 Nm/rad}, beside: {rz: {law: friction, moment: 3 Nm, stiffness: 800 Nm/rad}}}
  lever: {offset: [0 mm, 0 mm, 100 mm]}
)";

// A Jenkins element beside a spring, by hand as in friction_test.cpp: slips at 3/800 rad, where the whole carries
// 3.75 Nm; back from 10 Nm it sticks over twice that way.
TEST(SideBySide, FrictionBesideADriveLoadsSlipsAndSticksAsByHand) {
  const Configuration c = configure_joints(parse_mechanism(actuator, "actuator.yaml"), VectorX::Zero(1));
  const analytic::AnalyticModel analytic(c);
  frame::MsaModel msa(c);
  std::vector<double> slips;
  const auto turn = [&](double Nm) {
    Conditions at;
    at.slips = slips;
    const auto a = analytic.solve(Nm * Vector6::Unit(5), at);
    const auto f = msa.solve(Nm * Vector6::Unit(5), at);
    EXPECT_TRUE(a.converged) << a.message;
    EXPECT_NEAR(a.displacement(5), f.displacement(5), 1e-14);
    slips = a.slips;
    return a.displacement(5);
  };
  EXPECT_NEAR(turn(2), 2.0 / 1000, 1e-15);
  EXPECT_NEAR(turn(10), 7.0 / 200, 1e-14);
  EXPECT_NEAR(turn(4), 7.0 / 200 - 6.0 / 1000, 1e-14);
  EXPECT_NEAR(turn(0), (7.0 / 200 - 7.5 / 1000) - 2.5 / 200, 1e-14);
}

const char* pressed = R"(name: drive
kinematics: {family: chains}
leg:
  drive: {joint: motor, rz: [{law: linear, stiffness: 400 Nm/rad}, {law: linear, stiffness: 400 Nm/rad}], beside: {rz: {law: friction, moment: 1 Nm, share: 0.4, stiffness: 800 Nm/rad}}}
  lever: {offset: [0 mm, 0 mm, 100 mm]}
)";

/// Turns a drive about its axis by one moment after the other, by both theories, which agree.
class Turned {
 public:
  explicit Turned(const std::string& file)
      : analytic_(configure_joints(parse_mechanism(file, "drive.yaml"), VectorX::Zero(1))),
        msa_(configure_joints(parse_mechanism(file, "drive.yaml"), VectorX::Zero(1))) {}

  double operator()(double Nm, Geometry geometry = Geometry::linear) {
    Conditions at(geometry), msa_at(geometry);
    at.slips = slips_;
    msa_at.slips = msa_slips_;
    const auto a = analytic_.displaced(Nm * Vector6::Unit(5), at);
    const auto f = msa_.solve(Nm * Vector6::Unit(5), msa_at);
    EXPECT_TRUE(a.converged) << a.message;
    EXPECT_TRUE(f.state.converged) << f.state.message;
    const double to = geometry == Geometry::linear ? 1e-13 + 1e-11 * std::abs(a.displacement(5)) : 1e-9;
    EXPECT_NEAR(a.displacement(5), f.displacement(5), to) << Nm;
    slips_ = a.slips;
    msa_slips_ = f.slips;
    return a.displacement(5);
  }

 private:
  analytic::AnalyticModel analytic_;
  frame::MsaModel msa_;
  std::vector<double> slips_, msa_slips_;
};

// Springs of 200 Nm/rad that carry s beside a friction r, |r| ≤ 1 + 0.4 |s|, s + r = T. Loading: s = (T − 1)/1.4.
// Unloading from 29 Nm (s = 20, 0.1 rad) it sticks until r = −9, then s = (T + 1)/0.6; at no load s = 1/0.6.
TEST(SideBySide, FrictionGrowsWithTheLoadBesideIt) {
  Turned turn(pressed);
  EXPECT_NEAR(turn(0.5), 0.5 / 1000, 1e-14);
  EXPECT_NEAR(turn(29), 20.0 / 200, 1e-13);
  EXPECT_NEAR(turn(24), 0.1 - 5.0 / 1000, 1e-13);
  EXPECT_NEAR(turn(8), 9 / 0.6 / 200, 1e-13);
  EXPECT_NEAR(turn(0), 1 / 0.6 / 200, 1e-13);
  EXPECT_NEAR(turn(-29), -20.0 / 200, 1e-13);
  EXPECT_NEAR(turn(0), -1 / 0.6 / 200, 1e-13);
}

TEST(SideBySide, FrictionGrowsWithTheLoadInTheDeformedShapeToo) {
  Turned turn(pressed);
  EXPECT_NEAR(turn(29, Geometry::finite), 20.0 / 200, 1e-9);
  EXPECT_NEAR(turn(8, Geometry::finite), 9 / 0.6 / 200, 1e-9);
}

// A play and another friction beside the same springs: hand values at the ends, both theories all along the loop.
TEST(SideBySide, FrictionThatGrowsStandsBesidePlayAndOtherFriction) {
  std::string file = pressed;
  const auto replace = [&](const std::string& what, const std::string& by) {
    file.replace(file.find(what), what.size(), by);
  };
  replace("{law: linear, stiffness: 400 Nm/rad}]",
          "{law: hardening, stiffness: 900 Nm/rad, reference: 0.1 rad}, {law: clearance, gap: 0.01 rad}]");
  replace("{law: friction,", "[{law: friction, moment: 2 Nm, stiffness: 3000 Nm/rad}, {law: friction,");
  replace("stiffness: 800 Nm/rad}", "stiffness: 800 Nm/rad}]");
  Turned turn(file);
  for (int i = 0; i <= 400; ++i) turn(20 * std::sin(2 * pi * i / 160.0));
  // s = 12, with 2 and 1 + 0.4 · 12 of friction at the top of the loop.
  double hardening = 0;
  for (int i = 0; i < 100; ++i) hardening = 12 / 900.0 / (1 + 100 * hardening * hardening);
  EXPECT_NEAR(turn(12 + 2 + 1 + 4.8), 12 / 400.0 + hardening + 0.01, 1e-10);
}

// Two frictions beside a spring with play have nothing but each other to hold them while the play is open.
TEST(SideBySide, SeveralFrictionsBesidePlayAreSolvedAllAlongALoop) {
  Turned turn(R"(name: drive
kinematics: {family: chains}
leg:
  drive:
    joint: motor
    rz: [{law: linear, stiffness: 190 Nm/rad}, {law: clearance, gap: 5.7 mrad}]
    beside: {rz: [{law: friction, moment: 5.2 Nm, stiffness: 200 Nm/rad}, {law: friction, moment: 0 Nm, share: 0.46, stiffness: 7000 Nm/rad}]}
)");
  for (int i = 0; i <= 400; ++i) turn(35 * std::sin(2 * pi * i / 160.0));
}

// In a machine of several legs no leg's load is known beforehand.
TEST(SideBySide, FrictionGrowsWithTheLoadsOfSeveralLegs) {
  const Mechanism m = with(test::device("tripteron"), "leg.slide.beside.tz",
                           "{law: friction, force: 1 N, share: 0.6, stiffness: 300 N/mm}", append);
  const Configuration c = configure(m, home_pose(m));
  const analytic::AnalyticModel model(c), whole(c);
  frame::MsaModel msa(c);
  std::mt19937 random(4);
  std::vector<double> slips;
  for (int i = 0; i < 12; ++i) {
    const Vector6 F = test::random_wrench(random);
    Conditions at;
    at.slips = slips;
    const analytic::AnalyticSolution a = model.displaced(F, at), b = whole.solve(F, at);
    const frame::MsaSolution f = msa.solve(F, at);
    ASSERT_TRUE(a.converged && b.converged && f.state.converged) << a.message << b.message;
    EXPECT_LE((a.displacement - b.displacement).norm(), 1e-9 * b.displacement.norm()) << i;
    EXPECT_LE((f.displacement - b.displacement).norm(), 1e-9 * b.displacement.norm()) << i;
    slips = b.slips;
  }
}

TEST(SideBySide, ARigidFreedomRefusesIt) {
  const Mechanism m = test::device("tripteron");
  try {
    with(m, "leg.shoulder.beside.rx", "{law: linear, stiffness: 1e6 Nmm/rad}", append);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("rx is rigid here"), std::string::npos) << e.what();
  }
}

TEST(SideBySide, IsKeptByTheFile) {
  const Mechanism m = parse_mechanism(actuator, "actuator.yaml");
  EXPECT_EQ(write_mechanism(parse_mechanism(write_mechanism(m), "again.yaml")), write_mechanism(m));
  const auto* drive = std::get_if<Joint>(&m.leg.front().second);
  ASSERT_TRUE(drive);
  EXPECT_EQ(std::get<FrictionLaw>(drive->beside[5].at(0)).force, 3);
}

// For fits a load costs the laws that jump alone, at any temperature and in every geometry: the same displacement and
// slips as with everything solved.
TEST(Displaced, IsWhatSolveSays) {
  const Mechanism haptic = with(test::device("haptic-6psu-ideal-joints"), "leg.ball_joint.tz",
                                "[{law: clearance, gap: 0.02 mm}, {law: linear, stiffness: 2000 N/mm}]");
  const Mechanism two_sided = with(test::device("haptic-6psu-ideal-joints"), "leg.ball_joint.tz",
                                   "{law: one_sided, pull: 0.002 mm/N, push: 0.0005 mm/N}");
  const Mechanism rubbing = with(test::device("tripteron"), "leg.slide.beside.tz",
                                 "{law: friction, force: 5 N, stiffness: 300 N/mm}", append);
  for (const Mechanism& m : {haptic, two_sided, rubbing})
    for (const Geometry geometry : {Geometry::linear, Geometry::second_order, Geometry::finite}) {
      const Configuration c = configure(m, home_pose(m));
      const analytic::AnalyticModel model(c), whole(c);
      std::mt19937 random(4);
      Conditions quick(geometry), slow(geometry);
      for (int i = 0; i < 12; ++i) {
        const Vector6 F = test::random_wrench(random);
        quick.warmer = slow.warmer = i < 6 ? 0 : 7 * i - 60;
        const analytic::AnalyticSolution a = model.displaced(F, quick), b = whole.solve(F, slow);
        ASSERT_TRUE(a.converged && b.converged) << a.message << b.message;
        EXPECT_LE((a.displacement - b.displacement).norm(), 1e-9 * b.displacement.norm()) << m.name << " " << i;
        ASSERT_EQ(a.slips.size(), b.slips.size());
        for (std::size_t k = 0; k < a.slips.size(); ++k)
          EXPECT_NEAR(a.slips[k], b.slips[k], 1e-9 * b.displacement.norm());
        quick.slips = a.slips;
        slow.slips = b.slips;
      }
    }
}

// From load to load along loops and in jumps: every law in every phase, with a preload and without. What is tried
// first, the phases of the load before, gives what a search from nothing gives.
TEST(Displaced, FromOneLoadToTheNextIsWhatSolveSays) {
  const std::string drive = R"(name: drive
kinematics: {family: chains}
leg:
  drive:
    joint: motor
    rz: [{law: linear, stiffness: 240 Nm/rad}, {law: clearance, gap: 4 mrad},
         {law: one_sided, pull: 0.3 mrad/Nm, push: 0.9 mrad/Nm}, {law: hardening, stiffness: 900 Nm/rad, reference: 50 mrad}]
    beside: {rz: [{law: friction, moment: 2 Nm, stiffness: 3000 Nm/rad},
                  {law: friction, moment: 0.2 Nm, share: 0.4, stiffness: 900 Nm/rad}]}
)";
  for (const char* preload : {"", "    preload: {rz: 1.5 Nm}\n"}) {
    const Configuration c = configure_joints(parse_mechanism(drive + preload, "drive.yaml"), VectorX::Zero(1));
    const analytic::AnalyticModel model(c), whole(c);
    Conditions quick, slow;
    for (int i = 0; i <= 460; ++i) {
      const double Nm = i <= 400 ? 30 * (1 - i / 500.0) * std::sin(2 * pi * i / 130.0) : 30 * std::sin(2.4 * i * i);
      const analytic::AnalyticSolution a = model.displaced(Nm * Vector6::Unit(5), quick),
                                       b = whole.solve(Nm * Vector6::Unit(5), slow);
      ASSERT_TRUE(a.converged && b.converged) << a.message << b.message;
      ASSERT_NEAR(a.displacement(5), b.displacement(5), 1e-13 + 1e-10 * std::abs(b.displacement(5))) << i << preload;
      quick.slips = a.slips;
      slow.slips = b.slips;
    }
  }
}

// An end that yields is a joint between the member and what holds it.
TEST(MemberEnds, AreJointsInTheMembersAxes) {
  const std::string head = R"(name: beam
kinematics: {family: chains}
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {rod: {shape: round, diameter: 20 mm}}
leg:
)";
  // Along x of the chain: the member's axes are the chain's.
  const std::string member = "  beam: {member: rod, material: steel, along: [300 mm, 0 mm, 0 mm]";
  const Mechanism ends = parse_mechanism(
      head + member + ", start: {rz: {law: linear, stiffness: 5e6 Nmm/rad}, tx: {law: linear, stiffness: 2e4 N/mm}}," +
          " end: {ry: {law: linear, stiffness: 3e6 Nmm/rad}}}\n  tip: {offset: [50 mm, 0 mm, 0 mm]}\n",
      "ends.yaml");
  const Mechanism joints =
      parse_mechanism(head +
                          "  root: {joint: fixed, rz: {law: linear, stiffness: 5e6 Nmm/rad}, tx: {law: linear, "
                          "stiffness: 2e4 N/mm}}\n" +
                          member + "}\n  seat: {joint: fixed, ry: {law: linear, stiffness: 3e6 Nmm/rad}}\n" +
                          "  tip: {offset: [50 mm, 0 mm, 0 mm]}\n",
                      "joints.yaml");
  expect_same(ends, joints, 1e-12);
  EXPECT_EQ(write_mechanism(parse_mechanism(write_mechanism(ends), "again.yaml")), write_mechanism(ends));
}

TEST(MemberEnds, OfTheFixedFamilyYieldToo) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  // The ball joint stands where the link begins, its z along the link.
  expect_same(with(m, "leg.link.start.tx", "{law: linear, stiffness: 900 N/mm}", append),
              with(m, "leg.ball_joint.tz", "{law: linear, stiffness: 900 N/mm}", append), 1e-9);
}

// Pose after pose a machine with either stands as it does alone.
TEST(Posing, KnowsJointsSideBySideAndEndsThatYield) {
  Mechanism m =
      with(test::device("haptic-6psu-ideal-joints"), "leg.link.start.tx", "{law: linear, stiffness: 900 N/mm}", append);
  m = with(m, "leg.ball_joint.beside.rx", "{law: linear, stiffness: 1e4 Nmm/rad}", append);
  Posing posing(m);
  for (const Pose& pose : test::random_poses(m, 3)) {
    const Configuration &a = posing.at(pose), b = configure(m, pose);
    const Vector6 F = Vector6::Constant(1);
    EXPECT_EQ(analytic::AnalyticModel(a).solve(F).displacement, analytic::AnalyticModel(b).solve(F).displacement);
  }
}

}  // namespace
}  // namespace deflect
