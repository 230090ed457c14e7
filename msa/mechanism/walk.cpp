#include "msa/mechanism/walk.h"

#include <fmt/format.h>

#include <map>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/place.h"

namespace deflect {
namespace {

Matrix3 rotation_about(std::size_t axis, double angle) {
  return Eigen::AngleAxisd(angle, Vector3::Unit(as_index(axis))).toRotationMatrix();
}

Frame turned(std::size_t axis, double angle) { return {Vector3::Zero(), rotation_about(axis, angle)}; }
Frame shifted(const Vector3& p) { return {p, Matrix3::Identity()}; }

Frame standard(const DhRow& r) { return turned(2, r.theta) * shifted({r.a, 0, r.d}) * turned(0, r.alpha); }
Frame modified(const DhRow& r) {
  return turned(0, r.alpha) * shifted({r.a, 0, 0}) * turned(2, r.theta) * shifted({0, 0, r.d});
}

Matrix3 axes_of(const Vector3& axis) {
  if (axis.isApprox(Vector3::UnitZ())) return Matrix3::Identity();
  return axes_along_z(axis, Vector3::UnitX(), Vector3::UnitY());
}

class Walker {
 public:
  explicit Walker(const std::vector<JointState>& states) : states_(states) {}

  Trace trace;

  void leg(const LegParts& l) {
    Trace::Leg out;
    out.start = at_ = frame_of(l.mount.base);
    path_.clear();
    passed_.clear();
    out.steps = parts(l.parts);
    out.end = at_ * frame_of(l.mount.platform).inverse();
    out.path = path_;
    trace.legs.push_back(std::move(out));
  }

 private:
  /// Where a member can begin.
  struct Points {
    Vector3 usual, start, end;

    const Vector3& at(PartPoint p) const { return p == PartPoint::usual ? usual : p == PartPoint::start ? start : end; }
  };

  static Points points_of(const Step& step) {
    if (std::holds_alternative<Joint>(*step.part)) return {step.joint.p, step.joint.p, step.after.p};
    const bool member = std::holds_alternative<Member>(*step.part);
    return {step.after.p, member ? step.start : step.before.p, step.after.p};
  }

  std::vector<Step> parts(const Named<Part>& list) {
    std::vector<Step> steps;
    steps.reserve(list.size());
    for (const auto& [name, part] : list) {
      Step step;
      step.name = &name;
      step.part = &part;
      step.before = at_;
      std::visit([&](const auto& p) { pass(p, step); }, part);
      step.after = at_;
      passed_[name] = points_of(step);
      steps.push_back(std::move(step));
    }
    return steps;
  }

  void add(const Step& step, std::size_t freedom, const std::array<Freedom, 6>& freedoms, const Vector3& v,
           const Vector3& w) {
    Coordinate c{step.state, freedom, freedoms[freedom] == Freedom::actuated, is_ball(freedoms), {}};
    c.twist << v, w;
    path_.push_back(trace.coordinates.size());
    trace.coordinates.push_back(c);
  }

  void pass(const Joint& j, Step& step) {
    step.state = next_;
    const JointState& s = states_[next_++];
    const std::array<Freedom, 6> freedoms = freedoms_of(j);
    const Frame before = j.modified_dh ? at_ * modified(*j.modified_dh) : at_;
    const Matrix3 A = axes_of(j.axis);
    step.joint = before * Frame{Vector3::Zero(), A};
    const Matrix3 axes = step.joint.R;

    Vector3 shift(s.q[0], s.q[1], s.q[2]);
    if (const double radius = j.bar.head<2>().norm(); radius > 0) {  // of a parallelogram: s = φ r along the circle
      const Vector3 bar = rotation_about(2, s.q[0] / radius) * j.bar;
      shift = bar;
      const Vector3 along = Vector3::UnitZ().cross(bar).normalized();
      step.joint.R = axes * axes_along_x(along, bar);
      add(step, 0, freedoms, step.joint.R.col(0), Vector3::Zero());
    } else {
      for (std::size_t i = 0; i < 3; ++i)
        if (movable(freedoms[i])) add(step, i, freedoms, axes.col(as_index(i)), Vector3::Zero());
    }
    const Vector3 p = step.joint.p + axes * shift;
    const bool ball = is_ball(freedoms);
    Matrix3 turning = Matrix3::Identity();
    step.turning = axes;
    bool first = true;
    for (std::size_t i = 0; i < 3; ++i) {
      if (movable(freedoms[3 + i])) {
        const Vector3 w = axes * (ball ? Matrix3::Identity() : turning).col(as_index(i));
        add(step, 3 + i, freedoms, p.cross(w), w);
      }
      turning = turning * rotation_about(i, s.q[3 + i]);
      if (first && movable(freedoms[3 + i])) {
        step.turning = axes * turning;
        first = false;
      }
    }
    if (ball) turning = s.ball;
    step.moved = {p, step.joint.R * turning};
    at_ = {p, axes * turning * A.transpose()};
    if (j.dh) at_ = at_ * standard(*j.dh);
  }

  void pass(const Member& m, Step& step) {
    if (m.along) {
      step.start = at_.p;
      at_ = at_ * shifted(*m.along);
      return;
    }
    const auto found = passed_.find(m.from);
    if (found == passed_.end())
      throw InputError(
          fmt::format("{}: the member begins at '{}', which is no earlier part of this leg", *step.name, m.from));
    step.start = found->second.at(m.from_point);
  }

  void pass(const Offset& o, Step&) { at_ = at_ * frame_of(o); }

  void pass(const Parallel& group, Step& step) {
    const Frame start = at_;
    const std::vector<std::size_t> path = path_;
    const std::map<std::string, Points> passed = passed_;
    Frame end;
    std::vector<std::size_t> path_to_end;
    for (std::size_t b = 0; b < group.mounts.size(); ++b) {
      const Mount& mount = group.mounts[b];
      at_ = start * frame_of(mount.base);
      path_ = path;
      passed_ = passed;
      step.branches.push_back(parts(mount.leg.empty() ? group.leg : mount.leg));
      const Frame reached = at_ * frame_of(mount.platform).inverse();
      if (b == 0) {
        end = reached;
        path_to_end = path_;
      } else {
        trace.closures.push_back({end, reached, path_to_end, path_});
      }
    }
    at_ = end;
    path_ = path_to_end;
    passed_ = passed;
  }

  const std::vector<JointState>& states_;
  std::size_t next_ = 0;
  Frame at_;
  std::vector<std::size_t> path_;
  std::map<std::string, Points> passed_;
};

void collect_home(const Named<Part>& parts, std::vector<JointState>& states) {
  for (const auto& [name, part] : parts)
    if (const auto* joint = std::get_if<Joint>(&part)) {
      JointState s;
      s.q = joint->home;
      for (std::size_t i = 0; i < 3; ++i) s.ball = s.ball * rotation_about(i, s.q[3 + i]);
      states.push_back(s);
    } else if (const auto* group = std::get_if<Parallel>(&part)) {
      for (const Mount& mount : group->mounts) collect_home(mount.leg.empty() ? group->leg : mount.leg, states);
    }
}

}  // namespace

Frame frame_of(const Placement& p) { return {p.shift, rotation_from_rpy(p.turn.x(), p.turn.y(), p.turn.z())}; }

bool movable(Freedom f) { return f != Freedom::rigid; }

bool is_ball(const std::array<Freedom, 6>& f) {
  return f[3] == Freedom::free && f[4] == Freedom::free && f[5] == Freedom::free;
}

std::vector<LegParts> legs_of(const Mechanism& m) {
  std::vector<LegParts> legs;
  for (int leg = 1; leg <= leg_count(m); ++leg) {
    const Mount mount = m.mounts.empty() ? Mount() : nth(m.mounts, leg - 1);
    legs.push_back({mount, leg_parts(m, leg)});
  }
  return legs;
}

std::vector<JointState> home_states(std::span<const LegParts> legs) {
  std::vector<JointState> states;
  for (const LegParts& leg : legs) collect_home(leg.parts, states);
  return states;
}

Trace walk(std::span<const LegParts> legs, const std::vector<JointState>& states) {
  Walker walker(states);
  for (const LegParts& leg : legs) walker.leg(leg);
  return std::move(walker.trace);
}

void move(JointState& s, const Coordinate& c, double step) {
  if (c.ball && c.freedom >= 3)
    s.ball = rotation_about(c.freedom - 3, step) * s.ball;
  else
    s.q[c.freedom] += step;
}

}  // namespace deflect
