#include "validation/subject/frame_readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_analysis.h"
#include "msa/frame/file/frame_fields.h"
#include "msa/frame/file/frame_sensors.h"

namespace deflect::subject {
namespace {

using frame::FrameDescription;
using frame::LoadCase;

template <class T>
const T& named(const Named<T>& list, const char* what, const std::string& name, const std::string& origin) {
  std::vector<std::string> known;
  for (const auto& [each, value] : list) {
    if (each == name) return value;
    known.push_back(each);
  }
  throw InputError(fmt::format("{}: {}", origin, frame::unknown_name(what, name, known)));
}

/// "node.B" without the beginning.
std::string node_of(const std::string& load_point) { return load_point.substr(load_point.find('.') + 1); }

std::vector<const frame::FrameSensor*> sensors_of(const FrameDescription& f, const measurement::Measurements& data) {
  std::vector<const frame::FrameSensor*> out;
  for (const measurement::SensorChannel& s : data.instruments.sensors)
    out.push_back(&named(f.sensors, "sensor", s.name, f.name));
  return out;
}

void add(LoadCase& sum, const LoadCase& each, double share) {
  const double times = share * each.factor;
  const Matrix3 turn = rotation_from_vector(each.turned);
  for (const auto& [node, wrench] : each.nodes) sum.nodes.emplace_back(node, times * frame::turned(each, wrench));
  for (const auto& [member, load] : each.members)
    sum.members.emplace_back(
        member, frame::LineLoad{times * (load.member_axes ? load.q : Vector3(turn * load.q)), load.member_axes});
  for (const auto& [member, kelvin] : each.temperature) sum.temperature.emplace_back(member, times * kelvin);
  sum.gravity += times * (turn * each.gravity);
  for (const auto& [node, values] : each.displacements) {
    auto found = std::find_if(sum.displacements.begin(), sum.displacements.end(),
                              [&name = node](const auto& other) { return other.first == name; });
    if (found == sum.displacements.end()) found = sum.displacements.insert(found, {node, {}});
    for (std::size_t i = 0; i < 6; ++i)
      if (values[i]) found->second[i] = found->second[i].value_or(0) + times * *values[i];
  }
}

// What a sum leaves of a factor of none: 0.1 + 0.2 − 0.3 is 6e-17. What so little moves is below the rounding of nodes.
constexpr double no_factor = 1e-12;

/// The loads of one reading, true ones.
LoadCase load_of(const FrameDescription& f, const measurement::Measurements& data, const measurement::Reading& r) {
  LoadCase out;
  for (std::size_t k = 0; k < r.factors.size(); ++k)
    if (std::abs(r.factors[k]) > no_factor)
      add(out, named(f.loads, "load case", data.instruments.load_cases[k], f.name), f.load_gain * r.factors[k]);
  for (std::size_t p = 0; p < r.at_points.size(); ++p)
    if (!r.at_points[p].isZero(0))
      out.nodes.emplace_back(node_of(data.instruments.load_points[p]), f.load_gain * r.at_points[p]);
  return out;
}

frame::FrameResult analysed(FrameDescription f, Named<LoadCase> loads, const frame::FrameOptions& o) {
  f.loads = std::move(loads);
  return frame::analyse(f, o);
}

/// Sensors with a column, behind them those that only show in the readings of others, and what is recorded of them.
struct Channels {
  std::vector<const frame::FrameSensor*> sensors;
  MatrixX mix;
  VectorX zero;

  Channels(const FrameDescription& f, const measurement::Measurements& data) : sensors(sensors_of(f, data)) {
    const std::size_t shown = sensors.size();
    for (std::size_t k = 0; k < shown; ++k)
      for (const auto& [other, share] : sensors[k]->crosstalk) place_of(named(f.sensors, "sensor", other, f.name));
    mix = MatrixX::Zero(as_index(shown), std::ssize(sensors));
    zero = VectorX::Zero(as_index(shown));
    for (std::size_t k = 0; k < shown; ++k) {
      mix(as_index(k), as_index(k)) = sensors[k]->gain;
      zero(as_index(k)) = sensors[k]->zero;
      for (const auto& [other, share] : sensors[k]->crosstalk)
        mix(as_index(k), place_of(named(f.sensors, "sensor", other, f.name))) += sensors[k]->gain * share;
    }
  }

  /// Six zeros, then the readings.
  VectorX recorded(const VectorX& true_readings) const {
    VectorX out = VectorX::Zero(6 + mix.rows());
    out.tail(mix.rows()) = mix * true_readings + zero;
    return out;
  }

 private:
  Eigen::Index place_of(const frame::FrameSensor& s) {
    const auto at = std::find(sensors.begin(), sensors.end(), &s);
    if (at != sensors.end()) return at - sensors.begin();
    sensors.push_back(&s);
    return std::ssize(sensors) - 1;
  }
};

/// By sensor (rows) and load case.
MatrixX true_readings(const std::vector<const frame::FrameSensor*>& sensors, const FrameDescription& f,
                      const frame::FrameResult& result) {
  MatrixX out(std::ssize(sensors), std::ssize(result.cases));
  for (std::size_t c = 0; c < result.cases.size(); ++c)
    for (std::size_t k = 0; k < sensors.size(); ++k)
      out(as_index(k), as_index(c)) = frame::true_reading(*sensors[k], f, result.structure, result.cases[c]);
  return out;
}

std::vector<VectorX> by_superposition(const FrameDescription& f, const measurement::Measurements& data) {
  const Channels channels(f, data);
  const frame::FrameResult result = analysed(f, unit_loads(f, data), {});
  if (const std::string failed = frame::failed_check(result); !failed.empty())
    throw NumericalError(fmt::format("{}: {}", f.name, failed));
  const MatrixX read = true_readings(channels.sensors, f, result) * true_factors(f, data);
  std::vector<VectorX> out;
  for (const auto& column : read.colwise()) out.push_back(channels.recorded(column));
  return out;
}

/// Whether some law of the frame is so.
template <class Is>
bool any_law(const FrameDescription& f, const Is& is) {
  const auto in = [&](const frame::FreedomLaws& laws) {
    if (laws.empty()) return false;  // most are
    for (std::size_t i = 0; i < 6; ++i)
      for (const bool beside : {false, true}) {
        const std::vector<Law> all = laws.at(i, beside);
        if (std::any_of(all.begin(), all.end(), is)) return true;
      }
    return false;
  };
  return std::any_of(f.supports.begin(), f.supports.end(), [&](const auto& s) { return in(s.second.laws); }) ||
         std::any_of(f.springs.begin(), f.springs.end(), [&](const auto& s) { return in(s.second.laws); }) ||
         std::any_of(f.members.begin(), f.members.end(),
                     [&](const auto& m) { return in(m.second.start) || in(m.second.end); });
}

/// What of the frame remembers earlier loads, so that the order of the readings matters; null: nothing.
const char* law_with_history(const FrameDescription& f) {
  if (any_law(f, [](const Law& law) { return row_of(law).has_history; })) return "friction";
  return any_law(f, [](const Law& law) { return deflect::has_history(law); }) ? "a table with 'unloading'" : nullptr;
}

/// The readings that are solved: all in their sequence where loads are remembered, else the first under each load.
struct Solved {
  bool in_sequence = false;
  std::vector<std::size_t> order;
  std::vector<std::size_t> place;  ///< by reading: where in `order` the one with its answer stands

  Solved(const FrameDescription& f, const measurement::Measurements& data) : place(data.readings.size()) {
    if (const char* const what = law_with_history(f)) {
      in_sequence = true;
      order = measurement::in_sequence(data, what);
      for (std::size_t c = 0; c < order.size(); ++c) place[order[c]] = c;
      return;
    }
    const MatrixX loads = measurement::loads_of(data);
    std::map<std::vector<double>, std::size_t> known;
    for (std::size_t i = 0; i < place.size(); ++i) {
      const auto load = loads.col(as_index(i));
      const auto [found, is_new] = known.try_emplace({load.begin(), load.end()}, order.size());
      if (is_new) order.push_back(i);
      place[i] = found->second;
    }
  }

  /// By reading what is recorded, from the true readings by sensor and place in `order`.
  std::vector<VectorX> recorded(const Channels& channels, const MatrixX& read) const {
    std::vector<VectorX> out;
    for (const std::size_t c : place) out.push_back(channels.recorded(read.col(as_index(c))));
    return out;
  }
};

std::vector<VectorX> one_by_one(const FrameDescription& f, const measurement::Measurements& data) {
  const Solved solved(f, data);
  frame::FrameOptions options;
  options.in_sequence = solved.in_sequence;
  Named<LoadCase> loads;
  for (const std::size_t i : solved.order)
    loads.emplace_back(fmt::format("line {}", data.readings[i].line), load_of(f, data, data.readings[i]));
  const frame::FrameResult result = analysed(f, std::move(loads), options);
  if (const std::string failed = frame::failed_check(result); !failed.empty())
    throw NumericalError(fmt::format("{}: {}: {}", data.origin, f.name, failed));
  const Channels channels(f, data);
  return solved.recorded(channels, true_readings(channels.sensors, f, result));
}

/// By what is known of a frame near it; nullopt where it is too far away.
std::optional<std::vector<VectorX>> by_known_frame(const FrameDescription& f, const measurement::Measurements& data,
                                                   const frame::KnownFrame& known) {
  const Named<LoadCase> loads = unit_loads(f, data);
  const Solved solved(f, data);
  const Channels channels(f, data);
  const MatrixX factors = true_factors(f, data)(Eigen::all, solved.order);
  const std::optional<MatrixX> read = known.readings(f, loads, channels.sensors, factors, solved.in_sequence);
  return read ? std::optional(solved.recorded(channels, *read)) : std::nullopt;
}

/// Sensors that stick follow what they read, in the order taken, only where they lag by more than their band. The first
/// reading of each pose is true.
void let_stick(const FrameDescription& f, const measurement::Measurements& data, std::vector<VectorX>& read) {
  const std::vector<const frame::FrameSensor*> sensors = sensors_of(f, data);
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    const double band = sensors[k]->gain * sensors[k]->stick;
    if (!(band > 0)) continue;
    if (order.empty()) order = measurement::in_sequence(data, "a sensor that sticks");
    std::optional<std::size_t> pose;
    double shown = 0;
    for (const std::size_t i : order) {
      double& value = read[i](as_index(6 + k));
      if (data.readings[i].pose != pose) shown = value;
      pose = data.readings[i].pose;
      shown = std::clamp(shown, value - band, value + band);
      value = shown;
    }
  }
}

}  // namespace

Named<LoadCase> unit_loads(const FrameDescription& f, const measurement::Measurements& data) {
  Named<LoadCase> out;
  for (const std::string& name : data.instruments.load_cases)
    out.emplace_back("load." + name, named(f.loads, "load case", name, f.name));
  for (const measurement::LoadChannel& c : measurement::load_channels(data)) {
    if (c.name.starts_with("load.")) continue;
    const std::size_t dot = c.name.rfind('.');
    const auto component = std::find(frame::wrench_names.begin(), frame::wrench_names.end(), c.name.substr(dot + 1)) -
                           frame::wrench_names.begin();
    LoadCase unit;
    unit.nodes.emplace_back(node_of(c.name.substr(0, dot)), Vector6::Unit(component));
    out.emplace_back(c.name, std::move(unit));
  }
  out.emplace_back("always", LoadCase());
  return out;
}

MatrixX true_factors(const FrameDescription& f, const measurement::Measurements& data) {
  const MatrixX recorded = measurement::loads_of(data);
  MatrixX out(recorded.rows() + 1, recorded.cols());
  out.topRows(recorded.rows()) = f.load_gain * recorded;
  out.bottomRows<1>() = VectorX::Ones(recorded.cols()).transpose() - out.topRows(recorded.rows()).colwise().sum();
  return out;
}

std::vector<VectorX> predicted_readings(const FrameDescription& frame, const measurement::Measurements& data,
                                        Geometry geometry, const FrameNearby* near) {
  std::optional<std::vector<VectorX>> out;
  for (const FrameNearby* n = geometry == Geometry::linear ? near : nullptr; n && !out; n = n->further())
    if (const frame::KnownFrame* known = n->known()) out = by_known_frame(frame, data, *known);
  if (!out && near && geometry == Geometry::linear && !has_linear_laws(frame)) {
    // A node that moves turns what its semi-rigid ends leave rigid: then the frame is known by itself, which spares a
    // search for the equilibrium of each reading.
    const FrameNearby own(frame, data);
    if (own.known()) out = by_known_frame(frame, data, *own.known());
  }
  if (!out) {
    FrameDescription f = frame;
    f.geometry = geometry;
    if (geometry != Geometry::finite) f.load_steps = 1;
    const bool sums = geometry == Geometry::linear && has_linear_laws(f);
    out = sums ? by_superposition(f, data) : one_by_one(f, data);
  }
  let_stick(frame, data, *out);
  return std::move(*out);
}

FrameNearby::FrameNearby(const FrameDescription& f, const measurement::Measurements& data,
                         std::shared_ptr<const FrameNearby> further)
    : frame_(f), loads_(unit_loads(f, data)), further_(std::move(further)) {}

const frame::KnownFrame* FrameNearby::known() const {
  std::call_once(once_, [&] {
    auto known = outcome_of([&] { return std::make_unique<const frame::KnownFrame>(frame_, loads_); });
    if (known) known_ = std::move(*known);
  });
  return known_.get();
}

bool has_linear_laws(const FrameDescription& f) {
  return !any_law(f, [](const Law& law) { return !is_linear(law); });
}

double size_of(const FrameDescription& f) {
  Vector3 low = f.nodes.front().second, high = low;
  for (const auto& [name, at] : f.nodes) low = low.cwiseMin(at), high = high.cwiseMax(at);
  return (high - low).norm();
}

bool has_history(const FrameDescription& f) {
  return std::any_of(f.sensors.begin(), f.sensors.end(), [](const auto& s) { return s.second.stick > 0; }) ||
         law_with_history(f);
}

}  // namespace deflect::subject
