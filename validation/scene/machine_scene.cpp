#include "validation/scene/machine_scene.h"

#include <algorithm>
#include <map>
#include <utility>

#include "msa/base/index.h"
#include "validation/figures/drawing.h"
#include "validation/measurement/configure_all.h"
#include "validation/report/text.h"
#include "validation/scene/scene_numbers.h"
#include "validation/theories/msa_theory.h"

namespace deflect::scene {
namespace {

constexpr int scene_elements = 8;  // of a member

/// What each part of the description looks like, by leg and part.
using Outlines = std::map<std::pair<std::string, std::string>, figures::SectionOutline>;

Outlines outlines_of(const Mechanism& m, const Configuration& c) {
  Outlines out;
  for (const figures::DrawnMember& member : figures::drawing_of(m, c).members)
    out[{member.leg, member.part}] = {member.size_y, member.size_z, member.round};
  return out;
}

/// Of each body the local y of its section, null of those that are no members.
class SectionAxes {
 public:
  explicit SectionAxes(const std::vector<PlacedLeg>& legs) { add(legs); }
  Json json(std::size_t bodies) {
    while (axes_.size() < bodies) axes_.push_back(nullptr);
    return axes_;
  }

 private:
  void add(const std::vector<PlacedLeg>& legs) {
    for (const PlacedLeg& leg : legs)
      for (const PlacedPart& part : leg.parts)
        if (const auto* group = std::get_if<PlacedParallel>(&part))
          add(group->branches);
        else if (const auto* member = std::get_if<PlacedMember>(&part)) {
          const Vector3 y = member->R_WM.col(1);
          axes_.push_back({scene_digits(y.x()), scene_digits(y.y()), scene_digits(y.z())});
        }
  }

  Json axes_ = Json::array();
};

Vector3 start_of(const PlacedPart& part) {
  if (const auto* joint = std::get_if<PlacedJoint>(&part)) return joint->p_W;
  if (const auto* member = std::get_if<PlacedMember>(&part)) return member->p_W_start;
  return std::get<PlacedParallel>(part).p_W_start;
}

/// Where the legs stand on the base.
Json ground_of(const Configuration& c) {
  Json out = Json::array();
  for (const PlacedLeg& leg : c.legs)
    if (!leg.beside && !leg.parts.empty())
      out.push_back({{"at_mm", scene_position(start_of(leg.parts.front()))},
                     {"words", c.legs.size() == 1 ? "base" : "base of " + leg.name},
                     {"whole", true}});
  return out;
}

class Drawing {
 public:
  Drawing(const Mechanism& m, const Configuration& c, const frame::MechanismModel& built,
          const std::vector<effects::ChangedPart>& guilty)
      : configuration_(c), outlines_(outlines_of(m, c)), built_(built), guilty_(guilty) {
    members(c.legs);
    arms();
    joints(c.legs);
    for (const auto& [part, joint, node] :
         {std::tuple{"base", &c.base, built.base}, std::tuple{"tool", &c.tool, built.tool}})
      if (is_guilty("", part)) add_joint("", part, *joint, node);
  }

  Json json() const {
    Json names = Json::array();
    for (const effects::ChangedPart& g : guilty_) {
      const std::string words = g.leg.empty() ? g.part : g.leg + " " + (g.part.empty() ? "seat" : g.part);
      if (std::find(names.begin(), names.end(), words) == names.end()) names.push_back(words);
    }
    return {{"kind", "machine"}, {"bodies", bodies_},     {"cells", cells_},
            {"joints", joints_}, {"tool", built_.tool},   {"ground", ground_of(configuration_)},
            {"guilty", names},   {"poses", Json::array()}};
  }

 private:
  bool is_guilty(const std::string& leg, const std::string& part) const {
    return std::any_of(guilty_.begin(), guilty_.end(), [&](const effects::ChangedPart& g) {
      return g.leg == leg && (g.part == part || (g.part.empty() && !leg.empty()));
    });
  }

  void members(const std::vector<PlacedLeg>& legs) {
    for (const PlacedLeg& leg : legs)
      for (const PlacedPart& part : leg.parts)
        if (const auto* group = std::get_if<PlacedParallel>(&part))
          members(group->branches);
        else if (const auto* member = std::get_if<PlacedMember>(&part))
          add_member(leg.name, *member);
  }

  /// Members come in the order in which they were built.
  void add_member(const std::string& leg, const PlacedMember& m) {
    const auto [first, last] = built_.members.at(bodies_.size());
    Json body = {{"leg", leg}, {"part", m.part}, {"kind", "member"}, {"guilty", is_guilty(leg, m.part)}};
    const auto outline = outlines_.find({leg, m.part});
    put_outline(body, outline == outlines_.end() ? figures::SectionOutline{} : outline->second, m.section);
    bodies_.push_back(std::move(body));
    for (std::size_t i = first; i < last; ++i)
      cells_.push_back({built_.model.beams[i].a, built_.model.beams[i].b, bodies_.size() - 1});
  }

  void arms() {
    const auto body = [this](const char* kind) {
      for (std::size_t i = 0; i < bodies_.size(); ++i)
        if (bodies_[i]["kind"] == kind) return i;
      bodies_.push_back({{"leg", ""}, {"part", kind}, {"kind", kind}, {"guilty", is_guilty("", kind)}});
      return bodies_.size() - 1;
    };
    for (const auto& [a, b] : built_.arms) {
      const auto touches = [a = a, b = b](int node) { return a == node || b == node; };
      const char* kind = touches(built_.platform) || touches(built_.tool) ? "platform"
                         : touches(built_.ground) || touches(built_.base) ? "base"
                                                                          : "offset";
      cells_.push_back({a, b, body(kind)});
    }
  }

  void joints(const std::vector<PlacedLeg>& legs) {
    for (const PlacedLeg& leg : legs)
      for (const PlacedPart& part : leg.parts)
        if (const PlacedJoint* joint = joint_of(part))
          add_joint(leg.name, joint->part, *joint, nearest_node(*joint));
        else if (const auto* group = std::get_if<PlacedParallel>(&part))
          joints(group->branches);
  }

  void add_joint(const std::string& leg, const std::string& part, const PlacedJoint& joint, int node) {
    const bool driven =
        std::find(joint.freedoms.begin(), joint.freedoms.end(), Freedom::actuated) != joint.freedoms.end();
    bool moves = driven;
    for (std::size_t i = 0; i < 6; ++i) moves = moves || joint.free(i) || joint.elastic(i);
    if (!moves) return;
    joints_.push_back(
        {{"leg", leg}, {"part", part}, {"point", node}, {"driven", driven}, {"guilty", is_guilty(leg, part)}});
  }

  int nearest_node(const PlacedJoint& joint) const {
    const auto& nodes = built_.model.nodes;
    const auto distance = [&](const frame::Node& n) { return (n.position - joint.p_W).squaredNorm(); };
    const auto nearest = std::min_element(nodes.begin(), nodes.end(), [&](const frame::Node& a, const frame::Node& b) {
      return distance(a) < distance(b);
    });
    return static_cast<int>(nearest - nodes.begin());
  }

  const Configuration& configuration_;
  Outlines outlines_;
  const frame::MechanismModel& built_;
  const std::vector<effects::ChangedPart>& guilty_;
  Json bodies_ = Json::array(), cells_ = Json::array(), joints_ = Json::array();
};

/// Named sensors and points of load: where they are beside T, and along which axis a sensor reads.
Json instruments_json(const Mechanism& m, const Configuration& c) {
  Json out = Json::array();
  const auto add = [&](const std::string& name, const char* kind, const Vector3& arm) -> Json& {
    out.push_back({{"name", name}, {"kind", kind}, {"arm_mm", scene_position(arm)}});
    return out.back();
  };
  for (const auto& [name, sensor] : m.sensors) {
    const measurement::SensorPlace place = measurement::sensor_place(m, sensor, c);
    const char* kind = !sensor.drive.empty() ? "force of a drive" : sensor.rotation ? "rotation sensor" : "sensor";
    add(name, kind, place.p_W - c.pose.p_WT)["axis"] = {place.axis.x(), place.axis.y(), place.axis.z()};
  }
  for (const auto& [name, load] : m.loads) add(name, "point of load", c.pose.R_WT * load.point);
  return out;
}

}  // namespace

Json scene_json(const Mechanism& m, const std::vector<SceneStand>& stands, const std::vector<Vector6>& loads,
                const std::vector<effects::ChangedPart>& guilty, Geometry geometry) {
  Json scene;
  for (const SceneStand& stand : stands) {
    theories::TheoryOptions options{m.name, frame::equal_division(stand.configuration, scene_elements)};
    options.keep_division = true;  // the bodies of the scene are these elements
    theories::MsaAt msa(stand.configuration, options);
    const auto& nodes = msa.mechanism().model.nodes;
    if (scene.is_null()) scene = Drawing(m, stand.configuration, msa.mechanism(), guilty).json();
    Json pose = {{"label", stand.label}, {"pose_mm_deg", json::json_numbers(stand.pose_mm_deg, "pose")}};
    for (const frame::Node& node : nodes) pose["points_mm"].push_back(scene_position(node.position));
    pose["instruments"] = instruments_json(m, stand.configuration);
    pose["axes"] = SectionAxes(stand.configuration.legs).json(scene["bodies"].size());
    pose["shapes"] = Json::array();
    for (const Vector6& load : loads) {
      msa.answer(load, geometry);
      Json shape;
      Vector6 shown = load;
      shown.tail<3>() *= report::mm;
      shape["load_N_Nmm"] = json::json_numbers(shown, "load");
      shape["arrows"] = Json::array();
      put_load_arrows(shape["arrows"], msa.mechanism().tool, load);
      for (std::size_t i = 0; i < nodes.size(); ++i)
        shape["displacement_mm"].push_back(scene_displacement(msa.displacements().segment<3>(as_index(6 * i))));
      pose["shapes"].push_back(std::move(shape));
    }
    scene["poses"].push_back(std::move(pose));
  }
  return scene;
}

}  // namespace deflect::scene
