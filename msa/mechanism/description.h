// The description of a mechanism: what a device file says, as data without methods. SI units throughout.
//
// A leg is a chain of parts from the base to the platform, in the order in which force passes through them. Parts
// are placed at named points and turned into named axes that the kinematics provide at every pose; for the family
// "6-psu" those are the points A (base joint), B (guideway's tip), C (platform joint) and the axes
//   base      of W;
//   guide     z along the guideway, x radially outwards at A;
//   link      z from B to C, x in the plane of z and the radial direction at A;
//   platform  of T.
#pragma once

#include <array>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "msa/base/spatial.h"
#include "msa/mechanism/law.h"
#include "msa/mechanism/section.h"

namespace deflect {

/// A list of named things that keeps the order of the file.
template <class T>
using Named = std::vector<std::pair<std::string, T>>;

template <class T>
const T* find(const Named<T>& list, const std::string& name) {
  for (const auto& [key, value] : list)
    if (key == name) return &value;
  return nullptr;
}

/// A joint between what stands before it in the chain and what follows. laws[i] are in series on freedom i
/// (tx ty tz rx ry rz of `axes`); an empty list leaves the freedom as the type's row in the joint table says.
struct Joint {
  std::string type = "fixed";
  std::string at, axes;
  std::array<std::vector<Law>, 6> laws;
};

enum class BeamTheory { euler_bernoulli, timoshenko };
inline constexpr const char* beam_theory_names[] = {"euler-bernoulli", "timoshenko"};

/// A straight flexible member. Its local x runs from `from` to `to`; local y lies in the plane of x and the radial
/// direction at A. bending_factor multiplies EIy and EIz (1 = sound).
struct Member {
  std::string section, material, from, to;
  BeamTheory beam = BeamTheory::euler_bernoulli;
  double bending_factor = 1;
};

using Part = std::variant<Joint, Member>;

/// Six vertical guideways, ball joint at B, universal joint at C. Legs 2k+1, 2k+2 stand at 120°·k ± base_angle/2 on
/// the base circle and at 120°·k ± (60° − platform_angle/2) on the platform circle.
struct SixPsu {
  double base_radius = 0, platform_radius = 0, link_length = 0;
  double base_angle = 0, platform_angle = 0;  ///< rad: angle between the two joints of a pair
  double slider_min = 0, slider_max = 0;      ///< limits of the free length L1 = |AB|
};

using Kinematics = std::variant<SixPsu>;
inline constexpr const char* family_names[] = {"6-psu"};
static_assert(std::size(family_names) == std::variant_size_v<Kinematics>);

/// One leg that differs: `path` inside the leg ("guideway.bending_factor"), `value` as it would stand in the file.
struct Variation {
  int leg = 0;  ///< 1-based
  std::string path, value;
};

/// Where the device is validated: a cube about the pose at which every slider of the untilted device has the
/// nominal length.
struct Workspace {
  double nominal_slider = 0, cube_edge = 0;
};

/// How loads and displacements are recorded: true load = gain · R(rotation) · recorded, recorded displacement =
/// R(rotation) · true. Used where measurements are compared or simulated; the device itself does not know it.
struct LoadCell {
  double gain = 1;
  Vector3 rotation = Vector3::Zero();  ///< rad, small rotation vector
};
struct Sensor {
  Vector3 rotation = Vector3::Zero();  ///< rad
  Vector3 drift = Vector3::Zero();     ///< m over a whole sequence
};

/// Standard deviations of what differs from machine to machine within its drawing.
struct Tolerances {
  double modulus = 0, guide_diameter = 0, load = 0;                        ///< relative
  double joint_position = 0, link_length = 0, actuator_repeatability = 0;  ///< m
};

struct Mechanism {
  std::string name, about, source;
  Kinematics kinematics;
  Named<Material> materials;
  Named<Section> sections;
  Named<Part> leg;  ///< every leg, base to platform
  std::vector<Variation> variations;
  Joint base;  ///< between the world and the machine, at the base origin, axes "base"
  Joint tool;  ///< between the platform and the tool point T, axes "platform"
  Workspace workspace;
  LoadCell load_cell;
  Sensor sensor;
  Tolerances tolerances;
  std::set<std::string> ours;  ///< paths of values that the source does not state and we assumed (YAML tag !ours)
};

}  // namespace deflect
