#include "msa/frame/mechanism/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/laws/component.h"
#include "msa/frame/structure/coupled_spring.h"

namespace deflect::frame {
namespace {

std::array<ConnectionFreedom, 6> connection(const PlacedJoint& j) {
  std::array<ConnectionFreedom, 6> out;
  for (std::size_t i = 0; i < 6; ++i) {
    out[i].rigid = !j.elastic(i) && !j.free(i);
    for (const Law& law : j.laws[i]) {
      out[i].laws.push_back(preloaded(spring_of(law), j.preload[i]));
      out[i].laws.back().rotation = i >= 3;
    }
  }
  return out;
}

/// Nodes must all exist before connections bring scalars: what is to be connected waits here.
struct Pending {
  int a, b;
  Vector3 p;
  const PlacedJoint* joint;  // nullptr: rigid
  std::string name;
  bool ends_leg = false;
  Vector6 beside = Vector6::Zero();     // rigid: how far b stands beside a, at p
  const PlacedJoint* shared = nullptr;  // of laws side by side with a joint: the joint
};

/// Tells the frictions of a connection with which spring of the joint they stand side by side.
void stand_beside(Model& model, const Pending& p, std::size_t first, std::size_t springs_of_joint) {
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < p.joint->laws[i].size(); ++k, ++first)
      if (auto* friction = std::get_if<FrictionSpring>(&model.springs[first].law);
          friction && friction->share > 0 && !p.shared->laws[i].empty())
        friction->beside = static_cast<int>(springs_of_joint);
    springs_of_joint += p.shared->laws[i].size();
  }
}

class Builder {
 public:
  explicit Builder(const MemberDivision& division) : division_(division) {}

  int body(const std::string& name, const Vector3& p) { return model.add_node(name, p); }

  void joint(int a, int b, const PlacedJoint& j, const std::string& name) {
    pending_.push_back({a, b, j.p_W, &j, name});
  }

  /// A leg of the mechanism, from the body of node `from` to the platform at p_WT, the body of node `to`.
  void mounted_leg(const PlacedLeg& leg, std::size_t number, int from, int to, const Vector3& p_WT) {
    const bool beside = !leg.misfit.isZero(0);
    const int end = beside ? body(leg.name + " end", p_WT) : to;
    leg_ = number;
    chain(leg, from, end, {});
    if (beside) pending_.push_back({end, to, p_WT, nullptr, leg.name + " seat", false, leg.misfit});
    pending_.back().ends_leg = true;
  }

  void finish(MechanismModel& out) {
    const auto position = [this](int node) { return nth(model.nodes, node).position; };
    std::map<const PlacedJoint*, std::size_t> springs_of;
    std::vector<MechanismModel::Cut> passed;
    for (const Pending& p : pending_) {
      if ((position(p.a) - position(p.b)).norm() > 1e-9) out.arms.emplace_back(p.a, p.b);
      const std::size_t constraints = model.constraints.size(), springs = model.springs.size(),
                        connections = model.connections.size();
      if (p.joint && p.joint->stiffness)
        connect_coupled(model, p.a, p.b, p.p, p.joint->R_WJ, *p.joint->stiffness, p.name, p.joint->part);
      else
        model.connect(p.a, p.b, p.p, p.joint ? p.joint->R_WJ : Matrix3::Identity(),
                      p.joint ? connection(*p.joint) : std::array<ConnectionFreedom, 6>{}, p.name,
                      p.joint ? p.joint->part : "");
      passed.push_back({model.connections.size() > connections ? static_cast<int>(connections) : -1, constraints,
                        model.constraints.size(), springs, model.springs.size()});
      if (p.joint) springs_of[p.joint] = springs;
      if (p.shared && springs_of.contains(p.shared)) stand_beside(model, p, springs, springs_of.at(p.shared));
      if (!p.beside.isZero(0))
        for (Eigen::Index i = 0; i < 6; ++i) model.constraints[constraints + as_size(i)].value = p.beside(i);
      if (p.ends_leg) out.attachments.push_back({constraints, model.constraints.size(), springs, model.springs.size()});
    }
    for (const auto& [key, open] : open_) {
      MechanismModel::Cut cut;
      if (open.pending) {
        cut = passed[*open.pending];
        cut.far = pending_[*open.pending].b;
      }
      cut.own = open.own;
      cut.side = open.side, cut.behind = open.behind;
      out.cuts[key] = cut;
    }
    out.members = std::move(members_);
    out.model = std::move(model);
  }

  Model model;

 private:
  using Path = std::vector<std::size_t>;
  /// What Cut says, before connections are made.
  struct Open {
    std::optional<std::size_t> pending = {};
    int side = 0, behind = 0;
    bool own = false;
  };

  /// A chain from the body of node `from` to the body of node `to`. `path`: of the branch, in the leg.
  void chain(const PlacedLeg& leg, int from, int to, const Path& path) {
    int at = from;
    const PlacedJoint* waiting = nullptr;       // a joint whose far side is the next member's node
    std::vector<std::pair<Path, bool>> joints;  // since the last connection; whether they stand on its far side
    const auto attach = [&](int node, const Vector3& p) {
      for (const auto& [part, far] : joints) {
        Open& open = open_[{leg_, part}];
        open.pending = pending_.size();
        open.side = far ? node : at;
        open.behind = open.own ? node : open.side;
      }
      joints.clear();
      if (waiting)
        joint(at, node, *waiting, leg.name + " " + waiting->part);
      else
        pending_.push_back({at, node, p, nullptr, leg.name + " attachment"});
      waiting = nullptr;
      at = node;
    };
    for (std::size_t k = 0; k < leg.parts.size(); ++k) {
      const PlacedPart& part = leg.parts[k];
      Path here = path;
      here.push_back(k);
      if (const auto* j = std::get_if<PlacedJoint>(&part)) {
        if (j->rigid()) {
          joints.emplace_back(here, waiting != nullptr);
          continue;
        }
        if (waiting) attach(body(fmt::format("{} {} / {}", leg.name, waiting->part, j->part), j->p_W), j->p_W);
        waiting = j;
        joints.emplace_back(here, false);
        open_[{leg_, here}].own = true;
      } else if (const auto* group = std::get_if<PlacedParallel>(&part)) {
        attach(body(fmt::format("{} {} start", leg.name, group->part), group->p_W_start), group->p_W_start);
        const int end = body(fmt::format("{} {} end", leg.name, group->part), group->p_W_end);
        const std::size_t first = pending_.size();
        for (std::size_t b = 0; b < group->branches.size(); ++b) {
          Path inner = here;
          inner.push_back(b);
          chain(group->branches[b], at, end, inner);
        }
        open_[{leg_, here}] = {{}, at, end};
        for (std::size_t i = first; group->one_joint && i < pending_.size(); ++i)
          if (pending_[i].joint && pending_[i].joint != joint_of(part)) pending_[i].shared = joint_of(part);
        at = end;
      } else {
        const auto& m = std::get<PlacedMember>(part);
        attach(body(fmt::format("{} {} start", leg.name, m.part), m.p_W_start), m.p_W_start);
        const int start = at;
        at = member(leg, m, at);
        open_[{leg_, here}] = {{}, start, at};
      }
    }
    attach(to, nth(model.nodes, to).position);
  }

  int member(const PlacedLeg& leg, const PlacedMember& m, int start) {
    const auto found = division_.find(m.part);
    const std::vector<double> at = found == division_.end() ? std::vector<double>{0, 1} : found->second;
    const std::string name = leg.name + " " + m.part;
    const std::size_t first = model.beams.size();
    int previous = start;
    for (std::size_t i = 1; i < at.size(); ++i) {
      const bool last = i + 1 == at.size();
      const Vector3 p = last ? m.p_W_end : m.p_W_start + at[i] * (m.p_W_end - m.p_W_start);
      const int next = body(last ? name + " end" : fmt::format("{} {:.4g}", name, at[i]), p);
      model.add_beam(previous, next, m.R_WM, rigidity(m), fmt::format("{} [{}]", name, i), m.part);
      model.beams.back().expansion = m.expansion;
      previous = next;
    }
    members_.emplace_back(first, model.beams.size());
    return previous;
  }

  const MemberDivision& division_;
  std::vector<Pending> pending_;
  std::size_t leg_ = 0;
  std::map<std::pair<std::size_t, Path>, Open> open_;
  std::vector<std::pair<std::size_t, std::size_t>> members_;
};

}  // namespace

BeamRigidity rigidity(const PlacedMember& m) {
  const double none = std::numeric_limits<double>::infinity();
  BeamRigidity r{m.E * m.section.A, m.E * m.section.Iy, m.E * m.section.Iz, m.G * m.section.J, none, none};
  if (m.beam == BeamTheory::timoshenko) {
    r.GAs_y = m.G * m.section.As_y;
    r.GAs_z = m.G * m.section.As_z;
  }
  return r;
}

MemberDivision equal_division(const Configuration& c, int elements) {
  std::vector<double> at;
  for (int i = 0; i <= elements; ++i) at.push_back(static_cast<double>(i) / elements);
  MemberDivision out;
  for_each_part(c.legs, [&](const auto& part) {
    if constexpr (std::is_same_v<std::decay_t<decltype(part)>, PlacedMember>) out[part.part] = at;
  });
  return out;
}

MemberDivision halved(const Configuration& c, const MemberDivision& division) {
  MemberDivision out = division;
  for_each_part(c.legs, [&](const auto& part) {
    if constexpr (std::is_same_v<std::decay_t<decltype(part)>, PlacedMember>) {
      const auto given = division.find(part.part);
      const std::vector<double> at = given == division.end() ? std::vector<double>{0, 1} : given->second;
      std::vector<double> finer{at.front()};
      for (std::size_t i = 1; i < at.size(); ++i) finer.insert(finer.end(), {(at[i - 1] + at[i]) / 2, at[i]});
      out[part.part] = std::move(finer);
    }
  });
  return out;
}

MechanismModel build(const Configuration& c, const MemberDivision& division) {
  Builder b(division);
  MechanismModel out;
  out.ground = b.body("ground", c.base.p_W);
  out.base = c.base.rigid() ? out.ground : b.body("base", c.base.p_W);
  out.platform = b.body("platform", c.pose.p_WT);
  out.tool = c.tool.rigid() ? out.platform : b.body("tool", c.tool.p_W);
  if (out.base != out.ground) b.joint(out.ground, out.base, c.base, "base");
  if (out.tool != out.platform) b.joint(out.platform, out.tool, c.tool, "tool");
  for (std::size_t i = 0; i < c.legs.size(); ++i) b.mounted_leg(c.legs[i], i, out.base, out.platform, c.pose.p_WT);
  b.model.fix(out.ground, "ground");
  b.model.watched = out.tool;
  b.finish(out);
  return out;
}

MechanismModel build_leg(const Configuration& c, std::size_t leg, const MemberDivision& division) {
  Builder b(division);
  MechanismModel out;
  out.ground = out.base = b.body("ground", c.base.p_W);
  out.platform = out.tool = b.body("platform", c.pose.p_WT);
  b.mounted_leg(c.legs[leg], leg, out.ground, out.platform, c.pose.p_WT);
  b.model.fix(out.ground, "ground");
  b.model.watched = out.tool;
  b.finish(out);
  return out;
}

}  // namespace deflect::frame
