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

std::vector<Listed> listed_joints(const FrameDescription& f) {
  std::vector<Listed> out;
  const frame::NameIndex members(f.members), springs(f.springs);
  for (const Place& p : places_of(f)) {
    const std::size_t dot = p.part.rfind('.');
    if (p.kind == PlaceKind::member_end && p.hold != Hold::free) {
      const auto at = p.part.substr(dot + 1) == "start" ? TakenLaws::At::start : TakenLaws::At::end;
      for (const std::size_t freedom : p.freedoms) {
        out.push_back({p, {at, as_size(members.find(p.part.substr(0, dot))), freedom}});
        out.back().place.freedoms = {freedom};
      }
    } else if (p.path.starts_with("springs.") && p.hold == Hold::elastic) {
      const auto spring = as_size(springs.find(p.path.substr(p.path.find('.') + 1)));
      out.push_back({p, {TakenLaws::At::spring, spring, p.freedoms.front()}});
    }
  }
  return out;
}

/// What is known of the frame at these places; nothing where it has laws that are not linear.
std::optional<frame::Passages> passages_at(const std::vector<Listed>& places, const FrameDescription& f,
                                           const measurement::Measurements& data, const FrameNearby& nearby) {
  if (!has_linear_laws(f) || !nearby.known()) return std::nullopt;
  std::vector<const frame::FrameSensor*> sensors;
  for (const measurement::SensorChannel& s : data.instruments.sensors) sensors.push_back(find(f.sensors, s.name));
  std::vector<TakenLaws> at;
  for (const Listed& each : places) at.push_back(each.at);
  std::optional<frame::Passages> known = nearby.known()->passages(sensors, at);
  for (std::size_t s = 0; known && s < sensors.size(); ++s) known->moves.row(as_index(s)) *= sensors[s]->gain;
  return known;
}

InnerSite site_of(const Listed& at, Eigen::Index k, const frame::Passages& known, double load_gain) {
  InnerSite out{name_of(at.place), at.place, at.place.rotation(), {}, {}};
  const Eigen::Index loads = known.carried.cols() - 1;  // the last one is always there
  out.per_load = load_gain * (known.carried.row(k).head(loads).array() - known.carried(k, loads)).matrix().transpose();
  out.moves = known.moves.col(k);
  return out;
}

}  // namespace

InnerSites inner_sites_of(const FrameDescription& f, const measurement::Measurements& data, const FrameNearby& nearby) {
  const std::vector<Listed> places = listed(f);
  const std::optional<frame::Passages> known = passages_at(places, f, data, nearby);
  if (!known) return {};
  double stiffest = 0;
  for (const Listed& each : places) stiffest = std::max(stiffest, each.stiffness);
  std::vector<Eigen::Index> giving;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (known->gives[i]) giving.push_back(as_index(i));
  InnerSites out;
  out.response = known->response(giving, giving);
  for (const Eigen::Index k : giving) {
    InnerSite site = site_of(nth(places, k), k, *known, f.load_gain);
    // N/m; of a rotation over the square of the frame's size.
    const double holds = -known->response(k, k), natural = nth(places, k).stiffness;
    const double scale = site.rotation ? stiffest * size_of(f) * size_of(f) : stiffest;
    site.determinate = !(holds > holds_nothing * (natural > 0 ? natural : scale));
    site.redundancy = site.determinate ? 0 : natural > 0 ? std::min(1.0, holds / natural) : 1;
    out.all.push_back(std::move(site));
  }
  return out;
}

std::vector<InnerSite> joint_sites_of(const FrameDescription& f, const measurement::Measurements& data,
                                      const FrameNearby& nearby) {
  const std::vector<Listed> places = listed_joints(f);
  const std::optional<frame::Passages> known = passages_at(places, f, data, nearby);
  std::vector<InnerSite> out;
  for (std::size_t i = 0; known && i < places.size(); ++i)
    if (known->gives[i]) out.push_back(site_of(places[i], as_index(i), *known, f.load_gain));
  return out;
}

}  // namespace deflect::subject
