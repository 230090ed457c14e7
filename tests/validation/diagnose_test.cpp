// What `diagnose` finds in simulated measurements (MSA, deformed shape, every part off by its tolerance), and what must
// not change it.
#include "validation/diagnosis/diagnosis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "msa/base/files.h"
#include "msa/mechanism/stand.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "validation/diagnosis/interval.h"
#include "validation/diagnosis/left_over.h"
#include "validation/effects/place_effects.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/report/diagnosis_results.h"

namespace deflect {
namespace {

using namespace diagnosis;
using namespace effects;
using namespace measurement;
using namespace prediction;
using namespace report;

const Mechanism& ideal() {
  static const Mechanism m = test::device("haptic-6psu-ideal-joints");
  return m;
}

/// 280 readings at 20 poses of a device.
Measurements measured(const Mechanism& truth, std::uint64_t seed, const std::string& plan = "random") {
  SimulationOptions o;
  o.seed = seed;
  return simulate(truth, campaign(plan, ideal(), 50, seed), o);
}

/// 98 readings at the first 7 of these poses: enough for large effects, and where two diagnoses are compared.
Measurements measured_briefly(const Mechanism& truth, std::uint64_t seed) {
  constexpr std::size_t poses = 7;
  SimulationOptions o;
  o.seed = seed;
  Measurements plan = campaign("random", ideal(), 50, seed);
  std::erase_if(plan.readings, [](const Reading& r) { return r.pose >= poses; });
  plan.poses.resize(poses);
  for (PoseGroup& p : plan.poses) p.readings.clear();
  for (std::size_t i = 0; i < plan.readings.size(); ++i) plan.poses[plan.readings[i].pose].readings.push_back(i);
  return simulate(truth, std::move(plan), o);
}

Mechanism with(const std::string& effect, std::initializer_list<double> values, std::optional<int> leg = {}) {
  return with_effect(ideal(), test::effect(effect), test::values(values), leg);
}

std::vector<std::string> names(const Hypothesis& h) {
  std::vector<std::string> out;
  for (const PlacedEffect& e : h) out.push_back(e.effect->name);
  std::sort(out.begin(), out.end());
  return out;
}

double probability(const Diagnosis& d, const std::string& effect, std::optional<int> leg = {}) {
  double sum = 0;
  for (const Candidate& c : d.candidates)
    if (c.added().effect->name == effect && (!leg || c.added().leg == leg)) sum += c.probability;
  return sum;
}

double total(const Diagnosis& d) {
  double sum = d.probability_nothing + d.probability_unknown;
  for (const Candidate& c : d.candidates) sum += c.probability;
  return sum;
}

TEST(Diagnose, NamesTheEffectWithItsValueAndTheErrorFallsToTheNoise) {
  const Diagnosis d = diagnose(ideal(), measured(with("guide_root_compliance", {5e6}), 11), test::all_effects());
  EXPECT_EQ(d.verdict, Verdict::effect);
  ASSERT_EQ(names(d.missing), std::vector<std::string>{"guide_root_compliance"});
  const auto [low, high] = interval95(d.missing, d.fit, 0);
  EXPECT_LT(low, 5e6);
  EXPECT_GT(high, 5e6);
  EXPECT_NEAR(total(d), 1, 1e-12);
  EXPECT_GT(probability(d, "guide_root_compliance"), 0.9);
  EXPECT_GT(d.baseline.rmse, 3 * d.final.rmse);
  EXPECT_GT(d.baseline.held_out, 1.2 * d.final.held_out);  // tolerances bent to the data hide most of it
  // 840 numbers: χ²/n within five of its deviations √(2/840).
  EXPECT_NEAR(d.final.chi2_per_dof, 1, 5 * std::sqrt(2.0 / 840));
  EXPECT_LT(d.final.rmse, 1.5 * d.noise_floor);
}

// Of a catalogue of one entry the only candidate is the last one too: without tolerances it leaves the noise, whose
// mean square over 294 numbers scatters by √(2/294).
TEST(Diagnose, TellsOfTheOnlyCandidateHowWellItPredicts) {
  const Mechanism truth = with("guide_root_compliance", {5e6});
  Measurements plan = measured_briefly(ideal(), 13);
  SimulationOptions o;
  o.tolerances = 0;
  o.sigma_u = 2e-6;
  const Diagnosis d = diagnose(ideal(), simulate(truth, plan, o), {test::effect("guide_root_compliance")});
  ASSERT_EQ(d.candidates.size(), 1u);
  EXPECT_NEAR(std::pow(d.candidates.front().rmse / o.sigma_u, 2), 1, 5 * std::sqrt(2.0 / 294));
  EXPECT_GE(d.candidates.front().held_out, d.candidates.front().rmse / 2);
  EXPECT_LT(d.candidates.front().held_out, d.baseline.held_out);
}

TEST(Diagnose, FindsNothingInAHealthyMachine) {
  const Measurements data = measured(ideal(), 12);
  const Diagnosis d = diagnose(ideal(), data, test::all_effects());
  EXPECT_EQ(d.verdict, Verdict::nothing_missing);
  EXPECT_TRUE(d.missing.empty());
  // What is left in the one's sentence is what is left in the other's: both know the deformed shape.
  EXPECT_NEAR(d.baseline.rmse, compare::compare(ideal(), data).kept_rmse, 1e-9 * d.baseline.rmse);
  EXPECT_GT(d.probability_nothing, 2 * d.candidates.front().probability);
  EXPECT_NEAR(total(d), 1, 1e-12);
}

/// A device may be described in the shape that its loads give it: what the readings are compared with is that shape.
TEST(Diagnose, FindsNothingInAHealthyMachineOfFiniteGeometry) {
  Mechanism m = ideal();
  m.geometry = Geometry::finite;
  SimulationOptions o;
  o.sigma_u = 5e-7;
  o.tolerances = 0;
  const Measurements data = simulate(m, campaign("paper", m, 200, 1), o);
  EXPECT_EQ(diagnose(m, data, test::all_effects(), {{}, 99}).verdict, Verdict::nothing_missing);
}

TEST(Diagnose, FindsTwoEffectsTogether) {
  Mechanism truth = with("joint_compliance", {1000});
  truth = with_effect(truth, test::effect("leg_defect"), test::values({0.6}), 3);
  const Diagnosis d = diagnose(ideal(), measured(truth, 13), test::all_effects());
  EXPECT_EQ(names(d.missing), (std::vector<std::string>{"joint_compliance", "leg_defect"}));
  for (const PlacedEffect& e : d.missing) {
    if (e.effect->name == "leg_defect") {
      EXPECT_EQ(e.leg, 3);
    }
  }
  EXPECT_FALSE(d.unexplained);
}

// Loads of one sign and one size per axis, without moments: a platform that yields is an actuator that yields.
TEST(Diagnose, SaysThatTheDataCannotTell) {
  const Diagnosis d =
      diagnose(ideal(), measured(with("platform_flexibility", {2000}), 14, "paper"), test::all_effects());
  ASSERT_EQ(d.verdict, Verdict::ambiguous);
  ASSERT_FALSE(d.indistinguishable.empty());
  const std::vector<std::string>& group = d.indistinguishable.front();
  EXPECT_NE(std::find(group.begin(), group.end(), "platform_flexibility"), group.end());
}

/// And the laws at the device's places.
std::vector<Effect> with_places(std::vector<Effect> named) {
  for (Effect& e : place_effects(ideal(), named)) named.push_back(std::move(e));
  return named;
}

const std::vector<Effect>& entries_and_places() {
  static const std::vector<Effect> all = with_places(test::all_effects());
  return all;
}

// An effect of one's own: the machine turns on its base about the vertical.
const char* own_effect = R"(name: turntable
title: The machine turns on its base
scope: machine
parameters:
  stiffness_Nmm_per_rad: {start: 1e7, low: 1e3, high: 1e12, scale: log, vanishes: infinity, about: of the base}
edits:
  - {at: base.rz, append: {law: linear, stiffness: $stiffness_Nmm_per_rad}}
pages: {machine: It turns., data: More displacement far from the middle., bench: Push it sideways., cure: Clamp it.}
)";

TEST(Diagnose, FindsAnEffectOfOnesOwnAndCallsItUnknownWithoutItsFile) {
  std::vector<Effect> effects = test::all_effects();
  const Effect own = parse_effect(own_effect, "own.yaml");
  const Measurements data = measured_briefly(with_effect(ideal(), own, test::values({2e6})), 15);

  const Diagnosis without = diagnose(ideal(), data, effects);
  EXPECT_EQ(without.verdict, Verdict::unknown_effect);
  EXPECT_FALSE(without.pattern.empty());

  const Diagnosis by_places = diagnose(ideal(), data, entries_and_places());
  ASSERT_EQ(names(by_places.missing), std::vector<std::string>{"linear@base.rz"});
  EXPECT_NEAR(by_places.fit.values(0), 2e6, 0.1 * 2e6);

  add_effect(effects, own);
  const std::vector<Effect> all = with_places(effects);
  const Diagnosis with_file = diagnose(ideal(), data, all);
  ASSERT_EQ(names(with_file.missing), std::vector<std::string>{"turntable"});
  const auto [low, high] = interval95(with_file.missing, with_file.fit, 0);
  EXPECT_LT(low, 2e6);
  EXPECT_GT(high, 2e6);
}

// Where the machine stands with no effect, "nothing is missing" would be said of nothing tried.
TEST(Diagnose, SaysNothingWhereNoEffectCanBeTried) {
  std::string text = own_effect;
  text.replace(text.find("{at: base.rz, append: {law: linear, stiffness: $stiffness_Nmm_per_rad}}"), text.npos,
               "{at: kinematics.link_length, multiply: $stiffness_Nmm_per_rad}\n"
               "pages: {machine: a, data: b, bench: c, cure: d}\n");
  text.replace(text.find("start: 1e7, low: 1e3"), 20, "start: 0.3, low: 0.1");  // no pose of the data is within reach
  Effect never = parse_effect(text, "own.yaml");
  never.place = entries_and_places().back().place;
  try {
    diagnose(ideal(), measured_briefly(ideal(), 3), {never});
    FAIL() << "no refusal";
  } catch (const ModelError& e) {
    const std::string what = e.what();
    EXPECT_NE(what.find("none can be tried, so that nothing can be said: with turntable"), what.npos) << what;
  }
}

// A turntable that yields in proportion to the load and stays as it is has neither play nor drift: where only these are
// in the catalogue, nothing of it is named beside what is unknown.
TEST(Diagnose, NamesNothingThatACommonPatternTakesBesideTheUnknown) {
  const Effect own = parse_effect(own_effect, "own.yaml");
  const Measurements data = measured_briefly(with_effect(ideal(), own, test::values({5e5})), 15);
  for (const char* entry : {"joint_clearance", "sensor_drift"}) {
    const Diagnosis d = diagnose(ideal(), data, {test::effect(entry)});
    EXPECT_EQ(d.verdict, Verdict::unknown_effect) << entry;
    EXPECT_TRUE(d.missing.empty()) << entry;
  }
}

// Once an effect is found, p/(1 − p) of something unknown is the evidence for it times its prior odds of 0.1 to 0.9.
// The diagnosis weighs by values of the fit before the last one, which differ by far less than their deviations.
TEST(Diagnose, ProbabilityOfTheUnknownIsThatOfBayes) {
  const std::vector<Effect> one = {test::effect("guide_root_compliance")};
  const Measurements data = measured_briefly(with("guide_root_compliance", {5e6}), 23);
  const Diagnosis d = diagnose(ideal(), data, one);
  ASSERT_EQ(d.missing.size(), 1u);
  const Observations o(ideal(), data, {}), seen = o.granted(subject_with(o, d.missing, d.fit.values));
  const SignaturesAtPlaces all(o, one, 1);
  const Fit fit = fit_of_all(seen, d.missing, d.fit.values);
  const LeftOver left = left_over(seen.whitened_patterns(), at_places({all, seen}, d.missing, fit, 1), fit);
  EXPECT_NEAR(9 * d.probability_unknown / (1 - d.probability_unknown) / std::exp(left.log_evidence), 1, 1e-3);
  EXPECT_NEAR(total(d), 1, 1e-12);
}

// Hundreds of laws at places do not outvote an entry, do not alarm where nothing is missing and do not change what an
// entry's fit says.
TEST(Diagnose, LawsAtPlacesStandBesideTheEntries) {
  const Measurements data = measured_briefly(with("guide_root_compliance", {5e6}), 11);
  const Diagnosis entries = diagnose(ideal(), data, test::all_effects()),
                  all = diagnose(ideal(), data, entries_and_places());
  EXPECT_EQ(names(all.missing), names(entries.missing));
  EXPECT_NEAR(all.fit.values(0) / entries.fit.values(0), 1, 1e-6);
  EXPECT_NEAR(total(all), 1, 1e-9);
  EXPECT_GT(all.candidates.size(), entries.candidates.size() + 100);

  const Diagnosis healthy = diagnose(ideal(), measured(ideal(), 12), entries_and_places());
  EXPECT_EQ(healthy.verdict, Verdict::nothing_missing);
}

// One leg's guide is clamped softly about one axis, which no entry is about.
TEST(Diagnose, NamesALawAtAPlaceThatNoEntryIsAbout) {
  const Mechanism truth =
      edited(ideal(), {"leg[4].actuator.rx", "{law: linear, stiffness: 2e6 Nmm/rad}", Edit::Action::append});
  const Diagnosis d = diagnose(ideal(), measured_briefly(truth, 31), entries_and_places());
  ASSERT_EQ(names(d.missing), std::vector<std::string>{"linear@leg.actuator.rx"});
  EXPECT_EQ(d.missing.front().leg, 4);
  const auto [low, high] = interval95(d.missing, d.fit, 0);
  EXPECT_LT(low, 2e6);
  EXPECT_GT(high, 2e6);
}

// Two entries that are as likely: hertz_contact and what ties with it.
TEST(Diagnose, AnEffectRegisteredTwiceChangesNeitherTheNameNorTheProbabilities) {
  const Measurements data = measured_briefly(with("hertz_contact", {0.0003}), 16);
  const Diagnosis once = diagnose(ideal(), data, test::all_effects());
  ASSERT_LT(probability(once, "hertz_contact"), 0.9);
  std::vector<Effect> effects = test::all_effects();
  Effect twin = test::effect(once.missing.at(0).effect->name);
  const std::string name = twin.name;
  twin.name += "_again";
  effects.push_back(twin);
  const Diagnosis twice = diagnose(ideal(), data, effects);
  EXPECT_EQ(names(twice.missing), names(once.missing));
  EXPECT_NEAR(probability(twice, name) + probability(twice, twin.name), probability(once, name), 1e-6);
  for (const Effect& e : test::all_effects())
    if (e.name != name) {
      EXPECT_NEAR(probability(twice, e.name), probability(once, e.name), 1e-6) << e.name;
    }
}

// The guides are thicker than drawn and no entry says so: clamps that yield would have to yield less than nothing. That
// they come nearest to the misfit must not keep others from being looked into.
TEST(Diagnose, WhatActsTheWrongWayDoesNotHideOthers) {
  Mechanism truth = with("guide_diameter", {1.2});
  truth = with_effect(truth, test::effect("sensor_drift"), test::values({0.001, 0, 0}));
  std::vector<Effect> effects = {test::effect("guide_root_compliance"), test::effect("sensor_drift")};
  const Diagnosis d = diagnose(ideal(), measured(truth, 21), effects);
  EXPECT_EQ(d.verdict, Verdict::unknown_effect);
  for (const Candidate& c : d.candidates)
    if (c.added().effect->name == "sensor_drift") {
      EXPECT_TRUE(c.fit.found);
      EXPECT_GT(c.gain, 6);
    } else {
      EXPECT_EQ(c.gain, 0);
    }
}

// Guides may only be thinner in this entry, and are thicker: it comes as near as can be. Along it lie the misfit and
// the noise of one number, which in every other draw is more than the misfit beyond all noise; a share is one at most.
TEST(Diagnose, TheNearestEntryHasNoMoreThanAllOfTheMisfit) {
  Effect thinner = test::effect("guide_diameter");
  thinner.parameters[0].high = 1, thinner.parameters[0].start = 0.99;
  for (const std::uint64_t seed : {4, 6, 7}) {
    const Diagnosis d = diagnose(ideal(), measured_briefly(with("guide_diameter", {1.12}), seed), {thinner});
    EXPECT_EQ(d.nearest, "guide_diameter");
    EXPECT_GT(d.nearest_share, 0.9);
    EXPECT_LE(d.nearest_share, 1);
  }
}

TEST(Diagnose, DoesNotDependOnTheNumberOfThreads) {
  const Measurements data = measured_briefly(with("leg_defect", {0.9}, 2), 17);
  EXPECT_EQ(diagnosis_json(diagnose(ideal(), data, test::all_effects(), {}, {1})),
            diagnosis_json(diagnose(ideal(), data, test::all_effects(), {}, {3})));
}

TEST(Diagnose, DoesNotDependOnTheUnitsOfTheDevice) {
  std::string text = read_text(test::source_dir() + "/validation/devices/haptic-6psu-ideal-joints.yaml");
  for (const auto& [from, to] :
       {std::pair{"118 mm", "11.8 cm"}, {"125.5 mm", "0.1255 m"}, {"210 GPa", "2.1e11 Pa"}, {"0.03 mm", "30 um"}}) {
    ASSERT_NE(text.find(from), text.npos) << from;
    for (std::size_t at; (at = text.find(from)) != text.npos;) text.replace(at, std::string(from).size(), to);
  }
  const Measurements data = measured(with("base_tilt", {2e8}), 20, "paper");
  const Diagnosis a = diagnose(ideal(), data, test::all_effects()),
                  b = diagnose(parse_mechanism(text, "units.yaml"), data, test::all_effects());
  EXPECT_EQ(names(a.missing), names(b.missing));
  for (const Effect& e : test::all_effects())
    EXPECT_NEAR(probability(a, e.name), probability(b, e.name), 1e-6) << e.name;
}

/// The effects that need no history, so that the order of readings says nothing.
std::vector<Effect> timeless() {
  std::vector<Effect> out = test::all_effects();
  std::erase_if(out, [](const Effect& e) { return e.name == "joint_friction" || e.name == "sensor_drift"; });
  return out;
}

Measurements without_sequence(Measurements data) {
  for (Reading& r : data.readings) r.sequence.reset();
  return data;
}

TEST(Diagnose, DoesNotDependOnTheOrderOfRows) {
  const std::vector<Effect> effects = timeless();
  const Measurements data = without_sequence(measured_briefly(with("actuator_compliance", {5000}), 18));
  Measurements reversed = data;
  const std::size_t n = data.readings.size();
  std::reverse(reversed.readings.begin(), reversed.readings.end());
  for (PoseGroup& p : reversed.poses) {
    for (std::size_t& i : p.readings) i = n - 1 - i;
    std::sort(p.readings.begin(), p.readings.end());
  }
  const Diagnosis a = diagnose(ideal(), data, effects), b = diagnose(ideal(), reversed, effects);
  EXPECT_EQ(names(a.missing), names(b.missing));
  EXPECT_EQ(a.verdict, b.verdict);
  for (const Effect& e : effects) EXPECT_NEAR(probability(a, e.name), probability(b, e.name), 1e-6) << e.name;
}

// The device is the same after a turn by 120° about z, with legs 1, 2 where 3, 4 were.
TEST(Diagnose, TurningTheMachineRenamesTheLegs) {
  const std::vector<Effect> effects = timeless();
  const Measurements data = without_sequence(measured_briefly(with("leg_joint_compliance", {800}, 5), 19));
  Measurements turned = data;
  const Matrix3 R = Eigen::AngleAxisd(2 * std::numbers::pi / 3, Vector3::UnitZ()).toRotationMatrix();
  for (PoseGroup& p : turned.poses) {
    const Pose pose = pose_from(p.pose_mm_deg);
    const Matrix3 turn = R * pose.R_WT * R.transpose();  // Rz(yaw) Ry(pitch) Rx(roll)
    p.pose_mm_deg << 1e3 * R * pose.p_WT, 180 / std::numbers::pi * std::atan2(turn(2, 1), turn(2, 2)),
        180 / std::numbers::pi * std::asin(-turn(2, 0)), 180 / std::numbers::pi * std::atan2(turn(1, 0), turn(0, 0));
  }
  for (Reading& r : turned.readings) {
    r.load.head<3>() = R * r.load.head<3>();
    r.load.tail<3>() = R * r.load.tail<3>();
    Vector3 u;
    for (std::size_t k = 0; k < 3; ++k) u(static_cast<Eigen::Index>(k)) = *r.displacement[k];
    u = R * u;
    for (std::size_t k = 0; k < 3; ++k) r.displacement[k] = u(static_cast<Eigen::Index>(k));
  }
  const Diagnosis a = diagnose(ideal(), data, effects), b = diagnose(ideal(), turned, effects);
  ASSERT_EQ(a.missing.size(), 1u);
  ASSERT_EQ(b.missing.size(), 1u);
  EXPECT_EQ(a.missing[0].leg, 5);
  EXPECT_EQ(b.missing[0].leg, 1);
  EXPECT_NEAR(a.fit.values(0) / b.fit.values(0), 1, 1e-4);
}

}  // namespace
}  // namespace deflect
