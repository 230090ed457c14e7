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
    if (edits(*e, "rig.load_cell"))
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

void add_steps(Plan& plan, const Rivalry& rivalry, RivalryAim aim, const std::vector<Block>& blocks,
               const std::vector<std::size_t>& chosen) {
  std::size_t readings = 0;
  const auto add = [&] {
    plan.steps.push_back({readings, rivalry.probability(aim.gain()), rivalry.pairs(aim.gain())});
  };
  add();
  for (const std::size_t b : chosen) {
    aim.take(b);
    readings += blocks[b].count;
    add();
  }
}

}  // namespace

Step expected_of(const subject::Subject& s, const Measurements& data, const Measurements& added,
                 const std::vector<Rival>& rivals, const PlanOptions& o, const parallel::Work& work) {
  Possible whole;
  whole.all = s.placed(measurement::joined({data, added}));
  whole.taken = data.readings.size();
  const Prospect prospect(s, std::move(whole), o.noise, work);
  const Rivalry rivalry(prospect, s, rivals, o.draws, o.seed, work.quiet());
  const std::vector<MatrixX> gain = rivalry.gain_of_all();
  return {added.readings.size(), rivalry.probability(gain), rivalry.pairs(gain)};
}

Plan next_readings(const subject::Subject& s, const Measurements& data, std::vector<Rival> rivals, const PlanOptions& o,
                   const parallel::Work& work) {
  Plan out;
  out.subject = s.name();
  out.data = data.origin;
  out.taken = data.readings.size();
  const bool sequences = remembers(s, data, rivals);
  const Prospect prospect(s, possible_readings(s, data, o.limits, sequences, o.seed), o.noise, work.part(0, 0.2));
  const std::vector<Block>& blocks = prospect.possible().blocks;
  out.possible = prospect.readings().readings.size() - out.taken;
  const Rivalry rivalry(prospect, s, std::move(rivals), o.draws, o.seed, work.part(0.2, 0.5));
  out.rivals = rivalry.rivals();
  std::vector<Pair> hopeless;
  const std::vector<Pair> at_most = rivalry.pairs(rivalry.gain_of_all());
  for (const Pair& p : at_most) {
    if (p.separation > nothing_tells) continue;
    hopeless.push_back(p);
    out.inseparable.push_back({p, instead_of_readings({&out.rivals[p.a].own(), &out.rivals[p.b].own()})});
  }
  const RivalryAim aim(rivalry, hopeless, o.probability);
  Choice choice;
  if (hopeless.size() < at_most.size()) choice = choose(aim, blocks, {o.readings, o.most_poses}, work.part(0.5, 0.9));
  add_steps(out, rivalry, aim, blocks, choice.blocks);
  out.as_planned = out.steps.back().pairs;
  out.probability = out.steps.back().probability;
  const auto more_sensors = [&](const Measurements& added) {
    const SensorOptions by{o.noise, o.probability, o.draws, o.seed, sequences};
    auto found = outcome_of([&] { return new_sensors(s, data, added, out.rivals, by, {work.threads}); });
    if (found) out.sensors = std::move(*found.value);  // what cannot be predicted there is not proposed
  };
  if (choice.blocks.empty()) {
    more_sensors(data);
    return out;
  }
  out.readings = as_plan(prospect.possible(), choice.blocks);
  if (out.probability >= o.probability)
    std::tie(out.at_random, out.at_random_is_more) =
        at_random(aim, blocks, longest * std::max<std::size_t>(10, choice.readings.back()), o.seed, work.threads);
  for (const measurement::Reading& r : data.readings)
    for (std::size_t i = 0; i < 6; ++i) out.read[i] = out.read[i] || r.displacement[i];
  Measurements as_taken = out.readings;
  for (measurement::Reading& r : as_taken.readings) {
    const measurement::Reading& like = prospect.readings().readings[blocks.front().first];
    r.displacement = like.displacement;
    r.sensors = like.sensors;
  }
  const Step whole = expected_of(s, data, as_taken, out.rivals, o, work.quiet());
  out.as_planned = whole.pairs;
  out.probability = whole.probability;
  more_sensors(as_taken);
  if (work.progress) work.progress(1);
  return out;
}

}  // namespace deflect::plan
