#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "analytic/constraint.h"
#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/number_words.h"
#include "msa/base/outcome.h"
#include "msa/base/units.h"
#include "msa/fields/yaml_tree.h"
#include "msa/mechanism/configuration.h"
#include "validation/cli/command.h"
#include "validation/cli/commands/effects.h"
#include "validation/cli/devices.h"
#include "validation/cli/made_by.h"
#include "validation/cli/talk.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/with_effect.h"
#include "validation/measurement/configure_all.h"
#include "validation/measurement/number_limits.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/report/effect_results.h"
#include "validation/subject/simulate_frame.h"

namespace deflect::cli {
namespace {

constexpr double most_noise_mm = 1000, most_tolerances = 1000;
constexpr double most_seed = 9e15;  // whole numbers up to 2^53 are told apart

/// A file with such a standard deviation could not be read.
bool is_too_little(double sigma) { return sigma > 0 && sigma <= measurement::least_sigma; }

struct SimulateArguments {
  std::string device, out, json, campaign = "rich", geometry = "finite", temperature, noise_rad, machine;
  std::vector<std::string> with, files;
  bool heavy_tails = false;
  double seed = 1, noise_mm = 0.002, tolerances = 1, outliers = 0, force = 50, elements = 4, threads = 0;
};

/// "EFFECT,leg=4,name=value,…": parameters that are not named keep the value at which a search begins.
effects::EffectInstance parse_with(const std::string& text, const std::vector<effects::Effect>& all) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    words.push_back(text.substr(at, comma - at));
    at = comma + 1;
  }
  const effects::Effect& effect = effects::find_effect(all, words.front());
  effects::EffectInstance out{{&effect, {}}, effects::start_values(effect)};
  std::vector<std::string> names = {"leg"};
  for (const effects::EffectParameter& p : effect.parameters) names.push_back(p.name);
  std::vector<bool> given(names.size());
  for (auto word = words.begin() + 1; word != words.end(); ++word) {
    const std::size_t equals = word->find('=');
    if (equals == word->npos)
      throw InputError(fmt::format("--with '{}': write name=value after '{}'", text, effect.name));
    const std::string name = word->substr(0, equals);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      throw InputError(
          fmt::format("--with '{}': {} has no parameter '{}'{}", text, effect.name, name, suggestion(name, names)));
    const auto at = as_size(found - names.begin());
    if (given[at]) throw InputError(fmt::format("--with '{}': '{}' is set twice", text, name));
    given[at] = true;
    const double value = told_at<InputError>([&] { return fmt::format("--with '{}': ", text); },
                                             [&] { return parse_number(std::string_view(*word).substr(equals + 1)); });
    if (at == 0) {
      out.leg = whole("--with leg", value, 1, 1000);
      continue;
    }
    effects::require_in_bounds(fmt::format("--with '{}': {}={:g}", text, name, value), effect,
                               effect.parameters[at - 1], value);
    out.values(as_index(at - 1)) = value;
  }
  return out;
}

prediction::SimulationOptions options_of(const SimulateArguments& a) {
  prediction::SimulationOptions o;
  if (!(a.seed >= 0 && a.seed <= most_seed) || a.seed != std::floor(a.seed))
    throw InputError(fmt::format("--seed {:.16g}: give a whole number from 0 to {:.16g}", a.seed, most_seed));
  o.seed = static_cast<std::uint64_t>(a.seed);
  if (!a.machine.empty())
    o.machine = static_cast<std::uint64_t>(
        whole("--machine", parse_list("--machine", a.machine, {1}, "a whole number")[0], 0, 1e9));
  if (!(a.noise_mm >= 0 && a.noise_mm <= most_noise_mm) || is_too_little(a.noise_mm / 1e3))
    throw InputError(fmt::format("--noise {}: give 0, or a value from {} to {} mm", a.noise_mm,
                                 1e3 * measurement::least_sigma, most_noise_mm));
  o.sigma_u = a.noise_mm / 1e3;
  if (!a.noise_rad.empty()) {
    o.sigma_th = parse_list("--noise-rotation", a.noise_rad, {1}, "rad")[0];
    if (!(*o.sigma_th >= 0 && *o.sigma_th <= 1) || is_too_little(*o.sigma_th))
      throw InputError(fmt::format("--noise-rotation {}: give 0, or a value from {} to 1 rad", a.noise_rad,
                                   measurement::least_sigma));
  }
  if (!(a.tolerances >= 0 && a.tolerances <= most_tolerances))
    throw InputError(fmt::format("--tolerances {}: give a factor from 0 to {}", a.tolerances, most_tolerances));
  o.tolerances = a.tolerances;
  if (!(a.outliers >= 0 && a.outliers < 0.5))
    throw InputError(fmt::format("--outliers {}: give a share from 0 to 0.5", a.outliers));
  o.outliers = a.outliers;
  o.heavy_tails = a.heavy_tails;
  if (!a.temperature.empty()) {
    const std::vector<double> t = parse_list("--temperature", a.temperature, {1, 2}, "mean or mean,swing in deg C");
    o.temperature = t[0];
    if (t.size() > 1) o.swing = t[1];
    if (const double coldest = o.temperature - std::abs(o.swing); coldest < -273.15 || !std::isfinite(coldest))
      throw InputError(fmt::format("--temperature {}: colder than -273.15 deg C", a.temperature));
  }
  o.geometry = parse_geometry(a.geometry);
  return o;
}

bool is_named(const std::string& campaign) {
  return std::find(std::begin(prediction::campaign_names), std::end(prediction::campaign_names), campaign) !=
         std::end(prediction::campaign_names);
}

measurement::Measurements plan_of(const SimulateArguments& a, const Mechanism& m, std::uint64_t seed) {
  if (!is_named(a.campaign) && std::filesystem::exists(a.campaign)) return read_plan(a.campaign, m);
  if (!(std::isfinite(a.force) && a.force != 0))
    throw InputError(fmt::format("--force {}: give a force in N other than zero", a.force));
  return prediction::campaign(a.campaign, m, a.force, seed);
}

/// What to say of loads that are too large: what the machine carries.
std::string way_out(const Mechanism& m, const measurement::Measurements& plan, const prediction::SimulationOptions& o,
                    const SimulateArguments& a) {
  const double share = prediction::share_carried(m, plan, o);
  if (share == 0 || share == 1) return "";
  const bool named = plan.origin == "campaign";
  return fmt::format(": of the machine as drawn equilibria are found up to {} % of the loads{}",
                     digits_of(100 * share, 2),
                     named ? fmt::format(", --force {} N", digits_of(share * a.force, 2)) : "");
}

/// What to say where the machine as built cannot take a pose of the plan: nothing where the machine as drawn cannot
/// either. An over-constrained machine is assembled without strain only where its positions and lengths are exact.
std::string way_to_assemble(const Mechanism& m, const measurement::Measurements& plan, double tolerances) {
  if (tolerances == 0) return "";
  const auto drawn = outcome_of<ModelError>([&] { return measurement::configure_all(m, plan); });
  if (!drawn) return "";
  const int redundant = drawn->empty() ? 0 : analytic::redundant_constraints(drawn->front());
  const std::string remedy = "build it as drawn with --tolerances 0, or with smaller ones, such as --tolerances 0.1";
  if (redundant == 0)
    return fmt::format(": the machine as drawn can, the deviations within its tolerances are too large for it: {}",
                       remedy);
  return fmt::format(
      ": the machine as drawn can. It is over-constrained ({} more constraint{} than hold it), so that deviations of "
      "positions and lengths leave its loops open: take those tolerances out of the device (joint_position, "
      "link_length, member.length, …), or build it as drawn with --tolerances 0",
      redundant, redundant == 1 ? "" : "s");
}

/// simulate(); its refusals with the way out.
measurement::Measurements readings_of(const Mechanism& m, const measurement::Measurements& plan,
                                      const prediction::SimulationOptions& o, const SimulateArguments& a,
                                      const parallel::Work& work) {
  const auto assembled = [&] {
    auto made = outcome_of<ModelError>([&] { return prediction::simulate(m, plan, o, work); });
    if (!made) throw ModelError(made.why + way_to_assemble(m, plan, o.tolerances), made.cause);
    return std::move(*made);
  };
  auto made = outcome_of<NumericalError>(assembled);
  if (!made) throw NumericalError(made.why + way_out(m, plan, o, a));
  return std::move(*made);
}

void tell_done(const SimulateArguments& a, const measurement::Measurements& data, const std::string& name,
               const std::string& hidden, const std::vector<effects::EffectInstance>& added, std::uint64_t seed) {
  say_new_folder(a.out);
  measurement::write_measurements(a.out, data);
  if (!a.json.empty())
    write_result(a.json, report::simulated_json(a.device, a.out, data.readings.size(), data.poses.size(), added, seed));
  const std::string poses = data.instruments.stationary ? "" : fmt::format(" at {} poses", data.poses.size());
  fmt::print("{}: {} readings{} of {}{}, seed {}\n", a.out, data.readings.size(), poses, name,
             hidden.empty() ? ", nothing hidden" : " with " + hidden, seed);
}

/// A frame is computed in the geometry that its file names.
void run_frame(const SimulateArguments& a, subject::Subject s) {
  const std::vector<effects::Effect> all = known_effects(a.files, s);
  const prediction::SimulationOptions o = options_of(a);
  if (a.force != SimulateArguments().force)
    throw InputError(
        "--force is for machines: a frame is loaded by its load cases; give their loads in the frame file");
  measurement::Measurements plan = !is_named(a.campaign) && std::filesystem::exists(a.campaign)
                                       ? read_plan(a.campaign, s)
                                       : subject::frame_campaign(a.campaign, *s.frame(), o.seed);
  std::string hidden;
  std::vector<effects::EffectInstance> added;
  for (const std::string& text : a.with) {
    const effects::EffectInstance effect = parse_with(text, all);
    added.push_back(effect);
    s = effects::with_effect(s, effect);
    hidden += fmt::format("{}{}", hidden.empty() ? "" : ", ", effect.effect->name);
  }
  const measurement::Measurements data =
      timed("simulate: MSA at every reading", [&] { return subject::simulate_frame(*s.frame(), plan, o); });
  tell_done(a, data, s.name(), hidden, added, o.seed);
}

void run(const SimulateArguments& a) {
  const subject::Subject given = read_subject(a.device);
  if (given.frame()) return run_frame(a, given);
  Mechanism m = *given.machine();
  const std::vector<effects::Effect> all = known_effects(a.files, m);
  prediction::SimulationOptions o = options_of(a);
  measurement::Measurements plan = plan_of(a, m, o.seed);
  std::string hidden;
  std::vector<effects::EffectInstance> added;
  for (const std::string& text : a.with) {
    const effects::EffectInstance effect = parse_with(text, all);
    added.push_back(effect);
    m = effects::with_effect(m, effect);
    tell("hidden: {} ({})", effect.effect->name, effects::site_of(effect));
    if (effects::is_geometry(*effect.effect)) o.geometry = m.geometry;
    hidden += fmt::format("{}{} ({})", hidden.empty() ? "" : ", ", effect.effect->name, effects::site_of(effect));
  }
  o.division = frame::equal_division(configure(m, home_pose(m)), whole("--elements", a.elements, 1, 1000));
  tell("campaign {}: {} readings; {} elements per member, geometry {}", a.campaign, plan.readings.size(), a.elements,
       nth(geometry_names, o.geometry));
  const int threads = parse_threads(a.threads);
  const measurement::Measurements data = timed_with_progress("simulate: MSA at every reading", [&](const auto& told) {
    return readings_of(m, plan, o, a, {threads, nullptr, told});
  });
  tell_done(a, data, m.name, hidden, added, o.seed);
}

}  // namespace

Command simulate_command() {
  auto a = std::make_shared<SimulateArguments>();
  return {
      "simulate",
      "Simulate measurements of a device, as a laboratory would deliver them. The device contains hidden effects, its "
      "parts deviate from the drawing within their tolerances, and the readings are noisy. The MSA computes them in "
      "the deformed shape. The same seed gives the same file",
      "deflect simulate haptic-6psu-ideal-joints --with joint_clearance,gap_mm=0.01 --campaign rich --seed 7 -o "
      "hidden.csv",
      {{"device", "DEVICE", "built-in device or frame, or a file of one", &a->device, true},
       {"--with", "EFFECT,NAME=VALUE,...",
        "hide an effect with values of its parameters, and leg=4 if it is of one leg; repeat for several effects",
        &a->with},
       {"--effects", "FILE", "your own effect files, in addition to the catalogue", &a->files},
       {"--campaign", "paper|cycle|rich|random|FILE",
        "paper (27 readings), cycle (432, loading and unloading), rich (720, the default), random (280), or for a "
        "frame the "
        "same kinds made of its load cases; or a "
        "measurement file that gives poses, loads, sequence and temperatures",
        &a->campaign},
       {"--force", "N", "largest force of a named campaign (default 50)", &a->force},
       {"--noise", "MM", "standard deviation of a translation in mm (default 0.002)", &a->noise_mm},
       {"--noise-rotation", "RAD", "measure rotations too, with this standard deviation", &a->noise_rad},
       {"--heavy-tails", "",
        "noise with heavy tails, of the same standard deviation: Student's t with three degrees of freedom",
        &a->heavy_tails},
       {"--tolerances", "FACTOR", "factor on the device's tolerances (default 1; 0: built as drawn)", &a->tolerances},
       {"--outliers", "SHARE", "share of gross outliers, 10 to 30 standard deviations (default 0)", &a->outliers},
       {"--temperature", "MEAN,SWING", "deg C: mean, and amplitude of a slow wave about it (default 20)",
        &a->temperature},
       {"--geometry", "linear|second-order|finite", "shape in which forces balance (default finite)", &a->geometry},
       {"--elements", "N", "elements per member (default 4)", &a->elements},
       {"--seed", "N", "seed of all random numbers (default 1)", &a->seed},
       {"--machine", "N",
        "seed of the machine that is built within the tolerances (default: --seed); campaigns with the same N and "
        "another --seed are of one machine",
        &a->machine},
       {"--threads", "N", "threads (default 0: all cores); they do not change the file", &a->threads},
       {"-o,--output", "DATA", "file to write", &a->out, true},
       {"--json", "FILE", "write what was hidden, the seed, and the hash of the file", &a->json}},
      [a] { run(*a); }};
}

}  // namespace deflect::cli
