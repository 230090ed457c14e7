// Parameters of effects that a user sets free: against hand calculations on a cantilever, and against the same number
// set free by its path.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/cantilever.h"
#include "validation/effects/effect_file.h"
#include "validation/fit/fit.h"
#include "validation/fit/predicted.h"
#include "validation/report/validity/fit_results.h"

namespace deflect {
namespace {

using namespace fit;
using measurement::Measurements;
using subject::Subject;
using test::cantilever::tip;

constexpr double sigma = 1e-6;
constexpr double factors[] = {1, -1, 0.5, -0.5, 1, -1, 0.5, -0.5, 0.25, -0.25, 0.75, -0.75};
const std::string beam = test::cantilever::file("sensors: {z: {node: B, direction: uz, sigma: 1 um}}\n");

Subject subject_of(const std::string& from = "", const std::string& to = "") {
  std::string text = beam;
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return frame::parse_frame(text, "frame.yaml");
}

Measurements placed_readings(const Subject& s, double factor) {
  return s.placed(measurement::parse_measurements(fmt::format("load.tip,z_mm\n{},0\n{},0\n", factor, -factor),
                                                  "plan.csv", s.instruments()));
}

/// What the subject reads, without noise.
Measurements without_noise(const Subject& s) {
  std::string csv = "load.tip,z_mm\n";
  for (const double f : factors) csv += fmt::format("{},0\n", f);
  Measurements out = s.placed(measurement::parse_measurements(csv, "data.csv", s.instruments()));
  const std::vector<VectorX> d = s.stand(out)->predict(out);
  for (std::size_t i = 0; i < d.size(); ++i) out.readings[i].sensors[0] = d[i](6);
  return out;
}

constexpr const char* pages = "pages: {machine: a, data: b, bench: c, cure: d}\n";

effects::Effect softer() {
  return effects::parse_effect(
      fmt::format(
          "name: softer\ntitle: Softer\nscope: machine\nparameters: {{factor: {{start: 0.5, low: 0.01, high: 10, "
          "scale: log, vanishes: 1, about: times E}}}}\nedits:\n  - {{at: materials.steel.E, multiply: $factor}}\n"
          "{}",
          pages),
      "softer.yaml");
}

/// The clamp yields about y.
effects::Effect yielding() {
  return effects::parse_effect(
      fmt::format(
          "name: yielding\ntitle: Yields\nscope: machine\nparameters: {{stiffness_Nmm_per_rad: {{start: 1e6, low: "
          "1e4, high: 1e10, scale: log, vanishes: infinity, about: of the clamp}}}}\nedits:\n  - {{at: supports.A, "
          "set: {{holds: [ux, uz], ry: [{{law: linear, stiffness: $stiffness_Nmm_per_rad}}]}}}}\n{}",
          pages),
      "yielding.yaml");
}

/// The same with edits that a function computes.
effects::Effect computed_yielding() {
  effects::Effect e = yielding();
  const std::vector<effects::EffectEdit> edits = e.edits;
  e.edits_at = [edits](const VectorX& values) {
    std::vector<effects::EffectEdit> out = edits;
    const std::string name = "$stiffness_Nmm_per_rad";
    std::string& text = out.front().value;
    text.replace(text.find(name), name.size(), fmt::format("{} Nmm/rad", values(0)));
    return out;
  };
  return e;
}

constexpr double clamp = 2e4;  // Nm/rad
Subject with_clamp() {
  return subject_of("A: clamped", "A: {holds: [ux, uz], ry: [{law: linear, stiffness: 2e4 Nm/rad}]}");
}

compare::ComparisonOptions recorded() {
  compare::ComparisonOptions o;
  o.as_recorded = true;
  return o;
}

std::map<std::string, FreedEffect> freed(const effects::Effect& e, std::optional<int> leg = {}) {
  const FreedEffect each{std::make_shared<const effects::Effect>(e), leg};
  return {{each.name(), each}};
}

FitResult fit_of(const Subject& s, const Measurements& data, const effects::Effect& e,
                 const std::vector<std::string>& priors = {}) {
  return fit::fit(s, data, free_parameters(s, {e.name}, priors, beam, freed(e)), recorded());
}

double sum_of_squares() {
  double out = 0;
  for (const double f : factors) out += f * f;
  return out;
}

// A factor on E as the effect's parameter is E itself as a path: the same value, certainty and misfit.
TEST(FitEffects, AFactorOnANumberIsTheNumber) {
  const Subject s = subject_of();
  const Measurements data = without_noise(subject_of("210 GPa", "189 GPa"));
  const FitResult path = fit::fit(s, data, free_parameters(s, {"materials.steel.E"}, {}, beam), recorded());
  const FitResult effect = fit_of(s, data, softer());
  ASSERT_EQ(effect.parameters.size(), 1u);
  const FittedParameter &p = path.parameters[0], &e = effect.parameters[0];
  EXPECT_EQ(e.path, "softer.factor");
  EXPECT_TRUE(e.positive);
  EXPECT_NEAR(e.fitted, 0.9, 1e-2 * p.deviation);
  EXPECT_NEAR(e.fitted * 210e9 / p.fitted, 1, 1e-2 * p.deviation);
  EXPECT_NEAR(e.deviation, p.deviation, 1e-4 * p.deviation);
  EXPECT_NEAR(effect.chi2_before, path.chi2_before, 1e-9 * path.chi2_before);
  EXPECT_TRUE(effect.converged);
  EXPECT_LT(effect.after.rmse, 1e-3 * sigma);
}

// A clamp that yields adds P L²/k to the tip: in ln k a reading has the derivative P L²/k, so the deviation is
// σ k / (P L² ‖f‖) with P = 10 N, L = 1 m. Computed edits say the same as those of a file.
TEST(FitEffects, FindsASpringAsCertainAsTheReadingsMakeIt) {
  const Measurements data = without_noise(with_clamp());
  const double deviation = sigma * clamp / (10 * std::sqrt(sum_of_squares()));
  for (const effects::Effect& e : {yielding(), computed_yielding()}) {
    const FitResult r = fit_of(subject_of(), data, e);
    const FittedParameter& k = r.parameters.at(0);
    EXPECT_EQ(k.path, "yielding.stiffness_Nmm_per_rad");
    EXPECT_EQ(k.unit, "Nmm/rad");
    EXPECT_EQ(k.value, 1e6);  // where the search begins
    EXPECT_NEAR(k.fitted, 1e3 * clamp, 1e-2 * deviation * 1e3 * clamp);
    EXPECT_NEAR(k.deviation, deviation, 1e-4 * deviation);
    EXPECT_NEAR(k.low, 1e3 * clamp * std::exp(-1.959964 * deviation), 1e-2 * deviation * 1e3 * clamp);
    EXPECT_LT(r.after.rmse, 1e-3 * sigma);
    EXPECT_NEAR(r.before.rmse, 10 / clamp * std::sqrt(sum_of_squares() / 12), 1e-3 * tip);
    EXPECT_FALSE(k.beyond_tolerance);
  }
}

// A prior is one more reading of ln k, in the unit of the parameter, which may be left out.
TEST(FitEffects, WeighsAPrior) {
  const Measurements data = without_noise(with_clamp());
  const double deviation = fit_of(subject_of(), data, yielding()).parameters[0].deviation;
  for (const char* unit : {"", " Nmm/rad"}) {
    const std::string prior = fmt::format("yielding.stiffness_Nmm_per_rad={}{} ± {} %", 2e7, unit, 100 * deviation);
    const FitResult r = fit_of(subject_of(), data, yielding(), {prior});
    EXPECT_NEAR(r.parameters[0].deviation, deviation / std::sqrt(2), 1e-3 * deviation);
    EXPECT_NEAR(*r.parameters[0].pull, 0, 1e-2);
  }
}

// The fitted subject is the truth, and a prediction has what the fit left unknown: the spring's part of the deflection
// is as certain as ln k.
TEST(FitEffects, PredictsWithThem) {
  const Subject s = subject_of();
  const effects::Effect e = computed_yielding();
  const std::vector<FreeParameter> free = free_parameters(s, {e.name}, {}, beam, freed(e));
  const FitResult r = fit::fit(s, without_noise(with_clamp()), free, recorded());
  const Subject fitted = with_values(s, free, fitted_values(r));
  const Measurements plan = placed_readings(s, 2);
  EXPECT_NEAR(fitted.stand(plan)->predict(plan)[0](6), -2 * (tip + 10 / clamp), 1e-3 * sigma);
  EXPECT_EQ(with_numbers(s, free, fitted_values(r)).file_text("a", ""), s.file_text("a", ""));

  const std::string json = report::fit_json(r);
  const PredictedPlan p = fit::predict(s, plan, read_fit(json, "fit.json", s, {e}));
  EXPECT_NEAR(p.numbers[0].value, -2 * (tip + 10 / clamp), 1e-2 * sigma);
  EXPECT_NEAR(p.numbers[0].deviation.parameters, 2 * sigma / std::sqrt(sum_of_squares()), 1e-3 * sigma);
  EXPECT_NE(outcome_of<InputError>([&] { return read_fit(json, "fit.json", s); }).why.find("which lacks the effect"),
            std::string::npos);
  EXPECT_NE(outcome_of<InputError>([&] { return read_fit(json, "fit.json", s, {softer()}); }).why.find("yielding"),
            std::string::npos);
}

TEST(FitEffects, BesideANumber) {
  const Subject s =
      subject_of("loads: {tip: {nodes: {B: {fz: -10 N}}}",
                 "loads: {tip: {nodes: {B: {fz: -10 N}}}, turn: {nodes: {A: {my: 0 Nm}, B: {my: 10 Nm}}}");
  std::string csv = "load.tip,load.turn,z_mm\n";
  for (const double f : factors) csv += fmt::format("{},{},0\n", f, f * f);
  Measurements data = s.placed(measurement::parse_measurements(csv, "data.csv", s.instruments()));
  const Subject truth =
      s.edited({{"materials.steel.E", "189 GPa", Edit::Action::set},
                {"supports.A", "{holds: [ux, uz], ry: [{law: linear, stiffness: 2e4 Nm/rad}]}", Edit::Action::set}});
  const std::vector<VectorX> d = truth.stand(data)->predict(data);
  for (std::size_t i = 0; i < d.size(); ++i) data.readings[i].sensors[0] = d[i](6);
  // The effect is named first; numbers come first all the same.
  const FitResult r =
      fit::fit(s, data, free_parameters(s, {"yielding", "materials.steel.E"}, {}, beam, freed(yielding())), recorded());
  ASSERT_EQ(r.parameters.size(), 2u);
  EXPECT_EQ(r.parameters[0].path, "materials.steel.E");
  EXPECT_NEAR(r.parameters[0].fitted, 189e9, 0.05 * r.parameters[0].deviation * 189e9);
  EXPECT_NEAR(r.parameters[1].fitted, 1e3 * clamp, 0.05 * r.parameters[1].deviation * 1e3 * clamp);
}

// The numbers of a machine with one leg have two names each.
TEST(FitEffects, AToleranceOfTheOneLegGivesWayUnderBothNames) {
  const Mechanism m = parse_mechanism(
      "name: lever\nkinematics: {family: chains}\nleg:\n  pivot: {joint: motor, rz: {law: linear, stiffness: 2 "
      "kNm/rad}}\n"
      "  lever: {offset: [300 mm, 0 mm, 0 mm]}\ntolerances: {leg.pivot.rz.stiffness: 5 %}\n",
      "lever.yaml");
  std::string csv = "pose,q1_rad,fx_N,fy_N,fz_N,uy_mm,sigma_u_mm\n";
  for (const double q : {0.0, 0.3, 0.6, 0.9})
    for (const double F : {30.0, -30.0, 15.0})  // uy = F (L cos q)²/k
      csv += fmt::format("p{0},{0},0,{1},0,{2},0.01\n", q, F, 0.045 * F * std::cos(q) * std::cos(q));
  const measurement::Measurements data = measurement::parse_measurements(csv, "data.csv");
  const subject::Subject s(m);
  const auto of = [&](const std::string& path) {
    return fit::fit(s, data, fit::free_parameters(s, {path}, {}), {}, parallel::alone).parameters.front();
  };
  const fit::FittedParameter one = of("leg[1].pivot.rz.stiffness"), all = of("leg.pivot.rz.stiffness");
  EXPECT_NEAR(all.deviation, one.deviation, 1e-6 * one.deviation);
  EXPECT_LT(all.deviation, 0.01);  // of 5 % otherwise
  EXPECT_TRUE(all.beyond_tolerance.has_value());
}

TEST(FitEffects, RefusesWhatItCannotSetFree) {
  const Subject s = subject_of();
  const auto why = [&](const effects::Effect& e, std::optional<int> leg, const std::vector<std::string>& priors = {}) {
    const auto known = freed(e, leg);
    return outcome_of<InputError>([&] { return free_parameters(s, {known.begin()->first}, priors, beam, known); }).why;
  };
  EXPECT_NE(why(yielding(), 2).find("not of one leg"), std::string::npos) << why(yielding(), 2);
  effects::Effect elsewhere = softer();
  elsewhere.edits.front().paths = {"materials.brass.E"};
  EXPECT_NE(why(elsewhere, {}).find("brass"), std::string::npos) << why(elsewhere, {});
  effects::Effect fixed = softer();
  fixed.parameters.clear();
  EXPECT_NE(why(fixed, {}).find("no parameter"), std::string::npos);
  EXPECT_NE(outcome_of<InputError>([&] {
              return free_parameters(s, {"yielding", "yielding"}, {}, beam, freed(yielding()));
            }).why.find("twice"),
            std::string::npos);
  EXPECT_NE(why(yielding(), {}, {"yielding.stiffness_Nmm_per_rad=1 mm ± 2 %"}).find("1 mm"), std::string::npos);
  EXPECT_NE(why(yielding(), {}, {"yielding.stiffness=1e6 ± 2 %"}).find("stiffness_Nmm_per_rad"), std::string::npos);
}

TEST(FitEffects, TolerancesThatAnEffectBringsAreTold) {
  using subject::Tolerance;
  const std::vector<Tolerance> before = {{"modulus", 0.01}, {"support A ry stiffness", 0.1}};
  EXPECT_EQ(added_tolerances(before, before), std::vector<std::size_t>());
  const std::vector<Tolerance> after = {
      {"modulus", 0.01}, {"support A ry stiffness", 0.1}, {"support A ry stiffness", 0.1}, {"support B uz", 0.1}};
  EXPECT_EQ(added_tolerances(before, after), (std::vector<std::size_t>{2, 3}));
}

}  // namespace
}  // namespace deflect
