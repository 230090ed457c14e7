// The legs of the family "chains": parts where the walk has taken them.
#include <fmt/format.h>

#include <algorithm>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/chain_kinematics.h"
#include "msa/mechanism/family.h"
#include "msa/mechanism/law.h"
#include "msa/mechanism/place.h"

namespace deflect {
namespace {

/// A joint of which only some freedoms are left; the others are rigid.
PlacedJoint only(PlacedJoint j, const std::array<bool, 6>& left, const Frame& at) {
  j.p_W = at.p;
  j.R_WJ = at.R;
  for (std::size_t i = 0; i < 6; ++i)
    if (!left[i]) {
      j.freedoms[i] = Freedom::rigid;
      j.laws[i].clear();
      j.preload[i] = 0;
    }
  return j;
}

/// A joint in the state in which it stands. Its freedoms move one after the other, each about axes that the ones before
/// have turned: where these are not the axes of one frame, it is several joints in series.
void place_joint(const Step& step, const Joint& joint, double actuator, const Mechanism& m, const std::string& leg,
                 std::vector<PlacedPart>& out) {
  const std::array<std::vector<Law>, 6> beside = beside_of(joint, m, actuator);
  const Frame& at = joint.axes == "after" ? step.moved : step.joint;
  PlacedJoint whole = placed(joint, *step.name, {at.p, at.R, actuator}, m);
  std::array<bool, 6> slides{}, turns{}, last_turn{}, yields{};
  const bool ball = is_ball(whole.freedoms);
  int slide_count = 0, turn_count = 0;
  for (std::size_t i = 0; i < 6; ++i)
    if (!movable(whole.freedoms[i]))
      yields[i] = whole.elastic(i);
    else if (i < 3)
      slides[i] = ++slide_count > 0;
    else
      (++turn_count == 3 && !ball ? last_turn : turns)[i] = true;
  const bool one_frame = turn_count == 0 || (slide_count == 0 && (turn_count == 1 || ball));
  if (one_frame || whole.stiffness) return put(std::move(whole), beside, leg, out);
  const auto add = [&](const std::array<bool, 6>& left, const Frame& frame) {
    if (std::find(left.begin(), left.end(), true) == left.end()) return;
    std::array<std::vector<Law>, 6> own;
    for (std::size_t i = 0; i < 6; ++i)
      if (left[i]) own[i] = beside[i];
    put(only(whole, left, frame), own, leg, out);
  };
  add(slides, step.joint);
  add(turns, {step.moved.p, ball ? at.R : step.turning});
  add(last_turn, step.moved);
  add(yields, at);
}

class Placer {
 public:
  Placer(const Mechanism& m, const std::vector<JointState>& states) : m_(m), states_(states) {}

  PlacedLeg leg(const std::string& name, const std::vector<Step>& steps) const {
    PlacedLeg out;
    out.name = name;
    const double actuator = extension(steps);
    for (const Step& step : steps)
      told_at<InputError>(
          [&] { return fmt::format("{}: {}: {}: ", m_.name, name, *step.name); },
          [&] { std::visit([&](const auto& part) { place(part, step, name, actuator, out.parts); }, *step.part); });
    return out;
  }

 private:
  /// Of the last actuated slide among the parts, m; a cable's free length where it has none of its own.
  double extension(const std::vector<Step>& steps) const {
    double found = 0;
    for (const Step& step : steps)
      if (const auto* joint = std::get_if<Joint>(step.part)) {
        const std::array<Freedom, 6> f = freedoms_of(*joint);
        for (std::size_t i = 0; i < 3; ++i)
          if (f[i] == Freedom::actuated) found = states_[step.state].q[i];
      }
    return found;
  }

  void place(const Joint& joint, const Step& step, const std::string& name, double actuator,
             std::vector<PlacedPart>& out) const {
    for (const auto* all : {&joint.laws, &joint.beside})
      for (const auto& laws : *all)
        for (const Law& law : laws)
          if (lacks_length(law) && !(actuator > 0))
            throw InputError(
                fmt::format("the {} has no length: no slide before it is driven and extended ({:.6g} mm); "
                            "give it a length",
                            row_of(law).name, 1e3 * actuator));
    place_joint(step, joint, actuator, m_, name, out);
  }

  void place(const Member& member, const Step& step, const std::string&, double, std::vector<PlacedPart>& out) const {
    if (member.y_axis.isZero(0)) {
      return put(member,
                 placed(member, *step.name, step.start, step.after.p, step.before.R.col(1), step.before.R.col(2), m_),
                 m_, out);
    }
    const Vector3 y_W = step.before.R * member.y_axis, along = step.after.p - step.start;
    if (along.norm() > 0 && along.cross(y_W).norm() <= 1e-6 * along.norm() * y_W.norm())
      throw ModelError(fmt::format("{}: y_axis is parallel to the member here: name another direction", *step.name));
    put(member, placed(member, *step.name, step.start, step.after.p, y_W, y_W, m_), m_, out);
  }

  void place(const Offset&, const Step&, const std::string&, double, std::vector<PlacedPart>&) const {}

  void place(const Parallel&, const Step& step, const std::string& name, double, std::vector<PlacedPart>& out) const {
    PlacedParallel group;
    group.part = *step.name;
    group.p_W_start = step.before.p;
    group.p_W_end = step.after.p;
    for (std::size_t b = 0; b < step.branches.size(); ++b)
      group.branches.push_back(leg(fmt::format("{} {} {}", name, *step.name, b + 1), step.branches[b]));
    out.emplace_back(std::move(group));
  }

  const Mechanism& m_;
  const std::vector<JointState>& states_;
};

/// The mechanism with its joints where they stand in another of the same kinematics; nothing where these differ.
std::optional<ChainAssembly> taken_over(const ChainAssembly& known, const Chains& k, const Mechanism& m) {
  const auto same = [](const Placement& a, const Placement& b) { return a.shift == b.shift && a.turn == b.turn; };
  if (known.home.has_value() != k.home.has_value() || (k.home && !same(*k.home, *known.home))) return std::nullopt;
  std::vector<LegParts> legs = legs_of(m);
  if (!same_kinematics(legs, known.legs)) return std::nullopt;
  return ChainAssembly{std::move(legs), known.states,      known.pose,     known.length,
                       known.home,      known.coordinates, known.actuators};
}

/// Those given by the user for the actuated ones of the chains.
std::vector<Actuator> actuators_of(const ChainAssembly& a, const MatrixX& controller) {
  std::vector<Actuator> out;
  const ActuatedCoordinates q = actuated(a);
  const VectorX given = controller.size() > 0 ? VectorX(controller.partialPivLu().solve(q.values)) : q.values;
  for (std::size_t i = 0; i < q.names.size(); ++i) out.push_back({q.names[i], given(as_index(i)), q.rotation[i]});
  return out;
}

PlacedMechanism placed_assembly(const Mechanism& m, ChainAssembly a) {
  PlacedMechanism out;
  out.pose = a.pose;
  for (std::size_t i = 0; i < a.legs.size(); ++i) {
    const Trace trace = walk(one(a.legs[i]), a.states[i]);
    const Trace::Leg& leg = trace.legs[0];
    out.legs.push_back(
        Placer(m, a.states[i]).leg(a.legs.size() == 1 ? "arm" : fmt::format("leg {}", i + 1), leg.steps));
    const Frame platform = Frame{a.pose.p_WT, a.pose.R_WT} * frame_of(a.legs[i].mount.platform);
    out.seats.push_back({leg.start.p, platform.p});
  }
  if (a.actuators.empty()) a.actuators = actuators_of(a, std::get<Chains>(m.kinematics).controller);
  out.actuators = a.actuators;
  out.assembly = std::make_shared<const ChainAssembly>(std::move(a));
  return out;
}

}  // namespace

PlacedMechanism place(const Chains& k, const Mechanism& m, const Pose& pose, const ChainAssembly* known) {
  const bool there =
      known && known->coordinates.size() == 0 && known->pose.p_WT == pose.p_WT && known->pose.R_WT == pose.R_WT;
  if (auto same = there ? taken_over(*known, k, m) : std::nullopt) return placed_assembly(m, std::move(*same));
  ChainAssembly a = home_assembly(m);
  move_to(a, pose);
  return placed_assembly(m, std::move(a));
}

PlacedMechanism place_joints(const Chains& k, const Mechanism& m, const VectorX& coordinates,
                             const ChainAssembly* known) {
  if (k.controller.size() > 0) require_count(m, k.controller.cols(), coordinates);
  const VectorX wanted = k.controller.size() > 0 ? VectorX(k.controller * coordinates) : coordinates;
  const bool there = known && known->coordinates.size() == wanted.size() && known->coordinates == wanted;
  if (auto same = there ? taken_over(*known, k, m) : std::nullopt) return placed_assembly(m, std::move(*same));
  ChainAssembly a = home_assembly(m);
  require_count(m, actuated(a).values.size(), wanted);
  move_to_coordinates(a, wanted);
  a.coordinates = wanted;
  return placed_assembly(m, std::move(a));
}

Pose home_pose(const Chains&, const Mechanism& m) { return home_assembly(m).pose; }

std::vector<Actuator> actuators_of(const Chains&, const Mechanism& m) {
  return placed_assembly(m, home_assembly(m)).actuators;
}

}  // namespace deflect
