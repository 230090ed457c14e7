#include "tests/benchmark/subjects.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>
#include <iterator>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/fields/yaml_tree.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/device_file.h"
#include "tests/benchmark/as_measured.h"
#include "tests/benchmark/hidden.h"
#include "tests/benchmark/oracle.h"
#include "tests/benchmark/random_arm.h"
#include "tests/support/paths.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/interval.h"
#include "validation/effects/edit_paths.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/place_effects.h"
#include "validation/parallel/pack.h"
#include "validation/prediction/campaign.h"

namespace deflect::benchmark {
namespace {

using namespace diagnosis;
using namespace effects;
using namespace measurement;
using namespace parallel;
using namespace prediction;

constexpr double separable = 9;  // difference of 2 ln L
constexpr const char* of_machines[] = {"rich", "random"};
constexpr const char* of_frames[] = {"rich", "cycle"};
const std::string data_folder = test::source_dir() + "/validation";
/// A gear unit whose output is locked, loaded by its own motor: measured as two of its records were.
const std::string actuator = "cycloidal-actuator", of_actuator = data_folder + "/measurements/cycloid/";
constexpr const char* records[] = {"baseline_play_initial.csv", "conic_disk_play_initial.csv"};
/// Arms by the dice, by seed.
constexpr std::pair<const char*, std::uint64_t> arms[] = {{"random-arm-1", 1}, {"random-arm-2", 2}};

struct Order {
  SetKind kind;
  double lambda = 0;   ///< of what is not among the candidates λ_res
  bool place = false;  ///< a law at a place is hidden, else an entry
};
constexpr Order turns[] = {{SetKind::healthy},       {SetKind::one, 4},         {SetKind::one, 8, true},
                           {SetKind::one, 16},       {SetKind::pair, 8},        {SetKind::unknown, 9, true},
                           {SetKind::stress},        {SetKind::one, 4, true},   {SetKind::one, 8},
                           {SetKind::one, 16, true}, {SetKind::pair, 16, true}, {SetKind::left_out, 18, true}};

std::vector<std::string> files_in(const std::string& folder) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(data_folder + folder))
    if (entry.path().extension() == ".yaml") out.push_back(entry.path().stem().string());
  std::sort(out.begin(), out.end());
  return out;
}

/// Frames that nothing reads cannot be diagnosed.
std::vector<std::string> measured_frames() {
  std::vector<std::string> out = files_in("/frames");
  std::erase_if(out, [](const std::string& name) {
    return frame::read_frame(data_folder + "/frames/" + name + ".yaml").sensors.empty();
  });
  return out;
}

/// A fiftieth of the rms translation of the machine as drawn.
double sigma_for(const subject::Subject& s) {
  const Measurements plan = campaign("random", *s.machine(), force, 1);
  double square = 0;
  for (const VectorX& d : s.stand(plan)->predict(plan, {}, alone)) square += d.head<3>().squaredNorm() / 3;
  return std::sqrt(square / static_cast<double>(plan.readings.size())) / 50;
}

/// A machine or a frame with its effects and plans, which point at each other.
class Examined {
 public:
  Examined(subject::Subject s, std::uint64_t seed, int threads) : subject_(std::move(s)) {
    effects_ = catalogue(data_folder + "/effects/catalogue");
    for (effects::Effect& e : place_effects(subject_, effects_)) effects_.push_back(std::move(e));
    PlanOptions o;
    o.changes = false;
    if (subject_.name() == actuator) {
      for (const char* name : records) {
        const Measurements record = read_measurements(of_actuator + name);
        o.record = &record;
        plans_.push_back(std::make_unique<Plan>(subject_, effects_, name, seed, o));
      }
    } else {
      if (subject_.machine()) o.sigma = sigma_for(subject_);
      for (const char* campaign : subject_.machine() ? of_machines : of_frames)
        plans_.push_back(std::make_unique<Plan>(subject_, effects_, campaign, seed, o));
    }
    for (const auto& plan : plans_)
      oracles_.emplace_back(std::async(
          std::launch::deferred, [&plan = *plan, seed, threads] { return Oracle(plan, 0.25, 0.5, seed, threads); }));
  }

  std::size_t candidates() const { return plans_.front()->signatures.size(); }

  SubjectSet diagnosed(std::size_t turn, std::uint64_t seed) const {
    const Order& order = turns[turn % std::size(turns)];
    const std::size_t round = turn / std::size(turns), which = (turn + round) % plans_.size();
    const Plan& plan = *plans_[which];
    SubjectSet out;
    out.kind = order.kind;
    out.lambda = order.lambda;
    Random random(seed);
    std::vector<Hidden> hidden;
    const subject::Subject truth = drawn(plan, order, random, hidden);
    if (hidden.empty() && order.lambda > 0) out.skipped = "no effect drawn reaches its size within its bounds";
    if (!out.skipped.empty()) return out;
    for (const Hidden& h : hidden) {
      out.hidden.push_back(name_of(h.effect));
      out.classes.push_back(alike(plan, h));
    }
    std::optional<Stress> stress;
    if (order.kind == SetKind::stress) {
      out.stress = static_cast<int>(random.uniform(0, std::size(stress_names)));
      stress = static_cast<Stress>(out.stress);
    }
    const std::optional<Measurements> data = as_measured(plan, truth, stress, seed);
    if (!data) {
      out.skipped = "the MSA finds no equilibrium";
      return out;
    }
    std::vector<std::string> gone;
    if (is_open(order.kind)) {
      gone = taken_out(plan, order.kind, hidden.front());
      out.lambda = hidden.front().lambda();
      out.lambda_res = beyond_others(plan, hidden.front(), gone);
    }
    diagnose_with(gone, *data, plan, hidden, truth, out);
    if (order.kind != SetKind::stress && !is_open(order.kind)) ask(oracles_[which].get(), plan, *data, out);
    return out;
  }

 private:
  void diagnose_with(const std::vector<std::string>& gone, const Measurements& data, const Plan& plan,
                     const std::vector<Hidden>& hidden, const subject::Subject& truth, SubjectSet& out) const {
    std::vector<effects::Effect> known;
    for (const effects::Effect& e : effects_)
      if (!holds(gone, e.name)) known.push_back(e);
    const auto start = std::chrono::steady_clock::now();
    const Diagnosis d = diagnose(subject_, data, known, {}, alone);
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    out.answer.verdict = nth(verdict_names, d.verdict);
    for (const effects::PlacedEffect& e : d.missing) out.answer.missing.push_back(e.effect->name);
    out.answer.groups = d.indistinguishable;
    if (!d.candidates.empty()) {
      out.answer.first = d.candidates.front().added().effect->name;
      out.answer.probability = d.candidates.front().probability;
    }
    count_intervals(d, hidden, out);
    if (!gone.empty()) count_places(d, out);
    if (out.kind == SetKind::one && out.lambda > 7 && plan.nominal_elsewhere.size() > 0)
      predict_new_poses(d, plan, truth, out);
  }

  static void ask(const Oracle& oracle, const Plan& plan, const Measurements& data, SubjectSet& out) {
    const VectorX residual = plan.observations->uncertainty().whitened(plan.residual(data));
    out.oracle_asked = true;
    if (out.kind == SetKind::pair) {
      Answer two;
      two.verdict = "effect";
      two.missing = oracle.answer_of_two(residual);
      out.oracle_right = exactly(two, out.classes);
      return;
    }
    const Oracle::Answer best = oracle.answer(residual);
    out.oracle_right = out.classes.empty() ? best.first.empty() : holds(out.classes.front(), best.first);
    out.oracle_reported = best.reported;
  }

  /// Whether all parts of the place told are parts of the hidden one.
  static bool within(const subject::Place& told, const subject::Place& hidden) {
    if (hidden.kind == subject::PlaceKind::sensor) return subject::of_one_part(told, hidden);
    const auto is_one = [&](const std::string& path) {
      return path == hidden.path || std::any_of(hidden.others.begin(), hidden.others.end(),
                                                [&](const subject::OtherPart& o) { return o.path == path; });
    };
    return is_one(told.path) && std::all_of(told.others.begin(), told.others.end(),
                                            [&](const subject::OtherPart& o) { return is_one(o.path); });
  }

  /// The places told, and those where the hidden effect is or one of its class.
  void count_places(const Diagnosis& d, SubjectSet& out) const {
    const EffectClass& hidden = out.classes.front();
    const auto tell = [&](const std::string& name, const std::optional<subject::Place>& place,
                          const effects::Effect* entry = nullptr) {
      const auto is_there = [&](const effects::Effect& e) {
        return e.place && holds(hidden, e.name) &&
               (place ? within(*place, *e.place) : entry && effects::edits_only(*entry, e.place->path, subject_));
      };
      out.told.push_back(name);
      out.told_rightly += holds(hidden, name) || std::any_of(effects_.begin(), effects_.end(), is_there);
    };
    for (const effects::PlacedEffect& e : d.missing) tell(e.effect->name, e.effect->place, e.effect);
    if (d.unexplained)
      for (const Localised& l : d.localised) tell(l.effect ? l.effect->name : l.what, l.place);
  }

  static void count_intervals(const Diagnosis& d, const std::vector<Hidden>& hidden, SubjectSet& out) {
    std::size_t at = 0;
    for (const effects::PlacedEffect& found : d.missing) {
      for (const Hidden& h : hidden)
        if (h.effect.effect->name == found.effect->name && h.effect.leg == found.leg)
          for (std::size_t i = 0; i < found.effect->parameters.size(); ++i) {
            const EffectParameter& p = found.effect->parameters[i];
            if (p.optional) continue;
            const auto [low, high] = interval95(d.missing, d.fit, at + i);
            const double value = h.effect.values(as_index(i));
            ++out.intervals;
            out.covering += low <= value && value <= high;
            if (i > 0 || hidden.size() > 1) continue;
            const auto scale = [&](double x) { return p.log ? std::log(x) : x; };
            const double sd = (scale(high) - scale(low)) / (2 * 1.959964);
            if (sd > 0) out.bias = (scale(d.fit.values(as_index(at))) - scale(value)) / sd;
          }
      at += found.effect->parameters.size();
    }
  }

  void predict_new_poses(const Diagnosis& d, const Plan& plan, const subject::Subject& truth, SubjectSet& out) const {
    try {
      const VectorX exact = predict_elsewhere(plan, *truth.machine(), theories::theory("msa"));
      VectorX told = plan.nominal_elsewhere;
      if (!d.missing.empty())
        told = predict_elsewhere(plan, PreparedEffects(subject_, d.missing).machine(d.fit.values),
                                 theories::theory("analytic"));
      out.new_poses = (told - exact).norm() / std::sqrt(static_cast<double>(exact.size())) / plan.simulation.sigma_u;
    } catch (const NumericalError&) {  // no equilibrium at one of the new poses
    }
  }

  /// The subject with what is hidden; `hidden` stays empty where nothing is, or nothing reaches its size. A pair has a
  /// law at a place at least, and where no entry is large enough one takes its place.
  subject::Subject drawn(const Plan& plan, const Order& order, Random& random, std::vector<Hidden>& hidden) const {
    constexpr int most = 20;
    for (int tries = 0; order.lambda > 0 && tries < most; ++tries) {
      std::vector<bool> places = {order.place || tries >= most / 2};
      if (order.kind == SetKind::pair) places.push_back(true);
      hidden.clear();
      for (const bool place : places)
        if (auto h =
                is_open(order.kind) ? drawn_unknown(plan, order, random) : drawn_one(plan, place, order.lambda, random))
          hidden.push_back(std::move(*h));
      if (hidden.size() < places.size() || (hidden.size() > 1 && too_near(plan, hidden))) continue;
      try {
        subject::Subject truth = subject_;
        for (const Hidden& h : hidden) truth = with_effect(truth, h.effect);
        return truth;
      } catch (const InputError&) {  // the two do not go together
      }
    }
    hidden.clear();
    return subject_;
  }

  /// Or one other effect does what both do together, as a spring does what yields to pull and what yields to push.
  static bool too_near(const Plan& plan, const std::vector<Hidden>& two) {
    constexpr double most_alike = 0.9;  // cosine
    Hidden both = two[0];
    both.change += two[1].change;
    return cosine(two[0], two[1]) >= most_alike || meet(alike(plan, two[0]), alike(plan, two[1])) ||
           alike(plan, both).size() > 1;
  }

  std::optional<Hidden> drawn_one(const Plan& plan, bool place, double lambda, Random& random) const {
    std::vector<const effects::Effect*> choice;
    for (const Signature& s : plan.signatures)
      if (s.effect.effect->place.has_value() == place && (choice.empty() || choice.back() != s.effect.effect))
        choice.push_back(s.effect.effect);
    if (choice.empty()) return std::nullopt;
    const auto lot = static_cast<std::size_t>(random.uniform(0, static_cast<double>(choice.size())));
    return hidden_effect(plan, *choice[lot], lambda, random);
  }

  /// A law as large as its λ_res wants (to a tenth). None where the other effects leave too little of the one drawn.
  std::optional<Hidden> drawn_unknown(const Plan& plan, const Order& order, Random& random) const {
    constexpr double first = 16, least_left = 0.05, accuracy = 0.1;
    const Random lots = random;
    double lambda = first;
    for (int tries = 0; tries < 6; ++tries) {
      random = lots;  // the same law with the same signs
      std::optional<Hidden> h = drawn_one(plan, order.place, lambda, random);
      if (!h) return std::nullopt;
      const double left = beyond_others(plan, *h, taken_out(plan, order.kind, *h));
      if (std::abs(left / order.lambda - 1) < accuracy) return h;
      if (left < least_left * h->lambda()) return std::nullopt;
      lambda *= order.lambda / left;
    }
    return std::nullopt;
  }

  /// What is no candidate where this one is hidden.
  static std::vector<std::string> taken_out(const Plan& plan, SetKind kind, const Hidden& h) {
    return kind == SetKind::unknown ? alike(plan, h) : std::vector{std::string(h.effect.effect->name)};
  }

  static EffectClass alike(const Plan& plan, const Hidden& h) {
    EffectClass out = {h.effect.effect->name};
    for (const Signature& s : plan.signatures) {
      const VectorX along = s.basis.transpose() * h.change;
      const double c = (s.shaped ? along.cwiseAbs().maxCoeff() : along.norm()) / h.lambda();
      if (h.lambda() * h.lambda() * std::max(0.0, 1 - c * c) < separable && !holds(out, s.effect.effect->name))
        out.push_back(s.effect.effect->name);
    }
    return out;
  }

  subject::Subject subject_;
  std::vector<effects::Effect> effects_;
  std::vector<std::unique_ptr<Plan>> plans_;
  std::vector<std::shared_future<Oracle>> oracles_;  // made when they are first asked, which takes minutes
};

constexpr std::uint64_t most_sets = 1'000'000'000;  // of one subject, so that each has a number of its own

subject::Subject built_in(const std::string& name, bool frame) {
  if (frame) {
    frame::FrameDescription f = frame::read_frame(data_folder + "/frames/" + name + ".yaml");
    f.geometry = Geometry::finite;
    return f;
  }
  for (const auto& [arm, seed] : arms)
    if (name == arm) return random_arm(seed);
  if (name == actuator) return read_mechanism(of_actuator + "actuator.yaml");
  return read_mechanism(data_folder + "/devices/" + name + ".yaml");
}

}  // namespace

template <class Archive>
void serialize(Archive& a, SubjectSet& s) {
  a(s.kind, s.stress, s.skipped, s.hidden, s.classes, s.lambda, s.lambda_res, s.answer, s.seconds, s.oracle_asked,
    s.oracle_right, s.oracle_reported, s.intervals, s.covering, s.bias, s.told, s.told_rightly, s.new_poses);
}

std::vector<SubjectRow> diagnose_subjects(const std::vector<std::string>& asked, std::size_t sets,
                                          std::optional<SetKind> kind, std::uint64_t seed, int threads,
                                          const std::function<void(const std::vector<SubjectRow>&)>& done,
                                          parallel::Journal* journal) {
  const std::vector<std::string> frames = measured_frames();
  std::vector<std::string> known = files_in("/devices"), names = asked;
  known.push_back(actuator);
  for (const auto& [arm, own_seed] : arms) known.emplace_back(arm);
  known.insert(known.end(), frames.begin(), frames.end());
  if (names == std::vector<std::string>{"all"}) names = known;
  for (const std::string& name : names)
    if (!holds(known, name))
      throw InputError(
          fmt::format("--devices: there is no device or frame with sensors '{}'{}", name, suggestion(name, known)));
  std::vector<SubjectRow> out;
  for (const std::string& name : names) {
    const bool frame = holds(frames, name);
    // A subject's sets are the same whatever others are asked for.
    const auto place = static_cast<std::size_t>(std::find(known.begin(), known.end(), name) - known.begin());
    const Examined examined(built_in(name, frame), seed, threads);
    const std::size_t first = place % 2 * std::size(turns) / 2;  // few sets of each are all kinds of set
    std::vector<std::size_t> wanted;
    for (std::size_t k = 0; wanted.size() < sets; ++k)
      if (!kind || turns[(first + k) % std::size(turns)].kind == *kind) wanted.push_back(k);
    SubjectRow row{name, frame, examined.candidates(), std::vector<SubjectSet>(sets)};
    parallel::SharedCases cases;
    cases.count = sets;
    cases.work = [&](std::size_t i) {
      const std::size_t k = wanted[i];
      try {
        row.sets[i] = examined.diagnosed(first + k, seed + 1000 * k + 100000 * place);
      } catch (const std::runtime_error& e) {
        row.sets[i].kind = turns[(first + k) % std::size(turns)].kind;
        row.sets[i].skipped = e.what();
      }
    };
    cases.result = [&](std::size_t i) { return parallel::pack(row.sets[i]); };
    cases.take = [&](std::size_t i, const std::string& bytes) { row.sets[i] = parallel::unpack<SubjectSet>(bytes); };
    parallel::for_each_case(cases, journal, place * most_sets, nullptr, threads);
    out.push_back(std::move(row));
    if (done) done(out);
  }
  return out;
}

}  // namespace deflect::benchmark
