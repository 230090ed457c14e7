// The legs of the family "6-psu": parts at the points A, B, C.
#include <fmt/format.h>

#include <map>

#include "msa/base/error.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/family.h"
#include "msa/mechanism/place.h"
#include "msa/mechanism/six_psu.h"

namespace deflect {
namespace {

constexpr int legs = 6;

/// The named points and axes of one leg at one pose.
struct LegFrames {
  std::map<std::string, Vector3> points;
  std::map<std::string, Matrix3> axes;
  Vector3 radial;
  double slider = 0;
};

LegFrames frames(const SixPsu& k, int leg, const Pose& pose) {
  const SixPsuLeg g = leg_at(k, leg, pose);
  return {{{"A", g.p_WA}, {"B", g.p_WB}, {"C", g.p_WC}},
          {{"base", Matrix3::Identity()},
           {"guide", axes_along_z(Vector3::UnitZ(), g.radial)},
           {"link", axes_along_z(g.p_WC - g.p_WB, g.radial)},
           {"platform", pose.R_WT}},
          g.radial,
          g.slider};
}

template <class T>
const T& look_up(const std::map<std::string, T>& list, const std::string& name, const char* what) {
  if (const auto found = list.find(name); found != list.end()) return found->second;
  throw InputError(fmt::format("there is no {} '{}'", what, name));
}

PlacedPart placed_part(const Part& part, const std::string& name, const LegFrames& f, const Mechanism& m) {
  if (const auto* member = std::get_if<Member>(&part))
    return placed(*member, name, look_up(f.points, member->from, "point"), look_up(f.points, member->to, "point"),
                  f.radial, Vector3::UnitZ(), m);
  const Joint& joint = std::get<Joint>(part);
  return placed(joint, name,
                {look_up(f.points, joint.at, "point"), look_up(f.axes, joint.axes, "set of axes"), f.slider}, m);
}

PlacedLeg placed_leg(const SixPsu& k, const Mechanism& m, const Named<Part>& parts, int leg, const Pose& pose) {
  const LegFrames f = frames(k, leg, pose);
  PlacedLeg out;
  out.name = fmt::format("leg {}", leg);
  for (const auto& [name, part] : parts) try {
      out.parts.push_back(placed_part(part, name, f, m));
    } catch (const InputError& e) {
      throw InputError(fmt::format("{}: leg.{}: {}", m.name, name, e.what()));
    } catch (const ModelError& e) {
      throw ModelError(fmt::format("leg {}: {}", leg, e.what()));
    }
  return out;
}

PlacedLeg placed_beside(const SixPsu& k, const Mechanism& m, const std::string& name, const Joint& joint, int leg,
                        const Pose& pose) try {
  PlacedLeg out;
  out.name = fmt::format("leg {} {}", leg, name);
  out.parts.push_back(placed_part(joint, name, frames(k, leg, pose), m));
  out.beside = true;
  return out;
} catch (const InputError& e) {
  throw InputError(fmt::format("{}: beside.{}: {}", m.name, name, e.what()));
}

}  // namespace

PlacedMechanism place(const SixPsu& k, const Mechanism& m, const Pose& pose) {
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

PlacedMechanism place_joints(const SixPsu& k, const Mechanism& m, const VectorX& coordinates) {
  std::array<double, legs> sliders{};
  std::copy(coordinates.begin(), coordinates.end(), sliders.begin());
  const ForwardKinematics found = forward_kinematics(k, sliders, centred_pose(k, coordinates.mean()));
  if (!found.converged)
    throw ModelError(
        fmt::format("the sliders fit no assembly of the device near the untilted one (closure error {:.3g} mm after {} "
                    "steps)",
                    1e3 * found.closure_error, found.iterations));
  return place(k, m, found.pose);
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
