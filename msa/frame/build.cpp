#include "msa/frame/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "msa/base/error.h"
#include "msa/frame/component.h"

namespace deflect::frame {
namespace {

bool rigid(const PlacedJoint& j) {
  for (std::size_t i = 0; i < 6; ++i)
    if (j.elastic(i) || j.free(i)) return false;
  return true;
}

std::array<ConnectionFreedom, 6> connection(const PlacedJoint& j) {
  std::array<ConnectionFreedom, 6> out;
  for (std::size_t i = 0; i < 6; ++i) {
    out[i].rigid = !j.elastic(i) && !j.free(i);
    for (const Law& law : j.laws[i]) out[i].laws.push_back(spring_of(law));
  }
  return out;
}

BeamRigidity rigidity(const PlacedMember& m) {
  const double none = std::numeric_limits<double>::infinity();
  BeamRigidity r{m.E * m.section.A, m.E * m.section.Iy, m.E * m.section.Iz, m.G * m.section.J, none, none};
  if (m.beam == BeamTheory::timoshenko) {
    r.GAs_y = m.G * m.section.As_y;
    r.GAs_z = m.G * m.section.As_z;
  }
  return r;
}

/// Nodes must all exist before connections bring scalars: what is to be connected waits here.
struct Pending {
  int a, b;
  Vector3 p;
  const PlacedJoint* joint;  // nullptr: rigid
  std::string name;
  bool ends_leg = false;
};

class Builder {
 public:
  explicit Builder(const MemberDivision& division) : division_(division) {}

  int body(const std::string& name, const Vector3& p) { return model.add_node(name, p); }

  void joint(int a, int b, const PlacedJoint& j, const std::string& name) {
    pending_.push_back({a, b, j.p_W, &j, name});
  }

  /// The chain from the body of node `from` to the body of node `to`.
  void chain(const PlacedLeg& leg, int from, int to) {
    int at = from;
    const PlacedJoint* waiting = nullptr;  // a joint whose far side is the next member's node
    const auto attach = [&](int node, const Vector3& p) {
      if (waiting)
        joint(at, node, *waiting, leg.name + " " + waiting->part);
      else
        pending_.push_back({at, node, p, nullptr, leg.name + " attachment"});
      waiting = nullptr;
      at = node;
    };
    for (const PlacedPart& part : leg.parts) {
      if (const auto* j = std::get_if<PlacedJoint>(&part)) {
        if (rigid(*j)) continue;
        if (waiting) attach(body(fmt::format("{} {} / {}", leg.name, waiting->part, j->part), j->p_W), j->p_W);
        waiting = j;
      } else {
        const auto& m = std::get<PlacedMember>(part);
        attach(body(fmt::format("{} {} start", leg.name, m.part), m.p_W_start), m.p_W_start);
        at = member(leg, m, at);
      }
    }
    attach(to, model.nodes[static_cast<std::size_t>(to)].position);
    pending_.back().ends_leg = true;
  }

  void finish(MechanismModel& out) {
    const auto position = [this](int node) { return model.nodes[static_cast<std::size_t>(node)].position; };
    for (const Pending& p : pending_) {
      if ((position(p.a) - position(p.b)).norm() > 1e-9) out.arms.emplace_back(p.a, p.b);
      const std::size_t constraints = model.constraints.size(), springs = model.springs.size();
      model.connect(p.a, p.b, p.p, p.joint ? p.joint->R_WJ : Matrix3::Identity(),
                    p.joint ? connection(*p.joint) : std::array<ConnectionFreedom, 6>{}, p.name,
                    p.joint ? p.joint->part : "");
      if (p.ends_leg) out.attachments.push_back({constraints, model.constraints.size(), springs, model.springs.size()});
    }
    out.model = std::move(model);
  }

  Model model;

 private:
  int member(const PlacedLeg& leg, const PlacedMember& m, int start) {
    const auto found = division_.find(m.part);
    const std::vector<double> at = found == division_.end() ? std::vector<double>{0, 1} : found->second;
    const std::string name = leg.name + " " + m.part;
    int previous = start;
    for (std::size_t i = 1; i < at.size(); ++i) {
      const bool last = i + 1 == at.size();
      const Vector3 p = last ? m.p_W_end : m.p_W_start + at[i] * (m.p_W_end - m.p_W_start);
      const int next = body(last ? name + " end" : fmt::format("{} {:.4g}", name, at[i]), p);
      model.add_beam(previous, next, m.R_WM, rigidity(m), fmt::format("{} [{}]", name, i), m.part);
      previous = next;
    }
    return previous;
  }

  const MemberDivision& division_;
  std::vector<Pending> pending_;
};

}  // namespace

MechanismModel build(const Configuration& c, const MemberDivision& division) {
  Builder b(division);
  MechanismModel out;
  out.ground = b.body("ground", c.base.p_W);
  out.base = rigid(c.base) ? out.ground : b.body("base", c.base.p_W);
  out.platform = b.body("platform", c.pose.p_WT);
  out.tool = rigid(c.tool) ? out.platform : b.body("tool", c.tool.p_W);
  if (out.base != out.ground) b.joint(out.ground, out.base, c.base, "base");
  if (out.tool != out.platform) b.joint(out.platform, out.tool, c.tool, "tool");
  for (const PlacedLeg& leg : c.legs) b.chain(leg, out.base, out.platform);
  b.model.fix(out.ground, "ground");
  b.finish(out);
  return out;
}

MechanismModel build_leg(const Configuration& c, std::size_t leg, const MemberDivision& division) {
  Builder b(division);
  MechanismModel out;
  out.ground = out.base = b.body("ground", c.base.p_W);
  out.platform = out.tool = b.body("platform", c.pose.p_WT);
  b.chain(c.legs[leg], out.ground, out.platform);
  b.model.fix(out.ground, "ground");
  b.finish(out);
  return out;
}

}  // namespace deflect::frame
