#include "tests/attack/random_pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/stand.h"
#include "tests/attack/frame_forms.h"
#include "tests/attack/law_forms.h"
#include "tests/attack/random_device.h"
#include "tests/attack/random_frame.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "validation/effects/place_effects.h"
#include "validation/subject/simulate_frame.h"

namespace deflect::attack {
namespace {

constexpr unsigned most_draws = 40;
constexpr double largest_share = 3e-3;  // displacement over size: what a measured structure may move

constexpr const char* machines[] = {"haptic-6psu-ideal-joints", "tripteron", "scara", "arm", "3-rrr", "flexure"};
constexpr const char* frames[] = {"truss-45", "portal-semi-rigid", "beam-on-springs", "lattice-girder"};

std::filesystem::path data(const char* folder, const std::string& name) {
  return std::filesystem::path(test::source_dir()) / "validation" / folder / (name + ".yaml");
}

/// Root mean square of the numbers `from` … `from + count` of the predicted readings.
double rms(const std::vector<VectorX>& readings, Eigen::Index from, Eigen::Index count) {
  double sum = 0;
  for (const VectorX& each : readings) sum += each.segment(from, count).squaredNorm();
  return std::sqrt(sum / static_cast<double>(count * std::ssize(readings)));
}

/// Loads of one size with random directions, signs and shares; some again.
std::vector<Vector6> loads(double force, double moment, int count, Dice& dice) {
  std::vector<Vector6> out;
  for (int i = 0; i < count; ++i) {
    if (i > 0 && dice.chance(0.2)) {
      out.push_back(out[dice.bits() % out.size()]);
      continue;
    }
    Vector6 F = Vector6::Zero();
    const bool alone = dice.chance(0.6);
    const int axis = dice.whole(0, 5);
    for (Eigen::Index k = 0; k < 6; ++k)
      if (!alone || k == axis) F(k) = (k < 3 ? force : moment) * dice.real(-1, 1);
    out.push_back(F);
  }
  return out;
}

void add_reading(measurement::Measurements& plan, std::size_t pose, bool sequence) {
  measurement::Reading r;
  r.pose = pose;
  if (sequence) r.sequence = static_cast<double>(plan.readings.size());
  r.line = plan.readings.size() + 2;
  plan.poses[pose].readings.push_back(plan.readings.size());
  plan.readings.push_back(r);
}

/// Home, and poses near it that the machine reaches.
measurement::Measurements machine_plan(const Mechanism& m, double force, double moment, double step, Dice& dice) {
  measurement::Measurements plan;
  plan.origin = "plan";
  const Vector6 home = mm_deg_from(home_pose(m));
  plan.poses.push_back({"home", home, {}, {}});
  for (int i = dice.whole(0, 3); i > 0; --i) {
    Vector6 at = home;
    for (Eigen::Index k = 0; k < 3; ++k) at(k) += 1e3 * step * dice.real(-1, 1);
    at = ((at * 1e6).array().round() / 1e6).matrix();
    if (outcome_of([&] { return configure(m, pose_from(at)); }))
      plan.poses.push_back({fmt::format("p{}", i), at, {}, {}});
  }
  const bool sequence = dice.chance(0.7);
  const int each = dice.whole(5, 12);
  for (std::size_t pose = 0; pose < plan.poses.size(); ++pose)
    for (const Vector6& F : loads(force, moment, each, dice)) {
      add_reading(plan, pose, sequence);
      plan.readings.back().load = F;
    }
  return plan;
}

measurement::Measurements frame_plan(const frame::FrameDescription& f, Dice& dice) {
  measurement::Measurements plan;
  plan.origin = "plan";
  plan.poses.push_back({"0", Vector6::Zero(), {}, {}});
  plan.instruments.stationary = true;
  for (const auto& [name, load] : f.loads) plan.instruments.load_cases.push_back(name);
  const bool sequence = dice.chance(0.7);
  for (int i = dice.whole(10, 40); i > 0; --i) {
    add_reading(plan, 0, sequence);
    std::vector<double>& factors = plan.readings.back().factors;
    factors.assign(f.loads.size(), 0);
    const bool alone = dice.chance(0.5);
    const std::size_t which = dice.bits() % f.loads.size();
    for (std::size_t k = 0; k < factors.size(); ++k)
      if (!alone || k == which) factors[k] = dice.real(-1, 1);
  }
  return plan;
}

/// Displacements of nodes, forces and strains of members, reactions: some read nothing but noise.
void add_sensors(frame::FrameDescription& f, Dice& dice) {
  for (int i = dice.whole(2, 7); i > 0; --i) {
    frame::FrameSensor s;
    s.reads = static_cast<frame::FrameSensor::Reads>(dice.whole(0, 3));
    if (s.reads == frame::FrameSensor::Reads::reaction && f.supports.empty()) continue;
    switch (s.reads) {
      case frame::FrameSensor::Reads::displacement: {
        s.of = f.nodes[dice.bits() % f.nodes.size()].first;
        const auto freedom = static_cast<std::size_t>(dice.whole(0, dice.chance(0.8) ? 2 : 5));
        s.direction = frame::node_freedoms[freedom];
        s.rotation = freedom > 2;
        s.axis = Vector3::Unit(as_index(freedom % 3));
        break;
      }
      case frame::FrameSensor::Reads::reaction:
        s.of = f.supports[dice.bits() % f.supports.size()].first;
        s.component = dice.bits() % 6;
        break;
      case frame::FrameSensor::Reads::strain:
        s.of = f.members[dice.bits() % f.members.size()].first;
        s.at = dice.real(0, 1);
        break;
      case frame::FrameSensor::Reads::force:
        s.of = f.members[dice.bits() % f.members.size()].first;
        s.component = dice.chance(0.7) ? 0 : dice.bits() % 6;
        break;
    }
    if (dice.chance(0.3)) s.gain_text = "1 ± 1 %", s.gain_sigma = 0.01;
    s.free_zero = dice.chance(0.2);
    f.sensors.emplace_back(fmt::format("s{}", i), s);
  }
}

frame::FrameDescription measured_frame(unsigned seed, Dice& dice) {
  const RandomFrame random = dice.chance(0.5) ? random_frame(seed) : random_law_frame(seed);
  frame::FrameDescription f = scaled(random.words(), random.unit);
  add_sensors(f, dice);
  f.tolerances.modulus = 0.01;
  f.tolerances.load = 0.002;
  if (dice.chance(0.4)) f.tolerances.numbers.emplace_back("member.factor", "1 %");
  // σ: a fiftieth of what the sensor reads at most, from readings with that of a thousandth. One that reads nothing has
  // none.
  const measurement::Measurements read = subject::simulate_frame(f, subject::frame_campaign("paper", f, 1), {});
  for (std::size_t i = 0; i < f.sensors.size(); ++i)
    if (const auto& sigma = read.instruments.sensors[i].sigma) f.sensors[i].second.sigma = *sigma * 20;
  return f;
}

std::vector<effects::Effect> known_effects(const subject::Subject& s) {
  std::vector<effects::Effect> all = test::all_effects();
  for (effects::Effect& e : effects::place_effects(s, all)) all.push_back(std::move(e));
  return all;
}

double drawn(const effects::EffectParameter& p, Dice& dice) {
  double value = 0;
  if (p.log)
    value = p.start * dice.power_of_ten(-1.5, 1.5);
  else {
    const double to = dice.chance(0.5) ? p.high : p.low;
    value = p.start + (std::isfinite(to) ? (to - p.start) * dice.real(0.05, 0.8) : dice.real(-1, 1));
  }
  return std::clamp(value, p.low, p.high);
}

std::vector<HiddenEffect> hide(const subject::Subject& s, int count, Dice& dice) {
  const std::vector<effects::Effect> all = known_effects(s);
  std::vector<HiddenEffect> out;
  for (int tries = 0; tries < 60 && static_cast<int>(out.size()) < count; ++tries) {
    const effects::Effect& e = all[dice.bits() % all.size()];
    const std::vector<effects::PlacedEffect> places = effects::places_of(e, s);
    if (places.empty() || effects::is_geometry(e)) continue;
    const effects::PlacedEffect& at = places[dice.bits() % places.size()];
    HiddenEffect h{e.name, at.leg, e.name + (at.leg ? fmt::format(",leg={}", *at.leg) : "")};
    for (const effects::EffectParameter& p : e.parameters) h.words += fmt::format(",{}={:.6g}", p.name, drawn(p, dice));
    out.push_back(std::move(h));
  }
  return out;
}

Spoilt draw_spoilt(const subject::Subject& s, Dice& dice) {
  Spoilt out;
  const std::size_t channels = s.frame() ? s.frame()->sensors.size() : 6;
  for (std::size_t k = 0; k < channels; ++k)
    if (dice.chance(0.15)) out.channels.push_back(k);
  if (dice.chance(0.3)) out.blank = 0.1;
  out.no_sequence = dice.chance(0.1), out.no_sigma = dice.chance(0.1);
  return out;
}

/// The plan with loads so small that the machine moves by a share of its size at most; nothing where it does not stand
/// under them, or does not move at all.
std::optional<measurement::Measurements> carried(const subject::Subject& s, measurement::Measurements plan) {
  const auto predicted = [&]() -> std::optional<std::vector<VectorX>> {
    const auto out = outcome_of([&] { return s.stand(plan)->predict(plan); });
    return out ? std::optional(*out) : std::nullopt;
  };
  const auto first = predicted();
  if (!first) return {};
  const auto standing = s.stand(plan);
  const double moved = rms(*first, 0, 3) + standing->size() * rms(*first, 3, 3);
  if (!(moved > 0) || !std::isfinite(moved)) return {};
  const double most = largest_share * standing->size();
  if (moved > most)
    for (measurement::Reading& r : plan.readings) measurement::scale_load(r, most / moved);
  return predicted() ? std::optional(plan) : std::nullopt;
}

std::optional<Pipeline> machine_pipeline(Mechanism m, double force, double moment, double unit, Dice& dice) {
  const subject::Subject s = m;
  const auto plan = carried(s, machine_plan(m, force, moment, 0.02 * unit, dice));
  if (!plan) return {};
  Pipeline p{0, PipelineKind::machine, s, *plan, {}, 0, 0, 0, {}};
  const std::vector<VectorX> readings = s.stand(*plan)->predict(*plan);
  const double share = dice.power_of_ten(-2.5, -1);
  p.noise_mm = 1e3 * share * rms(readings, 0, 3);
  if (dice.chance(0.4)) p.noise_rad = share * rms(readings, 3, 3);
  if (!(p.noise_mm > 0)) return {};
  return p;
}

std::optional<Pipeline> drawn(unsigned seed, PipelineKind kind, Dice& dice) {
  if (kind == PipelineKind::built_in && dice.chance(0.3)) {
    frame::FrameDescription f = frame::read_frame(data("frames", frames[dice.bits() % std::size(frames)]));
    measurement::Measurements plan = frame_plan(f, dice);
    return Pipeline{0, kind, std::move(f), std::move(plan), {}, 0.002, 0, 0, {}};
  }
  if (kind == PipelineKind::built_in) {
    const Mechanism m = read_mechanism(data("devices", machines[dice.bits() % std::size(machines)]));
    return machine_pipeline(m, 50, 1, 0.5, dice);
  }
  if (kind == PipelineKind::frame) {
    const auto f = outcome_of([&] { return measured_frame(seed, dice); });
    if (!f || f->sensors.empty() || f->loads.empty()) return {};
    return Pipeline{0, kind, *f, frame_plan(*f, dice), {}, 0.002, 0, 0, {}};
  }
  RandomDevice d = random_device(seed);
  if (kind == PipelineKind::nonlinear_machine) d = with_nonlinear_laws(std::move(d));
  d.mechanism.tolerances = {0.01, 0, 0.002, 0, 0, 0, {}};  // shifted seats would not close rigid loops
  return machine_pipeline(d.mechanism, d.load.head<3>().norm(), d.load.tail<3>().norm() + 1e-3 * d.unit, d.unit, dice);
}

}  // namespace

std::optional<Pipeline> random_pipeline(unsigned seed) {
  const auto kind = static_cast<PipelineKind>(seed % std::size(pipeline_kind_names));
  for (unsigned draw = 0; draw < most_draws; ++draw) {
    Dice dice(seed + 0x71BE11AEull * (draw + 1));
    const auto made = outcome_of([&] { return drawn(seed * most_draws + draw, kind, dice); });
    if (!made || !*made) continue;
    Pipeline p = **made;
    p.seed = seed, p.kind = kind;
    p.hidden = hide(p.subject, dice.chance(0.25) ? 0 : dice.chance(0.8) ? 1 : 2, dice);
    if (dice.chance(0.15)) p.outliers = 0.03;
    if (dice.chance(0.6)) p.spoilt = draw_spoilt(p.subject, dice);
    return p;
  }
  return {};
}

measurement::Measurements spoilt(measurement::Measurements m, const Spoilt& how, unsigned seed) {
  Dice dice(seed + 0xB1A2Cull);
  for (measurement::Reading& r : m.readings) {
    if (how.no_sequence) r.sequence.reset();
    if (how.no_sigma) r.sigma_u.reset(), r.sigma_th.reset();
    std::vector<std::optional<double>*> cells;
    if (r.sensors.empty())
      for (auto& each : r.displacement) cells.push_back(&each);
    for (auto& each : r.sensors) cells.push_back(&each);
    const auto left = [&] { return std::count_if(cells.begin(), cells.end(), [](auto* c) { return c->has_value(); }); };
    for (const std::size_t k : how.channels)
      if (k < cells.size() && left() > 1) cells[k]->reset();
    for (auto* cell : cells)
      if (dice.chance(how.blank) && left() > 1) cell->reset();
  }
  return m;
}

}  // namespace deflect::attack
