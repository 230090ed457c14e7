#include "validation/report/page_scene.h"
#include "validation/report/text.h"

#include <algorithm>
#include <cmath>

#include "validation/compare/at_pose.h"

namespace deflect {
namespace {

constexpr int elements = 8;

/// For the eye: positions to 0.1 µm; displacements keep seven digits.
double rounded(double x, double step) { return std::round(x / step) * step; }
double digits(double x) {
  if (x == 0) return 0;
  const double step = std::pow(10, std::floor(std::log10(std::abs(x))) - 6);
  return rounded(x, step);
}

Json position(const Vector3& p) {
  return {rounded(mm * p.x(), 1e-4), rounded(mm * p.y(), 1e-4), rounded(mm * p.z(), 1e-4)};
}

class Drawing {
 public:
  Drawing(const Configuration& c, const frame::MechanismModel& built, const std::vector<ChangedPart>& guilty)
      : configuration_(c), built_(built), guilty_(guilty) {
    members(c.legs);
    arms();
    joints(c.legs);
    for (const auto& [part, joint, node] :
         {std::tuple{"base", &c.base, built.base}, std::tuple{"tool", &c.tool, built.tool}})
      if (is_guilty("", part)) add_joint("", part, *joint, node);
  }

  Json json() const {
    Json names = Json::array();
    for (const ChangedPart& g : guilty_) {
      const std::string words = g.leg.empty() ? g.part : g.leg + " " + (g.part.empty() ? "seat" : g.part);
      if (std::find(names.begin(), names.end(), words) == names.end()) names.push_back(words);
    }
    return {{"bodies", bodies_}, {"cells", cells_}, {"joints", joints_}, {"tool", built_.tool}, {"guilty", names}};
  }

 private:
  bool is_guilty(const std::string& leg, const std::string& part) const {
    return std::any_of(guilty_.begin(), guilty_.end(), [&](const ChangedPart& g) {
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

  /// Beams of a member are called "leg 1 guideway [3]".
  void add_member(const std::string& leg, const PlacedMember& m) {
    const std::string name = leg + " " + m.part + " [";
    const double radius = 2 * std::sqrt(std::max(m.section.Iy, m.section.Iz) / m.section.A);
    bodies_.push_back({{"leg", leg},
                       {"part", m.part},
                       {"kind", "member"},
                       {"radius_mm", digits(mm * radius)},
                       {"guilty", is_guilty(leg, m.part)}});
    for (const frame::Beam& beam : built_.model.beams)
      if (beam.name.starts_with(name)) cells_.push_back({beam.a, beam.b, bodies_.size() - 1});
  }

  void arms() {
    const auto body = [this](const char* kind) {
      for (std::size_t i = 0; i < bodies_.size(); ++i)
        if (bodies_[i]["kind"] == kind) return i;
      bodies_.push_back(
          {{"leg", ""}, {"part", kind}, {"kind", kind}, {"radius_mm", 0}, {"guilty", is_guilty("", kind)}});
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
        if (const auto* group = std::get_if<PlacedParallel>(&part))
          joints(group->branches);
        else if (const auto* joint = std::get_if<PlacedJoint>(&part))
          add_joint(leg.name, joint->part, *joint, nearest_node(*joint));
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
  const frame::MechanismModel& built_;
  const std::vector<ChangedPart>& guilty_;
  Json bodies_ = Json::array(), cells_ = Json::array(), joints_ = Json::array();
};

}  // namespace

Json scene_json(const std::vector<SceneStand>& stands, const std::vector<Vector6>& loads,
                const std::vector<ChangedPart>& guilty, Geometry geometry) {
  Json scene;
  for (const SceneStand& stand : stands) {
    MsaAtPose msa(stand.configuration, frame::equal_division(stand.configuration, elements), "pose " + stand.label);
    const auto& nodes = msa.mechanism().model.nodes;
    if (scene.is_null()) {
      scene = Drawing(stand.configuration, msa.mechanism(), guilty).json();
      scene["poses"] = Json::array();
    }
    Json pose = {{"label", stand.label}, {"pose_mm_deg", json_numbers(stand.pose_mm_deg, "pose")}};
    for (const frame::Node& node : nodes) pose["points_mm"].push_back(position(node.position));
    pose["shapes"] = Json::array();
    for (const Vector6& load : loads) {
      msa.solve(load, geometry);
      Json shape;
      Vector6 shown = load;
      shown.tail<3>() *= mm;
      shape["load_N_Nmm"] = json_numbers(shown, "load");
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Vector3 u = mm * msa.displacements().segment<3>(static_cast<Eigen::Index>(6 * i));
        shape["displacement_mm"].push_back({digits(u.x()), digits(u.y()), digits(u.z())});
      }
      pose["shapes"].push_back(std::move(shape));
    }
    scene["poses"].push_back(std::move(pose));
  }
  return scene;
}

}  // namespace deflect
