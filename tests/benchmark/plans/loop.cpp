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
#include "validation/diagnosis/fit_problem.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/place_effects.h"
#include "validation/measurement/joined.h"
#include "validation/measurement/random.h"
#include "validation/plan/next_readings.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/subject/simulate_frame.h"

namespace deflect::benchmark {
namespace {

using measurement::Measurements;

constexpr double force = 50, sigma = 2e-6;
constexpr double decided = 0.95;          // probability of either rival
constexpr double within = 1.25;           // of λ
constexpr std::size_t most_planned = 80;  // readings
constexpr int most_campaigns = 4;         // "random" of 280 readings each on a machine

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

/// Values of an effect as a plan takes them to be before any reading: even over the coordinates of its parameters
/// (fit_problem.h). The first that are so large on some readings that with noise they can look as large as λ. Throws
/// NumericalError where none are.
VectorX drawn_values(const diagnosis::Observations& o, const effects::PlacedEffect& e, double lambda,
                     measurement::Random& random) {
  constexpr double noise = 3.5;  // standard deviations: λ of the data is further from that of the truth in 1 of 2000
  constexpr int tries = 5000;
  for (int k = 0; k < tries; ++k) {
    VectorX values(std::ssize(e.effect->parameters));
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      const effects::EffectParameter& p = nth(e.effect->parameters, i);
      values(i) =
          diagnosis::value_at(p, random.uniform(diagnosis::coordinate(p, p.low), diagnosis::coordinate(p, p.high)));
    }
    const auto there = outcome_of([&] { return o.whitened_residual(effects::with_effect(o.subject(), {e, values})); });
    if (!there) continue;
    const double size = (*there - o.null_residual()).norm();
    if (size < lambda * within + noise && size > lambda / within - noise) return values;
  }
  throw NumericalError(fmt::format("'{}' does not become as large as λ = {}", e.effect->name, lambda));
}

class Loop {
 public:
  Loop(const Tied& t, std::uint64_t seed, int threads)
      : subject_(subject_of(t.subject)), tied_(t), seed_(seed), threads_(threads) {
    effects_ = effects::catalogue(test::source_dir() + "/validation/effects/catalogue");
    for (effects::Effect& e : effects::place_effects(subject_, effects_)) effects_.push_back(std::move(e));
    for (const std::string& name : {t.first, t.second}) pair_.push_back({&effects::find_effect(effects_, name), {}});
  }

  LoopResult run(std::size_t index) const {
    LoopResult out;
    const effects::PlacedEffect& truth = pair_[index % 2];
    out.truth = truth.effect->name;
    const Begun begun = begun_with(truth, seed_ + 1000 * index, index % 2);
    const auto& [machine, paper, built, before, fits] = begun;
    const std::vector<plan::Rival>& rivals = fits.rivals;
    out.before = fits.apart;
    out.tied = std::max(rivals[0].probability, rivals[1].probability) < decided;
    if (!out.tied) return out;
    plan::PlanOptions o;
    o.seed = machine;
    if (tied_.moment > 0) o.limits.moment = tied_.moment;
    if (tied_.nodes) o.limits.nodes = {"all"};
    o.readings = most_planned;
    const auto start = std::chrono::steady_clock::now();
    const plan::Plan plan = plan::next_readings(subject_, before, rivals, o, {threads_});
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (plan.readings.readings.empty()) {
      out.skipped = "no reading tells them apart";
      return out;
    }
    out.planned = plan.readings.readings.size();
    if (!plan.at_random_is_more) out.by_lot = plan.at_random;
    const Measurements after = read_after(paper, plan.readings, built, machine);
    const Measurements all = subject_.placed(measurement::joined({before, after}));
    const plan::Pair expected = plan::expected_of(subject_, before, after, rivals, o, {threads_}).pairs.front();
    out.predicted = index % 2 == 0 ? expected.if_a : expected.if_b;
    const double apart = fitted(all, index % 2).apart;
    out.right = apart > 0;
    out.found = apart - out.before;
    std::tie(out.at_random, out.at_random_is_more) = at_random(before, rivals, o, plan.probability, machine);
    return out;
  }

 private:
  /// Both effects fitted to readings, with their probabilities; no rivals where one of them cannot be.
  struct Fitted {
    std::vector<plan::Rival> rivals;
    double apart = 0;   ///< χ² of the wrong one − χ² of the true one
    double lambda = 0;  ///< of the better one: √(χ² of neither − χ² of it)
  };

  /// A machine with one of the two, and what the paper's plan says of it.
  struct Begun {
    std::uint64_t machine = 0;
    Measurements paper;
    subject::Subject built;
    Measurements before;
    Fitted fits;
  };

  /// The first machine whose readings show λ, within a quarter. Throws NumericalError where none of 200 does.
  Begun begun_with(const effects::PlacedEffect& truth, std::uint64_t seed, std::size_t true_one) const {
    constexpr std::uint64_t most = 200;
    measurement::Random random(seed);
    const Measurements paper = sequenced(campaign_of(subject_, "paper", seed));
    const Measurements as_drawn = read(subject_, paper, seed, seed + 1);
    const diagnosis::Observations healthy(subject_, as_drawn, as_recorded(), parallel::alone);
    for (std::uint64_t k = 0; k < most; ++k) {
      const std::uint64_t machine = seed + 5 * k;
      Begun out{machine,
                paper,
                effects::with_effect(subject_, {truth, drawn_values(healthy, truth, tied_.lambda, random)}),
                {},
                {}};
      auto readings = outcome_of([&] { return read(out.built, paper, machine, machine + 2); });
      if (!readings) continue;  // the MSA finds no equilibrium
      out.before = std::move(*readings.value);
      out.fits = fitted(out.before, true_one);
      const double shown = out.fits.lambda / tied_.lambda;
      if (out.fits.rivals.size() == 2 && shown < within && shown > 1 / within) return out;
    }
    throw NumericalError(fmt::format("no machine with '{}' shows λ = {}", truth.effect->name, tied_.lambda));
  }

  static compare::ComparisonOptions as_recorded() {
    compare::ComparisonOptions out;
    out.as_recorded = true;
    return out;
  }

  Fitted fitted(const Measurements& data, std::size_t true_one) const {
    const diagnosis::Observations o(subject_, data, as_recorded(), {threads_});
    Fitted out;
    std::vector<double> chi2;
    for (const effects::PlacedEffect& e : pair_) {
      const diagnosis::Fit fit = diagnosis::fit(o, {e}, {}, {}, threads_);
      if (!fit.found) return {};
      out.rivals.push_back({{e}, fit.values, 0});
      chi2.push_back(fit.chi2);
    }
    out.apart = chi2[1 - true_one] - chi2[true_one];
    const double least = std::min(chi2[0], chi2[1]);
    out.lambda = std::sqrt(std::max(0.0, o.null_residual().squaredNorm() - least));
    const double sum = std::exp((least - chi2[0]) / 2) + std::exp((least - chi2[1]) / 2);
    for (std::size_t i = 0; i < 2; ++i) out.rivals[i].probability = std::exp((least - chi2[i]) / 2) / sum;
    return out;
  }

  /// The fewest readings of the campaign "random", in its order, after those before that promise as much; whether even
  /// all do not. More readings promise more, but for draws.
  std::pair<std::size_t, bool> at_random(const Measurements& before, const std::vector<plan::Rival>& rivals,
                                         const plan::PlanOptions& o, double probability, std::uint64_t machine) const {
    Measurements all;
    const auto promise = [&](std::size_t readings) {
      return plan::expected_of(subject_, before, first_of(all, readings), rivals, o, {threads_}).probability;
    };
    for (const int campaigns : {1, most_campaigns}) {
      std::vector<Measurements> random;
      for (int k = 0; k < campaigns; ++k)
        random.push_back(
            sequenced(as_if_read(campaign_of(subject_, "random", machine + static_cast<std::uint64_t>(k)), before)));
      all = measurement::joined(random);
      std::size_t too_few = 0, enough = all.readings.size();
      if (promise(enough) < probability) continue;
      while (enough - too_few > 1) {
        const std::size_t half = (too_few + enough) / 2;
        (promise(half) < probability ? too_few : enough) = half;
      }
      return {enough, false};
    }
    return {all.readings.size(), true};
  }

  static Measurements first_of(Measurements m, std::size_t readings) {
    m.readings.resize(readings);
    for (measurement::PoseGroup& p : m.poses) std::erase_if(p.readings, [&](std::size_t i) { return i >= readings; });
    while (m.poses.back().readings.empty()) m.poses.pop_back();  // a campaign goes from pose to pose
    return m;
  }

  /// With a number in each cell that the data have, which a plan does not look at.
  static Measurements as_if_read(Measurements m, const Measurements& data) {
    const measurement::Reading& like = data.readings.front();
    m.instruments.sensors = data.instruments.sensors;
    for (measurement::Reading& r : m.readings) {
      r.displacement = like.displacement;
      r.sensors = like.sensors;
      r.sigma_u = like.sigma_u;
      r.sigma_th = like.sigma_th;
    }
    return m;
  }

  /// Planned readings of the machine that went through the campaign before them: friction still holds what it held.
  Measurements read_after(const Measurements& before, const Measurements& plan, const subject::Subject& built,
                          std::uint64_t machine) const {
    plan::Possible both;
    both.taken = before.readings.size();
    both.all = read(built, subject_.placed(measurement::joined({before, plan})), machine, machine + 3);
    both.blocks = {{both.taken, plan.readings.size(), before.poses.size()}};
    return plan::without_data(std::move(both)).all;
  }

  static Measurements sequenced(Measurements m) {
    for (std::size_t i = 0; i < m.readings.size(); ++i) m.readings[i].sequence = static_cast<double>(i + 1);
    return m;
  }

  subject::Subject subject_;
  Tied tied_;
  std::vector<effects::Effect> effects_;
  std::vector<effects::PlacedEffect> pair_;
  std::uint64_t seed_;
  int threads_;
};

template <class Of>
double median(const std::vector<LoopResult>& all, const Of& of) {
  std::vector<double> values;
  for (const LoopResult& r : all)
    if (r.skipped.empty() && r.tied) values.push_back(static_cast<double>(of(r)));
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
    fmt::print(stderr, "{} {}/{} {}: truth {} before {:.1f} ", t.subject, t.first, t.second, i, r.truth, r.before);
    if (r.skipped.empty() && r.tied)
      fmt::print(stderr, "planned {} random {}{} by lot {} predicted {:.1f} found {:.1f} ({:.1f} s)\n", r.planned,
                 r.at_random_is_more ? ">" : "", r.at_random, r.by_lot, r.predicted, r.found, r.seconds);
    else
      fmt::print(stderr, "{}\n", r.skipped.empty() ? "no tie" : r.skipped);
    out.push_back(r);
  }
  return out;
}

std::string loop_table(const std::vector<std::pair<Tied, std::vector<LoopResult>>>& all) {
  std::string out =
      "| subject | tied, λ | truths | of these tied | readings planned, median | of `random` for as much, median | by "
      "lot, median | told rightly | predicted λ², median | found, median | slope ± standard error "
      "|\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [tied, results] : all) {
    std::size_t n = 0, right = 0, tried = 0;
    double xy = 0, xx = 0, rest = 0;
    bool more = false;
    const double random = median(results, [](const LoopResult& r) { return r.at_random; });
    for (const LoopResult& r : results) {
      if (!r.skipped.empty()) continue;
      ++tried;
      if (!r.tied) continue;
      ++n;
      if (r.right) ++right;
      xy += r.predicted * r.found, xx += r.predicted * r.predicted;
      more = more || (r.at_random_is_more && static_cast<double>(r.at_random) <= random);
    }
    out +=
        fmt::format("| {} | {} / {}, {:g} | {} | {} |", tied.subject, tied.first, tied.second, tied.lambda, tried, n);
    if (n == 0) {
      out += " | | | | | | |\n";
      continue;
    }
    const double slope = xy / xx;
    for (const LoopResult& r : results)
      if (r.skipped.empty() && r.tied) rest += std::pow(r.found - slope * r.predicted, 2);
    const double error = n > 1 ? std::sqrt(rest / static_cast<double>(n - 1) / xx) : NAN;
    out += fmt::format(" {:g} | {}{:g} | {:g} | {} | {:.1f} | {:.1f} | {:.2f} ± {:.2f} |\n",
                       median(results, [](const LoopResult& r) { return r.planned; }), more ? "> " : "", random,
                       median(results, [](const LoopResult& r) { return r.by_lot; }), right,
                       median(results, [](const LoopResult& r) { return r.predicted; }),
                       median(results, [](const LoopResult& r) { return r.found; }), slope, error);
  }
  return out;
}

}  // namespace deflect::benchmark
