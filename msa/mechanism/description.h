// The description of a mechanism: what a device file says, as data without methods. SI units throughout.
//
// A leg is a chain of parts from the base to the platform, in the order in which force passes through them. Where the
// parts stand is said in one of two ways.
//
// Family "6-psu": parts are placed at named points and turned into named axes that the kinematics provide at every
// pose: the points A (base joint), B (guideway's tip), C (platform joint) and the axes
//   base      of W;
//   guide     z along the guideway, x radially outwards at A;
//   link      z from B to C, x in the plane of z and the radial direction at A;
//   platform  of T.
//
// Family "chains", for any other mechanism: a frame walks along the chain. It starts at the leg's mount on the base; a
// joint stands where the frame is and moves it by its coordinates; a member takes it along its own length; an offset
// moves it rigidly; branches in parallel leave from it and meet again in one frame. Where the walk ends, turned back by
// the mount on the platform, is the frame of the platform. A serial arm is a mechanism of one leg, whose platform is
// the tool.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "msa/base/geometry.h"
#include "msa/base/spatial.h"
#include "msa/fields/named.h"
#include "msa/mechanism/law.h"
#include "msa/mechanism/section.h"

namespace deflect {

/// A frame seen from another: shift in the axes of the other, turn as roll, pitch, yaw: R = Rz(yaw) Ry(pitch) Rx(roll).
struct Placement {
  Vector3 shift = Vector3::Zero();  ///< m
  Vector3 turn = Vector3::Zero();   ///< rad
};

/// Rows of Denavit–Hartenberg tables (m, rad). Standard: joint about z, then Rz(θ) Tz(d) Tx(a) Rx(α). Modified (J. J.
/// Craig, Introduction to Robotics, (3.6)): Rx(α) Tx(a) Rz(θ) Tz(d), then the joint about z.
struct DhRow {
  double theta = 0, d = 0, a = 0, alpha = 0;
};

/// A joint between what stands before it in the chain and what follows. Its freedoms are tx ty tz rx ry rz of its axes
/// and move in this order: translation first, then Rx Ry Rz, each about axes that the ones before have turned.
/// laws[i] are in series on freedom i; an empty list leaves the freedom as the type's row in the joint table says.
struct Joint {
  std::string type = "fixed";
  std::string freedoms;  ///< six letters of the joint table, for the type "custom"

  std::string at;    ///< families with named places
  std::string axes;  ///< there a named set of axes; in a chain "before" or "after": the motion that laws do not follow

  Vector3 axis = Vector3::UnitZ();  ///< chains: z of the joint in the axes of the chain
  std::optional<DhRow> dh, modified_dh;
  Vector3 bar = Vector3::Zero();  ///< of a parallelogram, from its hinges on this side to those on the other at φ = 0
  std::array<double, 6> home{};   ///< coordinates (m, rad) from which the kinematics start
  std::array<std::optional<double>, 6> min, max;  ///< limits of the coordinates

  std::array<std::vector<Law>, 6> laws;
  std::optional<Matrix6> stiffness;  ///< of all six freedoms together, [δ; θ] in the joint's axes, SI; excludes laws
  /// Force (N) or moment (Nm) that the joint itself keeps in the laws of freedom i (a clamped ball, a pretensioned
  /// cable): the laws work about it.
  std::array<double, 6> preload{};
  /// Of a joint of a leg: each law alone stands side by side with all of laws[i] (friction beside a gear, a rubber
  /// seal). Only where freedom i moves: by a law of its own, or freely.
  std::array<std::vector<Law>, 6> beside;
};

enum class BeamTheory { euler_bernoulli, timoshenko };
inline constexpr const char* beam_theory_names[] = {"euler-bernoulli", "timoshenko"};

/// Which point of a part of a chain. Start: where the chain comes to it, of a joint its place before it moves; end:
/// where the chain leaves it. Usual: where a joint stands (its start), the end of anything else.
enum class PartPoint { usual, start, end };
inline constexpr const char* part_point_names[] = {"usual", "start", "end"};

/// A straight flexible member, local x along it.
/// Named places: runs from `from` to `to`; local y in the plane of x and the radial direction at A.
/// Chains: runs along `along` (axes of the chain, m), or from a point of part `from` to where the chain is, which
/// lengthens it with the joints between. Local y lies in the plane of x and `y_axis` (axes of the chain where the
/// member stands in it, on its side); zero: the chain's y, and its z where x is within 2.6 deg of the chain's y. z = x
/// × y. bending_factor multiplies EIy and EIz (1 = sound).
struct Member {
  std::string section, material, from, to;
  std::optional<Vector3> along;
  BeamTheory beam = BeamTheory::euler_bernoulli;
  double bending_factor = 1;
  PartPoint from_point = PartPoint::usual;
  Vector3 y_axis = Vector3::Zero();
  Joint start, end;  ///< how its ends yield against what holds them: fixed joints in its own axes (x along it)
};

/// A rigid piece of a chain.
struct Offset : Placement {};

struct Part;

/// Where a leg stands: its first frame in the frame of the base and its last one in the frame of the platform, and the
/// parts of this leg where they are others than those of every leg.
struct Mount {
  Placement base, platform;
  std::vector<std::pair<std::string, Part>> leg;
};

/// Branches side by side: a parallelogram, an inner loop, a parallel stage on an arm.
struct Parallel {
  std::vector<Mount> mounts;
  std::vector<std::pair<std::string, Part>> leg;
};

struct Part : std::variant<Joint, Member, Offset, Parallel> {
  using variant::variant;
};

/// How one leg of a machine differs from its drawing: its joints A (axes of W) and C (axes of T), its link's length; m.
struct LegDeviation {
  int leg = 0;  ///< 1-based
  Vector3 base_joint = Vector3::Zero(), platform_joint = Vector3::Zero();
  double link_length = 0;
};

/// Six vertical guideways, ball joint at B, universal joint at C. Legs 2k+1, 2k+2 stand at 120°·k ± base_angle/2 on
/// the base circle and at 120°·k ± (60° − platform_angle/2) on the platform circle.
struct SixPsu {
  double base_radius = 0, platform_radius = 0, link_length = 0;
  double base_angle = 0, platform_angle = 0;  ///< rad: angle between the two joints of a pair
  double slider_min = 0, slider_max = 0;      ///< limits of the free length L1 = |AB|
  std::vector<LegDeviation> deviations;       ///< of a machine that was measured, or drawn by lot
};

/// Parts placed by walking along each leg; see above.
struct Chains {
  std::optional<Placement> home;  ///< pose of T from which the kinematics start; absent: from the joints' home
  /// Actuated coordinates of the chain = controller · coordinates given by the user; empty: they are the same.
  MatrixX controller;
};

using Kinematics = std::variant<SixPsu, Chains>;
inline constexpr const char* family_names[] = {"6-psu", "chains"};
static_assert(std::size(family_names) == std::variant_size_v<Kinematics>);

/// One leg that differs: `path` inside the leg ("guideway.bending_factor"), `value` as it would stand in the file.
struct Variation {
  int leg = 0;  ///< 1-based
  std::string path, value;
};

/// One leg that is assembled beside its drawing: its seats on the base and on the platform, in the axes of W and T.
struct Misfit {
  int leg = 0;  ///< 1-based
  Placement base, platform;
};

/// Regions of the tool point, m, in axes of the base; boxes, discs and cylinders about the workspace's centre.
struct CubeSpace {
  double edge = 0;  ///< 0: the device has no workspace
};
struct BoxSpace {
  Vector3 edges = Vector3::Zero();  ///< along x, y, z; zero along an axis in which it is flat
};
struct DiscSpace {
  double radius = 0;  ///< level
};
struct CylinderSpace {
  double radius = 0, height = 0;  ///< upright
};
/// Level, anywhere in the base's x and y.
struct PolygonSpace {
  struct Corner {
    double x = 0, y = 0;
  };
  std::vector<Corner> corners;
  std::optional<double> z;  ///< the centre's where absent
};
struct PoseSpace {
  std::vector<Placement> poses;  ///< of T
};
using WorkspaceShape = std::variant<CubeSpace, BoxSpace, DiscSpace, CylinderSpace, PolygonSpace, PoseSpace>;
inline constexpr const char* workspace_keys[] = {"cube_edge", "box", "disc", "cylinder", "polygon", "poses"};
static_assert(std::size(workspace_keys) == std::variant_size_v<WorkspaceShape>);

/// Where the device is validated, mapped and measured. The centre is a pose of T; absent: the home pose, which is of a
/// 6-psu the one at which every slider of the untilted device has the nominal length.
struct Workspace {
  double nominal_slider = 0;
  WorkspaceShape shape;
  std::optional<Placement> centre;
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
  bool free_zero = false;              ///< readings count from a zero that nobody knows, one for all of a file
  Vector6 zero = Vector6::Zero();      ///< that zero, m and rad, where it is known; no part of a file
};

/// Standard deviations of what differs from machine to machine within its drawing.
struct Tolerances {
  double modulus = 0, guide_diameter = 0, load = 0;                        ///< relative
  double joint_position = 0, link_length = 0, actuator_repeatability = 0;  ///< m
  Named<std::string> numbers;  ///< of single numbers, as the file says it: "drive.stiffness" "10 %" (tolerances.h)
};

struct Mechanism {
  std::string name, about, source;
  Kinematics kinematics;
  Named<Material> materials;
  Named<Section> sections;
  std::vector<Mount> mounts;  ///< chains: one leg each; none is one leg from the base's frame to the tool's
  Named<Part> leg;            ///< every leg, base to platform
  std::vector<Variation> variations;
  /// 6-psu: joints that stand side by side with every leg between the base and the platform (friction of a link's
  /// joints, a bellows), each at a point and in axes of that leg.
  Named<Joint> beside;
  Joint base;          ///< between the world and the machine, at the base origin, axes "base"
  Joint tool;          ///< between the platform and the tool point T, axes "platform"
  double payload = 0;  ///< kg at T; its weight acts along −z of W
  std::vector<Misfit> misfits;
  Geometry geometry = Geometry::linear;  ///< of the shape in which equilibrium is to be found
  Workspace workspace;
  LoadCell load_cell;
  Sensor sensor;
  /// Kinds of place at which nothing is missing: "base", "tool", "load", "load cell", "sensor".
  std::vector<std::string> trusted;
  Tolerances tolerances;
  std::set<std::string> ours;  ///< paths of values that the source does not state and we assumed (YAML tag !ours)
  /// The parts of each leg, variations applied, where resolved() worked them out once for many poses; no part of a
  /// file.
  std::vector<Named<Part>> legs;
};

}  // namespace deflect
