#include "tests/benchmark/plans/loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "tests/support/paths.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/place_effects.h"
#include "validation/measurement/joined.h"
#include "validation/plan/next_readings.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/subject/simulate_frame.h"

namespace deflect::benchmark {
namespace {

using measurement::Measurements;

constexpr double lambda = 8, force = 50, sigma = 2e-6;
constexpr std::size_t most_random = 1120;  // readings: four campaigns

subject::Subject subject_of(const std::string& name) {
  const std::string folder = test::source_dir() + "/validation/";
  const std::string device = folder + "devices/" + name + ".yaml";
  if (std::filesystem::exists(device)) return read_mechanism(device);
  return frame::read_frame(folder + "frames/" + name + ".yaml");
}

Measurements campaign_of(const subject::Subject& s, const char* name, std::uint64_t seed) {
  if (s.frame()) return subject::frame_campaign(name, *s.frame(), seed);
  return prediction::campaign(name, *s.machine(), force, seed);
}

/// The machine of that number, read with noise of its own.
Measurements read(const subject::Subject& s, const Measurements& plan, std::uint64_t machine, std::uint64_t seed) {
  prediction::SimulationOptions o;
  o.seed = seed;
  o.machine = machine;
  o.sigma_u = sigma;
  if (s.frame()) return subject::simulate_frame(*s.frame(), plan, o);
  o.division = frame::equal_division(configure(*s.machine(), home_pose(*s.machine())), 2);
  return prediction::simulate(*s.machine(), plan, o, parallel::alone);
}

/// Values at which the effect is `times` as large as at its start.
VectorX values_at(const effects::Effect& e, double times) {
  VectorX out = effects::start_values(e);
  for (std::size_t i = 0; i < e.parameters.size(); ++i) {
    const effects::EffectParameter& p = e.parameters[i];
    double& value = out(as_index(i));
    if (p.vanishes) value = std::isinf(*p.vanishes) ? p.start / times : *p.vanishes + times * (p.start - *p.vanishes);
    value = std::clamp(value, p.low, p.high);
  }
  return out;
}

/// As large as λ on those readings.
VectorX sized(const diagnosis::Observations& o, const effects::PlacedEffect& e) {
  double x = 0;
  for (int tries = 0; tries < 30; ++tries) {
    const subject::Subject with = effects::with_effect(o.subject(), {e, values_at(*e.effect, std::exp(x))});
    const double here = (o.whitened_residual(with) - o.null_residual()).norm();
    if (std::abs(here / lambda - 1) < 0.02) break;
    x += std::clamp(std::log(lambda / std::max(here, 1e-9)), -2.0, 2.0) * 0.8;
  }
  return values_at(*e.effect, std::exp(x));
}

class Loop {
 public:
  Loop(const Tied& t, std::uint64_t seed, int threads)
      : subject_(subject_of(t.subject)), seed_(seed), threads_(threads) {
    effects_ = effects::catalogue(test::source_dir() + "/validation/effects/catalogue");
    for (effects::Effect& e : effects::place_effects(subject_, effects_)) effects_.push_back(std::move(e));
    for (const std::string& name : {t.first, t.second}) pair_.push_back({&effects::find_effect(effects_, name), {}});
  }

  LoopResult run(std::size_t index) const {
    LoopResult out;
    const effects::PlacedEffect& truth = pair_[index % 2];
    out.truth = truth.effect->name;
    const std::uint64_t machine = seed_ + 1000 * index;
    const Measurements paper = campaign_of(subject_, "paper", machine);
    compare::ComparisonOptions recorded;
    recorded.as_recorded = true;
    const diagnosis::Observations healthy(subject_, sequenced(read(subject_, paper, machine, machine + 1)), recorded,
                                          parallel::alone);
    const subject::Subject built = effects::with_effect(subject_, {truth, sized(healthy, truth)});
    const Measurements before = sequenced(read(built, paper, machine, machine + 2));
    std::vector<plan::Rival> rivals = fitted(before, out.before, index % 2);
    if (rivals.size() < 2) {
      out.skipped = "one of the two cannot be fitted";
      return out;
    }
    plan::PlanOptions o;
    o.seed = machine;
    const auto begun = std::chrono::steady_clock::now();
    const plan::Plan plan = plan::next_readings(subject_, before, rivals, o, {threads_});
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    if (plan.readings.readings.empty()) {
      out.skipped = "no reading tells them apart";
      return out;
    }
    out.planned = plan.readings.readings.size();
    const Measurements after = read(built, subject_.placed(plan.readings), machine, machine + 3);
    const Measurements all = subject_.placed(measurement::joined({before, after}));
    plan::PlanOptions as_fitted = o;
    as_fitted.draws = 1;
    out.predicted = plan::expected_of(subject_, before, after, rivals, as_fitted, {threads_}).pairs.front().separation;
    fitted(all, out.found, index % 2);
    out.right = out.found > 0;
    out.found -= out.before;
    std::tie(out.at_random, out.at_random_is_more) = at_random(built, before, rivals, o, plan.probability, machine);
    return out;
  }

 private:
  /// Both effects fitted, with their probabilities; `apart`: χ² of the wrong one − χ² of the true one.
  std::vector<plan::Rival> fitted(const Measurements& data, double& apart, std::size_t true_one) const {
    compare::ComparisonOptions recorded;
    recorded.as_recorded = true;
    const diagnosis::Observations o(subject_, data, recorded, {threads_});
    std::vector<plan::Rival> out;
    std::vector<double> chi2;
    for (const effects::PlacedEffect& e : pair_) {
      const diagnosis::Fit fit = diagnosis::fit(o, {e}, {}, {}, threads_);
      if (!fit.found) return {};
      out.push_back({{e}, fit.values, 0});
      chi2.push_back(fit.chi2);
    }
    apart = chi2[1 - true_one] - chi2[true_one];
    const double least = std::min(chi2[0], chi2[1]);
    const double sum = std::exp((least - chi2[0]) / 2) + std::exp((least - chi2[1]) / 2);
    for (std::size_t i = 0; i < 2; ++i) out[i].probability = std::exp((least - chi2[i]) / 2) / sum;
    return out;
  }

  /// The fewest readings of the campaign "random" after those before that promise as much; whether even all do not.
  std::pair<std::size_t, bool> at_random(const subject::Subject& built, const Measurements& before,
                                         const std::vector<plan::Rival>& rivals, const plan::PlanOptions& o,
                                         double probability, std::uint64_t machine) const {
    std::vector<Measurements> campaigns;
    std::size_t all = 0;
    for (std::uint64_t k = 0; all < most_random; ++k) {
      campaigns.push_back(
          sequenced(read(built, campaign_of(subject_, "random", machine + k), machine, machine + 10 + k)));
      all += campaigns.back().readings.size();
    }
    const Measurements many = measurement::joined(campaigns);
    const auto enough = [&](std::size_t n) {
      const auto expected =
          outcome_of([&] { return plan::expected_of(subject_, before, first_of(many, n), rivals, o, {threads_}); });
      return expected && expected->probability >= probability;
    };
    std::size_t low = 0, high = 8;
    while (high < most_random && !enough(high)) low = high, high *= 2;
    if (high >= most_random) {
      high = most_random;
      if (!enough(high)) return {high, true};
    }
    while (high > low + 1 && static_cast<double>(high) > 1.15 * static_cast<double>(low)) {
      const std::size_t middle = (low + high) / 2;
      (enough(middle) ? high : low) = middle;
    }
    return {high, false};
  }

  static Measurements first_of(Measurements m, std::size_t n) {
    m.readings.resize(std::min(n, m.readings.size()));
    std::erase_if(m.poses, [&](measurement::PoseGroup& p) {
      std::erase_if(p.readings, [&](std::size_t i) { return i >= m.readings.size(); });
      return p.readings.empty();
    });
    return m;
  }

  static Measurements sequenced(Measurements m) {
    for (std::size_t i = 0; i < m.readings.size(); ++i) m.readings[i].sequence = static_cast<double>(i + 1);
    return m;
  }

  subject::Subject subject_;
  std::vector<effects::Effect> effects_;
  std::vector<effects::PlacedEffect> pair_;
  std::uint64_t seed_;
  int threads_;
};

template <class Of>
double median(const std::vector<LoopResult>& all, const Of& of) {
  std::vector<double> values;
  for (const LoopResult& r : all)
    if (r.skipped.empty()) values.push_back(static_cast<double>(of(r)));
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return (values[(n - 1) / 2] + values[n / 2]) / 2;
}

}  // namespace

std::vector<LoopResult> run_loops(const Tied& t, std::size_t truths, std::uint64_t seed, int threads) {
  const Loop loop(t, seed, threads);
  std::vector<LoopResult> out;
  for (std::size_t i = 0; i < truths; ++i) {
    auto result = outcome_of([&] { return loop.run(i); });
    if (!result) {
      LoopResult failed;
      failed.skipped = result.why;
      result.value = failed;
    }
    const LoopResult& r = *result;
    fmt::print(stderr,
               "{} {}: truth {} before {:.1f} planned {} random {}{} predicted {:.1f} found {:.1f} ({:.1f} s) {}\n",
               t.subject, i, r.truth, r.before, r.planned, r.at_random_is_more ? ">" : "", r.at_random, r.predicted,
               r.found, r.seconds, r.skipped);
    out.push_back(r);
  }
  return out;
}

std::string loop_table(const std::vector<std::pair<Tied, std::vector<LoopResult>>>& all) {
  std::string out =
      "| subject | tied | truths | readings planned, median | of `random` for as much, median | told rightly | "
      "predicted "
      "λ², median | found, median | slope |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [tied, results] : all) {
    std::size_t n = 0, right = 0;
    double xy = 0, xx = 0;
    bool more = false;
    const double random = median(results, [](const LoopResult& r) { return r.at_random; });
    for (const LoopResult& r : results) {
      if (!r.skipped.empty()) continue;
      ++n;
      if (r.right) ++right;
      xy += r.predicted * r.found, xx += r.predicted * r.predicted;
      more = more || (r.at_random_is_more && static_cast<double>(r.at_random) <= random);
    }
    out += fmt::format("| {} | {} / {} | {} of {} | {:g} | {}{:g} | {} | {:.1f} | {:.1f} | {:.2f} |\n", tied.subject,
                       tied.first, tied.second, n, results.size(),
                       median(results, [](const LoopResult& r) { return r.planned; }), more ? "> " : "", random, right,
                       median(results, [](const LoopResult& r) { return r.predicted; }),
                       median(results, [](const LoopResult& r) { return r.found; }), xy / xx);
  }
  return out;
}

}  // namespace deflect::benchmark
