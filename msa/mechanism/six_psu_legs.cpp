// The legs of the family "6-psu": parts at the points A, B, C.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/family.h"
#include "msa/mechanism/law.h"
#include "msa/mechanism/place.h"
#include "msa/mechanism/six_psu.h"

namespace deflect {
namespace {

constexpr int legs = 6;

constexpr std::array point_names = {"A", "B", "C"};
constexpr std::array axes_names = {"base", "guide", "link", "platform"};

/// The points and axes of one leg at one pose, in the order of their names.
struct LegFrames {
  std::array<Vector3, point_names.size()> points;
  std::array<Matrix3, axes_names.size()> axes;
  Vector3 radial;
  double slider = 0;
};

LegFrames frames(const SixPsu& k, const SixPsuDrawing& drawn, const Pose& pose) {
  const SixPsuLeg g = leg_at(k, drawn, pose);
  return {{g.p_WA, g.p_WB, g.p_WC},
          {Matrix3::Identity(), axes_along_z(Vector3::UnitZ(), g.radial), axes_along_z(g.p_WC - g.p_WB, g.radial),
           pose.R_WT},
          g.radial,
          g.slider};
}

template <std::size_t n>
std::size_t number_of(const std::string& name, const std::array<const char*, n>& names, const char* what) {
  for (std::size_t i = 0; i < n; ++i)
    if (name == names[i]) return i;
  throw InputError(fmt::format("there is no {} '{}'", what, name));
}

/// Adds the part to the leg.
void put_part(const Part& part, const std::string& name, const LegFrames& f, const Mechanism& m, PlacedLeg& leg) {
  const auto point = [&](const std::string& p) { return f.points[number_of(p, point_names, "point")]; };
  if (const auto* member = std::get_if<Member>(&part))
    return put(*member, placed(*member, name, point(member->from), point(member->to), f.radial, Vector3::UnitZ(), m), m,
               leg.parts);
  const Joint& joint = std::get<Joint>(part);
  const JointPlace at{point(joint.at), f.axes[number_of(joint.axes, axes_names, "set of axes")], f.slider};
  put(placed(joint, name, at, m), beside_of(joint, m, f.slider), leg.name, leg.parts);
}

/// Refusals of work() are that leg's.
template <class F>
void of_leg(int leg, const F& work) {
  told_at<ModelError>([&] { return fmt::format("leg {}: ", leg); }, work);
}

PlacedLeg placed_leg(const SixPsu& k, const Mechanism& m, const Named<Part>& parts, int leg, const Pose& pose) {
  const LegFrames f = frames(k, drawing_of(k, leg), pose);
  PlacedLeg out;
  out.name = fmt::format("leg {}", leg);
  for (const auto& [name, part] : parts)
    told_at<InputError>([&, &name = name] { return fmt::format("{}: leg.{}: ", m.name, name); },
                        [&, &name = name, &part = part] { of_leg(leg, [&] { put_part(part, name, f, m, out); }); });
  return out;
}

PlacedLeg placed_beside(const SixPsu& k, const Mechanism& m, const std::string& name, const Joint& joint, int leg,
                        const Pose& pose) {
  PlacedLeg out;
  out.name = fmt::format("leg {} {}", leg, name);
  told_at<InputError>([&] { return fmt::format("{}: beside.{}: ", m.name, name); },
                      [&] { put_part(joint, name, frames(k, drawing_of(k, leg), pose), m, out); });
  out.beside = true;
  return out;
}

}  // namespace

PlacedMechanism place(const SixPsu& k, const Mechanism& m, const Pose& pose, const ChainAssembly*) {
  PlacedMechanism out;
  out.pose = pose;
  for (int leg = 1; leg <= legs; ++leg) {
    out.legs.push_back(placed_leg(k, m, m.variations.empty() && m.legs.empty() ? m.leg : leg_parts(m, leg), leg, pose));
    const SixPsuLeg g = leg_at(k, leg, pose);
    out.seats.push_back({g.p_WA, g.p_WC});
    out.actuators.push_back({fmt::format("leg {} slider", leg), g.slider, false});
  }
  for (const auto& [name, joint] : m.beside)
    for (int leg = 1; leg <= legs; ++leg) out.legs.push_back(placed_beside(k, m, name, joint, leg, pose));
  return out;
}

SixPsuMoves::SixPsuMoves(const SixPsu& k, const Mechanism& m) {
  const auto moves_of = [](const Part& part, std::size_t leg) -> Move {
    if (const auto* member = std::get_if<Member>(&part))
      return {leg, number_of(member->from, point_names, "point"), number_of(member->to, point_names, "point"), {}};
    const Joint& joint = std::get<Joint>(part);
    Move move{leg, number_of(joint.at, point_names, "point"), number_of(joint.axes, axes_names, "set of axes"), {}};
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t n = 0; n < joint.laws[i].size(); ++n)
        if (lacks_length(joint.laws[i][n])) move.cables.emplace_back(i, n);
    return move;
  };
  for (int leg = 1; leg <= legs; ++leg) {
    drawn_.push_back(drawing_of(k, leg));
    moves_.emplace_back();
    for (const auto& [name, part] : leg_parts(m, leg)) moves_.back().push_back(moves_of(part, drawn_.size() - 1));
  }
  for (const auto& [name, joint] : m.beside)
    for (std::size_t leg = 0; leg < legs; ++leg) moves_.push_back({moves_of(joint, leg)});
}

bool SixPsuMoves::hold(const std::vector<PlacedLeg>& placed) const {
  return std::equal(placed.begin(), placed.end(), moves_.begin(), moves_.end(), [](const auto& leg, const auto& moves) {
    const auto several = [](const PlacedPart& part) { return std::holds_alternative<PlacedParallel>(part); };
    return leg.parts.size() == moves.size() && std::none_of(leg.parts.begin(), leg.parts.end(), several);
  });
}

void SixPsuMoves::move(const SixPsu& k, const Pose& pose, std::vector<PlacedLeg>& placed,
                       std::vector<Actuator>& actuators, std::vector<Seats>& seats) const {
  std::array<LegFrames, legs> all;
  for (std::size_t leg = 0; leg < legs; ++leg) {
    all[leg] = frames(k, drawn_[leg], pose);
    seats[leg] = {all[leg].points[0], all[leg].points[2]};
    actuators[leg].value = all[leg].slider;
  }
  for (std::size_t l = 0; l < moves_.size(); ++l)
    for (std::size_t p = 0; p < moves_[l].size(); ++p) {
      const Move& how = moves_[l][p];
      const LegFrames& f = all[how.leg];
      if (auto* member = std::get_if<PlacedMember>(&placed[l].parts[p])) {
        of_leg(static_cast<int>(how.leg) + 1,
               [&] { place_between(*member, f.points[how.first], f.points[how.second], f.radial, Vector3::UnitZ()); });
        continue;
      }
      auto& joint = std::get<PlacedJoint>(placed[l].parts[p]);
      joint.p_W = f.points[how.first];
      joint.R_WJ = f.axes[how.second];
      for (const auto& [freedom, law] : how.cables) *length_from_pose(joint.laws[freedom][law]) = f.slider;
    }
}

PlacedMechanism place_joints(const SixPsu& k, const Mechanism& m, const VectorX& coordinates, const ChainAssembly*) {
  require_count(m, legs, coordinates);
  std::array<double, legs> sliders{};
  std::copy(coordinates.begin(), coordinates.end(), sliders.begin());
  const ForwardKinematics found = forward_kinematics(k, sliders, centred_pose(k, coordinates.mean()));
  if (!found.converged)
    throw ModelError(
        fmt::format("the sliders fit no assembly of the device near the untilted one (closure error {:.3g} mm after {} "
                    "steps)",
                    1e3 * found.closure_error, found.iterations));
  return place(k, m, found.pose, nullptr);
}

Pose home_pose(const SixPsu& k, const Mechanism& m) {
  if (!(m.workspace.nominal_slider > 0))
    throw InputError(
        fmt::format("{}: the device has no workspace; add for example 'workspace: {{nominal_slider: 80 mm, "
                    "cube_edge: 50 mm}}' to its file",
                    m.name));
  return centred_pose(k, m.workspace.nominal_slider);
}

std::vector<Actuator> actuators_of(const SixPsu&, const Mechanism& m) {
  std::vector<Actuator> out;
  for (int leg = 1; leg <= legs; ++leg)
    out.push_back({fmt::format("leg {} slider", leg), m.workspace.nominal_slider, false});
  return out;
}

}  // namespace deflect
