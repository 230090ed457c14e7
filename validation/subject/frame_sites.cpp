#include "validation/subject/frame_sites.h"

#include <algorithm>

#include "msa/base/index.h"
#include "msa/frame/file/name_index.h"
#include "validation/subject/frame_places.h"

namespace deflect::subject {
namespace {

using frame::FrameDescription;
using frame::TakenLaws;

/// Of the stiffest part: a stiffness below that is rounding.
constexpr double holds_nothing = 1e-9;

struct Listed {
  Place place;
  TakenLaws at;
  double stiffness = 0;  // of a member along its axis, N/m
};

std::vector<Listed> listed(const FrameDescription& f) {
  std::vector<Listed> out;
  const frame::NameIndex members(f.members), supports(f.supports), sections(f.sections), materials(f.materials);
  for (const Place& p : places_of(f)) {
    const std::string name = p.path.substr(p.path.find('.') + 1);
    if (p.path.starts_with("members.") && p.freedoms.empty()) {
      const auto k = as_size(members.find(name));
      const frame::FrameMember& m = f.members[k].second;
      if (m.truss ? false : m.release_from[0] || m.release_to[0]) continue;
      const frame::FrameMaterial& material = nth(f.materials, materials.find(m.material)).second;
      const double area = properties(nth(f.sections, sections.find(m.section)).second, material.elastic.poisson()).A;
      const double length = (*find(f.nodes, m.to) - *find(f.nodes, m.from)).norm();
      out.push_back({p, {TakenLaws::At::start, k, 0}, m.factor * material.elastic.E * area / length});
    } else if (p.path.starts_with("supports.") && p.hold != Hold::free) {
      out.push_back({p, {TakenLaws::At::support, as_size(supports.find(name)), p.freedoms.front()}});
    }
  }
  return out;
}

}  // namespace

InnerSites inner_sites_of(const FrameDescription& f, const measurement::Measurements& data, const FrameNearby& nearby) {
  if (!has_linear_laws(f) || !nearby.known()) return {};
  std::vector<const frame::FrameSensor*> sensors;
  for (const measurement::SensorChannel& s : data.instruments.sensors) sensors.push_back(find(f.sensors, s.name));
  const std::vector<Listed> places = listed(f);
  std::vector<TakenLaws> at;
  double stiffest = 0;
  for (const Listed& each : places) at.push_back(each.at), stiffest = std::max(stiffest, each.stiffness);
  std::optional<frame::Passages> known = nearby.known()->passages(sensors, at);
  if (!known) return {};
  std::vector<Eigen::Index> giving;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (known->gives[i]) giving.push_back(as_index(i));
  InnerSites out;
  out.response = known->response(giving, giving);
  for (const Eigen::Index k : giving) {
    const std::size_t i = as_size(k);
    InnerSite site{name_of(places[i].place), places[i].place, places[i].place.rotation(), {}, {}};
    const Eigen::Index loads = known->carried.cols() - 1;  // the last one is always there
    site.per_load =
        f.load_gain * (known->carried.row(k).head(loads).array() - known->carried(k, loads)).matrix().transpose();
    site.moves = known->moves.col(k);
    for (std::size_t s = 0; s < sensors.size(); ++s) site.moves(as_index(s)) *= sensors[s]->gain;
    // N/m; of a rotation over the square of the frame's size.
    const double holds = -known->response(k, k), natural = places[i].stiffness;
    const double scale = site.rotation ? stiffest * size_of(f) * size_of(f) : stiffest;
    site.determinate = !(holds > holds_nothing * (natural > 0 ? natural : scale));
    site.redundancy = site.determinate ? 0 : natural > 0 ? std::min(1.0, holds / natural) : 1;
    out.all.push_back(std::move(site));
  }
  return out;
}

}  // namespace deflect::subject
