// Springs apart from each other, each pushed and read by itself, and effects that change their readings as a function
// says: data and candidates of a diagnosis made by hand.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "msa/base/index.h"
#include "msa/frame/file/frame_file.h"
#include "validation/diagnosis/observations.h"
#include "validation/effects/effect.h"

namespace deflect::test::springs_apart {

/// What a spring reads over the unit in which changes are given: one standard deviation of both readings together. So
/// large that the changes by several effects, which multiply the readings, add up.
inline constexpr double reading_in_units = 1e5;

/// Each of 1e6 N/m, pushed by 100 N: it reads 0.1 mm, twice, with σ = √2 nm.
inline frame::FrameDescription springs(std::size_t count) {
  std::string nodes, supports, elastic, loads, sensors;
  for (std::size_t i = 0; i < count; ++i) {
    nodes += fmt::format("{}N{}: [{} m, 0 m, 0 m]", i ? ", " : "", i, i);
    supports += fmt::format("{}N{}: [uz, ry]", i ? ", " : "", i);
    elastic += fmt::format("{}s{}: {{node: N{}, ux: 1000 N/mm}}", i ? ", " : "", i, i);
    loads += fmt::format("{}N{}: {{fx: 100 N}}", i ? ", " : "", i);
    sensors += fmt::format("{}x{}: {{node: N{}, direction: ux, sigma: 1.4142135623730951e-6 mm}}", i ? ", " : "", i, i);
  }
  return frame::parse_frame(fmt::format("name: springs\nplane: xz\nnodes: {{{}}}\nsupports: {{{}}}\nsprings: {{{}}}\n"
                                        "loads: {{push: {{nodes: {{{}}}}}}}\nsensors: {{{}}}\n",
                                        nodes, supports, elastic, loads, sensors),
                            "springs.yaml");
}

/// The readings of the springs, changed by so many units.
inline measurement::Measurements readings(const subject::Subject& s, const VectorX& change) {
  std::string csv = "load.push";
  for (Eigen::Index i = 0; i < change.size(); ++i) csv += fmt::format(",x{}_mm", i);
  for (int twice = 0; twice < 2; ++twice) {
    csv += "\n1";
    for (const double c : change) csv += fmt::format(",{:.17g}", 0.1 * (1 + c / reading_in_units));
  }
  return s.placed(measurement::parse_measurements(csv + "\n", "readings.csv", s.instruments()));
}

/// With these parameters it changes the readings of the springs by `change` of their values, in units.
inline effects::Effect effect(const std::string& name, std::vector<effects::EffectParameter> parameters,
                              std::function<VectorX(const VectorX&)> change) {
  effects::Effect e;
  e.name = e.title = name;
  e.scope = effects::Scope::machine;
  e.parameters = std::move(parameters);
  e.edits_at = [change = std::move(change)](const VectorX& values) {
    const VectorX c = change(values);
    std::vector<effects::EffectEdit> out;
    for (Eigen::Index i = 0; i < c.size(); ++i)
      out.push_back({effects::EffectEdit::Action::multiply,
                     {fmt::format("springs.s{}.ux.stiffness", i)},
                     fmt::format("{:.17g}", 1 / (1 + c(i) / reading_in_units))});
    return out;
  };
  VectorX start(std::ssize(e.parameters));
  for (Eigen::Index i = 0; i < start.size(); ++i) start(i) = nth(e.parameters, i).start;
  e.edits = e.edits_at(start);
  return e;
}

/// Linear, between these bounds.
inline effects::EffectParameter parameter(const std::string& name, double start, double low, double high,
                                          std::optional<double> vanishes) {
  effects::EffectParameter p;
  p.name = name;
  p.start = start, p.low = low, p.high = high;
  p.vanishes = vanishes;
  return p;
}

/// Proportional to its size, of either sign: a change of `size` along a direction.
inline effects::Effect along(const std::string& name, const VectorX& direction) {
  return effect(name, {parameter("size", 1, -1000, 1000, 0.0)},
                [direction](const VectorX& values) { return VectorX(values(0) * direction); });
}

/// Springs with these changes of their readings, and all that is compared with them.
struct Seen {
  std::shared_ptr<const measurement::Measurements> data;  // to which the observations point
  diagnosis::Observations observations;
};

inline Seen seen(const VectorX& change) {
  const subject::Subject s = springs(as_size(change.size()));
  const auto data = std::make_shared<const measurement::Measurements>(readings(s, change));
  compare::ComparisonOptions o;
  o.as_recorded = true;
  return {data, diagnosis::Observations(s, *data, o)};
}

}  // namespace deflect::test::springs_apart
