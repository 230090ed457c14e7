#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "validation/diagnosis/found_effects.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/with_effect.h"
#include "validation/measurement/parse_plan.h"
#include "validation/plan/foresight.h"
#include "validation/plan/next_readings.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"
#include "validation/python/bindings.h"
#include "validation/python/interruptible.h"
#include "validation/python/mechanism.h"
#include "validation/report/effect_results.h"
#include "validation/report/plan/foresight_results.h"
#include "validation/report/plan/plan_results.h"
#include "validation/subject/simulate_frame.h"

namespace deflect::python {

namespace py = pybind11;
using measurement::Measurements;
using subject::Subject;

namespace {

bool is_campaign(const std::string& name) {
  return std::any_of(std::begin(prediction::campaign_names), std::end(prediction::campaign_names),
                     [&](const char* each) { return name == each; });
}

/// A built-in campaign by its name, else a plan: then the text of a file.
Measurements campaign_of(const Subject& s, const std::string& name, const std::optional<NamedText>& plan, double force,
                         std::uint64_t seed) {
  if (plan) return plan_of(s, *plan);
  if (s.frame()) return subject::frame_campaign(name, *s.frame(), seed);
  if (!(std::isfinite(force) && force != 0))
    throw InputError(fmt::format("force = {}: give a force in N other than zero", force));
  return prediction::campaign(name, *s.machine(), force, seed);
}

void require_between(const char* what, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw InputError(fmt::format("{} = {:g}: give a value from {:g} to {:g}", what, value, low, high));
}

struct SimulateAsked {
  std::vector<AskedEffect> hidden;
  std::string campaign;
  std::optional<NamedText> plan;
  double force_N = 50;
  int elements = 4;
  prediction::SimulationOptions options = {};
};

std::vector<effects::EffectInstance> instances(const std::vector<AskedEffect>& asked,
                                               const std::vector<effects::Effect>& known) {
  std::vector<effects::EffectInstance> out;
  for (const AskedEffect& each : asked) out.push_back(instance_of(effects::find_effect(known, each.name), each));
  return out;
}

/// The measurements as a file, and the JSON of what is hidden in them.
std::pair<std::string, std::string> simulate(const Subject& given, const SimulateAsked& asked,
                                             const EffectSources& sources, int threads, const py::object& progress) {
  return interruptible(progress, [&](const auto& told) {
    const std::vector<effects::Effect> known = sources.known(given);
    prediction::SimulationOptions o = asked.options;
    const Measurements plan = campaign_of(given, asked.campaign, asked.plan, asked.force_N, o.seed);
    const std::vector<effects::EffectInstance> hidden = instances(asked.hidden, known);
    Subject s = given;
    for (const effects::EffectInstance& e : hidden) {
      s = effects::with_effect(s, e);
      if (s.machine() && effects::is_geometry(*e.effect)) o.geometry = s.machine()->geometry;
    }
    Measurements data;
    if (s.frame()) {
      data = subject::simulate_frame(*s.frame(), plan, o);
    } else {
      const Mechanism& m = *s.machine();
      o.division = frame::equal_division(configure(m, home_pose(m)), asked.elements);
      data = prediction::simulate(m, plan, o, {threads, nullptr, told});
    }
    return std::pair(measurement::measurements_text(data),
                     report::simulated_json(given.name(), "", data.readings.size(), data.poses.size(), hidden, o.seed));
  });
}

struct PlanAsked {
  plan::Limits limits;
  std::optional<NamedText> poses;  ///< for the limits
  std::size_t most_poses = 0;
  std::uint64_t seed = 1;

  plan::Limits limits_of(const Subject& s) const {
    plan::Limits out = limits;
    if (poses) out.poses = plan_of(s, *poses);
    return out;
  }
};

/// JSON, report for a person, and the readings as a file to be filled in.
using Planned = std::tuple<std::string, std::string, std::string>;

Planned foresight(const Subject& s, const std::string& campaign, const std::optional<NamedText>& plan,
                  const std::optional<NamedText>& use, const std::string& aim, const Noise& noise,
                  const PlanAsked& asked, const EffectSources& sources, int threads, const py::object& progress) {
  if (aim != "effects" && aim != "precision")
    throw InputError(fmt::format("aim '{}': write effects or precision", aim));
  return interruptible(progress, [&](const auto& told) {
    std::vector<effects::Effect> effects = sources.known(s);
    if (s.machine()) std::erase_if(effects, [](const effects::Effect& e) { return e.place.has_value(); });
    plan::ForesightOptions o;
    o.limits = asked.limits_of(s);
    o.sigma_u = noise.translation().value_or(o.sigma_u);
    o.sigma_th = noise.rotation();
    if (use) o.use = plan_of(s, *use);
    o.toward = aim == "effects" ? plan::Toward::effects : plan::Toward::precision;
    o.most_poses = asked.most_poses;
    o.seed = asked.seed;
    Measurements given = plan ? s.placed(measurement::parse_campaign(plan->first, plan->second, s.instruments()))
                              : campaign_of(s, campaign, plan, o.limits.force.value_or(50), o.seed);
    if (!plan) given.origin = fmt::format("the campaign {}", campaign);
    const plan::Foresight f = plan::foresight(s, given, effects, o, {threads, nullptr, told});
    return Planned(report::foresight_json(f), report::foresight_report(f),
                   measurement::measurements_text(f.better.readings, f.read));
  });
}

struct NextAsked {
  NamedText diagnosis;
  std::vector<NamedText> data;  ///< its sessions
  int group = 1;
  std::size_t readings = 30;
  double probability = 0.95;
};

const diagnosis::FoundTie& tie_of(const NextAsked& a, const diagnosis::FoundEffects& found) {
  if (found.ties.empty())
    throw InputError("no effects are tied in this diagnosis; give before=CAMPAIGN to plan before measuring");
  require_between("group", a.group, 1, static_cast<double>(found.ties.size()));
  return found.ties[as_size(a.group - 1)];
}

Planned next_readings(const Subject& s, const NextAsked& a, const Noise& noise, const PlanAsked& asked,
                      const EffectSources& sources, int threads, const py::object& progress) {
  return interruptible(progress, [&](const auto& told) {
    const std::vector<effects::Effect> effects = sources.known(s);
    const diagnosis::FoundEffects found = diagnosis::parse_found_effects(a.diagnosis.first, a.diagnosis.second);
    plan::PlanOptions o;
    o.limits = asked.limits_of(s);
    o.noise = {noise.translation(), noise.rotation()};
    o.readings = a.readings;
    o.most_poses = asked.most_poses;
    o.seed = asked.seed;
    require_between("probability", a.probability, 1e-12, 1);
    o.probability = a.probability;
    const plan::Plan p = plan::next_readings(s, data_of(s, a.data), plan::rivals_of(tie_of(a, found), effects), o,
                                             {threads, nullptr, told});
    const std::string file =
        p.readings.readings.empty() ? std::string() : measurement::measurements_text(p.readings, p.read);
    return Planned(report::plan_json(p), report::plan_report(p), file);
  });
}

SimulateAsked simulate_asked(std::vector<AskedEffect> hidden, std::string campaign, std::optional<NamedText> plan,
                             const py::dict& o) {
  constexpr double most_noise_mm = 1000, most_tolerances = 1000;
  SimulateAsked out{std::move(hidden), std::move(campaign), std::move(plan)};
  out.force_N = o["force"].cast<double>();
  out.elements = o["elements"].cast<int>();
  out.options.seed = o["seed"].cast<std::uint64_t>();
  out.options.machine = o["machine"].cast<std::optional<std::uint64_t>>();
  out.options.sigma_u = o["noise"].cast<double>() / 1e3;
  out.options.sigma_th = o["noise_rotation"].cast<std::optional<double>>();
  out.options.tolerances = o["tolerances"].cast<double>();
  out.options.outliers = o["outliers"].cast<double>();
  std::tie(out.options.temperature, out.options.swing) = o["temperature"].cast<std::pair<double, double>>();
  out.options.geometry = geometry_of(o["geometry"].cast<std::string>());
  require_between("noise", 1e3 * out.options.sigma_u, 0, most_noise_mm);
  require_between("noise_rotation", out.options.sigma_th.value_or(0), 0, 1);
  require_between("tolerances", out.options.tolerances, 0, most_tolerances);
  require_between("outliers", out.options.outliers, 0, 0.5);
  require_between("elements", out.elements, 1, 1000);
  require_between("temperature", out.options.temperature - std::abs(out.options.swing), -273.15, 1e6);
  return out;
}

}  // namespace

void bind_campaigns(py::module_& m) {
  py::class_<SimulateAsked>(m, "SimulateAsked").def(py::init(&simulate_asked));
  py::class_<PlanAsked>(m, "PlanAsked")
      .def(py::init([](std::optional<double> force_N, std::optional<double> moment_Nmm, bool forces_only,
                       std::size_t cases, std::vector<std::string> nodes, bool as_measured,
                       std::optional<NamedText> poses, std::size_t most_poses, std::uint64_t seed) {
        PlanAsked out;
        out.limits.force = force_N;
        if (moment_Nmm) out.limits.moment = *moment_Nmm / 1e3;
        out.limits.forces_only = forces_only;
        out.limits.cases = cases;
        out.limits.nodes = std::move(nodes);
        out.limits.where = as_measured ? plan::Where::as_measured : plan::Where::workspace;
        out.poses = std::move(poses), out.most_poses = most_poses, out.seed = seed;
        return out;
      }));
  m.def("is_campaign", &is_campaign);
  m.def("simulate", &simulate);
  m.def("foresight", &foresight);
  m.def("data_of_diagnosis", [](const std::string& json, const std::string& origin) {
    return diagnosis::parse_found_effects(json, origin).data;
  });
  m.def("next_readings", [](const Subject& s, NamedText diagnosis, std::vector<NamedText> data, int group,
                            std::size_t readings, double probability, const Noise& noise, const PlanAsked& asked,
                            const EffectSources& sources, int threads, const py::object& progress) {
    const NextAsked next{std::move(diagnosis), std::move(data), group, readings, probability};
    return next_readings(s, next, noise, asked, sources, threads, progress);
  });
}

}  // namespace deflect::python
