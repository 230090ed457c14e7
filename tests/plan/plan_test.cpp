#include "validation/plan/next_readings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "msa/frame/file/frame_file.h"
#include "tests/plan/rivals_on_the_6psu.h"
#include "tests/support/cantilever.h"
#include "validation/effects/place_effects.h"
#include "validation/measurement/joined.h"
#include "validation/plan/foresight.h"
#include "validation/prediction/campaign.h"
#include "validation/report/plan/foresight_results.h"
#include "validation/report/plan/plan_results.h"

namespace deflect::plan {
namespace {

using measurement::Measurements;
using test::effect;
using test::values;

/// The paper's plan as the machine is predicted to read it.
const Measurements& paper() {
  static const Measurements data =
      filled_in(machine(), prediction::campaign("paper", machine(), 50, 1), ForesightOptions(), true);
  return data;
}

Plan plan_of(std::vector<Rival> rivals, PlanOptions o = {}, int threads = 1) {
  o.draws = 3;
  return next_readings(machine(), paper(), std::move(rivals), o, {threads});
}

TEST(Plan, ModulusAndLoadGainAreToldApartByNoReading) {
  const Plan p = plan_of({rival("modulus", values({0.9})), rival("load_gain", values({1.1}))});
  ASSERT_EQ(p.inseparable.size(), 1u);
  EXPECT_TRUE(p.readings.readings.empty());
  EXPECT_LT(p.inseparable.front().pair.separation, 1);
  std::string all;
  for (const std::string& sentence : p.inseparable.front().instead) all += sentence;
  EXPECT_NE(all.find("independent calibration of the load cell"), all.npos) << all;
}

TEST(Plan, ActuatorAndPlatformTakeMoments) {
  const std::vector<Rival> rivals = {rival("actuator_compliance", values({4000})),
                                     rival("platform_flexibility", values({2500}))};
  PlanOptions o;
  o.limits.moment = 5;  // on a lever of 100 mm: a reading then tells about five times what one of 50 N does
  const Plan p = plan_of(rivals, o);
  ASSERT_FALSE(p.readings.readings.empty());
  EXPECT_GE(p.probability, 0.9);
  std::size_t moments = 0;
  for (const measurement::Reading& r : p.readings.readings)
    if (!r.load.tail<3>().isZero(0)) ++moments;
  EXPECT_GT(2 * moments, p.readings.readings.size());
  PlanOptions forces = o;
  forces.limits.forces_only = true;
  const Plan without = plan_of(rivals, forces);
  for (const measurement::Reading& r : without.readings.readings) EXPECT_TRUE(r.load.tail<3>().isZero(0));
  EXPECT_GE(without.readings.readings.size(), p.readings.readings.size());
}

/// Both remember the loads: the readings are steps of sequences, each from a new approach.
TEST(Plan, WhereLoadsAreRememberedReadingsAreStepsOfSequences) {
  PlanOptions o;
  o.readings = 6;
  const Plan p =
      plan_of({rival("joint_friction", values({2, 1000, 1})), rival("joint_friction", values({4, 200, 1}))}, o);
  ASSERT_FALSE(p.readings.readings.empty());
  for (const measurement::PoseGroup& pose : p.readings.poses)
    EXPECT_NE(p.readings.readings[pose.readings.front()].notes.front().find("goes on"), std::string::npos);
  EXPECT_GT(p.as_planned.front().separation, 0);
}

// At the poses of the paper, which are not tilted, the normal of the platform is the axis of the guideways: there a
// platform that yields is told from actuators that do by no reading.
TEST(Plan, EveryReadingKeepsToTheLimits) {
  PlanOptions o;
  o.limits.force = 20;
  o.limits.moment = 4;
  o.limits.where = Where::as_measured;
  o.readings = 8;
  o.most_poses = 2;
  o.probability = 1;
  const Plan p = plan_of({rival("actuator_compliance", values({4000})), rival("joint_compliance", values({4000}))}, o);
  EXPECT_EQ(p.readings.readings.size(), 8u);
  EXPECT_LE(p.readings.poses.size(), 2u);
  for (const measurement::Reading& r : p.readings.readings) {
    EXPECT_LE(r.load.head<3>().cwiseAbs().maxCoeff(), 20);
    EXPECT_LE(r.load.tail<3>().cwiseAbs().maxCoeff(), 4);
    const Vector6& at = p.readings.poses[r.pose].pose_mm_deg;
    EXPECT_TRUE(std::any_of(paper().poses.begin(), paper().poses.end(),
                            [&](const measurement::PoseGroup& g) { return g.pose_mm_deg == at; }));
  }
}

TEST(Plan, GrowsWithEveryReadingAndNotWithThreads) {
  PlanOptions o;
  o.readings = 6;
  o.probability = 1;
  const std::vector<Rival> rivals = {rival("actuator_compliance", values({4000})),
                                     rival("platform_flexibility", values({2500}))};
  const Plan one = plan_of(rivals, o, 1), two = plan_of(rivals, o, 2);
  ASSERT_EQ(one.steps.size(), 7u);
  for (std::size_t i = 1; i < one.steps.size(); ++i)
    EXPECT_GE(one.steps[i].pairs.front().separation, one.steps[i - 1].pairs.front().separation);
  EXPECT_EQ(measurement::measurements_text(one.readings, one.read),
            measurement::measurements_text(two.readings, two.read));
  EXPECT_EQ(one.probability, two.probability);
}

TEST(Plan, ChanceOfConfusionIsTheTailBeyondHalfTheDistance) {
  EXPECT_DOUBLE_EQ(chance_of_confusion(0), 0.5);
  EXPECT_NEAR(chance_of_confusion(4 * 1.959964 * 1.959964), 0.025, 1e-8);  // the line between them is 1.96 σ away
}

std::vector<effects::Effect> elastic_effects() {
  std::vector<effects::Effect> out;
  for (const char* name : {"actuator_compliance", "platform_flexibility", "joint_compliance", "tool_compliance"})
    out.push_back(effect(name));
  return out;
}

TEST(Plan, TheBetterCampaignTakesTheWrongEffectMoreSeldom) {
  ForesightOptions o;
  o.limits.moment = 5;
  const Foresight f = foresight(machine(), prediction::campaign("paper", machine(), 50, 1), elastic_effects(), o);
  ASSERT_EQ(f.given.separations.rows(), 4);
  const auto mean = [](const MatrixX& separations) {
    double sum = 0;
    for (Eigen::Index i = 0; i < 4; ++i)
      for (Eigen::Index k = 0; k < 4; ++k)
        if (i != k) sum += chance_of_confusion(separations(i, k));
    return sum / 12;
  };
  // Of two effects of λ = 8 what is left of one beside the other is 8 times the sine between their signatures.
  for (Eigen::Index i = 0; i < 4; ++i)
    for (Eigen::Index k = 0; k < 4; ++k)
      EXPECT_NEAR(f.given.separations(i, k), 64 * (1 - std::pow(f.given.cosines(i, k), 2)), 1e-9);
  // Actuators and platform are one at poses that are not tilted: alone they give 2 of 12 chances of one half.
  EXPECT_GT(mean(f.given.separations), 1.0 / 12);
  EXPECT_LT(mean(f.better.separations), 0.7 * mean(f.given.separations));
}

/// 280 readings at 20 poses: too many for every reading to be looked at every time.
TEST(Plan, ALongCampaignIsExchangedToo) {
  ForesightOptions o;
  o.limits.moment = 1;
  const Foresight f = foresight(machine(), prediction::campaign("random", machine(), 50, 1), elastic_effects(), o, {1});
  EXPECT_TRUE(f.found);
  EXPECT_EQ(f.better.readings.readings.size(), 280u);
  EXPECT_LE(f.better.readings.poses.size(), 20u);
  const Confusion here = confusion(f.given, f.given), there = confusion(f.better, f.given);
  EXPECT_GE(there.told, here.told);
  EXPECT_LT(there.mean, here.mean);
  // Both curves begin at ½, where nothing is known, and fall to what the whole campaign tells.
  ASSERT_EQ(f.better.gain.size(), 280u);
  EXPECT_LE(f.better.gain.front().value, 0.5);
  EXPECT_LT(f.better.gain.back().value, f.given.gain.back().value);
}

/// A force beside the tool point: with a moment about an axis across it.
TEST(Plan, ForcesActBesideTheToolPointToo) {
  const Possible all = possible_readings(machine(), paper(), {}, false, 1);
  std::size_t beside = 0;
  for (std::size_t i = all.taken; i < all.all.readings.size(); ++i) {
    const Vector6& load = all.all.readings[i].load;
    if (load.head<3>().isZero(0) || load.tail<3>().isZero(0)) continue;
    EXPECT_NEAR(load.head<3>().dot(load.tail<3>()), 0, 0);  // what a force on a lever gives
    ++beside;
  }
  EXPECT_EQ(beside % 48, 0u);
  EXPECT_GT(beside, 0u);
  Limits forces;
  forces.forces_only = true;
  const Possible without = possible_readings(machine(), paper(), forces, false, 1);
  for (const measurement::Reading& r : without.all.readings) EXPECT_TRUE(r.load.tail<3>().isZero(0));
}

/// Three load cases: alone with both senses in three sizes, in twos and in threes with all senses.
TEST(Plan, LoadCasesOfAFrameStandTogether) {
  const subject::Subject beam = frame::parse_frame(
      test::cantilever::file("sensors: {z: {node: B, direction: uz, sigma: 10 um}}\n",
                             "line: {members: {beam: {qz: -25 N/m, axes: base}}}, half: {nodes: {B: {fz: -5 N}}}"),
      "frame.yaml");
  const Measurements data =
      beam.placed(measurement::parse_measurements("load.tip,z_mm\n1,0\n", "data.csv", beam.instruments()));
  ASSERT_EQ(beam.instruments().load_cases.size(), 3u);
  for (const auto& [cases, readings] :
       {std::pair{0u, 18u + 12 + 8}, std::pair{3u, 18u + 12 + 8}, std::pair{2u, 18u + 12}, std::pair{1u, 18u}}) {
    Limits limits;
    limits.cases = cases;
    const Possible all = possible_readings(beam, data, limits, false, 1);
    EXPECT_EQ(all.all.readings.size() - all.taken, readings) << cases;
    for (std::size_t i = all.taken; i < all.all.readings.size(); ++i)
      for (const double factor : all.all.readings[i].factors) EXPECT_LE(std::abs(factor), 1);
  }
}

/// A force at each node named, along both axes of the plane, with both senses, in three sizes; as large as a load case
/// has it at a node, or as it is said. What the data have loaded needs no name.
TEST(Plan, AForceCanStandAtNodes) {
  const subject::Subject beam = frame::parse_frame(
      test::cantilever::file("sensors: {z: {node: B, direction: uz, sigma: 10 um}}\n"), "frame.yaml");
  const auto read = [&](const char* rows) {
    return beam.placed(measurement::parse_measurements(rows, "data.csv", beam.instruments()));
  };
  const auto forces = [&](const Measurements& data, const Limits& limits) {
    const Possible all = possible_readings(beam, data, limits, false, 1);
    std::map<std::string, std::vector<double>> at;
    for (std::size_t i = all.taken; i < all.all.readings.size(); ++i)
      for (std::size_t p = 0; p < all.all.instruments.load_points.size(); ++p)
        if (const Vector6& load = all.all.readings[i].at_points[p]; !load.isZero(0))
          at[all.all.instruments.load_points[p]].push_back(load.cwiseAbs().maxCoeff());
    return at;
  };
  const Measurements by_cases = read("load.tip,z_mm\n2,0\n"), at_a_node = read("node.B.fz_N,z_mm\n-3,0\n");
  EXPECT_TRUE(forces(by_cases, {}).empty());
  Limits limits;
  limits.nodes = {"all"};
  const auto everywhere = forces(by_cases, limits);
  EXPECT_EQ(everywhere.size(), beam.frame()->nodes.size());
  const double tip = beam.frame()->loads.front().second.nodes.front().second.head<3>().cwiseAbs().maxCoeff();
  for (const auto& [point, sizes] : everywhere) {
    EXPECT_EQ(sizes.size(), 12u) << point;
    EXPECT_EQ(*std::max_element(sizes.begin(), sizes.end()), 2 * tip) << point;
  }
  EXPECT_EQ(forces(at_a_node, {}).count("node.B"), 1u);
  limits.nodes = {"B"}, limits.force = 7;
  const auto at_b = forces(by_cases, limits);
  ASSERT_EQ(at_b.size(), 1u);
  EXPECT_EQ(*std::max_element(at_b.at("node.B").begin(), at_b.at("node.B").end()), 7);
  limits.nodes = {"Q"};
  EXPECT_THROW(forces(by_cases, limits), InputError);
  EXPECT_THROW(possible_readings(machine(), paper(), limits, false, 1), InputError);
}

/// A campaign stands among what could be read instead of it, reading by reading, and shares its approaches.
TEST(Plan, TheCampaignGivenIsOneOfThePossibleOnes) {
  const Possible all = possible_campaign(machine(), paper(), {}, 1);
  ASSERT_EQ(all.given.size(), paper().readings.size());
  for (std::size_t i = 0; i < all.given.size(); ++i) {
    const Block& block = all.blocks[all.given[i]];
    const measurement::Reading &r = all.all.readings[block.first], &given = paper().readings[i];
    EXPECT_EQ(r.load, given.load);
    EXPECT_EQ(all.all.poses[block.pose].pose_mm_deg, paper().poses[given.pose].pose_mm_deg);
    EXPECT_GT(all.all.poses[block.pose].readings.size(), 3u);
  }
  for (const Block& b : all.blocks) EXPECT_EQ(all.all.readings[b.first].pose, b.pose);
  Limits less;
  less.force = 49;  // under the 50 N of the paper
  const Possible without = possible_campaign(machine(), paper(), less, 1);
  EXPECT_TRUE(without.given.empty());
  for (const measurement::Reading& r : without.all.readings) EXPECT_LE(r.load.head<3>().cwiseAbs().maxCoeff(), 49);
}

/// The tip's full load tells most of the modulus, and it is the only load case: nothing is better than to repeat it.
TEST(Plan, WhereNoCampaignIsBetterNoneIsNamed) {
  const subject::Subject beam = frame::parse_frame(
      test::cantilever::file("sensors: {z: {node: B, direction: uz, sigma: 10 um}}\ntolerances: {modulus: 1 %}\n"),
      "frame.yaml");
  ForesightOptions o;
  o.toward = Toward::precision;
  const auto better = [&](const char* rows) {
    const Measurements given = beam.placed(measurement::parse_measurements(rows, "plan.csv", beam.instruments()));
    const Foresight f = foresight(beam, given, {}, o, {1});
    EXPECT_EQ(f.better.readings.readings.size(), 2u);
    EXPECT_EQ(report::foresight_report(f).find("No better campaign of 2 readings was found") != std::string::npos,
              !f.found);
    return f.found;
  };
  EXPECT_FALSE(better("load.tip,z_mm\n1,0\n1,0\n"));
  // Of half the load the error is as if its noise were twice as large.
  EXPECT_TRUE(better("load.tip,z_mm\n1,0\n0.5,0\n"));
}

/// Two springs in series, 1 N/µm each, with a sensor at the far end and more of them.
subject::Subject two_springs(const std::string& more_sensors) {
  return frame::parse_frame(R"(name: chain
plane: xz
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m]}
supports: {A: [uz, ry], B: [uz, ry]}
springs: {lower: {node: A, ux: 1 N/um}, upper: {node: B, to: A, ux: 1 N/um}}
loads: {pull: {nodes: {B: {fx: 10 N}}}}
sensors: {top: {node: B, direction: ux, sigma: 1 um})" +
                                more_sensors + "}\n",
                            "chain.yaml");
}

/// Read at the far end alone: 10 N move it by 30 µm, and the one or the other is half as stiff. No load tells which.
/// The node between them moves by 20 or by 10 µm: with σ = 1 µm and the reading at the end taken again, the lower
/// spring half as stiff leaves 10² where the upper one is fitted, which cannot move the node, and the upper one leaves
/// the least of (10 + x)² + 2 x² where the lower one is, 66.7.
TEST(Plan, NamesTheInstrumentThatWouldTell) {
  const subject::Subject s = two_springs("");
  const std::vector<effects::Effect> effects = effects::place_effects(s, {});
  const auto softer = [&](const char* name) -> Rival {
    return {{{&effects::find_effect(effects, name), {}}}, values({0.5}), 0.5};
  };
  const Measurements data =
      s.placed(measurement::parse_measurements("load.pull,top_mm\n1,0.03\n", "data.csv", s.instruments()));
  PlanOptions o;
  o.draws = 1;
  const Plan p = next_readings(s, data, {softer("factor@spring.lower.ux"), softer("factor@spring.upper.ux")}, o);
  EXPECT_EQ(p.inseparable.size(), 1u);
  EXPECT_TRUE(p.readings.readings.empty());
  ASSERT_EQ(p.sensors.size(), 1u);
  EXPECT_EQ(p.sensors.front().sensor.name, "ux of node A");
  EXPECT_EQ(p.sensors.front().enough, std::vector<std::size_t>{0});
  double least = INFINITY;
  for (double x = -10; x < 0; x += 1e-3) {  // a factor's logarithm has the prior deviation 3
    const double prior = std::log(20 / (20 + x)) / 3;
    least = std::min(least, (10 + x) * (10 + x) + 2 * x * x + prior * prior);
  }
  EXPECT_NEAR(p.sensors.front().separation, (100 + least) / 2, 0.01);
  const std::string report = report::plan_report(p);
  EXPECT_NE(report.find("{node: A, direction: ux, sigma: 0.001 mm}"), std::string::npos) << report;
}

/// The same two springs, where the node between them is read next. How much softer the upper one may be is known from
/// elsewhere, 0.6 ± 10 %: fitted to what the lower one would read it stands at 0.5 exp(u), reads 20 (exp(−u) − 1) µm
/// more at the end, as often as that is read, and pays ((u + ln 0.5/0.6)/0.1)² for it.
TEST(Plan, KnowsWhatAParameterIsBefore) {
  const subject::Subject s = two_springs(", mid: {node: A, direction: ux, sigma: 1 um}");
  const std::vector<effects::Effect> effects = effects::place_effects(s, {});
  effects::Effect upper = effects::find_effect(effects, "factor@spring.upper.ux");
  upper.parameters.front().prior = effects::ParameterPrior{0.6, 0.06};
  const auto half = [](const effects::Effect& e) -> Rival { return {{{&e, {}}}, values({0.5}), 0.5}; };
  const auto read = [&](const char* rows) {
    return s.placed(measurement::parse_measurements(rows, "data.csv", s.instruments()));
  };
  PlanOptions o;
  o.draws = 1;
  const Pair p = expected_of(s, read("load.pull,top_mm\n1,0.03\n"), read("load.pull,top_mm,mid_mm\n1,0.03,0.02\n"),
                             {half(effects::find_effect(effects, "factor@spring.lower.ux")), half(upper)}, o)
                     .pairs.front();
  const auto least = [](double ends) {
    double out = INFINITY;
    for (double u = -1; u < 1; u += 1e-5) {
      const double off = 20 * (std::exp(-u) - 1), known = (u + std::log(0.5 / 0.6)) / 0.1;
      out = std::min(out, ends * off * off + known * known);
    }
    return out;
  };
  EXPECT_NEAR(p.if_a, 100 + least(2) - least(1), 0.01);
}

TEST(Plan, IsAFileWithEmptyCellsThatReadsBack) {
  const Plan p = plan_of({rival("actuator_compliance", values({4000})), rival("platform_flexibility", values({2500}))});
  const std::string text = measurement::measurements_text(p.readings, {true, true, true, true, false, false});
  EXPECT_NE(text.find("ux_mm,uy_mm,uz_mm,thx_rad,"), text.npos);
  const Measurements back = measurement::parse_measurements(text, "plan.csv");
  ASSERT_EQ(back.readings.size(), p.readings.readings.size());
  for (std::size_t i = 0; i < back.readings.size(); ++i) {
    EXPECT_TRUE(back.readings[i].load.isApprox(p.readings.readings[i].load, 1e-12));
    for (const auto& cell : back.readings[i].displacement) EXPECT_FALSE(cell);
  }
}

TEST(Joined, KeepsApproachesAndOrderApart) {
  Measurements first = paper(), second = paper();
  for (std::size_t i = 0; i < 27; ++i) {
    first.readings[i].sequence = static_cast<double>(i);
    second.readings[i].sequence = 100 - static_cast<double>(i);
  }
  const Measurements all = measurement::joined({first, second});
  ASSERT_EQ(all.readings.size(), 54u);
  ASSERT_EQ(all.poses.size(), 18u);
  std::set<std::string> labels;
  for (const measurement::PoseGroup& pose : all.poses) labels.insert(pose.label);
  EXPECT_EQ(labels.size(), 18u);
  EXPECT_TRUE(labels.count("3 (2)"));
  const std::vector<std::size_t> order = measurement::in_sequence(all, "a test");
  for (std::size_t i = 0; i < 27; ++i) {
    EXPECT_EQ(order[i], i);
    EXPECT_EQ(order[27 + i], 53 - i);
  }
  for (std::size_t i = 0; i < 54; ++i) {
    const auto& own = all.poses[all.readings[i].pose].readings;
    EXPECT_NE(std::find(own.begin(), own.end(), i), own.end());
    EXPECT_EQ(all.readings[i].displacement, paper().readings[i % 27].displacement);
  }
  second.readings[3].sequence.reset();
  second.readings.front().sequence.reset();
  EXPECT_FALSE(measurement::joined({first, second}).readings.front().sequence);
}

}  // namespace
}  // namespace deflect::plan
