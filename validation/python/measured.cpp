#include <fmt/format.h>
#include <fmt/ranges.h>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "validation/compare/history.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/effects/effect_file.h"
#include "validation/fit/fit.h"
#include "validation/fit/fit_file.h"
#include "validation/fit/plan_of_one.h"
#include "validation/fit/predicted.h"
#include "validation/python/bindings.h"
#include "validation/python/interruptible.h"
#include "validation/python/mechanism.h"
#include "validation/report/compare_results.h"
#include "validation/report/diagnosis_results.h"
#include "validation/report/history_results.h"
#include "validation/report/validity/fit_results.h"
#include "validation/report/validity/predict_results.h"
#include "validation/report/validity/validity_results.h"
#include "validation/validity/validation.h"

namespace deflect::python {

namespace py = pybind11;
using measurement::Measurements;
using subject::Subject;

std::optional<double> Noise::translation() const {
  if (!sigma_mm) return std::nullopt;
  if (!(*sigma_mm > 0))
    throw InputError(fmt::format("sigma = {}: give a standard deviation above zero, in mm", *sigma_mm));
  return *sigma_mm / 1e3;
}

std::optional<double> Noise::rotation() const {
  if (sigma_rad && !(*sigma_rad > 0))
    throw InputError(fmt::format("sigma_rotation = {}: give a standard deviation above zero, in rad", *sigma_rad));
  return sigma_rad;
}

namespace {

compare::ComparisonOptions comparison_options(const Noise& n) { return {n.translation(), n.rotation(), n.as_recorded}; }

/// A JSON of the contract, and what a person reads.
using Told = std::pair<std::string, std::string>;

/// The same, and the table of residuals.
std::tuple<std::string, std::string, std::string> compare(const Subject& s, const NamedText& csv, const Noise& noise,
                                                          int threads, const py::object& progress) {
  return interruptible(progress, [&](const auto& told) {
    const Measurements data = data_of(s, csv);
    const compare::Comparison c = compare::compare(s, data, comparison_options(noise), {threads, nullptr, told});
    return std::tuple(report::compare_json(c), report::compare_report(c), report::residuals_csv(c));
  });
}

struct ValidityAsked {
  std::optional<NamedText> calibration, use, fit;
  std::vector<std::string> free;
  std::string yaml;
};

Told validity(const Subject& s, const NamedText& csv, const Noise& noise, const ValidityAsked& a, int threads,
              const py::object& progress) {
  if (a.calibration && a.calibration->first == csv.first)
    throw InputError("calibration: this is the validation data: what a model was calibrated with cannot validate it");
  return interruptible(progress, [&](const auto& told) {
    const Measurements data = data_of(s, csv);
    validity::ValidationOptions o;
    o.comparison = comparison_options(noise);
    std::optional<Measurements> calibration, use;
    if (a.calibration) calibration = data_of(s, *a.calibration), o.calibration = &*calibration;
    if (a.use) use = plan_of(s, *a.use), o.use = &*use;
    if (a.fit) o.fit = fit::read_fit(a.fit->first, a.fit->second, s);
    if (!a.free.empty()) o.parameters = fit::free_parameters(s, a.free, {}, a.yaml);
    const validity::ValidationStudy v = validity::validate(s, data, o, {threads, nullptr, told});
    return Told(report::validity_json(v), report::validity_report(v));
  });
}

Told diagnose(const Subject& s, const std::vector<NamedText>& sessions, const EffectSources& effects,
              const Noise& noise, int bootstrap, int threads, const py::object& progress) {
  if (bootstrap < 99) throw InputError(fmt::format("bootstrap = {}: give a whole number of at least 99", bootstrap));
  return interruptible(progress, [&](const auto& told) {
    const Measurements data = data_of(s, sessions);
    const std::vector<effects::Effect> known = effects.known(s);
    const diagnosis::Diagnosis d =
        diagnosis::diagnose(s, data, known, {comparison_options(noise), bootstrap}, {threads, nullptr, told});
    return Told(report::diagnosis_json(d), report::diagnosis_report(d, s.name(), data.origin));
  });
}

Told history(const std::vector<Subject>& versions, const NamedText& csv, const Noise& noise, int threads,
             const py::object& progress) {
  if (versions.empty()) throw InputError("models: give at least one version");
  return interruptible(progress, [&](const auto& told) {
    const Measurements data = data_of(versions.front(), csv);
    const parallel::Work work{threads, nullptr, told};
    const auto n = static_cast<double>(versions.size());
    std::vector<compare::Comparison> all;
    for (const Subject& s : versions) {
      const auto done = static_cast<double>(all.size());
      all.push_back(compare::compare(s, data, comparison_options(noise), work.part(done / n, (done + 1) / n)));
    }
    const compare::History h = compare::history(all);
    return Told(report::history_json(h), report::history_report(h));
  });
}

struct Fitted {
  Told told;
  Subject subject;
};

/// What a user sets free: paths and names of effects, with the effects; the search begins at values given.
struct FreeAsked {
  std::vector<std::string> free, priors;
  std::string yaml;  ///< of the subject, for the units
  EffectSources sources;
  std::vector<AskedEffect> effects;

  std::vector<fit::FreeParameter> parameters(const Subject& s) const {
    std::map<std::string, fit::FreedEffect> freed;
    if (!effects.empty()) {
      const std::vector<effects::Effect> known = sources.known(s);
      for (const AskedEffect& asked : effects) {
        effects::Effect e = effects::find_effect(known, asked.name);
        const VectorX start = instance_of(e, asked).values;
        for (std::size_t i = 0; i < e.parameters.size(); ++i) e.parameters[i].start = start(as_index(i));
        const fit::FreedEffect each{std::make_shared<const effects::Effect>(std::move(e)), asked.leg};
        freed.emplace(each.name(), each);
      }
    }
    return fit::free_parameters(s, free, priors, yaml, freed);
  }
};

Fitted fit(const Subject& s, const NamedText& csv, const FreeAsked& free, const Noise& noise, int threads,
           const py::object& progress) {
  return interruptible(progress, [&](const auto& told) {
    const std::vector<fit::FreeParameter> parameters = free.parameters(s);
    const Measurements data = data_of(s, csv);
    const fit::FitResult r = fit::fit(s, data, parameters, comparison_options(noise), {threads, nullptr, told});
    return Fitted{{report::fit_json(r), report::fit_report(r)}, fit::with_values(s, parameters, fit::fitted_values(r))};
  });
}

/// What is to be predicted: a plan; or of a machine one pose, of a frame factors on load cases.
struct PredictAsked {
  std::optional<NamedText> plan;
  Asked at;
  std::vector<double> load;
  std::vector<std::pair<std::string, double>> factors;

  Measurements of(const Subject& s) const {
    if (plan) return plan_of(s, *plan);
    if (s.frame()) return fit::plan_of_one(s, factors);
    return fit::plan_of_one(stand_of(*s.machine(), at), wrench_from_mm(load_from(load)), !at.joints.empty());
  }
};

Told predict(const Subject& s, const PredictAsked& asked, const std::optional<NamedText>& fit,
             const std::optional<EffectSources>& sources, const Noise& noise, const std::vector<std::string>& theories,
             int threads, const py::object& progress) {
  return interruptible(progress, [&](const auto& told) {
    std::optional<fit::Knowledge> known;
    if (fit)
      known = fit::read_fit(fit->first, fit->second, s, sources ? sources->known(s) : std::vector<effects::Effect>());
    fit::PredictedPlanOptions o;
    o.theories = theories::theories_named(fmt::format("{}", fmt::join(theories, ",")));
    o.sigma_u = noise.translation();
    o.sigma_th = noise.rotation();
    const fit::PredictedPlan p = fit::predict(s, asked.of(s), known, o, {threads, nullptr, told});
    return Told(report::predict_json(p), report::predict_report(p));
  });
}

}  // namespace

void bind_measured(py::module_& m) {
  py::class_<Noise>(m, "Noise")
      .def(py::init([](std::optional<double> sigma_mm, std::optional<double> sigma_rad, bool as_recorded) {
        const Noise noise{sigma_mm, sigma_rad, as_recorded};
        (void)noise.translation(), (void)noise.rotation();
        return noise;
      }));
  m.def("compare", &compare);
  m.def("validity", [](const Subject& s, const NamedText& csv, const Noise& noise, std::optional<NamedText> calibration,
                       std::optional<NamedText> use, std::optional<NamedText> fit, std::vector<std::string> free,
                       std::string yaml, int threads, const py::object& progress) {
    const ValidityAsked asked{std::move(calibration), std::move(use), std::move(fit), std::move(free), std::move(yaml)};
    return validity(s, csv, noise, asked, threads, progress);
  });
  m.def("diagnose", &diagnose);
  m.def("history", &history);
  py::class_<FreeAsked>(m, "FreeAsked")
      .def(py::init([](std::vector<std::string> free, std::vector<std::string> priors, std::string yaml,
                       EffectSources sources, std::vector<AskedEffect> effects) {
        return FreeAsked{std::move(free), std::move(priors), std::move(yaml), std::move(sources), std::move(effects)};
      }));
  m.def("fit", [](const Subject& s, const NamedText& csv, const FreeAsked& free, const Noise& noise, int threads,
                  const py::object& progress) {
    const Fitted f = fit(s, csv, free, noise, threads, progress);
    return py::make_tuple(f.told.first, f.told.second, f.subject);
  });
  py::class_<PredictAsked>(m, "PredictAsked")
      .def(py::init([](std::optional<NamedText> plan, Asked at, std::vector<double> load,
                       std::vector<std::pair<std::string, double>> factors) {
        return PredictAsked{std::move(plan), std::move(at), std::move(load), std::move(factors)};
      }));
  m.def("predict", &predict);
}

}  // namespace deflect::python
