#include "validation/recording/channel_mistakes.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/index.h"
#include "validation/measurement/column_names.h"

namespace deflect::recording {
namespace {

using measurement::Measurements;
using measurement::Quantity;
using measurement::Reading;

struct OtherUnit {
  const char* id;
  const char* words;
  double factor;  // number of the contract = factor · recorded number
};

std::vector<OtherUnit> units_of(Quantity q) {
  constexpr double lbf = 4.4482216152605, kgf = 9.80665;
  switch (q) {
    case Quantity::length:
      return {{"in_m", "in m", 1e3}, {"in_um", "in µm", 1e-3}, {"in_inch", "in inches", 25.4}};
    case Quantity::angle:
      return {{"in_deg", "in deg", pi / 180}, {"in_mrad", "in mrad", 1e-3}, {"in_urad", "in µrad", 1e-6}};
    case Quantity::force:
      return {{"in_kN", "in kN", 1e3}, {"in_lbf", "in lbf", lbf}, {"in_kgf", "in kgf", kgf}};
    case Quantity::moment:
      return {{"in_Nm", "in Nm", 1e3}, {"in_lbfin", "in lbf in", 25.4 * lbf}, {"in_kgfmm", "in kgf mm", kgf}};
    case Quantity::strain:
      return {{"in_m_per_m", "in m/m", 1e6}, {"in_percent", "in %", 1e4}, {"in_mm_per_m", "in mm/m", 1e3}};
  }
  return {};
}

Correction scaled_channel(std::size_t k, double factor, std::string id, std::string sentence) {
  Correction c;
  c.id = std::move(id);
  c.sentence = std::move(sentence);
  c.scaled_channels = {{6 + k, factor}};
  c.readings = [k, factor](Measurements& m) {
    for (Reading& r : m.readings)
      if (r.sensors[k]) *r.sensors[k] *= factor;
  };
  return c;
}

/// A load of all readings times a factor: a load case, or a component at a node.
void scale(Measurements& m, const std::string& name, double factor) {
  if (name.starts_with("load.")) {
    for (std::size_t k = 0; k < m.instruments.load_cases.size(); ++k)
      if ("load." + m.instruments.load_cases[k] == name)
        for (Reading& r : m.readings) r.factors[k] *= factor;
    return;
  }
  for (std::size_t p = 0; p < m.instruments.load_points.size(); ++p)
    if (name.starts_with(m.instruments.load_points[p] + ".")) {
      constexpr const char* components[] = {"fx", "fy", "fz", "mx", "my", "mz"};
      const auto at = std::find(std::begin(components), std::end(components), name.substr(name.rfind('.') + 1));
      for (Reading& r : m.readings) r.at_points[p](at - std::begin(components)) *= factor;
    }
}

Correction scaled_load(const std::vector<std::string>& names, double factor, std::string id, std::string sentence) {
  Correction c;
  c.id = std::move(id);
  c.sentence = std::move(sentence);
  c.readings = [names, factor](Measurements& m) {
    for (const std::string& name : names) scale(m, name, factor);
  };
  return c;
}

/// The index of a point of load, which is made where it is new.
std::size_t point_of(Measurements& m, const std::string& node) {
  const std::string name = "node." + node;
  auto& points = m.instruments.load_points;
  const auto found = std::find(points.begin(), points.end(), name);
  if (found != points.end()) return as_size(found - points.begin());
  points.push_back(name);
  for (Reading& r : m.readings) r.at_points.push_back(Vector6::Zero());
  return points.size() - 1;
}

bool loads_nodes_alone(const frame::LoadCase& c) {
  return !c.nodes.empty() && c.members.empty() && c.temperature.empty() && c.gravity.isZero(0) &&
         c.displacements.empty();
}

/// Nodes that a load can stand at: those that no support holds in all directions of the load.
std::vector<std::string> other_nodes(const frame::FrameDescription& f, const std::string& node) {
  std::vector<std::string> out;
  for (const auto& [name, at] : f.nodes) {
    const frame::FrameSupport* support = find(f.supports, name);
    if (name != node && !(support && support->rigid(0) && support->rigid(1) && support->rigid(2))) out.push_back(name);
  }
  return out;
}

}  // namespace

std::vector<Correction> mistaken_channels(const Measurements& m) {
  std::vector<Correction> out;
  const auto& sensors = m.instruments.sensors;
  for (std::size_t k = 0; k < sensors.size(); ++k) {
    const std::string column = measurement::sensor_column(sensors[k]);
    for (const OtherUnit& unit : units_of(sensors[k].quantity))
      out.push_back(scaled_channel(k, unit.factor, fmt::format("{}_{}", sensors[k].name, unit.id),
                                   fmt::format("{} {}: give its numbers in {}", column, unit.words,
                                               measurement::row_of(sensors[k].quantity).unit)));
    out.push_back(scaled_channel(k, -1, fmt::format("{}_sign", sensors[k].name),
                                 fmt::format("{} with the other sign: turn its numbers round", column)));
    for (std::size_t other = 0; other < k; ++other) {
      if (sensors[other].quantity != sensors[k].quantity) continue;
      Correction c;
      c.id = fmt::format("{}_and_{}_swapped", sensors[other].name, sensors[k].name);
      c.sentence = fmt::format("{} and {} in one another's place: exchange the two columns",
                               measurement::sensor_column(sensors[other]), column);
      c.readings = [k, other](Measurements& data) {
        for (Reading& r : data.readings) std::swap(r.sensors[k], r.sensors[other]);
      };
      out.push_back(std::move(c));
    }
  }
  return out;
}

std::vector<Correction> mistaken_loads(const Measurements& m) {
  std::vector<Correction> out;
  std::vector<std::string> all;
  for (const measurement::LoadChannel& channel : measurement::load_channels(m)) all.push_back(channel.name);
  const auto add = [&](const std::vector<std::string>& names, const std::string& what, const std::string& id) {
    for (const OtherUnit& unit : units_of(Quantity::force))
      out.push_back(scaled_load(names, unit.factor, fmt::format("{}_{}", id, unit.id),
                                fmt::format("{} {}: give what was applied", what, unit.words)));
    out.push_back(
        scaled_load(names, -1, id + "_sign", fmt::format("{} with the other sign: turn the numbers round", what)));
  };
  for (const std::string& name : all) add({name}, name, name);
  if (all.size() > 1) add(all, "all loads", "loads");
  return out;
}

std::vector<Correction> misplaced_loads(const Measurements& m, const frame::FrameDescription& f) {
  std::vector<Correction> out;
  const auto add = [&](const std::string& what, const std::string& from, const std::string& to,
                       std::function<void(Measurements&)> move) {
    Correction c;
    c.id = fmt::format("{}_at_{}", what, to);
    c.sentence = fmt::format("{} at node {} instead of {}: correct where it is said to act", what, to, from);
    c.readings = std::move(move);
    out.push_back(std::move(c));
  };
  for (std::size_t k = 0; k < m.instruments.load_cases.size(); ++k) {
    const std::string& name = m.instruments.load_cases[k];
    const frame::LoadCase* load = find(f.loads, name);
    if (!load || !loads_nodes_alone(*load)) continue;
    for (std::size_t i = 0; i < load->nodes.size(); ++i)
      for (const std::string& to : other_nodes(f, load->nodes[i].first))
        add(load->nodes.size() > 1 ? fmt::format("load.{} of {}", name, load->nodes[i].first) : "load." + name,
            load->nodes[i].first, to, [k, i, to, nodes = load->nodes, times = load->factor](Measurements& data) {
              for (std::size_t n = 0; n < nodes.size(); ++n) {
                const std::size_t p = point_of(data, n == i ? to : nodes[n].first);
                for (Reading& r : data.readings) r.at_points[p] += times * r.factors[k] * nodes[n].second;
              }
              for (Reading& r : data.readings) r.factors[k] = 0;
            });
  }
  for (std::size_t p = 0; p < m.instruments.load_points.size(); ++p) {
    const std::string from = m.instruments.load_points[p].substr(5);
    for (const std::string& to : other_nodes(f, from))
      add(m.instruments.load_points[p], from, to, [p, to](Measurements& data) {
        const std::size_t there = point_of(data, to);
        for (Reading& r : data.readings) {
          r.at_points[there] += r.at_points[p];
          r.at_points[p].setZero();
        }
      });
  }
  return out;
}

}  // namespace deflect::recording
