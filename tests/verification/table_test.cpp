// Tables by hand: one drive along z, by both theories, which agree.
#include <gtest/gtest.h>

#include <random>

#include "analytic/model.h"
#include "msa/frame/mechanism/msa.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/stand.h"
#include "tests/support/devices.h"
#include "validation/studies/solve.h"
#include "validation/studies/workspace.h"

namespace deflect {
namespace {

constexpr double um = 1e-6;

/// A slide with these fields, which a force along z loads and unloads; m and N.
class Slide {
 public:
  explicit Slide(const std::string& fields) : c_(configured(fields)), analytic_(c_), msa_(c_) {}

  /// The state follows where `keep`, which it does in a sequence.
  double operator()(double N, bool keep = true) {
    const Vector6 F = N * Vector6::Unit(2);
    Conditions at, msa_at;
    at.slips = slips_;
    msa_at.slips = msa_slips_;
    const analytic::AnalyticSolution a = analytic_.solve(F, at);
    const frame::MsaSolution f = msa_.solve(F, msa_at);
    EXPECT_TRUE(a.converged) << a.message;
    EXPECT_TRUE(f.state.converged) << f.state.message;
    EXPECT_NEAR(a.displacement(2), f.displacement(2), 1e-12 * 300 * um) << N;
    EXPECT_EQ(a.slips.size(), f.slips.size());
    for (std::size_t i = 0; i < a.slips.size(); ++i) EXPECT_NEAR(a.slips[i], f.slips[i], 1e-12 * 300 * um) << N;
    stored = total(analytic_.energies(a));
    EXPECT_NEAR(stored, total(f.energies), 1e-12 * 300 * um * 100) << N;
    EXPECT_NEAR(analytic_.displaced(F, at).displacement(2), a.displacement(2), 1e-12 * 300 * um);
    stiffness = 1 / analytic_.compliance(a)(2, 2);
    if (keep) slips_ = a.slips, msa_slips_ = f.slips;
    return a.displacement(2);
  }

  double stiffness_by_msa(double N) {
    const frame::MsaSolution f = msa_.solve(N * Vector6::Unit(2));
    return msa_.stiffness(f.state).K(2, 2);
  }

  double stored = 0, stiffness = 0;

 private:
  static double total(const std::vector<std::pair<std::string, double>>& energies) {
    double sum = 0;
    for (const auto& [part, energy] : energies) sum += energy;
    return sum;
  }
  static Configuration configured(const std::string& fields) {
    const std::string file = "name: slide\nkinematics: {family: chains}\nleg:\n  drive: {joint: prismatic, " + fields +
                             "}\n  lever: {offset: [0 mm, 0 mm, 100 mm]}\n";
    return configure_joints(parse_mechanism(file, "slide.yaml"), VectorX::Zero(1));
  }

  Configuration c_;
  analytic::AnalyticModel analytic_;
  frame::MsaModel msa_;
  std::vector<double> slips_, msa_slips_;
};

const std::string bent = "{law: table, points: [[0 N, 0 um], [10 N, 10 um], [30 N, 70 um]]}";

TEST(Table, IsTheCurveOfItsPointsOddAndGoesOnWithItsLastSlope) {
  Slide slide("tz: " + bent);
  const std::vector<std::pair<double, double>> by_hand = {{0, 0},    {5, 5},   {10, 10},   {20, 40},    {30, 70},
                                                          {50, 130}, {-5, -5}, {-20, -40}, {1e-9, 1e-9}};
  for (const auto& [N, deflection] : by_hand) EXPECT_NEAR(slide(N), deflection * um, 1e-14 * 100 * um) << N;
}

TEST(Table, MayHavePointsOfItsOwnUnderPush) {
  Slide slide("tz: {law: table, points: [[-20 N, -10 um], [0 N, 0 um], [10 N, 10 um], [30 N, 70 um]]}");
  EXPECT_NEAR(slide(20), 40 * um, 1e-18);
  EXPECT_NEAR(slide(-20), -10 * um, 1e-18);
  EXPECT_NEAR(slide(-60), -30 * um, 1e-18);
}

// Beside 1e5 N/m at 40 um: 20 N in the table, 4 N in the spring. In series the deflections add up.
TEST(Table, SharesALoadWithASpringAndAddsToOneAsByHand) {
  Slide beside("tz: " + bent + ", beside: {tz: {law: linear, stiffness: 1e5 N/m}}");
  EXPECT_NEAR(beside(24), 40 * um, 1e-12 * um * 100);
  EXPECT_NEAR(beside(-24), -40 * um, 1e-12 * um * 100);
  Slide of_spring("tz: {law: linear, stiffness: 1e5 N/m}, beside: {tz: " + bent + "}");
  EXPECT_NEAR(of_spring(24), 40 * um, 1e-12 * um * 100);
  Slide series("tz: [" + bent + ", {law: linear, stiffness: 1e5 N/m}]");
  EXPECT_NEAR(series(20), 240 * um, 1e-12 * um * 100);
  Slide with_play("tz: [" + bent + ", {law: clearance, gap: 5 um}]");
  EXPECT_NEAR(with_play(20), 45 * um, 1e-12 * um * 100);
}

TEST(Table, CountsFromItsPreload) {
  Slide slide("tz: " + bent + ", preload: {tz: 5 N}");
  EXPECT_NEAR(slide(0.01), 0.01 * um, 1e-14 * um);  // 5 N and 5.01 N lie on one piece: no digit is lost
  EXPECT_NEAR(slide(20), 50 * um, 1e-12 * um * 100);
  EXPECT_NEAR(slide(-20), -30 * um, 1e-12 * um * 100);
  Slide at_corner("tz: " + bent + ", preload: {tz: 10 N}");
  EXPECT_NEAR(at_corner(0.05), 0.15 * um, 1e-12 * um);
  EXPECT_NEAR(at_corner(-0.05), -0.05 * um, 1e-12 * um);
}

TEST(Table, HasTheStiffnessOfThePieceAndAtACornerOfTheNextOne) {
  Slide slide("tz: " + bent);
  for (const auto& [N, k] : {std::pair{5.0, 1e6}, {10.0, 1e6 / 3}, {20.0, 1e6 / 3}, {0.0, 1e6}, {-10.0, 1e6 / 3}}) {
    slide(N);
    EXPECT_NEAR(slide.stiffness / k, 1, 1e-12) << N;
    EXPECT_NEAR(slide.stiffness_by_msa(N) / k, 1, 1e-12) << N;
  }
}

// c = 1 um/N. A rises from 10 N by 2 and from 30 N by 3 um/N to P = 100 um at 50 N; B from there: 100 um at 30 N, 80 um
// at 10 N, 40 um at none, and on with 4 um/N to none at −10 N.
const std::string loop =
    "{law: table, points: [[0 N, 0 um], [10 N, 10 um], [30 N, 70 um], [50 N, 150 um]], "
    "unloading: [[50 N, 150 um], [30 N, 130 um], [10 N, 90 um], [0 N, 40 um]]}";

TEST(TableThatRemembers, HasBothBranchesAsMeasured) {
  for (const double sign : {1.0, -1.0}) {
    Slide slide("tz: " + loop);
    for (const auto& [N, deflection] :
         {std::pair{0.0, 0.0}, {5, 5},     {10, 10},    {20, 40},    {30, 70}, {40, 110}, {50, 150},
          {40, 140},           {30, 130},  {20, 110},   {10, 90},    {5, 65},  {0, 40},   {-5, 15},
          {-10, -10},          {-30, -70}, {-50, -150}, {-30, -130}, {0, -40}, {10, 10},  {50, 150}})
      EXPECT_NEAR(slide(sign * N), sign * deflection * um, 1e-12 * 150 * um) << sign * N;
  }
}

// Loading took 1250 and ∫A⁻¹dp = 3200, unloading gives back 1250 and 600 N um.
TEST(TableThatRemembers, GivesBackWhatItHasStored) {
  Slide slide("tz: " + loop);
  slide(50);
  EXPECT_NEAR(slide.stored, 1850 * um, 1e-12 * 1850 * um);
  double work = 0, before = slide(50);
  for (int N = 49; N >= 0; --N) {
    const double here = slide(N);
    work += (N + 0.5) * (here - before);
    before = here;
  }
  EXPECT_NEAR(work, -1850 * um, 1e-11 * 1850 * um);
  EXPECT_NEAR(slide.stored, 0, 1e-15);
}

// Once round: 2 ∫(A⁻¹ − B⁻¹)dp = 2 (3200 − 400) N um, straight between whole newtons.
TEST(TableThatRemembers, LosesTheAreaOfItsLoop) {
  Slide slide("tz: " + loop);
  double before = slide(50), area = 0, at = 50;
  for (const double end : {-50.0, 50.0})
    while (at != end) {
      const double next = at + (end > at ? 1 : -1), here = slide(next);
      area += (at + next) / 2 * (here - before);
      before = here, at = next;
    }
  EXPECT_NEAR(area, 5600 * um, 1e-11 * 5600 * um);
}

// What push has left, 40 um, goes back under pull by 4 um/N and has gone at 10 N, while the rest yields by 1 um/N; from
// 20 N on another 2 um/N and more come from loading.
TEST(TableThatRemembers, YieldsMoreWhileItGivesBackWhatTheOtherSenseHasLeft) {
  Slide slide("tz: " + loop);
  slide(-50), slide(0);
  for (const auto& [N, stiffness] : {std::pair{1.0, 0.2}, {4, 0.2}, {6, 0.2}, {9, 0.2}, {15, 1.0 / 3}, {25, 1.0 / 3}}) {
    slide(N, false);
    EXPECT_NEAR(slide.stiffness, stiffness / um, 1e-9 / um) << N;
  }
}

TEST(TableThatRemembers, ClosesSmallLoopsAndForgetsThemUnderALargerLoad) {
  Slide slide("tz: " + loop), straight("tz: " + loop);
  straight(40);
  for (const double N : {15.0, 4.0, 12.0, 7.0, 12.0, 4.0, 15.0}) slide(N);
  EXPECT_NEAR(slide(40), 110 * um, 1e-12 * 150 * um);
  slide(3);
  const double first = slide(22);
  for (const double N : {5.0, 18.0, 7.0, 18.0, 5.0}) slide(N);
  EXPECT_NEAR(slide(22), first, 1e-12 * 150 * um);
  for (const double N : {40.0, 50.0, 33.0, -8.0, -50.0, 20.0}) EXPECT_EQ(slide(N), straight(N)) << N;
}

TEST(TableThatRemembers, LosesNothingBeyondItsPointsAndKeepsItsStateBetweenThem) {
  Slide slide("tz: " + loop);
  EXPECT_NEAR(slide(80), 270 * um, 1e-12 * 270 * um);
  EXPECT_NEAR(slide(60), 190 * um, 1e-12 * 270 * um);
  EXPECT_NEAR(slide(30), 130 * um, 1e-12 * 270 * um);
  slide(50), slide(31);
  EXPECT_NEAR(slide.stiffness / 1e6, 1, 1e-12);
  EXPECT_NEAR(slide(45), 145 * um, 1e-12 * 150 * um);
}

// A spring of 2e5 N/m beside a friction of 30 N and 8e5 N/m slips at 37.5 N; from 100 N back it sticks until 25 N.
TEST(TableThatRemembers, OfASpringBesideAFrictionDoesWhatTheyDo) {
  Slide table(
      "tz: {law: table, points: [[0 N, 0 um], [37.5 N, 37.5 um], [100 N, 350 um]], "
      "unloading: [[100 N, 350 um], [25 N, 275 um], [0 N, 150 um]]}");
  Slide friction(
      "tz: {law: linear, stiffness: 2e5 N/m}, "
      "beside: {tz: {law: friction, force: 30 N, stiffness: 8e5 N/m}}");
  std::mt19937 dice(7);
  std::uniform_real_distribution<double> load(-100, 100);
  for (int i = 0; i < 200; ++i) {
    const double N = load(dice);
    EXPECT_NEAR(table(N), friction(N), 1e-12 * 350 * um) << i << ": " << N;
  }
}

TEST(TableThatRemembers, SharesALoadWithASpringAsByHand) {
  Slide slide("tz: " + loop + ", beside: {tz: {law: linear, stiffness: 1e5 N/m}}");
  EXPECT_NEAR(slide(65), 150 * um, 1e-12 * 150 * um);  // 50 N and 15 N
  EXPECT_NEAR(slide(43), 130 * um, 1e-12 * 150 * um);  // 30 N and 13 N
  EXPECT_NEAR(slide(4), 40 * um, 1e-12 * 150 * um);    // none and 4 N
  // at 0 N the table carries −1e5 δ: 40 um + 5 um/N f = δ
  EXPECT_NEAR(slide(0), 40.0 / 1.5 * um, 1e-12 * 150 * um);
}

/// Curves of a random loop in units of the drive; widths and slopes over several decades.
std::string random_loop(std::mt19937& dice) {
  std::uniform_real_distribution<double> u(0, 1);
  std::vector<std::pair<double, double>> up = {{0, 0}};
  const int n = 2 + static_cast<int>(4 * u(dice));
  for (int i = 0; i < n; ++i)
    up.emplace_back(up.back().first + 2 + 20 * u(dice), up.back().second + std::pow(10, 2 * u(dice)));
  // Back on the same loads, each by a slope that keeps it above.
  std::vector<std::pair<double, double>> back = {up.back()};
  for (auto p = up.rbegin() + 1; p != up.rend(); ++p) {
    const double least = p->second, most = back.back().second;
    back.emplace_back(p->first, least + (most - least) * (0.05 + 0.9 * u(dice)));
  }
  const auto text = [](const auto& points) {
    std::string out;
    for (const auto& [f, d] : points) out += fmt::format("{}[{} N, {} um]", out.empty() ? "" : ", ", f, d);
    return out;
  };
  return "{law: table, points: [" + text(up) + "], unloading: [" + text(back) + "]}";
}

// Beside a spring the second round closes on itself. Two tables side by side share the load by what is left in both,
// which settles in a few rounds.
TEST(TableThatRemembers, NeverCreatesWorkWhateverTheLoop) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 dice(seed);
    SCOPED_TRACE(seed);
    const bool alone = seed % 2 == 0;
    const std::string loop_of_seed = random_loop(dice);
    Slide slide("tz: " + loop_of_seed +
                ", beside: {tz: " + (alone ? "{law: linear, stiffness: 1e6 N/m}" : random_loop(dice)) + "}");
    std::uniform_real_distribution<double> load(-90, 90);
    std::vector<double> loads;
    for (int i = 0; i < 5; ++i) loads.push_back(load(dice));
    double at = 0, before = 0;
    const auto go = [&](double to) {  // the work, by trapezes of 1/20 of the way
      const double from = at;
      double work = 0;
      for (int k = 1; k <= 20; ++k) {
        const double next = from + (to - from) * k / 20, here = slide(next);
        work += (at + next) / 2 * (here - before);
        at = next, before = here;
      }
      return work;
    };
    double work = 0, round = 0, started = 0;
    for (int pass = 0; pass < 3; ++pass) {
      started = before, round = 0;
      for (const double to : loads) round += go(to);
      work += round;
    }
    if (alone) {
      EXPECT_NEAR(before, started, 1e-12 * 300 * um);
    }
    EXPECT_GE(round, -1e-3 * std::abs(work));
    EXPECT_GE(slide.stored, -1e-15);
  }
}

/// The largest difference of the theories over loads in turn, every fourth one none, relative to the largest
/// deflection.
double largest_difference(const Mechanism& m, double N) {
  const Configuration c = configure(m, home_pose(m));
  const analytic::AnalyticModel analytic(c);
  frame::MsaModel msa(c);
  std::mt19937 dice(1);
  std::uniform_real_distribution<double> load(-N, N);
  Conditions at, msa_at;
  double largest = 0, off = 0;
  for (int i = 0; i < 40; ++i) {
    Vector6 F = Vector6::Zero();
    for (Eigen::Index k = 0; k < 3 && i % 4 != 0; ++k) F(k) = load(dice);
    const analytic::AnalyticSolution a = analytic.solve(F, at);
    const frame::MsaSolution f = msa.solve(F, msa_at);
    EXPECT_TRUE(a.converged) << i << ": " << a.message;
    EXPECT_TRUE(f.state.converged) << i << ": " << f.state.message;
    largest = std::max(largest, a.displacement.head<3>().norm());
    off = std::max({off, (a.displacement - f.displacement).head<3>().norm(),
                    (analytic.displaced(F, at).displacement - a.displacement).head<3>().norm()});
    at.slips = a.slips, msa_at.slips = f.slips;
  }
  return off / largest;
}

TEST(TableThatRemembers, HasOneAnswerInBothTheoriesWhateverCameBefore) {
  using test::with;
  constexpr auto append = Edit::Action::append;
  const std::string turning =
      "{law: table, points: [[0 Nm, 0 mrad], [2 Nm, 1 mrad], [9 Nm, 8 mrad]], "
      "unloading: [[9 Nm, 8 mrad], [3 Nm, 5 mrad], [0 Nm, 2 mrad]]}";
  const Mechanism tripteron = test::device("tripteron"), arm = test::device("arm"),
                  haptic = test::device("haptic-6psu-ideal-joints");
  EXPECT_LT(largest_difference(with(tripteron, "leg.slide.tz", loop, append), 50), 1e-9);
  EXPECT_LT(largest_difference(with(tripteron, "leg.elbow.rz", turning, append), 50), 1e-9);
  EXPECT_LT(largest_difference(with(tripteron, "leg.slide.beside.tz", loop, append), 50), 1e-9);
  EXPECT_LT(largest_difference(with(arm, "leg.joint_2.rz", turning, append), 20), 1e-9);
  EXPECT_LT(largest_difference(with(haptic, "leg.actuator.tz", loop), 50), 1e-9);
  EXPECT_LT(largest_difference(with(with(haptic, "leg.ball_joint.tz", loop), "leg.actuator.tz",
                                    "[{law: clearance, gap: 0.01 mm}, {law: linear, stiffness: 500 N/mm}]"),
                               50),
            1e-9);
}

TEST(TableThatRemembers, HasOneAnswerInAllTheoriesInEveryGeometry) {
  Mechanism m = test::device("haptic-6psu-ideal-joints");
  m = test::with(m, "leg.actuator.tz", loop);
  m = test::with(m, "leg.actuator.ry",
                 "{law: table, points: [[0 Nm, 0 mrad], [0.5 Nm, 1 mrad], [1 Nm, 4 mrad]], "
                 "unloading: [[1 Nm, 4 mrad], [0.4 Nm, 3 mrad], [0 Nm, 1 mrad]]}");
  const Vector6 load = (Vector6() << 30, -20, 35, 400, 300, -500).finished();
  for (const Geometry geometry : {Geometry::linear, Geometry::second_order, Geometry::finite})
    EXPECT_NO_THROW(studies::solve(m, stand(m, studies::workspace_points(m)[3].pose_mm_deg), load, {}, geometry))
        << geometry_names[static_cast<int>(geometry)];
}

/// 30 N go 10 µm with 1 N/µm and 60 µm with 20 N on 60 µm: ½·10·10 + ½ (10 + 30)·60 Nµm are stored, more than half of
/// 30 N times 70 µm. A slide that softens is answered.
TEST(Table, ASlideThatSoftensStoresMoreThanHalfOfForceTimesWay) {
  const Mechanism m = parse_mechanism(R"(
name: slide
kinematics: {family: chains}
leg: {slide: {joint: prismatic, tz: {law: table, points: [[0 N, 0 um], [10 N, 10 um], [30 N, 70 um]]}}}
workspace: {cube_edge: 1 mm}
)",
                                      "slide.yaml");
  const studies::SolveResult r = studies::solve(m, stand(m, mm_deg_from(home_pose(m))), 30 * Vector6::Unit(2), {});
  for (const studies::TheorySolution& s : r.solutions) EXPECT_NEAR(s.displacement_mm_rad(2), 0.07, 1e-12);
}

}  // namespace
}  // namespace deflect
