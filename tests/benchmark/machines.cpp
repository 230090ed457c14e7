#include "tests/benchmark/machines.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/fields/yaml_tree.h"
#include "msa/mechanism/device_file.h"
#include "tests/benchmark/hidden.h"
#include "tests/benchmark/oracle.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/place_effects.h"
#include "validation/parallel/cases.h"
#include "validation/prediction/campaign.h"

namespace deflect::benchmark {
namespace {

using namespace diagnosis;
using namespace effects;
using namespace measurement;
using namespace parallel;
using namespace prediction;
using namespace subject;

constexpr double separable = 9;  // difference of 2 ln L
constexpr const char* campaigns[] = {"rich", "random"};
const std::string data_folder = std::string(DEFLECT_SOURCE_DIR) + "/validation";

std::vector<std::string> built_in() {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder + "/devices"))
    if (entry.path().extension() == ".yaml") out.push_back(entry.path().stem().string());
  std::sort(out.begin(), out.end());
  return out;
}

/// A fiftieth of the rms translation of the drawn machine.
double sigma_for(const Mechanism& m) {
  const Measurements plan = campaign("random", m, force, 1);
  const Subject subject = m;
  double square = 0;
  for (const VectorX& d : subject.stand(plan)->predict(plan, {}, alone)) square += d.head<3>().squaredNorm() / 3;
  return std::sqrt(square / static_cast<double>(plan.readings.size())) / 50;
}

bool among(const std::vector<std::string>& list, const std::vector<std::string>& of) {
  return std::any_of(list.begin(), list.end(),
                     [&](const std::string& name) { return std::find(of.begin(), of.end(), name) != of.end(); });
}

/// A device with its effects and plans, which point at each other.
class Machine {
 public:
  Machine(const std::string& name, std::uint64_t seed)
      : name_(name), mechanism_(read_mechanism(data_folder + "/devices/" + name + ".yaml")) {
    effects_ = catalogue(data_folder + "/effects/catalogue");
    for (effects::Effect& e : place_effects(mechanism_, effects_)) effects_.push_back(std::move(e));
    PlanOptions o;
    o.sigma = sigma_for(mechanism_);
    o.changes = false;
    for (const char* campaign : campaigns)
      plans_.push_back(std::make_unique<Plan>(mechanism_, effects_, campaign, seed, o));
    for (const auto& plan : plans_) oracles_.emplace_back(*plan, 0.25, 0.5, seed, 0);
  }

  std::size_t candidates() const { return plans_.front()->signatures.size(); }

  MachineSet diagnosed(std::size_t k, std::uint64_t seed) const {
    constexpr double lambdas[] = {4, 8, 16};
    MachineSet out;
    out.device = name_;
    const Plan& plan = *plans_[k % plans_.size()];
    measurement::Random random(seed);
    Mechanism truth = mechanism_;
    std::optional<Hidden> hidden;
    if (k % 4 != 0) {
      const bool place = k % 2 == 0;
      hidden = drawn(plan, place, lambdas[k % 3], random);
      if (!hidden) {
        out.skipped = "no effect drawn reaches its size within its bounds";
        return out;
      }
      truth = with_effect(mechanism_, hidden->effect);
      out.effect = hidden->effect.effect->name;
      out.site = site_of(hidden->effect);
      out.lambda = hidden->lambda();
      out.alike = alike(plan, *hidden);
    }
    SimulationOptions o = plan.simulation;
    o.seed = seed;
    const Measurements data = simulate(truth, plan.readings, o, alone);
    const auto start = std::chrono::steady_clock::now();
    const Diagnosis d = diagnose(mechanism_, data, effects_, {}, alone);
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    take(d, hidden, out);
    const Oracle::Answer best =
        oracles_[k % plans_.size()].answer(plan.observations->uncertainty().whitened(plan.residual(data)));
    out.oracle_right = hidden ? among({best.first}, out.alike) : best.first.empty();
    out.oracle_reported = best.reported;
    if (hidden && hidden->effect.effect->place) leave_out(*hidden, data, out);
    return out;
  }

 private:
  /// The same data without any law at the place where one is hidden: is the place found by what acts near it?
  void leave_out(const Hidden& hidden, const Measurements& data, MachineSet& out) const {
    const Place& place = *hidden.effect.effect->place;
    std::vector<effects::Effect> others;
    for (const effects::Effect& e : effects_)
      if (&e != hidden.effect.effect) others.push_back(e);
    const Diagnosis d = diagnose(mechanism_, data, others, {}, alone);
    out.left_out = true;
    std::vector<const effects::Effect*> told;
    for (const effects::PlacedEffect& e : d.missing) told.push_back(e.effect);
    if (d.unexplained)
      for (const Localised& l : d.localised) told.push_back(l.effect.effect);
    for (const effects::Effect* each : told) {
      const bool right = (each->place && each->place->path == place.path) || among({each->name}, out.alike);
      ++out.told;
      out.told_rightly += right;
      out.place_found = out.place_found || right;
    }
  }

  std::optional<Hidden> drawn(const Plan& plan, bool place, double lambda, measurement::Random& random) const {
    std::vector<const effects::Effect*> choice;
    for (const Signature& s : plan.signatures)
      if (s.effect.effect->place.has_value() == place && (choice.empty() || choice.back() != s.effect.effect))
        choice.push_back(s.effect.effect);
    for (int tries = 0; tries < 10 && !choice.empty(); ++tries) {
      const auto lot = static_cast<std::size_t>(random.uniform(0, static_cast<double>(choice.size())));
      if (auto h = hidden_effect(plan, *choice[lot], lambda, random)) return h;
    }
    return std::nullopt;
  }

  static std::vector<std::string> alike(const Plan& plan, const Hidden& h) {
    std::vector<std::string> out = {h.effect.effect->name};
    for (const Signature& s : plan.signatures) {
      const VectorX along = s.basis.transpose() * h.change;
      const double c = (s.shaped ? along.cwiseAbs().maxCoeff() : along.norm()) / h.lambda();
      if (h.lambda() * h.lambda() * std::max(0.0, 1 - c * c) < separable) out.push_back(s.effect.effect->name);
    }
    return out;
  }

  static void take(const Diagnosis& d, const std::optional<Hidden>& hidden, MachineSet& out) {
    out.verdict = nth(verdict_names, d.verdict);
    for (const effects::PlacedEffect& e : d.missing) out.missing.push_back(e.effect->name);
    for (const std::vector<std::string>& group : d.indistinguishable)
      out.tied.insert(out.tied.end(), group.begin(), group.end());
    if (!d.candidates.empty()) out.probability = d.candidates.front().probability;
    if (!hidden || d.missing.size() != 1 || d.missing.front().effect != hidden->effect.effect ||
        d.missing.front().leg != hidden->effect.leg)
      return;
    for (std::size_t i = 0; i < hidden->effect.effect->parameters.size(); ++i) {
      if (hidden->effect.effect->parameters[i].optional) continue;
      const auto [low, high] = interval95(d.missing, d.fit, i);
      const double value = hidden->effect.values(as_index(i));
      ++out.intervals;
      out.covering += low <= value && value <= high;
      if (i > 0) continue;
      const bool log = hidden->effect.effect->parameters[i].log;
      const auto at = [&](double x) { return log ? std::log(x) : x; };
      const double sd = (at(high) - at(low)) / (2 * 1.959964);
      out.named = sd > 0;
      if (out.named) out.bias = (at(d.fit.values(as_index(i))) - at(value)) / sd;
    }
  }

  std::string name_;
  Mechanism mechanism_;
  std::vector<effects::Effect> effects_;
  std::vector<std::unique_ptr<Plan>> plans_;
  std::vector<Oracle> oracles_;  // of the plans
};

bool is_named(const MachineSet& s) { return s.verdict == "effect" || s.verdict == "ambiguous"; }
bool is_right(const MachineSet& s) {
  if (s.effect.empty()) return s.verdict == "nothing_missing";
  return is_named(s) && s.missing.size() == 1 && (among(s.missing, s.alike) || among(s.tied, s.alike));
}
bool is_wrong(const MachineSet& s) {
  return !is_right(s) && s.verdict == "effect" && s.probability >= 0.9 && !among(s.missing, s.alike);
}

using Which = std::function<bool(const MachineSet&)>;

/// "0.83 (12)": share and number of sets.
std::string share(const std::vector<MachineSet>& all, const Which& which, const Which& does) {
  int sets = 0, yes = 0;
  for (const MachineSet& s : all) {
    if (!s.skipped.empty() || !which(s)) continue;
    ++sets;
    yes += does(s);
  }
  return sets == 0 ? "" : fmt::format("{:.2f} ({})", static_cast<double>(yes) / sets, sets);
}

/// "0.94": of the sets that the oracle has right, the share that the diagnosis has right too, and the number.
std::string beside_oracle(const std::vector<MachineSet>& all) {
  int oracle = 0, both = 0;
  for (const MachineSet& s : all) {
    if (!s.skipped.empty()) continue;
    oracle += s.oracle_right;
    both += s.oracle_right && is_right(s);
  }
  return oracle == 0 ? "" : fmt::format("{:.2f} ({})", static_cast<double>(both) / oracle, oracle);
}

/// "2.1 / 1.9": how many effects are left in question, by the diagnosis and by the oracle, where one is named.
std::string sizes(const std::vector<MachineSet>& all) {
  double own = 0, oracle = 0;
  int sets = 0;
  for (const MachineSet& s : all) {
    if (!s.skipped.empty() || s.effect.empty() || !is_named(s)) continue;
    std::vector<std::string> names = s.missing;
    names.insert(names.end(), s.tied.begin(), s.tied.end());
    std::sort(names.begin(), names.end());
    own += static_cast<double>(std::unique(names.begin(), names.end()) - names.begin());
    oracle += static_cast<double>(s.oracle_reported);
    ++sets;
  }
  return sets == 0 ? "" : fmt::format("{:.1f} / {:.1f}", own / sets, oracle / sets);
}

/// F1 of the places told where the law was left out, and the number of sets.
std::string localisation(const std::vector<MachineSet>& all) {
  int sets = 0, found = 0, told = 0, rightly = 0;
  for (const MachineSet& s : all) {
    if (!s.skipped.empty() || !s.left_out || s.lambda < 7) continue;
    ++sets;
    found += s.place_found;
    told += s.told;
    rightly += s.told_rightly;
  }
  if (sets == 0) return "";
  const double recall = static_cast<double>(found) / sets,
               precision = told > 0 ? static_cast<double>(rightly) / told : 0;
  const double f1 = recall + precision > 0 ? 2 * recall * precision / (recall + precision) : 0;
  return fmt::format("{:.2f} ({})", f1, sets);
}

/// Mean of (found − true)/standard deviation, and its own standard error.
std::string mean_bias(const std::vector<MachineSet>& all) {
  double sum = 0;
  int sets = 0;
  for (const MachineSet& s : all)
    if (s.skipped.empty() && s.named) sum += s.bias, ++sets;
  return sets == 0 ? "" : fmt::format("{:+.2f} ± {:.2f}", sum / sets, 1 / std::sqrt(static_cast<double>(sets)));
}

std::string row(const std::string& name, const std::string& candidates, const std::vector<MachineSet>& all) {
  const auto size = [](double lambda) {
    return [=](const MachineSet& s) { return !s.effect.empty() && std::abs(s.lambda / lambda - 1) < 0.1; };
  };
  const auto hidden = [](const MachineSet& s) { return !s.effect.empty(); };
  const auto healthy = [](const MachineSet& s) { return s.effect.empty(); };
  const auto large = [](const MachineSet& s) { return s.lambda > 7; };
  const auto holds = [](const MachineSet& s) { return among(s.missing, s.alike) || among(s.tied, s.alike); };
  int intervals = 0, covering = 0;
  std::vector<double> seconds;
  for (const MachineSet& s : all) {
    intervals += s.intervals, covering += s.covering;
    if (s.skipped.empty()) seconds.push_back(s.seconds);
  }
  std::sort(seconds.begin(), seconds.end());
  return fmt::format(
      "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", name, candidates,
      share(all, size(4), is_right), share(all, size(8), is_right), share(all, size(16), is_right),
      share(all, large, holds), share(all, healthy, [](const MachineSet& s) { return !is_right(s); }),
      share(all, hidden, is_wrong),
      intervals > 0 ? fmt::format("{:.2f} ({})", static_cast<double>(covering) / intervals, intervals) : "",
      mean_bias(all), beside_oracle(all), sizes(all), localisation(all),
      seconds.empty() ? "" : fmt::format("{:.1f}", seconds[seconds.size() / 2]));
}

}  // namespace

std::vector<MachineRow> diagnose_machines(const std::vector<std::string>& devices, std::size_t sets, std::uint64_t seed,
                                          int threads) {
  const std::vector<std::string> known = built_in();
  std::vector<std::string> names = devices;
  if (names == std::vector<std::string>{"all"}) names = known;
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw InputError(fmt::format("--devices: there is no device '{}'{}", name, suggestion(name, known)));
  std::vector<MachineRow> out;
  for (const std::string& name : names) {
    const Machine machine(name, seed);
    MachineRow row{name, machine.candidates(), std::vector<MachineSet>(sets)};
    parallel::for_each_case(sets, 1, threads, [&](std::size_t k) {
      try {
        row.sets[k] = machine.diagnosed(k, seed + 1000 * k + 100000 * out.size());
      } catch (const std::runtime_error& e) {
        row.sets[k].device = name;
        row.sets[k].skipped = e.what();
      }
    });
    out.push_back(std::move(row));
  }
  return out;
}

std::string machines_table(const std::vector<MachineRow>& rows) {
  std::string out =
      "| machine | candidates that act | right class, λ 4 | λ 8 | λ 16 | truth reported, λ ≥ 8 | false alarms | "
      "confident and wrong | intervals that hold | bias, σ | of the oracle's right answers | effects reported, by the "
      "oracle | place of a law left out, F1 | s |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::vector<MachineSet> all;
  for (const MachineRow& r : rows) {
    out += row(r.device, std::to_string(r.candidates), r.sets);
    all.insert(all.end(), r.sets.begin(), r.sets.end());
  }
  if (rows.size() > 1) out += row("all", "", all);
  for (const MachineSet& s : all)
    if (!s.skipped.empty()) out += fmt::format("Skipped: {}: {}.\n", s.device, s.skipped);
  return out;
}

Json machines_json(const std::vector<MachineRow>& rows) {
  Json out = Json::array();
  for (const MachineRow& r : rows) {
    Json one = {{"device", r.device}, {"candidates", r.candidates}, {"sets", Json::array()}};
    for (const MachineSet& s : r.sets)
      one["sets"].push_back({{"effect", s.effect},
                             {"site", s.site},
                             {"lambda", s.lambda},
                             {"verdict", s.verdict},
                             {"missing", s.missing},
                             {"tied", s.tied},
                             {"alike", s.alike},
                             {"probability", s.probability},
                             {"right", is_right(s)},
                             {"oracle_right", s.oracle_right},
                             {"oracle_reported", s.oracle_reported},
                             {"bias", s.bias},
                             {"left_out", s.left_out},
                             {"places_told", s.told},
                             {"places_right", s.told_rightly},
                             {"wrong", is_wrong(s)},
                             {"seconds", s.seconds},
                             {"skipped", s.skipped}});
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace deflect::benchmark
