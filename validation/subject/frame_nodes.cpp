#include "validation/subject/frame_nodes.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "msa/base/index.h"
#include "validation/subject/frame_places.h"

namespace deflect::subject {
namespace {

using frame::FrameDescription;
using frame::FrameSensor;
using frame::LoadCase;

constexpr std::size_t most_freedoms = 1000;
constexpr double rounding = 1e-9;  // of the largest motion

struct NodeFreedom {
  Place place;
  std::string node;
  FrameSensor motion;  // reads it
};

/// What stands between a node's freedom and the ground: a support, or a spring.
std::map<std::pair<std::string, std::size_t>, Place> places_to_ground(const FrameDescription& f) {
  std::map<std::pair<std::string, std::size_t>, Place> out;
  for (const Place& p : places_of(f)) {
    if (p.freedoms.size() != 1) continue;
    const std::string name = p.path.substr(p.path.find('.') + 1);
    if (p.kind == PlaceKind::support) out.insert_or_assign({name, p.freedoms.front()}, p);
    const frame::FrameSpring* spring = p.kind == PlaceKind::joint ? find(f.springs, name) : nullptr;
    if (spring && spring->to.empty()) out.try_emplace({spring->node, p.freedoms.front()}, p);
  }
  return out;
}

/// Those that are not held rigidly; rotations where a member resists them.
std::vector<NodeFreedom> freedoms_of(const FrameDescription& f) {
  const auto to_ground = places_to_ground(f);
  std::set<std::string> resisted;
  for (const auto& [name, m] : f.members)
    if (!m.truss) resisted.insert({m.from, m.to});
  std::vector<NodeFreedom> out;
  for (const auto& [node, at] : f.nodes)
    for (std::size_t i = 0; i < 6; ++i) {
      if (out_of_plane(f, i) || (i >= 3 && !resisted.contains(node))) continue;
      Place place{PlaceKind::node, {}, "node." + node, "nodes." + node, {i}};
      place.hold = Hold::free;
      place.base_axes = true;
      if (const auto known = to_ground.find({node, i}); known != to_ground.end()) place = known->second;
      if (place.hold == Hold::rigid) continue;
      NodeFreedom own{std::move(place), node, {}};
      own.motion.of = node;
      own.motion.axis = Vector3::Unit(as_index(i % 3));
      own.motion.rotation = i >= 3;
      out.push_back(std::move(own));
    }
  return out;
}

}  // namespace

std::vector<NodeMotion> node_motions_of(const FrameDescription& f, const measurement::Measurements& data,
                                        const FrameNearby& nearby) {
  if (!has_linear_laws(f) || !nearby.known()) return {};
  const std::vector<NodeFreedom> all = freedoms_of(f);
  if (all.size() > most_freedoms) return {};
  std::vector<const FrameSensor*> motions, sensors;
  Named<LoadCase> forces;
  for (const NodeFreedom& each : all) {
    motions.push_back(&each.motion);
    LoadCase unit;
    unit.nodes.emplace_back(each.node, Vector6::Unit(as_index(each.place.freedoms.front())));
    forces.emplace_back(fmt::format("unit {} {}", each.node, each.place.freedoms.front()), std::move(unit));
  }
  for (const measurement::SensorChannel& s : data.instruments.sensors) sensors.push_back(find(f.sensors, s.name));

  const Named<LoadCase> loads = unit_loads(f, data);
  MatrixX factors = true_factors(f, data);
  factors.conservativeResize(Eigen::NoChange, factors.cols() + 1);
  factors.rightCols<1>() = VectorX::Unit(factors.rows(), factors.rows() - 1);  // what is always there
  forces.push_back(loads.back());
  const std::optional<MatrixX> moved = nearby.known()->readings(f, loads, motions, factors, false),
                               read = nearby.known()->readings(
                                   f, forces, sensors, MatrixX::Identity(std::ssize(forces), std::ssize(forces)),
                                   false);
  if (!moved || !read) return {};
  std::vector<NodeMotion> out;
  const Eigen::Index readings = moved->cols() - 1, units = read->cols() - 1;
  const MatrixX own = moved->leftCols(readings).colwise() - moved->col(readings);
  const double size = size_of(f);
  VectorX most = own.cwiseAbs().rowwise().maxCoeff();
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all[k].motion.rotation) most(as_index(k)) *= size;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Eigen::Index i = as_index(k);
    if (most(i) <= rounding * most.maxCoeff()) continue;
    NodeMotion each{all[k].place, own.row(i).transpose(), read->col(i) - read->col(units)};
    for (std::size_t s = 0; s < sensors.size(); ++s) each.moves(as_index(s)) *= sensors[s]->gain;
    out.push_back(std::move(each));
  }
  return out;
}

}  // namespace deflect::subject
