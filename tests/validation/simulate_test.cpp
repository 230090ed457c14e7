// Simulated measurements.
#include "validation/prediction/simulate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/stand.h"
#include "tests/support/devices.h"
#include "tests/support/paths.h"
#include "validation/measurement/configure_all.h"
#include "validation/prediction/as_built.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/prediction.h"
#include "validation/subject/simulate_frame.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

using namespace measurement;
using namespace prediction;

Mechanism ideal() { return test::device("haptic-6psu-ideal-joints"); }

TEST(Campaign, HasTheReadingsThatItsHeaderSays) {
  const Mechanism m = ideal();
  for (const auto& [name, readings, poses] :
       {std::tuple{"paper", 27, 9}, {"cycle", 432, 9}, {"rich", 720, 15}, {"random", 280, 20}}) {
    const Measurements plan = campaign(name, m, 50, 1);
    EXPECT_EQ(plan.readings.size(), static_cast<std::size_t>(readings)) << name;
    EXPECT_EQ(plan.poses.size(), static_cast<std::size_t>(poses)) << name;
    configure_all(m, plan);  // all can be reached
    for (const Reading& r : plan.readings) EXPECT_LE(r.load.head<3>().norm(), 50 * (1 + 1e-12));
  }
  EXPECT_THROW(campaign("poor", m, 50, 1), InputError);
}

// F/5 … F, of all directions: of 280 sizes that are uniform there the smallest and largest lie within 5 % of the ends
// but for one in a million.
TEST(Campaign, RandomLoadsAreFromAFifthOfTheForceOn) {
  double least = 1e9, most = 0;
  Vector3 sum = Vector3::Zero();
  for (const Reading& r : campaign("random", ideal(), 50, 1).readings) {
    least = std::min(least, r.load.head<3>().norm());
    most = std::max(most, r.load.head<3>().norm());
    sum += r.load.head<3>().normalized();
  }
  EXPECT_GE(least, 10 - 1e-3);
  EXPECT_LE(least, 12);
  EXPECT_GE(most, 48);
  EXPECT_LE(sum.norm() / 280, 0.3);  // expected 0.06
}

TEST(Campaign, ACycleGoesUpDownAndBackAlongEachAxis) {
  const Measurements plan = campaign("cycle", ideal(), 40, 1);
  const double loop[] = {10, 20, 30, 40, 30, 20, 10, 0, -10, -20, -30, -40, -30, -20, -10, 0};
  for (std::size_t i = 0; i < plan.readings.size(); ++i) {
    EXPECT_EQ(plan.readings[i].load, Vector6(loop[i % 16] * Vector6::Unit(static_cast<Eigen::Index>(i / 16 % 3)))) << i;
    EXPECT_EQ(plan.readings[i].pose, i / 48);
    EXPECT_EQ(plan.readings[i].sequence, static_cast<double>(i));
  }
}

TEST(Campaign, WorksForEveryDeviceWithAWorkspace) {
  for (const char* name : {"tripteron", "delta", "stewart-6ups", "hybrid", "haptic-6psu"})
    EXPECT_EQ(campaign("random", test::device(name), 50, 2).readings.size(), 280u) << name;
}

TEST(Simulate, ExactReadingsOfTheDrawingAreTheMsa) {
  const Mechanism m = ideal();
  SimulationOptions o;
  o.sigma_u = 0;
  o.sigma_th = 0;
  o.tolerances = 0;
  o.geometry = Geometry::linear;
  const Measurements data = simulate(m, campaign("paper", m, 50, 1), o);
  PredictionOptions p;  // the other theory
  const std::vector<VectorX> d = predict(m, configure_all(m, data), data, p);
  for (std::size_t i = 0; i < d.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k)
      EXPECT_NEAR(*data.readings[i].displacement[k], d[i](static_cast<Eigen::Index>(k)), 1e-9 * d[i].norm());
}

TEST(Simulate, SeedInSameFileOut) {
  const Mechanism m = ideal();
  SimulationOptions o;
  o.geometry = Geometry::linear;
  const auto text = [&](std::uint64_t seed, int threads) {
    o.seed = seed;
    return measurements_text(simulate(m, campaign("random", m, 50, 1), o, {threads}));
  };
  EXPECT_EQ(text(5, 1), text(5, 3));
  EXPECT_NE(text(5, 1), text(6, 1));
}

TEST(Simulate, NoiseAndTolerancesHaveTheirSize) {
  Mechanism m = ideal();
  SimulationOptions o;
  o.tolerances = 0;
  o.geometry = Geometry::linear;
  o.sigma_u = 3e-6;
  const Measurements data = simulate(m, campaign("rich", m, 50, 1), o);
  const std::vector<VectorX> d = predict(m, configure_all(m, data), data, {});
  double squares = 0;
  for (std::size_t i = 0; i < d.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      squares += std::pow(*data.readings[i].displacement[k] - d[i](static_cast<Eigen::Index>(k)), 2);
  // 2160 numbers: the estimate scatters by 1/√4320.
  EXPECT_NEAR(std::sqrt(squares / 2160) / 3e-6, 1, 5 / std::sqrt(4320.0));
}

// A reading in five; each of its numbers 10 to 30 σ off, to either side.
TEST(Simulate, GrossOutliersAreAsManyAndAsLargeAsSaid) {
  const Mechanism m = ideal();
  SimulationOptions o;
  o.tolerances = 0;
  o.geometry = Geometry::linear;
  o.sigma_u = 3e-6;
  o.outliers = 0.2;
  const Measurements data = simulate(m, campaign("rich", m, 50, 1), o);
  const std::vector<VectorX> d = predict(m, configure_all(m, data), data, {});
  int readings = 0, above = 0, below = 0;
  double least = 1e9, most = 0;
  for (std::size_t i = 0; i < d.size(); ++i) {
    int gross = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double off = (*data.readings[i].displacement[k] - d[i](static_cast<Eigen::Index>(k))) / 3e-6;
      if (std::abs(off) < 5.5) continue;
      least = std::min(least, std::abs(off)), most = std::max(most, std::abs(off));
      ++(off > 0 ? above : below);
      ++gross;
    }
    EXPECT_TRUE(gross == 0 || gross == 3) << i;
    readings += gross > 0;
  }
  EXPECT_NEAR(readings, 144, 5 * std::sqrt(720 * 0.2 * 0.8));
  EXPECT_NEAR(above, below, 5 * std::sqrt(3.0 * 144));
  EXPECT_GT(least, 10 - 5);
  EXPECT_LT(least, 13);
  EXPECT_GT(most, 27);
  EXPECT_LT(most, 30 + 5);
}

/// Shares of |z| below `within` by Student's t with three degrees of freedom, scaled to the deviation 1 (its own is
/// √3).
void expect_heavy_tails(const std::vector<double>& z) {
  const auto n = static_cast<double>(z.size());
  const boost::math::students_t t(3);
  for (const double within : {0.25, 0.5, 1.0, 2.0, 4.0}) {
    const double share = 1 - 2 * boost::math::cdf(boost::math::complement(t, std::sqrt(3.0) * within));
    const auto inside = std::count_if(z.begin(), z.end(), [&](double x) { return std::abs(x) < within; });
    EXPECT_NEAR(static_cast<double>(inside) / n, share, 4 * std::sqrt(share * (1 - share) / n)) << within;
  }
}

TEST(Simulate, HeavyTailsAreStudents) {
  const Mechanism m = ideal();
  SimulationOptions o;
  o.tolerances = 0;
  o.geometry = Geometry::linear;
  o.sigma_u = 3e-6;
  o.heavy_tails = true;
  std::vector<double> z;
  const Measurements data = simulate(m, campaign("rich", m, 50, 1), o);
  const std::vector<VectorX> d = predict(m, configure_all(m, data), data, {});
  for (std::size_t i = 0; i < d.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      z.push_back((*data.readings[i].displacement[k] - d[i](static_cast<Eigen::Index>(k))) / 3e-6);
  expect_heavy_tails(z);
}

TEST(Simulate, HeavyTailsOfAFrameAreStudents) {
  const frame::FrameDescription f = frame::read_frame(test::source_dir() + "/validation/frames/truss-45.yaml");
  const subject::Subject s = f;
  SimulationOptions o;
  o.tolerances = 0;
  o.heavy_tails = true;
  std::vector<double> z;
  const Measurements data = subject::simulate_frame(f, subject::frame_campaign("rich", f, 1), o);
  const std::vector<VectorX> d = s.stand(data)->predict(data);
  for (std::size_t i = 0; i < d.size(); ++i)
    for (std::size_t k = 0; k < data.instruments.sensors.size(); ++k)
      z.push_back((*data.readings[i].sensors[k] - d[i](static_cast<Eigen::Index>(6 + k))) /
                  *data.instruments.sensors[k].sigma);
  expect_heavy_tails(z);
}

TEST(Simulate, TheTemperatureSwingsOnceAboutItsMean) {
  const Mechanism m = ideal();
  SimulationOptions o;
  o.tolerances = 0;
  o.geometry = Geometry::linear;
  o.temperature = 22, o.swing = 3;
  const Measurements data = simulate(m, campaign("cycle", m, 50, 1), o);
  ASSERT_EQ(data.readings.size(), 432u);
  EXPECT_TRUE(data.temperature_recorded);
  for (std::size_t i = 0; i < data.readings.size(); ++i)
    EXPECT_NEAR(data.readings[i].temperature_C, 22 + 3 * std::sin(2 * M_PI * static_cast<double>(i) / 432), 6e-4) << i;
}

TEST(Simulate, TheShareCarriedIsKnownToAHundredth) {
  const Mechanism m = test::device("flexure");
  Measurements plan;
  plan.poses.push_back({"home", mm_deg_from(home_pose(m)), {}, {0}});
  Reading r;
  SimulationOptions o;
  o.tolerances = 0;
  const auto carries = [&](double force) {
    r.load = force * Vector6::Unit(0);
    plan.readings = {r};
    try {
      simulate(m, plan, o);
      return true;
    } catch (const NumericalError&) {
      return false;
    }
  };
  double force = 100;
  while (force < 1e9 && carries(force)) force *= 10;
  ASSERT_LT(force, 1e9);
  const double share = share_carried(m, plan, o);
  ASSERT_GT(share, 0);
  ASSERT_LT(share, 1);
  EXPECT_TRUE(carries(share * force));
  EXPECT_FALSE(carries(1.0101 * share * force));
}

/// One reading at each of some poses.
Measurements one_load_a_pose(const Mechanism& m, int poses) {
  Measurements plan;
  for (const Pose& pose : test::random_poses(m, poses)) {
    Reading r;
    r.pose = plan.poses.size();
    r.load << 30, -40, 20, 0.5, -0.3, 0.4;
    plan.poses.push_back({std::to_string(r.pose), mm_deg_from(pose), {}, {r.pose}});
    plan.readings.push_back(r);
  }
  return plan;
}

SimulationOptions exact_but_for_tolerances() {
  SimulationOptions o;
  o.sigma_u = 0;
  o.sigma_th = 0;
  o.geometry = Geometry::linear;
  return o;
}

// Each reading has six numbers and its pose six sliders, whose errors they tell to first order: 120 errors, whose mean
// square scatters by √(2/120) of it.
TEST(Simulate, SlidersStandOffByTheirRepeatability) {
  Mechanism m = ideal();
  m.tolerances = {};
  constexpr double sigma = 1e-6, step = 1e-6;
  m.tolerances.actuator_repeatability = sigma;
  const Measurements plan = one_load_a_pose(m, 20), data = simulate(m, plan, exact_but_for_tolerances());
  const std::vector<Configuration> drawn = configure_all(m, plan);
  PredictionOptions p;
  p.geometry = Geometry::linear;
  const auto read = [&](std::size_t pose, const VectorX& errors) -> Vector6 {
    std::vector<Configuration> machines = drawn;
    machines[pose] = configure_as_built(m, {}, drawn[pose], errors);
    return predict(m, machines, data, p)[pose].head<6>();
  };
  double squares = 0;
  for (std::size_t pose = 0; pose < drawn.size(); ++pose) {
    const Vector6 none = read(pose, Vector6::Zero());
    Matrix6 slope;
    Vector6 off;
    for (Eigen::Index i = 0; i < 6; ++i) {
      slope.col(i) = (read(pose, step * Vector6::Unit(i)) - read(pose, -step * Vector6::Unit(i))) / (2 * step);
      off(i) = *data.readings[pose].displacement[static_cast<std::size_t>(i)] - none(i);
    }
    squares += slope.fullPivLu().solve(off).squaredNorm() / (sigma * sigma);
  }
  EXPECT_NEAR(squares / 120, 1, 5 * std::sqrt(2.0 / 120));
}

// By the tolerance of its gain; a sensor without one reads as the description says, 5 % off.
TEST(Simulate, GainsOfSensorsAreDrawnWithinTheirTolerance) {
  Mechanism m = test::with(ideal(), "sensors",
                           "{doubtful: {direction: uz, gain: \"1 ± 2 %\"}, known: {direction: ux, gain: 1.05}}");
  m.tolerances = {};
  const Measurements plan = one_load_a_pose(m, 1);
  Mechanism exact = m;
  for (auto& [name, sensor] : exact.sensors) sensor.gain = 1, sensor.gain_sigma = 0;
  SimulationOptions o = exact_but_for_tolerances();
  const Measurements without = simulate(exact, plan, o);
  double squares = 0;
  constexpr int machines = 100;
  for (std::uint64_t seed = 1; seed <= machines; ++seed) {
    o.seed = seed;
    const Measurements data = simulate(m, plan, o);
    const auto gain = [&](std::size_t k) { return *data.readings[0].sensors[k] / *without.readings[0].sensors[k]; };
    squares += std::pow((gain(0) - 1) / 0.02, 2);
    EXPECT_NEAR(gain(1), 1.05, 1e-12);
  }
  EXPECT_NEAR(squares / machines, 1, 5 * std::sqrt(2.0 / machines));
}

// A slider that stands at an end of its range in the drawing goes a little beyond in half of the machines.
TEST(AsBuilt, AMachineStandsWhereItsDrawingJustCan) {
  Mechanism m = ideal();
  const Pose pose = test::random_poses(m, 1)[0];
  double low = 1, high = 0;
  for (const Actuator& actuator : configure(m, pose).actuators)
    low = std::min(low, actuator.value), high = std::max(high, actuator.value);
  auto& k = std::get<SixPsu>(m.kinematics);
  k.slider_min = low - 1e-9, k.slider_max = high + 1e-9;
  const Configuration drawn = configure(m, pose);
  for (const double error : {-1e-4, 1e-4}) {
    EXPECT_THROW(configure_as_built(m, {}, drawn, VectorX::Constant(6, error)), ModelError);
    const Configuration built = configure_as_built(with_geometry(m, {}), {}, drawn, VectorX::Constant(6, error));
    EXPECT_NEAR(built.pose.p_WT.z() - drawn.pose.p_WT.z(), error, 1e-12);
  }
}

TEST(AsBuilt, AMachineAsDrawnIsTheDrawing) {
  const Mechanism m = ideal();
  AsBuilt built;
  built.legs.resize(6);
  const Configuration drawn = configure(m, test::random_poses(m, 1)[0]);
  const Configuration same = configure_as_built(with_geometry(m, built), built, drawn);
  EXPECT_LT((same.pose.p_WT - drawn.pose.p_WT).norm(), 1e-12);
  EXPECT_LT((same.pose.R_WT - drawn.pose.R_WT).norm(), 1e-12);
}

TEST(AsBuilt, APlatformOnLiftedJointsIsLifted) {
  const Mechanism m = ideal();
  AsBuilt built;
  built.legs.resize(6);
  for (LegAsBuilt& leg : built.legs) leg.base_joint.z() = 2e-5;
  const Configuration drawn = configure(m, test::random_poses(m, 1)[0]);
  const Configuration lifted = configure_as_built(with_geometry(m, built), built, drawn);
  EXPECT_LT((lifted.pose.p_WT - drawn.pose.p_WT - Vector3(0, 0, 2e-5)).norm(), 1e-12);
  // Sliders that stand too far out by as much do the same.
  const Configuration pushed = configure_as_built(m, {}, drawn, VectorX::Constant(6, 2e-5));
  EXPECT_LT((pushed.pose.p_WT - lifted.pose.p_WT).norm(), 1e-12);
}

TEST(AsBuilt, EveryLinkLongerLiftsTheSymmetricPlatform) {
  const Mechanism m = ideal();
  AsBuilt built;
  built.legs.resize(6);
  for (LegAsBuilt& leg : built.legs) leg.link_length = 1e-6;
  const Configuration drawn = configure(m, home_pose(m));
  const Configuration longer = configure_as_built(with_geometry(m, built), built, drawn);
  // dz = dL · L2/√(L2² − beside²), to first order.
  const SixPsuLeg leg = leg_at(test::six_psu(m), 1, drawn.pose);
  const double slope = test::six_psu(m).link_length / (leg.p_WC - leg.p_WB).z();
  EXPECT_NEAR(longer.pose.p_WT.z() - drawn.pose.p_WT.z(), 1e-6 * slope, 1e-10);
}

TEST(AsBuilt, ThickerGuidesBendLessByTheFourthPower) {
  const Mechanism m = ideal();
  AsBuilt built;
  built.legs.resize(6);
  for (LegAsBuilt& leg : built.legs) leg.guide_diameter = 0.01;
  const Configuration drawn = configure(m, home_pose(m));
  const Configuration thick = configure_as_built(with_geometry(m, built), built, drawn);
  const auto first = [](const Configuration& c) {
    for (const PlacedPart& part : c.legs[2].parts)
      if (const auto* member = std::get_if<PlacedMember>(&part)) return *member;
    throw std::logic_error("no member");
  };
  EXPECT_NEAR(first(thick).section.Iy / first(drawn).section.Iy, std::pow(1.01, 4), 1e-12);
  EXPECT_NEAR(first(thick).section.A / first(drawn).section.A, std::pow(1.01, 2), 1e-12);
}

TEST(Deviations, StandInTheDeviceFileAndMoveTheLeg) {
  const Mechanism m = test::with(ideal(), "kinematics.deviations",
                                 "[{leg: 3, base_joint: [0 mm, 0 mm, 0.5 mm], link_length: -0.2 mm}]");
  const Mechanism again = parse_mechanism(write_mechanism(m), "again");
  ASSERT_EQ(test::six_psu(again).deviations.size(), 1u);
  const Pose pose = home_pose(ideal());
  EXPECT_NEAR(leg_at(test::six_psu(again), 3, pose).p_WA.z(), 5e-4, 1e-15);
  EXPECT_EQ(leg_at(test::six_psu(again), 2, pose).p_WA.z(), 0);
  const SixPsuLeg leg = leg_at(test::six_psu(again), 3, pose);
  EXPECT_NEAR((leg.p_WC - leg.p_WB).norm(), 0.1253, 1e-12);
}

}  // namespace
}  // namespace deflect
