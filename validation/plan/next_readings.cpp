#include "validation/plan/next_readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/measurement/joined.h"
#include "validation/measurement/random.h"
#include "validation/parallel/cases.h"

namespace deflect::plan {
namespace {

using measurement::Measurements;

constexpr std::size_t orders = 9;    // random ones
constexpr std::size_t longest = 20;  // times the plan

bool remembers(const subject::Subject& s, const Measurements& data, const std::vector<Rival>& rivals) {
  const auto standing = s.stand(data);
  return std::any_of(rivals.begin(), rivals.end(), [&](const Rival& r) {
    return subject_with(s, r, r.values).stand(data, standing.get())->has_history();
  });
}

/// Whether an effect changes something of this kind: by the beginning of a path that it edits.
bool edits(const effects::PlacedEffect& e, const std::string& beginning) {
  for (const effects::EffectEdit& edit : e.effect->edits)
    for (const std::string& path : edit.paths)
      if (path.starts_with(beginning)) return true;
  return false;
}

/// What would tell an effect from others where no reading of this kind does.
std::vector<std::string> instead_of_readings(const std::vector<const effects::PlacedEffect*>& both) {
  std::vector<std::string> out;
  for (const effects::PlacedEffect* e : both) {
    std::string sentence;
    if (edits(*e, "rig.load_cell.point") || edits(*e, "rig.sensor.point"))
      sentence = "a measurement of where it touches";
    else if (edits(*e, "rig.load_cell"))
      sentence = "an independent calibration of the load cell";
    else if (edits(*e, "rig.sensor") || edits(*e, "sensors."))
      sentence = "an independent calibration of the sensor";
    else if (edits(*e, "materials."))
      sentence = "a test of the material itself (a sample that is pulled, or its speed of sound)";
    else
      sentence = "a measurement at the part itself";
    if (const std::string& bench = e->effect->pages.bench; !bench.empty()) sentence += ": " + bench;
    out.push_back(fmt::format("{}: {}", diagnosis::name_of(*e), sentence));
  }
  return out;
}

/// Random blocks until the aim is reached; the number of readings, median over a few orders.
std::pair<std::size_t, bool> at_random(const RivalryAim& start, const std::vector<Block>& blocks, std::size_t most,
                                       std::uint64_t seed, int threads) {
  std::vector<std::size_t> needed(orders, most);
  parallel::for_each_case(orders, 1, threads, [&](std::size_t i) {
    measurement::Random random(seed + 100 + i);
    RivalryAim aim = start;
    for (std::size_t used = 0; used < most;) {
      const double at = random.uniform(0, static_cast<double>(blocks.size()));
      const std::size_t block = std::min(blocks.size() - 1, as_size(std::lround(std::floor(at))));
      aim.take(block);
      used += blocks[block].count;
      if (!aim.reached()) continue;
      needed[i] = used;
      return;
    }
  });
  std::nth_element(needed.begin(), needed.begin() + orders / 2, needed.end());
  return {needed[orders / 2], needed[orders / 2] >= most};
}

/// Expected after each block in turn, from none on.
std::vector<Step> steps_of(const Rivalry& rivalry, RivalryAim aim, const std::vector<Block>& blocks,
                           const std::vector<std::size_t>& chosen) {
  std::vector<Step> out;
  std::size_t readings = 0;
  const auto add = [&] { out.push_back({readings, rivalry.probability(aim.gain()), rivalry.pairs(aim.gain())}); };
  add();
  for (const std::size_t b : chosen) {
    aim.take(b);
    readings += blocks[b].count;
    add();
  }
  return out;
}

/// What readings in their sequence add to the data, every rival fitted to the end, and where those fits ended.
struct Judged {
  Step step;
  FitsToTruths at;
};

Judged judge(const subject::Subject& s, const Measurements& data, const Measurements& added,
             const std::vector<Rival>& rivals, const PlanOptions& o, const parallel::Work& work) {
  Possible whole;
  whole.all = s.placed(measurement::joined({data, added}));
  whole.taken = data.readings.size();
  const Prospect prospect(s, std::move(whole), o.noise, work, subject_with_likeliest(s, rivals));
  const Rivalry rivalry(prospect, s, rivals, o.draws, o.seed, work.quiet());
  Refits refits = rivalry.refitted(work.quiet());
  return {{added.readings.size(), rivalry.probability(refits.gain), rivalry.pairs(refits.gain)}, std::move(refits.at)};
}

/// Pairs that all possible readings do not tell apart, not even where the rivals are fitted to the end.
std::vector<Pair> hopeless_pairs(const Prospect& prospect, const subject::Subject& s, const Rivalry& rivalry,
                                 const PlanOptions& o, int threads) {
  std::vector<Pair> out;
  for (const Pair& p : rivalry.pairs(rivalry.gain_of_all())) {
    if (p.separation > nothing_tells) continue;
    const Rivalry two(prospect, s, {rivalry.rivals()[p.a], rivalry.rivals()[p.b]}, 1, o.seed, {threads});
    if (two.pairs(two.refitted({threads}).gain).front().separation <= nothing_tells) out.push_back(p);
  }
  return out;
}

/// A plan and what it is expected to say.
struct Chosen {
  Choice choice;
  std::vector<Step> steps;
  Measurements plan, as_taken;  // as_taken: with a number in each cell that is to be filled in
  Judged judged;
};

/// How many of the blocks, each the one that brings most after those before: where all of them do not reach the
/// probability that is wanted, those after which the others raise it by next to nothing, one at least.
std::size_t worth_taking(const std::vector<Step>& steps, double wanted) {
  constexpr double next_to_nothing = 2e-3;
  const double end = steps.back().probability;
  std::size_t out = steps.size() - 1;
  while (end < wanted && out > 1 && steps[out - 1].probability > end - next_to_nothing) --out;
  return out;
}

/// Whether rivals fitted to the end say something else than the choice reckoned with.
bool bends(const Chosen& c) {
  constexpr double much = 0.1;  // of λ²
  const std::vector<Pair>& reckoned = c.steps.back().pairs;
  for (std::size_t i = 0; i < reckoned.size(); ++i)
    if (std::abs(c.judged.step.pairs[i].separation - reckoned[i].separation) >
        nothing_tells + much * reckoned[i].separation)
      return true;
  return false;
}

class Planning {
 public:
  Planning(const subject::Subject& s, const Measurements& data, const Prospect& prospect, const Rivalry& rivalry,
           const PlanOptions& o, int threads)
      : s_(s),
        data_(data),
        prospect_(prospect),
        rivalry_(rivalry),
        hopeless_(hopeless_pairs(prospect, s, rivalry, o, threads)),
        o_(o) {}

  const std::vector<Pair>& hopeless() const { return hopeless_; }
  /// About which the best plan was chosen.
  const Rivalry& rivalry() const { return rivalry_; }
  RivalryAim aim() const { return {rivalry_, hopeless_, o_.probability}; }

  /// Where laws bend, chosen again with the rivals linearised where the first plan would bring them.
  Chosen best(const parallel::Work& work) {
    const std::size_t rivals = rivalry_.rivals().size();
    if (2 * hopeless_.size() == rivals * (rivals - 1)) return Chosen{{}, steps({}), {}, {}, {}};
    Chosen out = chosen(work.part(0, 0.6));
    if (out.choice.blocks.empty() || !bends(out)) return out;
    rivalry_ = rivalry_.about(out.judged.at, work.quiet());
    Chosen again = chosen(work.part(0.6, 1));
    if (!again.choice.blocks.empty() && is_better(again, out))
      out = std::move(again);
    else
      out.steps = steps(out.choice.blocks);
    return out;
  }

 private:
  const std::vector<Block>& blocks() const { return prospect_.possible().blocks; }
  std::vector<Step> steps(const std::vector<std::size_t>& chosen) const {
    return steps_of(rivalry_, aim(), blocks(), chosen);
  }

  Chosen chosen(const parallel::Work& work) const {
    Chosen out;
    out.choice = choose(aim(), blocks(), {o_.readings, o_.most_poses}, work);
    out.choice.blocks.resize(worth_taking(steps(out.choice.blocks), o_.probability));
    out.choice.readings.resize(out.choice.blocks.size());
    out.choice.blocks = pose_by_pose(prospect_.possible(), std::move(out.choice.blocks));
    out.steps = steps(out.choice.blocks);
    if (out.choice.blocks.empty()) return out;
    out.plan = out.as_taken = as_plan(prospect_.possible(), out.choice.blocks);
    const measurement::Reading& like = prospect_.readings().readings[blocks().front().first];
    for (measurement::Reading& r : out.as_taken.readings) {
      r.displacement = like.displacement;
      r.sensors = like.sensors;
    }
    out.judged = judge(s_, data_, out.as_taken, rivalry_.rivals(), o_, work.quiet());
    return out;
  }

  /// Reaches what is wanted with fewer readings, or comes nearer to it.
  bool is_better(const Chosen& a, const Chosen& than) const {
    const double p = a.judged.step.probability, q = than.judged.step.probability;
    if (p < o_.probability || q < o_.probability) return p > q;
    return a.plan.readings.size() < than.plan.readings.size();
  }

  const subject::Subject& s_;
  const Measurements& data_;
  const Prospect& prospect_;
  Rivalry rivalry_;
  std::vector<Pair> hopeless_;
  const PlanOptions& o_;
};

}  // namespace

Step expected_of(const subject::Subject& s, const Measurements& data, const Measurements& added,
                 const std::vector<Rival>& rivals, const PlanOptions& o, const parallel::Work& work) {
  return judge(s, data, added, rivals, o, work).step;
}

Plan next_readings(const subject::Subject& s, const Measurements& data, std::vector<Rival> rivals, const PlanOptions& o,
                   const parallel::Work& work) {
  Plan out;
  out.subject = s.name();
  out.data = data.origin;
  out.taken = data.readings.size();
  for (const measurement::Reading& r : data.readings)
    for (std::size_t i = 0; i < 6; ++i) out.read[i] = out.read[i] || r.displacement[i];
  const bool sequences = remembers(s, data, rivals);
  const Prospect prospect(s, possible_readings(s, data, o.limits, sequences, o.seed), o.noise, work.part(0, 0.2),
                          subject_with_likeliest(s, rivals));
  out.possible = prospect.readings().readings.size() - out.taken;
  Planning planning(s, data, prospect, Rivalry(prospect, s, std::move(rivals), o.draws, o.seed, work.part(0.2, 0.4)), o,
                    work.threads);
  out.rivals = planning.rivalry().rivals();
  for (const Pair& p : planning.hopeless())
    out.inseparable.push_back({p, instead_of_readings({&out.rivals[p.a].own(), &out.rivals[p.b].own()})});
  Chosen best = planning.best(work.part(0.4, 0.9));
  const bool any = !best.choice.blocks.empty();
  const Step& end = any ? best.judged.step : best.steps.back();
  out.as_planned = end.pairs;
  out.probability = end.probability;
  const SensorOptions by{o.noise, o.probability, o.draws, o.seed, sequences};
  auto sensors =
      outcome_of([&] { return new_sensors(s, data, any ? best.as_taken : data, out.rivals, by, {work.threads}); });
  if (sensors) out.sensors = std::move(*sensors.value);  // what cannot be predicted there is not proposed
  if (any && out.probability >= o.probability)
    std::tie(out.at_random, out.at_random_is_more) =
        at_random(planning.aim(), prospect.possible().blocks,
                  longest * std::max<std::size_t>(10, best.choice.readings.back()), o.seed, work.threads);
  out.steps = std::move(best.steps);
  out.readings = std::move(best.plan);
  if (work.progress) work.progress(1);
  return out;
}

}  // namespace deflect::plan
