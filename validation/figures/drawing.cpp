#include "validation/figures/drawing.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/frame/file/frame_build.h"
#include "msa/frame/file/member_axes.h"
#include "msa/frame/mechanism/build.h"
#include "msa/frame/structure/mobility.h"
#include "msa/frame/structure/stability.h"
#include "msa/mechanism/chain_kinematics.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/place.h"
#include "msa/mechanism/stand.h"
#include "validation/measurement/configure_all.h"

namespace deflect::figures {
namespace {

constexpr double shown_motion = 0.1;  // of the machine's size

SectionOutline outline(const RoundSection& s) { return {s.diameter, s.diameter, true}; }
SectionOutline outline(const TubeSection& s) { return {s.outer_diameter, s.outer_diameter, true}; }
SectionOutline outline(const GivenSection&) { return {}; }
SectionOutline outline(const AngleSection& s) { return {s.long_leg, s.short_leg, false}; }
template <class Shaped>
SectionOutline outline(const Shaped& s) {
  return {s.width_y, s.height_z, false};
}

void set_section(DrawnMember& m, const Named<Section>& sections, const std::string& name) {
  m.section = name;
  const Section* section = find(sections, name);
  if (!section) return;
  const SectionOutline o = outline_of(*section);
  m.size_y = o.size_y;
  m.size_z = o.size_z;
  m.round = o.round;
}

void set_motions(MachineDrawing& d, const frame::Model& model, std::size_t points) {
  const std::vector<char> all(model.springs.size(), 1);
  const frame::Mobility mobility = frame::mobility_of(model, all);
  if (mobility.free.cols() == 0) return;
  d.trouble = fmt::format("it cannot stand: {} motion{} that nothing resists", mobility.free.cols(),
                          mobility.free.cols() == 1 ? "" : "s");
  for (const frame::FreeMotion& motion : frame::free_motions_of(model, mobility.free)) {
    DrawnMotion drawn{describe(model, motion), {}};
    double largest = 0;
    for (std::size_t i = 0; i < points; ++i) {
      drawn.displacements.push_back(motion.u.segment<3>(as_index(6 * i)));
      largest = std::max(largest, drawn.displacements.back().norm());
    }
    const double scale = largest > 0 ? shown_motion * d.size() / largest : 0;
    for (Vector3& u : drawn.displacements) u *= scale;
    d.motions.push_back(std::move(drawn));
  }
}

/// Parts of a leg as they are described, beside the same parts as they stand.
class PlacedDrawing {
 public:
  PlacedDrawing(MachineDrawing& d, const Mechanism& m, const frame::MechanismModel& built)
      : drawing_(d), mechanism_(m), built_(built) {}

  void add_leg(const PlacedLeg& leg, const Named<Part>& parts) {
    auto described = parts.begin();
    for (const PlacedPart& placed : leg.parts) {
      const std::string& name = std::visit([](const auto& p) -> const std::string& { return p.part; }, placed);
      while (described != parts.end() && described->first != name) ++described;
      const Part* part = described == parts.end() ? nullptr : &described->second;
      if (const PlacedJoint* joint = joint_of(placed)) {
        add_joint(leg.name, *joint);
      } else if (const auto* member = std::get_if<PlacedMember>(&placed)) {
        add_member(leg.name, *member, part ? std::get_if<Member>(part) : nullptr);
      } else {
        const auto& group = std::get<PlacedParallel>(placed);
        const auto* branches = part ? std::get_if<Parallel>(part) : nullptr;
        for (std::size_t i = 0; branches && i < group.branches.size() && i < branches->mounts.size(); ++i)
          add_leg(group.branches[i], branches->mounts[i].leg.empty() ? branches->leg : branches->mounts[i].leg);
      }
    }
  }

  void add_joint(const std::string& leg, const PlacedJoint& joint) {
    DrawnJoint out;
    out.leg = leg;
    out.part = joint.part;
    for (std::size_t i = 0; i < 6; ++i) {
      out.letters += joint.freedoms[i] == Freedom::actuated ? 'a' : joint.freedoms[i] == Freedom::free ? 'f' : 'r';
      out.elastic[i] = joint.elastic(i);
    }
    if (joint.rigid() && !out.driven()) return;
    out.at = joint.p_W;
    out.axes = joint.R_WJ;
    drawing_.joints.push_back(std::move(out));
  }

 private:
  /// Beams of a member are called "leg 1 guideway [3]".
  void add_member(const std::string& leg, const PlacedMember& placed, const Member* described) {
    DrawnMember m;
    m.leg = leg;
    m.part = placed.part;
    m.start = placed.p_W_start;
    m.end = placed.p_W_end;
    m.axes = placed.R_WM;
    if (described) {
      m.material = described->material;
      set_section(m, mechanism_.sections, described->section);
    }
    const std::string name = leg + " " + placed.part;
    for (const frame::Beam& beam : built_.model.beams)
      if (beam.name == name || beam.name.starts_with(name + " ["))
        drawing_.lines.push_back({beam.a, beam.b, static_cast<int>(drawing_.members.size())});
    drawing_.members.push_back(std::move(m));
  }

  MachineDrawing& drawing_;
  const Mechanism& mechanism_;
  const frame::MechanismModel& built_;
};

MachineDrawing standing(const Mechanism& m, const Configuration& c) {
  MachineDrawing d;
  d.pose_mm_deg = mm_deg_from(c.pose);
  d.driven = c.actuators;
  const frame::MechanismModel built = frame::build(c);
  for (const frame::Node& node : built.model.nodes) d.points.push_back(node.position);
  PlacedDrawing placed(d, m, built);
  for (std::size_t i = 0; i < c.legs.size(); ++i)
    placed.add_leg(c.legs[i], c.legs[i].beside ? Named<Part>() : leg_parts(m, static_cast<int>(i) + 1));
  placed.add_joint("", c.base);
  placed.add_joint("", c.tool);
  for (const auto& [a, b] : built.arms) d.lines.push_back({a, b, -1});
  d.frames = {{"base", "", Vector3::Zero(), Matrix3::Identity()}, {"tool", "", c.pose.p_WT, c.pose.R_WT}};
  const auto at = [&](const Vector3& point) { return Vector3(c.pose.p_WT + c.pose.R_WT * point); };
  for (const auto& [name, s] : m.sensors) {
    const measurement::SensorPlace place = measurement::sensor_place(m, s, c);
    d.instruments.push_back({name, place.what, place.p_W, place.axis});
  }
  for (const auto& [name, p] : m.loads) d.instruments.push_back({name, "load on the " + p.body, at(p.point), {}});
  set_motions(d, built.model, d.points.size());
  return d;
}

/// Each leg by itself, where the walk leads it with its joints at home.
class OpenDrawing {
 public:
  OpenDrawing(MachineDrawing& d, const Mechanism& m) : drawing_(d), mechanism_(m) {}

  void add(const std::string& leg, const std::vector<Step>& steps) {
    for (const Step& step : steps) {
      if (const auto* joint = std::get_if<Joint>(step.part)) {
        add_joint(leg, step, *joint);
        add_line(step.before.p, step.after.p, -1);
      } else if (const auto* member = std::get_if<Member>(step.part)) {
        DrawnMember out;
        out.leg = leg;
        out.part = *step.name;
        out.material = member->material;
        out.start = step.start;
        out.end = step.after.p;
        out.axes = axes_of(*member, step);
        set_section(out, mechanism_.sections, member->section);
        add_line(out.start, out.end, static_cast<int>(drawing_.members.size()));
        drawing_.members.push_back(std::move(out));
      } else if (std::holds_alternative<Parallel>(*step.part)) {
        for (std::size_t i = 0; i < step.branches.size(); ++i)
          add(fmt::format("{} {} {}", leg, *step.name, i + 1), step.branches[i]);
      } else {
        add_line(step.before.p, step.after.p, -1);
      }
    }
  }

  void add_line(const Vector3& a, const Vector3& b, int member) {
    const auto i = static_cast<int>(drawing_.points.size());
    drawing_.points.push_back(a);
    drawing_.points.push_back(b);
    drawing_.lines.push_back({i, i + 1, member});
  }

 private:
  /// As place.h has them; those of the chain where the member has no length.
  static Matrix3 axes_of(const Member& member, const Step& step) {
    const Vector3 along = step.after.p - step.start, y_W = step.before.R * member.y_axis;
    const bool own = along.cross(y_W).norm() > 1e-6 * along.norm() * y_W.norm();
    PlacedMember placed;
    placed.R_WM = step.before.R;
    if (along.norm() > 1e-9)
      place_between(placed, step.start, step.after.p, own ? y_W : Vector3(step.before.R.col(1)), step.before.R.col(2));
    return placed.R_WM;
  }

  void add_joint(const std::string& leg, const Step& step, const Joint& joint) {
    DrawnJoint out;
    out.leg = leg;
    out.part = *step.name;
    const std::array<Freedom, 6> freedoms = freedoms_of(joint);
    for (std::size_t i = 0; i < 6; ++i) {
      out.letters += freedoms[i] == Freedom::actuated ? 'a' : freedoms[i] == Freedom::free ? 'f' : 'r';
      out.elastic[i] = joint.stiffness || !joint.laws[i].empty();
    }
    out.at = step.joint.p;
    out.axes = step.joint.R;
    drawing_.joints.push_back(std::move(out));
  }

  MachineDrawing& drawing_;
  const Mechanism& mechanism_;
};

MachineDrawing open_legs(const Mechanism& m, const std::string& why) {
  MachineDrawing d;
  const std::vector<LegParts> legs = legs_of(m);
  const Trace trace = walk(legs, home_states(legs));
  OpenDrawing open(d, m);
  for (std::size_t i = 0; i < trace.legs.size(); ++i) {
    open.add_line(Vector3::Zero(), trace.legs[i].start.p, -1);
    open.add(fmt::format("leg {}", i + 1), trace.legs[i].steps);
    d.frames.push_back({fmt::format("end of leg {}", i + 1), "", trace.legs[i].end.p, trace.legs[i].end.R});
  }
  d.frames.insert(d.frames.begin(), {"base", "", Vector3::Zero(), Matrix3::Identity()});
  const ActuatedCoordinates driven = actuated_at_home(m);
  for (std::size_t i = 0; i < driven.names.size(); ++i)
    d.driven.push_back({driven.names[i], driven.values(as_index(i)), driven.rotation[i]});
  d.trouble = fmt::format("{}. Each leg is drawn alone, with its joints at their home", why);
  return d;
}

/// Where the device stands at home, or why it does not.
Outcome<Configuration> at_home(const Mechanism& m) {
  return outcome_of<ModelError>([&] { return configure(m, home_pose(m)); });
}

using EntryKind = DrawnEntry::Kind;
using EntryWords = std::vector<std::string>;

/// "ry: linear, clearance; ry beside: friction"
void add_laws(const frame::FreedomLaws& laws, const frame::FreedomNames& names, EntryWords& out) {
  for (std::size_t i = 0; i < 6; ++i)
    for (const bool beside : {false, true}) {
      EntryWords kinds;
      for (const Law& law : laws.at(i, beside)) kinds.emplace_back(row_of(law).name);
      if (!kinds.empty())
        out.push_back(fmt::format("{}{}: {}", names[i], beside ? " beside" : "", fmt::join(kinds, ", ")));
    }
}

std::string laws_words(const frame::FreedomLaws& laws, const frame::FreedomNames& names) {
  EntryWords out;
  add_laws(laws, names, out);
  return fmt::format("{}", fmt::join(out, "; "));
}

std::string spring_words(const frame::FrameSpring& s) {
  EntryWords out = {fmt::format("{} to {}", s.node, s.to.empty() ? "the ground" : s.to)};
  if (s.coupled) out.emplace_back("6×6 stiffness");
  for (std::size_t i = 0; i < 6; ++i)
    if (s.stiffness[i])
      out.push_back(fmt::format("{}: {:.6g} {}", frame::node_freedoms[i], (i < 3 ? 1e-3 : 1e3) * *s.stiffness[i],
                                i < 3 ? "N/mm" : "Nmm/rad"));
  add_laws(s.laws, frame::node_freedoms, out);
  return fmt::format("{}", fmt::join(out, "; "));
}

/// "nodes B, M", with the names that have it.
template <class T>
void add_names(const char* what, const Named<T>& all, EntryWords& out) {
  EntryWords names;
  for (const auto& [name, value] : all) names.push_back(name);
  if (!names.empty()) out.push_back(fmt::format("{} {}", what, fmt::join(names, ", ")));
}

std::string load_words(const frame::LoadCase& load) {
  EntryWords out;
  for (const auto& [node, wrench] : load.nodes) {
    EntryWords components;
    for (Eigen::Index i = 0; i < 6; ++i)
      if (wrench(i) != 0)
        components.push_back(fmt::format("{} {:.6g} {}", nth(frame::wrench_names, i), (i < 3 ? 1 : 1e3) * wrench(i),
                                         i < 3 ? "N" : "Nmm"));
    out.push_back(
        fmt::format("{}: {}", node, components.empty() ? "0" : fmt::format("{}", fmt::join(components, ", "))));
  }
  add_names("along members", load.members, out);
  add_names("heated members", load.temperature, out);
  add_names("moved supports", load.displacements, out);
  if (!load.gravity.isZero(0)) out.emplace_back("weight");
  return fmt::format("{}", fmt::join(out, "; "));
}

std::string sensor_words(const frame::FrameSensor& s) {
  switch (s.reads) {
    case frame::FrameSensor::Reads::displacement:
      return fmt::format("{} of node {}", s.direction, s.of);
    case frame::FrameSensor::Reads::force:
      return fmt::format("{} of member {}", nth(frame::section_force_names, s.component), s.of);
    case frame::FrameSensor::Reads::strain:
      return fmt::format("strain of member {} at {:g} of its length, y = {:g} mm, z = {:g} mm", s.of, s.at, 1e3 * s.y,
                         1e3 * s.z);
    case frame::FrameSensor::Reads::reaction:
      break;
  }
  return fmt::format("{} of support {}", nth(frame::wrench_names, s.component), s.of);
}

/// Springs, laws at supports and at ends of members, load cases, sensors, each kind in the order of the file.
std::vector<DrawnEntry> entries_of(const frame::FrameDescription& f) {
  std::vector<DrawnEntry> out;
  for (const auto& [name, spring] : f.springs) out.push_back({EntryKind::spring, name, spring_words(spring)});
  const auto add = [&](const std::string& place, const frame::FreedomLaws& laws, const frame::FreedomNames& names) {
    if (!laws.empty()) out.push_back({EntryKind::law, place, laws_words(laws, names)});
  };
  for (const auto& [node, support] : f.supports) add("support " + node, support.laws, frame::node_freedoms);
  for (const auto& [name, member] : f.members) {
    add(fmt::format("start of {}", name), member.start, frame::member_freedoms);
    add(fmt::format("end of {}", name), member.end, frame::member_freedoms);
  }
  for (const auto& [name, load] : f.loads) out.push_back({EntryKind::load, name, load_words(load)});
  for (const auto& [name, sensor] : f.sensors) out.push_back({EntryKind::sensor, name, sensor_words(sensor)});
  return out;
}

}  // namespace

SectionOutline outline_of(const Section& section) {
  return std::visit([](const auto& s) { return outline(s); }, section.shape);
}

double MachineDrawing::size() const {
  Eigen::AlignedBox3d box;
  for (const Vector3& p : points) box.extend(p);
  return points.empty() ? 0 : box.diagonal().norm();
}

MachineDrawing drawing_of(const Mechanism& m, const std::optional<Configuration>& at) {
  const Outcome<Configuration> c = at ? Outcome<Configuration>{at, ""} : at_home(m);
  if (!c && !std::holds_alternative<Chains>(m.kinematics)) throw ModelError(c.why, c.cause);
  MachineDrawing d = c ? standing(m, *c) : open_legs(m, c.why);
  d.name = m.name;
  d.about = m.about;
  return d;
}

MachineDrawing drawing_of(const frame::FrameDescription& f) {
  MachineDrawing d;
  d.name = f.name;
  d.about = f.about;
  d.frame = true;
  const frame::FrameModel built = frame::build_frame(f);
  for (const frame::Node& node : built.model.nodes) d.points.push_back(node.position);
  for (std::size_t i = 0; i < f.members.size(); ++i) {
    const auto& [name, member] = f.members[i];
    DrawnMember m;
    m.part = name;
    m.material = member.material;
    m.start = nth(f.nodes, built.nodes.find(member.from)).second;
    m.end = nth(f.nodes, built.nodes.find(member.to)).second;
    m.axes = frame::member_axes(m.end - m.start, member.y_axis);
    set_section(m, f.sections, member.section);
    for (int e = built.first_element[i]; e < built.first_element[i + 1]; ++e) {
      const frame::Beam& beam = nth(built.model.beams, e);
      d.lines.push_back({beam.a, beam.b, static_cast<int>(i)});
    }
    d.members.push_back(std::move(m));
  }
  for (const auto& [a, b] : built.arms) d.lines.push_back({a, b, -1});
  for (const auto& [name, position] : f.nodes) {
    DrawnPoint node{name, "", position, Matrix3::Identity()};
    for (const auto& [where, held] : f.supports)
      for (std::size_t i = 0; where == name && i < 6; ++i)
        if (held[i]) node.held += (node.held.empty() ? "" : " ") + std::string(frame::node_freedoms[i]);
    d.frames.push_back(std::move(node));
  }
  d.entries = entries_of(f);
  set_motions(d, built.model, d.points.size());
  return d;
}

}  // namespace deflect::figures
