// Models for which the program once gave a wrong answer, refused a right one or ended by a signal, each with the
// outcome that is right. The files are in cases/.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "msa/mechanism/device_file.h"
#include "tests/attack/device_oracle.h"
#include "tests/support/apart.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "tests/support/sanitizers.h"
#include "validation/studies/solve.h"

namespace deflect {
namespace {

using nlohmann::json;
using test::Folder;

std::string case_path(const std::string& name) {
  return std::string("'") + test::source_dir() + "/tests/attack/cases/" + name + "'";
}

/// The program with a limit on its time, so that a run that hangs is a failure and no stop of all tests.
test::Run timely(const std::string& arguments, int seconds = 60) {
  return test::command("timeout " + std::to_string(seconds * test::times_slower) + " '" + test::program() + "' " +
                       arguments);
}

struct Answered {
  test::Run run;
  json result;

  /// Not a number where there was no answer.
  Vector6 displacement(const char* theory) const {
    Vector6 d = Vector6::Constant(std::nan(""));
    if (run.code != 0) return d;
    for (std::size_t i = 0; i < 6; ++i)
      d(static_cast<Eigen::Index>(i)) = result[theory]["displacement"][i].get<double>();
    return d;
  }
  std::string notes() const { return result.contains("notes") ? result["notes"].dump() : ""; }
};

Answered solve(const std::string& arguments, int seconds = 60) {
  const Folder folder;
  const std::string file = (folder / "result.json").string();
  Answered a{timely("solve " + arguments + " --json '" + file + "'", seconds), {}};
  if (a.run.code == 0) a.result = json::parse(test::contents(file));
  return a;
}

/// Both theories answer and agree: to the digits that a device of stiffness ratio 1e7 leaves (1e-16 · 1e7).
void expect_agreement(const Answered& a, double tolerance = 1e-9) {
  ASSERT_EQ(a.run.code, 0) << a.run.out;
  EXPECT_LE(a.result["relative_difference"].get<double>(), tolerance) << a.run.out;
}

/// As expect_agreement, and right: as the force method has it. Linear laws only; mm, deg, N, Nmm.
void expect_right(const std::string& file, const Vector6& pose, const Vector6& load) {
  const Mechanism m = read_mechanism(test::source_dir() + "/tests/attack/cases/" + file);
  const attack::DeviceTruth truth = attack::solve_by_forces(stand(m, pose).configuration);
  ASSERT_TRUE(truth.held && truth.clear);
  const Vector6 right = twist_in_mm(truth.flexibility * wrench_from_mm(load));
  const Answered a = solve(case_path(file) +
                           fmt::format(" --pose={:.17g} --load={:.17g}", fmt::join(pose, ","), fmt::join(load, ",")));
  expect_agreement(a);
  for (const char* theory : {"analytic", "msa"})
    EXPECT_LE(test::apart(a.displacement(theory), right, 1e3), 1e-9) << theory << "\n" << a.run.out;
  if (truth.idle > 0) {
    EXPECT_NE(a.notes().find("held"), std::string::npos) << a.run.out;
  }
}

Vector6 six(double a, double b, double c, double d, double e, double f) {
  return (Vector6() << a, b, c, d, e, f).finished();
}

void expect_refused(const test::Run& run, std::initializer_list<const char*> words) {
  EXPECT_EQ(run.code, 3) << run.out;
  for (const char* word : words) EXPECT_NE(run.out.find(word), std::string::npos) << word << "\n" << run.out;
}

// Its far end slides along its local z at n4 and turns there about its local y, which is (0.0295, -0.0708, 0.997).
TEST(KnownCases, AMemberThatSwingsAboutItsStartIsRefused) {
  expect_refused(timely("frame " + case_path("swinging-member.yaml")),
                 {"cannot stand", "e3", "turns about (0.0295, -0.0708, 0.997)"});
}

// The only support holds all but rz, at n2 = (400, -300, -300) mm.
TEST(KnownCases, AFrameThatTurnsOnItsOnlySupportIsRefused) {
  expect_refused(timely("frame " + case_path("turning-frame.yaml")),
                 {"cannot stand", "turns about (0, 0, 1) through (400, -300,"});
}

TEST(KnownCases, AnInnerBodyThatSlidesIdlyIsHeldAndNoted) {
  expect_right("inner-slider.yaml",
               six(221.54227370443257, -298.03213649652025, 101.90312290344717, 61.04210250043314, 67.85013364143981,
                   128.53455258160074),
               six(-106.04861529442888, -496.8827183080567, -398.3087207180375, 11981.626139746766, -49039.70389085885,
                   -10427.705612679276));
}

TEST(KnownCases, InnerBodiesThatSlideIdlyInEveryLegAreHeldAndNoted) {
  expect_right("inner-sliders.yaml", six(250, 250, 250, 0, 0, 0),
               six(-448.7293978657114, 0, 406.1252535368077, 0, 53002.478546281054, -41546.31652918679));
}

TEST(KnownCases, FourLegsWithLongOffsetsAreSolved) {
  expect_right("four-offset-legs.yaml",
               six(-144.310993717065, 308.0766159659567, 67.16314993545058, 112.14501359103693, -49.19604589273027,
                   108.36190329640591),
               six(-151.12100377188807, 165.26791418889525, 149.54999993564377, -51778.704804612105,
                   -13642.855292347278, 69209.39132261841));
}

TEST(KnownCases, ThreeLegsOfMixedJointsAreSolved) {
  expect_right("three-mixed-legs.yaml",
               six(-428.5021276685038, -383.70534127668043, 346.5561454382317, 25.60898890040918, -71.88608187019955,
                   120.43192453893768),
               six(180.4589670339759, 0.5743904576351611, -317.1473500251638, 54012.72700058604, -68550.6017846232,
                   94166.56742678268));
}

TEST(KnownCases, ABeamBesideALinkageIsSolved) {
  expect_right("beam-beside-linkage.yaml", six(500, 500, -500, 0, 0, 0),
               six(175.55586484827109, 0, -207.64357664789515, -86972.09817227334, 0, -27529.01592471879));
}

// Two elastic slides of different directions, all else rigid: the platform cannot move at all.
TEST(KnownCases, ADeviceThatIsHeldRigidlyIsRefused) {
  expect_refused(timely("solve " + case_path("held-rigidly.yaml") +
                        " --load=458.32212319008886,-200.37937695861928,145.7654927105158,0,0,0 --pose=0,0,0,0,0,0"),
                 {"rigid"});
}

// The platform yields in four ways.
TEST(KnownCases, ABeamBesideAUniversalJointIsSolved) {
  expect_right("beam-beside-universal.yaml", six(297.12826933000827, -271.7442135448348, -156.4907491588563, 0, 0, 0),
               six(0, 0, 0, 0, 0, 11550.996117250705));
}

TEST(KnownCases, APowerLawThatCarriesNothingIsSolved) {
  expect_agreement(solve(case_path("power-law-that-carries-nothing.yaml") +
                         " --load=0,0,0,0,0,-583979.6542018397"
                         " --pose=161.3830572238304,-389.8379510827882,-473.06322120947317,0,0,0"));
}

// One leg is rigid from the base to the platform.
TEST(KnownCases, ADeviceWithARigidLegIsRefused) {
  expect_refused(
      timely("solve " + case_path("rigid-leg.yaml") + " --load=0,0,0,0,0,-1381.8301455803617 --pose=0,0,0,0,0,0"),
      {"rigid"});
}

// An answer, or the cause: the power law δ = c f^0.2 yields without end where its force passes zero, as it does here.
TEST(KnownCases, AOneSidedLawBesideABeamIsSolvedOrRefusedWithTheCause) {
  const Answered a =
      solve(case_path("one-sided-beside-beam.yaml") + " --load=0,0,0,0,0,-3247.146829095071 --pose=0,0,0,0,0,0");
  if (a.run.code == 0) return expect_agreement(a, 1e-7);
  EXPECT_EQ(a.run.code, 4) << a.run.out;
  EXPECT_NE(a.run.out.find("power laws"), std::string::npos) << a.run.out;
}

// It took 13 s. An answer, or the cause: "did not converge" is none.
TEST(KnownCases, SevenLegsWithFrictionEndSoonWithAnAnswerOrTheCause) {
  const auto start = std::chrono::steady_clock::now();
  const Answered a = solve(case_path("seven-friction-legs.yaml") +
                           " --load=-3661.8796094296395,4089.313808860787,-326.21914437792344,-818464.249031611,"
                           "-1180362.2686367922,826548.208002055 --pose=-250,-250,-250,0,0,0");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 6);
  if (a.run.code == 0) return expect_agreement(a, 1e-7);
  EXPECT_TRUE(a.run.code == 3 || a.run.code == 4) << a.run.code;
  EXPECT_EQ(a.run.out.find("did not converge"), std::string::npos) << a.run.out;
}

// A pure moment loads no drive: the platform stays in the middle of its play, where it is without play.
TEST(KnownCases, APlatformThatFloatsInItsPlayStaysInTheMiddle) {
  const std::string at = " --pose 500,500,500 --load=0,0,0,-10000,0,0";
  const Answered a = solve(case_path("tripteron-backlash.yaml") + at), without = solve("tripteron" + at);
  expect_agreement(a);
  expect_agreement(without);
  const Vector6 right = without.displacement("analytic");
  for (const char* theory : {"analytic", "msa"})
    EXPECT_LE((a.displacement(theory) - right).norm(), 1e-9 * right.norm()) << theory;
  EXPECT_NE(a.notes().find("floats within its play by ux ±0.01 mm"), std::string::npos) << a.notes();
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(a.result["floating"]["most"][static_cast<std::size_t>(axis)].get<double>(), 0.01, 1e-12);
}

// A spring of 100 N/mm, 3 mm off, strains a brake of 100 N to its limit: 10 N more stretch the spring alone.
TEST(KnownCases, ABrakeThatAMisfitHasLetSlideIsSolved) {
  const Answered a = solve(case_path("misfit-and-brake.yaml") + " --pose 0,0,0 --load=10,0,0");
  expect_agreement(a);
  for (const char* theory : {"analytic", "msa"})
    EXPECT_NEAR(a.displacement(theory)(0), 0.1, 1e-12) << theory << a.run.out;
}

TEST(KnownCases, ACampaignOnADeviceWithBacklashIsSimulated) {
  for (const char* device : {"tripteron", "hybrid", "stewart-6ups"}) {
    const Folder folder;
    const std::string file = (folder / "x.csv").string();
    const test::Run run =
        timely(fmt::format("simulate {} --with actuator_backlash --campaign paper --seed 1 -o '{}'", device, file));
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_GT(test::contents(file).size(), 1000u);
  }
}

TEST(KnownCases, AHexapodOnATiltingBaseIsSolvedAtEveryPoseAndLoad) {
  for (const Vector3& p : {Vector3(0, 0, 2000), Vector3(200, 100, 2100), Vector3(-300, 0, 1900), Vector3(0, 300, 2200),
                           Vector3(100, -200, 1800), Vector3(-100, -100, 2050)})
    for (const int axis : {0, 1, 2})
      expect_right("stewart-base-tilt.yaml", six(p.x(), p.y(), p.z(), 0, 0, 0), 50 * Vector6::Unit(axis));
}

// P L²/EI = 5 at the tip of a blade, inextensible: the end angle t solves K(k) − F(φ, k) = √5 with
// k² = (1 + sin t)/2 and sin φ = 1/(k √2); then w/L = 1 − 2 (E(k) − E(φ, k))/√5 (Bisshopp and Drucker, 1945).
TEST(KnownCases, ABladeThatBendsFarFollowsTheElastica) {
  const double root = std::sqrt(5.0);
  const auto excess = [&](double t) {
    const double k = std::sqrt((1 + std::sin(t)) / 2), phi = std::asin(1 / (k * std::sqrt(2.0)));
    return std::comp_ellint_1(k) - std::ellint_1(k, phi) - root;
  };
  double low = 0, high = pi / 2 - 1e-9;
  for (int i = 0; i < 100; ++i) (excess((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
  const double k = std::sqrt((1 + std::sin(low)) / 2), phi = std::asin(1 / (k * std::sqrt(2.0)));
  const double w = 500 * (1 - 2 * (std::comp_ellint_2(k) - std::ellint_2(k, phi)) / root);
  EXPECT_NEAR(w, 0.7138 * 500, 0.02);  // K. Mattiasson, 1981
  const Answered a = solve(case_path("blade.yaml") + " --pose 500,0,0 --geometry finite --load=0,0,7");
  ASSERT_EQ(a.run.code, 0) << a.run.out;
  // The blade is extensible: EA = 4.2 MN against 7 N makes 2e-6.
  for (const char* theory : {"analytic", "msa"}) EXPECT_NEAR(a.displacement(theory)(2), w, 1e-5 * w) << theory;
}

// 1e-4 N close the gap of 1 mm and stretch 100 N/mm by 1e-6 mm.
TEST(KnownCases, ASmallForceClosesALargeGap) {
  const Answered a = solve(case_path("clearance-small-load.yaml") + " --pose 0,0,0,0,0,0 --load=0,0,1e-4");
  expect_agreement(a);
  for (const char* theory : {"analytic", "msa"}) EXPECT_NEAR(a.displacement(theory)(2), 1.000001, 1e-12) << theory;
}

TEST(KnownCases, AFlexureWithoutDrivesIsComparedAndDiagnosed) {
  const std::string files = case_path("flexure.yaml") + " " + case_path("flexure.csv");
  for (const char* verb : {"compare ", "diagnose "}) {
    const test::Run run = timely(verb + files, 300);
    EXPECT_EQ(run.code, 0) << verb << run.out;
  }
}

}  // namespace
}  // namespace deflect
