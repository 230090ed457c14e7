#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/index.h"
#include "msa/base/units.h"
#include "msa/fields/file_kind.h"
#include "msa/frame/file/frame_file.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/questions.h"
#include "msa/mechanism/stand.h"
#include "validation/diagnosis/found_effects.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/place_effects.h"
#include "validation/effects/with_effect.h"
#include "validation/measurement/joined.h"
#include "validation/measurement/parse_plan.h"
#include "validation/python/bindings.h"
#include "validation/report/effect_results.h"

namespace deflect::python {

namespace py = pybind11;
using subject::Subject;

ComputedEffect::ComputedEffect(NamedText text, py::function f)
    : head(std::move(text)), edits(new py::function(std::move(f)), [](py::function* each) {
        const py::gil_scoped_acquire acquired;
        delete each;
      }) {}

effects::Effect ComputedEffect::effect() const {
  effects::Effect e = effects::parse_effect(head.first, head.second);
  e.edits_at = [f = edits, origin = head.second](const VectorX& values) {
    std::pair<bool, std::string> found;
    {
      const py::gil_scoped_acquire acquired;
      found = (*f)(std::vector<double>(values.begin(), values.end())).cast<std::pair<bool, std::string>>();
    }
    if (!found.first) throw InputError(fmt::format("{}: {}", origin, found.second));
    return found.second.empty() ? std::vector<effects::EffectEdit>()
                                : effects::parse_effect(found.second, origin).edits;
  };
  e.edits = e.edits_at(effects::start_values(e));
  return e;
}

std::vector<effects::Effect> EffectSources::named() const {
  std::vector<effects::Effect> all = effects::catalogue(catalogue);
  for (const auto& [text, origin] : own) effects::add_effect(all, effects::parse_effect(text, origin));
  for (const ComputedEffect& each : computed) effects::add_effect(all, each.effect());
  return all;
}

std::vector<effects::Effect> EffectSources::known(const Subject& s) const {
  std::vector<effects::Effect> all = named();
  for (effects::Effect& e : effects::place_effects(s, all)) all.push_back(std::move(e));
  return all;
}

effects::EffectInstance instance_of(const effects::Effect& e, const AskedEffect& asked) {
  diagnosis::FoundEffect found{asked.name, asked.leg, asked.values};
  const VectorX start = effects::start_values(e);
  for (std::size_t i = 0; i < e.parameters.size(); ++i) {
    const effects::EffectParameter& p = e.parameters[i];
    const auto given = std::find_if(asked.values.begin(), asked.values.end(),
                                    [&](const auto& value) { return value.first == p.name; });
    if (given == asked.values.end())
      found.parameters.emplace_back(p.name, start(as_index(i)));
    else
      effects::require_in_bounds(fmt::format("{}, {} = {:g}", e.name, p.name, given->second), e, p, given->second);
  }
  return diagnosis::instance(e, found);
}

Vector6 six(const char* what, const std::vector<double>& given, std::initializer_list<std::size_t> counts) {
  if (std::find(counts.begin(), counts.end(), given.size()) == counts.end())
    throw InputError(fmt::format("{}: {} numbers; {} are wanted", what, given.size(), fmt::join(counts, " or ")));
  Vector6 out = Vector6::Zero();
  for (Eigen::Index i = 0; const double x : given) {
    if (!std::isfinite(x)) throw InputError(fmt::format("{}: {} is no finite number", what, x));
    out(i++) = x;
  }
  return out;
}

Vector6 load_from(const std::vector<double>& given) {
  const Vector6 F = six("load", given);
  for (Eigen::Index i = 0; i < 6; ++i)
    if (const double most = i < 3 ? largest_force : 1e3 * largest_moment; std::abs(F(i)) > most)
      throw InputError(fmt::format("load: {:g} {} is too large: at most {:g}", F(i), i < 3 ? "N" : "Nmm", most));
  return F;
}

measurement::Measurements data_of(const Subject& s, const NamedText& csv) {
  return s.placed(measurement::parse_measurements(csv.first, csv.second, s.instruments()));
}

measurement::Measurements data_of(const Subject& s, const std::vector<NamedText>& sessions) {
  if (sessions.empty()) throw InputError("data: give at least one session");
  measurement::require_different(sessions);
  std::vector<measurement::Measurements> all;
  for (const NamedText& each : sessions) all.push_back(data_of(s, each));
  return s.placed(measurement::joined(all));
}

measurement::Measurements plan_of(const Subject& s, const NamedText& csv) {
  return s.placed(measurement::parse_plan(csv.first, csv.second, s.instruments()));
}

namespace {

Subject parse(const std::string& yaml, const std::string& origin, bool want_frame) {
  if (want_frame || kind_of(parse_yaml(yaml, origin)) == FileKind::frame) return frame::parse_frame(yaml, origin);
  return parse_mechanism(yaml, origin);
}

/// What a person should look at again: implausible materials.
std::vector<std::string> questions(const Subject& s) {
  std::vector<std::string> out;
  const auto ask = [&](const std::string& name, const Material& m) {
    if (const auto question = question_about(name, m)) out.push_back(*question);
  };
  if (s.machine())
    for (const auto& [name, material] : s.machine()->materials) ask(name, material);
  if (s.frame())
    for (const auto& [name, material] : s.frame()->materials) ask(name, material.elastic);
  return out;
}

std::string places_json(const Subject& s) {
  Json out = Json::array();
  for (const subject::Place& p : s.places()) {
    Json one = {{"id", subject::id_of(p)}, {"name", subject::name_of(p)}};
    one.update(report::place_json(p, p.leg));
    one["hold"] = p.hold == subject::Hold::rigid ? "rigid" : p.hold == subject::Hold::elastic ? "elastic" : "free";
    Json freedoms = Json::array();
    for (const std::size_t f : p.freedoms) freedoms.push_back(subject::freedom_name(p, f));
    one["freedoms"] = freedoms;
    out.push_back(std::move(one));
  }
  return out.dump();
}

std::vector<std::tuple<std::string, std::string, std::optional<double>>> sensors(const Subject& s) {
  std::vector<std::tuple<std::string, std::string, std::optional<double>>> out;
  for (const measurement::SensorChannel& c : s.instruments().sensors) {
    const measurement::QuantityRow& row = measurement::row_of(c.quantity);
    std::optional<double> sigma;
    if (c.sigma) sigma = *c.sigma * row.per_SI;
    out.emplace_back(c.name, row.unit, sigma);
  }
  return out;
}

Vector6 home(const Subject& s) {
  if (!s.machine()) throw InputError(s.name() + " is a frame: it has no tool point and no home pose");
  return mm_deg_from(home_pose(*s.machine()));
}

Subject edited(const Subject& s, const std::vector<std::tuple<std::string, std::string, std::string>>& edits) {
  const std::pair<const char*, Edit::Action> actions[] = {{"set", Edit::Action::set},
                                                          {"append", Edit::Action::append},
                                                          {"multiply", Edit::Action::multiply},
                                                          {"add", Edit::Action::add}};
  std::vector<Edit> all;
  for (const auto& edit : edits) {
    const std::string &path = std::get<0>(edit), &action = std::get<2>(edit);
    const auto found =
        std::find_if(std::begin(actions), std::end(actions), [&](const auto& a) { return action == a.first; });
    if (found == std::end(actions))
      throw InputError(fmt::format("edit '{}': '{}' is no action; write set, append, multiply or add", path, action));
    all.push_back({path, std::get<1>(edit), found->second});
  }
  return s.edited(all);
}

Subject with_effect(const Subject& s, const EffectSources& sources, const AskedEffect& asked) {
  const std::vector<effects::Effect> all = sources.known(s);
  const effects::Effect& effect = effects::find_effect(all, asked.name);
  return effects::with_effect(s, diagnosis::instance(effect, {asked.name, asked.leg, asked.values}));
}

}  // namespace

void bind_subjects(py::module_& m) {
  py::class_<ComputedEffect>(m, "ComputedEffect").def(py::init<NamedText, py::function>());
  py::class_<EffectSources>(m, "EffectSources")
      .def(py::init([](std::string catalogue, std::vector<NamedText> own, std::vector<ComputedEffect> computed) {
        return EffectSources{std::move(catalogue), std::move(own), std::move(computed)};
      }));
  py::class_<AskedEffect>(m, "AskedEffect")
      .def(py::init([](std::string name, std::optional<int> leg, std::vector<std::pair<std::string, double>> values) {
        return AskedEffect{std::move(name), leg, std::move(values)};
      }));
  py::class_<Subject>(m, "Subject")
      .def_property_readonly("name", &Subject::name)
      .def_property_readonly("about", &Subject::about)
      .def_property_readonly("is_frame", [](const Subject& s) { return s.frame() != nullptr; })
      .def_property_readonly("legs", &Subject::legs)
      .def_property_readonly("load_cases", [](const Subject& s) { return s.instruments().load_cases; })
      .def("yaml", &Subject::file_text)
      .def("named", &Subject::named)
      .def("home", &home)
      .def("questions", &questions)
      .def("places_json", &places_json)
      .def("sensors", &sensors)
      .def("edited", &edited)
      .def("with_effect", &with_effect);
  m.def("parse", &parse);
  m.def("read_text", [](const std::string& path) { return read_text(path); });
  m.def("suggestion", &suggestion);
  m.def("effects_json", [](const EffectSources& sources, const std::optional<Subject>& s) {
    if (s) return report::effects_json(sources.known(*s), s);
    return report::effects_json(sources.named(), std::nullopt);
  });
}

}  // namespace deflect::python
