// Parameters that a user sets free: values, intervals and what data do not determine, against hand calculations on a
// cantilever; intervals of predictions, by how often they hold.
#include "validation/fit/fit.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/cantilever.h"
#include "tests/support/devices.h"
#include "tests/support/paths.h"
#include "validation/fit/predicted.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/report/validity/fit_results.h"
#include "validation/report/validity/predict_results.h"
#include "validation/subject/simulate_frame.h"

namespace deflect {
namespace {

using namespace fit;
using measurement::Measurements;
using subject::Subject;

using test::cantilever::tip;

constexpr double sigma = 1e-6;
const std::string file = test::cantilever::file("sensors: {z: {node: B, direction: uz, sigma: 1 um}}\n");

Subject frame_of(const std::string& more = "", const std::string& from = "", const std::string& to = "") {
  std::string text = file + more;
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return frame::parse_frame(text, "frame.yaml");
}

constexpr double factors[] = {1, -1, 0.5, -0.5, 1, -1, 0.5, -0.5, 0.25, -0.25, 0.75, -0.75};

/// Σ factor².
double squares() {
  double out = 0;
  for (const double f : factors) out += f * f;
  return out;
}

/// What the subject reads, without noise.
Measurements exact(const Subject& s) {
  std::string csv = "load.tip,z_mm\n";
  for (const double f : factors) csv += fmt::format("{},0\n", f);
  Measurements out = s.placed(measurement::parse_measurements(csv, "data.csv", s.instruments()));
  const std::vector<VectorX> d = s.stand(out)->predict(out);
  for (std::size_t i = 0; i < d.size(); ++i) out.readings[i].sensors[0] = d[i](6);
  return out;
}

compare::ComparisonOptions as_recorded() {
  compare::ComparisonOptions o;
  o.as_recorded = true;
  return o;
}

FitResult fitted(const Subject& s, const Measurements& data, const std::vector<std::string>& paths,
                 const std::vector<std::string>& priors = {}) {
  return fit::fit(s, data, free_parameters(s, paths, priors, file), as_recorded());
}

std::string refusal(const Subject& s, const std::vector<std::string>& paths,
                    const std::vector<std::string>& priors = {}) {
  return outcome_of<InputError>([&] { return free_parameters(s, paths, priors); }).why;
}

// The deflection goes as 1/E: in ln E each reading has the derivative −d, so the deviation is σ/‖d‖. d is that of the
// softer beam, 1/0.9 as large. The derivatives are by differences of 1e-5, exact to 1e-9.
TEST(Fit, FindsAModulusAsCertainAsTheReadingsMakeIt) {
  const Subject s = frame_of(), truth = frame_of("", "210 GPa", "189 GPa");
  const FitResult r = fitted(s, exact(truth), {"materials.steel.E"});
  ASSERT_EQ(r.parameters.size(), 1u);
  const FittedParameter& E = r.parameters[0];
  const double deviation = sigma / (tip / 0.9 * std::sqrt(squares()));
  EXPECT_TRUE(E.positive);
  EXPECT_EQ(E.unit, "GPa");
  EXPECT_NEAR(E.fitted, 189e9, 1e-2 * deviation * 189e9);
  EXPECT_NEAR(E.deviation, deviation, 1e-5 * deviation);
  EXPECT_NEAR(E.high, 189e9 * std::exp(1.959964 * deviation), 1e-2 * deviation * 189e9);
  EXPECT_TRUE(r.converged);
  EXPECT_TRUE(r.undetermined.empty());
  // Before the fit the residual is 1/0.9 − 1 of each deflection.
  EXPECT_NEAR(r.before.rmse, tip / 9 * std::sqrt(squares() / 12), 1e-3 * tip);
  EXPECT_LT(r.after.rmse, 1e-3 * sigma);
  EXPECT_NEAR(r.chi2_before, std::pow(tip / 9 / sigma, 2) * squares(), 1e-2 * r.chi2_before);
}

// A prior is one more reading of ln E: precisions add, and the value lies between both by their weights.
TEST(Fit, WeighsAPriorByItsDeviation) {
  const Subject s = frame_of();
  const FitResult free = fitted(s, exact(s), {"materials.steel.E"});
  const double deviation = free.parameters[0].deviation, prior = 2 * deviation, mean = 1 + 3 * deviation;
  const FitResult r = fitted(s, exact(s), {"materials.steel.E"},
                             {fmt::format("materials.steel.E={:.12f} GPa +- {:.12f} %", 210 * mean, 100 * prior)});
  const double weight = 0.25 / 1.25;  // 1/prior² over the sum
  EXPECT_NEAR(std::log(r.parameters[0].fitted / 210e9), weight * std::log(mean), 2e-2 * deviation);
  EXPECT_NEAR(r.parameters[0].deviation, deviation / std::sqrt(1.25), 1e-3 * deviation);
  ASSERT_TRUE(r.parameters[0].pull);
  EXPECT_NEAR(*r.parameters[0].pull, -(1 - weight) * std::log(mean) / prior, 1e-2);
}

// What is declared of the same number gives way; what is declared of another does not.
TEST(Fit, AToleranceOfTheSameNumberGivesWay) {
  const Measurements data = exact(frame_of());
  const double deviation = fitted(frame_of(), data, {"materials.steel.E"}).parameters[0].deviation;
  const FitResult own = fitted(frame_of("tolerances: {modulus: 1 %}"), data, {"materials.steel.E"});
  EXPECT_NEAR(own.parameters[0].deviation, deviation, 1e-5 * deviation);
  const FitResult other = fitted(frame_of("tolerances: {member.bending_factor: 1 %}"), data, {"materials.steel.E"});
  EXPECT_NEAR(other.parameters[0].deviation, std::hypot(0.01 / 1.01, deviation), 1e-5);
}

// The description that is judged before the fit is the one that `diagnose` judges, with its tolerance.
TEST(Fit, TheMisfitBeforeIsThatOfADiagnosis) {
  const Subject s = frame_of("tolerances: {modulus: 2 %}"), truth = frame_of("", "210 GPa", "189 GPa");
  const Measurements data = exact(truth);
  const diagnosis::Observations declared(s, data, as_recorded());
  EXPECT_NEAR(fitted(s, data, {"materials.steel.E"}).chi2_before, declared.null_residual().squaredNorm(),
              1e-9 * declared.null_residual().squaredNorm());
}

TEST(Fit, WarnsWhereAValueIsFarFromWhatWasDeclared) {
  const Measurements data = exact(frame_of("", "210 GPa", "189 GPa"));
  const FitResult r = fitted(frame_of("tolerances: {modulus: 1 %}"), data, {"materials.steel.E"});
  ASSERT_TRUE(r.parameters[0].beyond_tolerance);
  EXPECT_NEAR(*r.parameters[0].beyond_tolerance, std::log(0.9) / 0.01, 0.1);
  const std::vector<std::string> warnings = report::fit_warnings(r);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("10.5 standard deviations of its declared tolerance"), std::string::npos) << warnings[0];
}

std::string undetermined_words(const Subject& s, const std::vector<std::string>& paths) {
  const FitResult r = fitted(s, exact(s), paths);
  return r.undetermined.size() == 1 ? r.undetermined[0].sentence : fmt::format("{} of them", r.undetermined.size());
}

// Tip deflection: factor · P L³/(3 E b I), b the bending factor. A spring k₁ in series with k₂ under the tip yields
// P (1/k₁ + 1/k₂).
TEST(Fit, TellsWhatTheDataDoNotDetermine) {
  EXPECT_EQ(undetermined_words(frame_of(), {"materials.steel.E", "members.beam.bending_factor"}),
            "only the product of materials.steel.E and members.beam.bending_factor is determined");
  EXPECT_EQ(undetermined_words(frame_of(), {"materials.steel.E", "loads.tip.factor"}),
            "only the ratio materials.steel.E / loads.tip.factor is determined");
  EXPECT_EQ(undetermined_words(frame_of("", "supports: {A: clamped}",
                                        "supports: {A: {holds: [ux, uz], ry: [{law: linear, stiffness: 2 kNm/rad}, "
                                        "{law: linear, stiffness: 7 kNm/rad}]}}"),
                               {"supports.A.ry.0.stiffness", "supports.A.ry.1.stiffness"}),
            "only 1/supports.A.ry.0.stiffness + 1/supports.A.ry.1.stiffness is determined");
}

TEST(Fit, RefusesWhatItCannotSetFree) {
  const Subject s = frame_of();
  EXPECT_NE(refusal(s, {}).find("--free materials.steel.E"), std::string::npos);
  EXPECT_NE(refusal(s, {"materials.steal.E"}).find("steel"), std::string::npos);
  EXPECT_NE(refusal(s, {"materials.steel"}).find("not a number"), std::string::npos);
  EXPECT_NE(refusal(s, {"materials.steel.E", "materials.*.E"}).find("moves the same number"), std::string::npos);
  EXPECT_NE(refusal(s, {"nodes.B.2"}).find("is 0"), std::string::npos) << refusal(s, {"nodes.B.2"});
  EXPECT_EQ(refusal(s, {"nodes.B.2"}, {"nodes.B.2=0 ± 1 mm"}), "");
  EXPECT_NE(refusal(s, {"materials.steel.E"}, {"materials.steel.E=210 mm ± 5 %"}).find("stress"), std::string::npos);
  EXPECT_NE(refusal(s, {"materials.steel.E"}, {"materials.steel.nu=0.3 ± 0.1"}).find("not among --free"),
            std::string::npos);
  EXPECT_NE(refusal(s, {"materials.steel.E"}, {"materials.steel.E=210 GPa"}).find("write PATH=mean"),
            std::string::npos);
  EXPECT_NE(refusal(s, {"materials.steel.E"}, {"materials.steel.E=210 GPa ± 0 GPa"}).find("above zero"),
            std::string::npos);
}

TEST(Fit, NumbersThatMayBeNegativeAreOnALinearScale) {
  const Subject s = frame_of(), truth = frame_of("", "B: [1 m, 0 m, 0 m]", "B: [1 m, 0 m, 2 mm]");
  const FitResult r = fitted(s, exact(truth), {"nodes.B.0"});
  EXPECT_FALSE(r.parameters[0].positive);
  EXPECT_NEAR(r.parameters[0].fitted, 1, 1e-3);  // a beam that rises by 2 mm is 2e-6 m longer and bends as before
}

/// A drive of 1000 Nm/rad beside a friction of 4 Nm, which starts so and sticks at so many Nm/rad.
Subject drive_of(double start, double stuck = 3000) {
  return parse_mechanism(
      fmt::format(
          "name: drive\nkinematics: {{family: chains}}\nleg: {{drive: {{joint: motor, rz: {{law: linear, stiffness: "
          "1000 Nm/rad}}, beside: {{rz: {{law: friction, moment: 4 Nm, stiffness: {} Nm/rad, start: {}}}}}}}}}\n",
          stuck, start),
      "drive.yaml");
}

/// What the drive reads in a loop to ±10 Nm, without noise.
Measurements exact_loop(const Subject& s) {
  std::string csv = "pose,q1_rad,fx_N,fy_N,fz_N,mz_Nmm,thz_rad,sigma_th_rad,sequence\n";
  for (int i = 1; i <= 40; ++i) {
    const int torque = std::abs((i + 30) % 40 - 20) - 10;  // Nm: 1 … 10 … −10 … 0
    csv += fmt::format("1,0,0,0,0,{},0,1e-5,{}\n", 1000 * torque, i);
  }
  Measurements out = measurement::parse_measurements(csv, "loop.csv");
  const std::vector<VectorX> d = s.stand(out)->predict(out);
  for (std::size_t i = 0; i < d.size(); ++i) out.readings[i].displacement[5] = d[i](5);
  return out;
}

FitResult fitted_start(const Subject& s, const Measurements& loop) {
  return fit::fit(s, loop, free_parameters(s, {"leg.drive.beside.rz.start"}, {}), as_recorded());
}

// A start lies between −1 and 1, a Poisson ratio below 0.5; a modulus is searched three decades to each side.
TEST(Fit, KnowsTheBoundsOfTheDescription) {
  const FreeParameter start = free_parameters(drive_of(-0.6), {"leg.drive.beside.rz.start"}, {})[0];
  EXPECT_FALSE(start.positive);
  EXPECT_NEAR(start.least, -1, 1e-7);
  EXPECT_NEAR(start.most, 1, 1e-7);
  EXPECT_NEAR(search_range(start), 2, 1e-6);
  const FreeParameter E = free_parameters(frame_of(), {"materials.steel.E"}, {})[0];
  EXPECT_NEAR(E.most / E.least, 1e6, 1);
  const FreeParameter nu = free_parameters(frame_of(), {"materials.steel.nu"}, {})[0];
  EXPECT_NEAR(nu.most, 0.5, 1e-6);
}

// Of a load M that came and went, friction that takes 3/4 of it keeps 3/4 M − 4 Nm. A search from −0.6 that may go
// beyond −1 meets what the description refuses.
TEST(Fit, StaysWithinTheBoundsOfTheDescription) {
  const FitResult r = fitted_start(drive_of(-0.6), exact_loop(drive_of(-0.9)));
  EXPECT_NEAR(r.parameters[0].fitted, -0.9, 0.1 * r.parameters[0].deviation);
  EXPECT_TRUE(r.converged);
}

// The loop begins as after −10 Nm, of which friction keeps 3.5 Nm. Where it sticks at 1800 Nm/rad it takes 0.64 of the
// load in place of 0.75 and keeps 2.4 Nm at most: the fit ends at the bound.
TEST(Fit, EndsAtABoundWhereTheDataAskForMore) {
  const FitResult r = fitted_start(drive_of(-0.8, 1800), exact_loop(drive_of(-1)));
  EXPECT_NEAR(r.parameters[0].fitted, -1, 1e-6);
  EXPECT_GE(r.parameters[0].low, -1 - 1e-9);
  EXPECT_TRUE(r.converged);
}

TEST(Fit, WritesADescriptionThatReadsBackWithTheValues) {
  const Subject s = frame_of(), truth = frame_of("", "210 GPa", "189 GPa");
  const std::vector<FreeParameter> all = free_parameters(s, {"materials.steel.E"}, {});
  const FitResult r = fit::fit(s, exact(truth), all, as_recorded());
  const Subject changed = with_values(s, all, fitted_values(r));
  const Subject read = frame::parse_frame(changed.file_text("new", ""), "new.yaml");
  EXPECT_NEAR(first_numbers(read, all)(0) / r.parameters[0].fitted, 1, 1e-14);
}

/// One reading of the tip under a factor.
Measurements plan_of(const Subject& s, double factor) {
  return s.placed(measurement::parse_measurements(fmt::format("load.tip,z_mm\n{},0\n{},0\n", factor, -factor),
                                                  "plan.csv", s.instruments()));
}

// Without a fit: 1 % of E and 0.5 % of the load make 1 % and 0.5 % of the deflection; σ is the sensor's.
TEST(Predict, AddsUpDeclaredTolerancesLoadAndNoise) {
  const Subject s = frame_of("tolerances: {modulus: 1 %, load: 0.5 %}");
  const PredictedPlan p = fit::predict(s, plan_of(s, 0.5));
  ASSERT_EQ(p.numbers.size(), 2u);
  const PredictedNumber& n = p.numbers[0];
  EXPECT_NEAR(n.value, -0.5 * tip, 1e-9 * tip);
  EXPECT_NEAR(n.deviation.tolerances, 0.01 * 0.5 * tip / 1.01, 1e-6 * tip);  // by the difference of one deviation
  EXPECT_NEAR(n.deviation.load, 0.005 * 0.5 * tip, 1e-9 * tip);
  EXPECT_EQ(n.deviation.parameters, 0);
  EXPECT_EQ(n.deviation.discrepancy, 0);
  EXPECT_EQ(n.deviation.noise, sigma);
  EXPECT_NEAR(n.high - n.low, 2 * 1.959964 * n.deviation.of_reading(), 1e-15);
}

// Of a quantity that was not read the share is that of what was.
TEST(Predict, WhatWasNotReadLacksAsMuch) {
  const Subject s = frame_of();
  for (const auto quantity : {measurement::Quantity::length, measurement::Quantity::force}) {
    PredictedPlanOptions o;
    o.discrepancies = {{quantity, 0.03}};
    const PredictedPlan p = fit::predict(s, plan_of(s, 1), {}, o);
    EXPECT_NEAR(p.numbers[0].deviation.discrepancy, 0.03 * tip, 1e-9 * tip);
    EXPECT_EQ(p.discrepancy_of_others.empty(), quantity == measurement::Quantity::length);
  }
}

// With the fitted modulus the deflection is as certain as that, σ/‖d‖ of itself, whatever was declared of the modulus.
TEST(Predict, HasWhatTheFitLeftUnknown) {
  const Subject s = frame_of("tolerances: {modulus: 1 %}"), truth = frame_of("", "210 GPa", "189 GPa");
  const FitResult r = fitted(s, exact(truth), {"materials.steel.E"});
  const std::string json = report::fit_json(r);
  const Subject after = with_values(s, free_parameters(s, {"materials.steel.E"}, {}), fitted_values(r));
  for (const Subject& each : {s, after}) {
    const PredictedPlan p = fit::predict(each, plan_of(each, 2), read_fit(json, "fit.json", each));
    EXPECT_NEAR(p.numbers[0].value, -2 * tip / 0.9, 2e-5 * tip);
    EXPECT_NEAR(p.numbers[0].deviation.parameters, 2 * sigma / std::sqrt(squares()), 1e-3 * sigma);
    EXPECT_NEAR(p.numbers[0].deviation.tolerances, 0, 1e-3 * sigma);
  }
  const Subject other = frame_of("", "210 GPa", "200 GPa");
  EXPECT_NE(outcome_of<InputError>([&] { return read_fit(json, "fit.json", other); }).why.find("neither"),
            std::string::npos);
  EXPECT_NE(outcome_of<InputError>([&] { return read_fit("{}", "fit.json", s); }).why.find("not a fit"),
            std::string::npos);
}

/// The readings with these indices alone.
Measurements part_of(const Measurements& all, const std::function<bool(const measurement::Reading&)>& wanted) {
  Measurements out = all;
  out.readings.clear();
  out.poses.clear();
  std::vector<std::size_t> poses;
  for (const measurement::Reading& r : all.readings) {
    if (!wanted(r)) continue;
    auto at = std::find(poses.begin(), poses.end(), r.pose);
    if (at == poses.end()) {
      poses.push_back(r.pose);
      out.poses.push_back(all.poses[r.pose]);
      out.poses.back().readings.clear();
      at = poses.end() - 1;
    }
    const auto pose = static_cast<std::size_t>(at - poses.begin());
    out.poses[pose].readings.push_back(out.readings.size());
    out.readings.push_back(r);
    out.readings.back().pose = pose;
  }
  return out;
}

/// Share of the numbers of the second part that lie in the intervals predicted from a fit to the first.
double covered(const Subject& s, const Measurements& first, const Measurements& second,
               const std::vector<std::string>& paths, double sigma_u) {
  const FitResult r = fit::fit(s, first, free_parameters(s, paths, {}), as_recorded(), parallel::alone);
  PredictedPlanOptions o;
  o.theories = {theories::all_theories().front()};
  o.sigma_u = sigma_u;
  const PredictedPlan p = fit::predict(s, second, read_fit(report::fit_json(r), "fit.json", s), o, parallel::alone);
  double inside = 0, all = 0;
  for (const PredictedNumber& n : p.numbers) {
    const measurement::Reading& read = second.readings[n.reading];
    const std::optional<double> y = n.channel < 6 ? read.displacement[n.channel] : read.sensors[n.channel - 6];
    if (!y) continue;
    all += 1;
    inside += n.low <= *y && *y <= n.high;
  }
  return inside / all;
}

std::uint64_t draws(std::uint64_t few) {
  const char* wanted = std::getenv("DEFLECT_COVERAGE");
  return wanted ? std::strtoull(wanted, nullptr, 10) : few;
}

/// Readings of one draw share its machine: at worst all of them hold or none, so the mean of n draws has a standard
/// deviation of √(0.95 · 0.05/n) at most. It lies within 3.3 of them but once in a thousand times.
void expect_coverage(const std::string& what, double sum, std::uint64_t n) {
  const double mean = sum / static_cast<double>(n), bound = 3.3 * std::sqrt(0.95 * 0.05 / static_cast<double>(n));
  ::testing::Test::RecordProperty(what, fmt::format("{:.4f}", mean));
  fmt::print("{}: {:.4f} of the readings in their 95 % intervals, {} draws\n", what, mean, n);
  EXPECT_NEAR(mean, 0.95, bound) << what;
}

// The truss within all its tolerances, one chord weaker by a known share: fitted under the first two load cases and
// their sum, predicted under the others.
TEST(Coverage, PredictionsOfAFrameHoldAsOftenAsTheySay) {
  const Subject s = frame::read_frame(test::source_dir() + "/validation/frames/truss-45.yaml");
  const Subject truth = s.edited({{"members.C1b.factor", "0.85", Edit::Action::multiply}});
  const std::uint64_t n = draws(60);
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= n; ++seed) {
    prediction::SimulationOptions o;
    o.seed = seed;
    const Measurements all =
        subject::simulate_frame(*truth.frame(), subject::frame_campaign("rich", *s.frame(), seed), o);
    const auto in_first = [&](const measurement::Reading& r) { return r.factors.back() == 0; };
    sum += covered(s, part_of(all, in_first), part_of(all, [&](const auto& r) { return !in_first(r); }),
                   {"members.C1b.factor"}, o.sigma_u);
  }
  expect_coverage("truss-45, load cases not fitted", sum, n);
}

// The arm within all its tolerances, two of its springs softer: fitted at twelve poses, predicted at eight others.
TEST(Coverage, PredictionsAtUnseenPosesHoldAsOftenAsTheySay) {
  const Mechanism m = test::device("arm");
  const Mechanism truth = edited_in_turn(m, {{"leg.joint_2.rz.stiffness", "0.8", Edit::Action::multiply},
                                             {"leg.joint_3.rz.stiffness", "1.1", Edit::Action::multiply}});
  const std::uint64_t n = draws(12);
  double sum = 0;
  for (std::uint64_t seed = 1; seed <= n; ++seed) {
    prediction::SimulationOptions o;
    o.seed = seed;
    const Measurements all = prediction::simulate(truth, prediction::campaign("random", m, 50, seed), o);
    sum += covered(m, part_of(all, [](const auto& r) { return r.pose < 12; }),
                   part_of(all, [](const auto& r) { return r.pose >= 12; }),
                   {"leg.joint_2.rz.stiffness", "leg.joint_3.rz.stiffness"}, o.sigma_u);
  }
  expect_coverage("arm, poses not fitted", sum, n);
}

}  // namespace
}  // namespace deflect
