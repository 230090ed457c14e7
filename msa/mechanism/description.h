// The description of a mechanism: the contents of a device file as plain data. SI units throughout.
//
// A leg is a chain of parts from the base to the platform, in the order in which force passes through them. The
// placement of the parts is given in one of two ways.
//
// Family "6-psu": parts are placed at named points and in named axes, which the kinematics provide at every pose. The
// points are A (base joint), B (guideway's tip) and C (platform joint); the axes are
//   base      of W;
//   guide     z along the guideway, x radially outwards at A;
//   link      z from B to C, x in the plane of z and the radial direction at A;
//   platform  of T.
//
// Family "chains", for any other mechanism: a frame moves along the chain, part by part. It starts at the leg's mount
// on the base. A joint is placed at the frame and moves it by its coordinates; a member moves it along its length; an
// offset moves it rigidly; parallel branches start from it and meet again in one frame. The last frame times the
// inverse of the mount on the platform is the frame of the platform. A serial arm is a mechanism with one leg, whose
// platform is the tool.
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
#include "msa/mechanism/sections/section.h"

namespace deflect {

/// A frame relative to another: shift in the axes of the other, turn as roll, pitch, yaw: R = Rz(yaw) Ry(pitch)
/// Rx(roll).
struct Placement {
  Vector3 shift = Vector3::Zero();  ///< m
  Vector3 turn = Vector3::Zero();   ///< rad
};

/// Rows of Denavit–Hartenberg tables (m, rad). Standard: joint about z, then Rz(θ) Tz(d) Tx(a) Rx(α). Modified (J. J.
/// Craig, Introduction to Robotics, (3.6)): Rx(α) Tx(a) Rz(θ) Tz(d), then the joint about z.
struct DhRow {
  double theta = 0, d = 0, a = 0, alpha = 0;
  bool operator==(const DhRow&) const = default;
};

/// How a joint moves, without its laws: all that its kinematics depend on in the family "chains".
struct JointKinematics {
  std::string type = "fixed";
  std::string freedoms;             ///< six letters of the joint table, for the type "custom"
  Vector3 axis = Vector3::UnitZ();  ///< z of the joint in the axes of the chain
  std::optional<DhRow> dh, modified_dh;
  Vector3 bar = Vector3::Zero();  ///< parallelogram: from its hinges on this side to those on the other, at φ = 0
  std::array<double, 6> home{};   ///< coordinates (m, rad) from which the kinematics start
  std::array<std::optional<double>, 6> min, max;  ///< limits of the coordinates

  bool operator==(const JointKinematics&) const = default;
};

/// A joint between the part before it in the chain and the part after it. Its freedoms are tx ty tz rx ry rz in its
/// axes and move in this order: translation first, then Rx Ry Rz, each about axes rotated by the ones before. laws[i]
/// are in series on freedom i; where the list is empty, the freedom is as in the type's row of the joint table.
struct Joint : JointKinematics {
  std::string at;  ///< family with named points ("6-psu"): the point
  /// "6-psu": the named axes. Chains: "before" or "after", whether the axes of the laws are those before or after the
  /// joint's motion.
  std::string axes;

  std::array<std::vector<Law>, 6> laws;
  std::optional<Matrix6> stiffness;  ///< 6×6, of [δ; θ] in the joint's axes, SI; instead of laws
  /// Preload, N or Nm: force in the laws of freedom i while the joint transmits none (a clamped ball, a pretensioned
  /// cable). Loads add to it.
  std::array<double, 6> preload{};
  /// For joints of legs: each of these laws acts in parallel with the series laws[i] (friction of a gear, a rubber
  /// seal). Only where freedom i is free or elastic.
  std::array<std::vector<Law>, 6> beside;

  bool operator==(const Joint&) const = default;
};

enum class BeamTheory { euler_bernoulli, timoshenko };
inline constexpr const char* beam_theory_names[] = {"euler-bernoulli", "timoshenko"};

/// A point of a part of a chain. Start: where the chain enters the part (for a joint, its place before its motion);
/// end: where the chain leaves it. Usual: the start of a joint, the end of any other part.
enum class PartPoint { usual, start, end };
inline constexpr const char* part_point_names[] = {"usual", "start", "end"};

/// A straight flexible member, local x along it. 6-psu: runs from `from` to `to`; local y in the plane of x and the
/// radial direction at A. Chains: runs along `along` (axes of the chain, m), or from a point of part `from` to the
/// chain's present frame; then its length depends on the joints between. Local y lies in the plane of x and `y_axis`,
/// on the side of `y_axis` (axes of the chain at the member). If `y_axis` is zero, it is the chain's y, or the chain's
/// z where x is within 2.6 deg of that y. z = x × y. bending_factor multiplies EIy and EIz (1 = sound).
struct Member {
  std::string section, material, from, to;
  std::optional<Vector3> along;
  BeamTheory beam = BeamTheory::euler_bernoulli;
  double bending_factor = 1;
  PartPoint from_point = PartPoint::usual;
  Vector3 y_axis = Vector3::Zero();
  Joint start, end;  ///< compliance of its ends: fixed joints in the member's axes (x along it)
};

/// A rigid offset in a chain.
struct Offset : Placement {};

struct Part;

/// The placement of a leg: its first frame relative to the base and its last frame relative to the platform. `leg`: the
/// parts of this leg, where they differ from Mechanism::leg.
struct Mount {
  Placement base, platform;
  std::vector<std::pair<std::string, Part>> leg;
};

/// Branches in parallel: a parallelogram, an inner loop, a parallel stage on an arm.
struct Parallel {
  std::vector<Mount> mounts;
  std::vector<std::pair<std::string, Part>> leg;
};

struct Part : std::variant<Joint, Member, Offset, Parallel> {
  using variant::variant;
};

/// Deviation of one leg from its drawing: shift of its joints A (axes of W) and C (axes of T), change of its link
/// length; m.
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
  std::vector<LegDeviation> deviations;       ///< of a measured machine, or drawn at random
};

/// Parts placed one after the other along each leg; see above.
struct Chains {
  std::optional<Placement> home;  ///< pose of T from which the kinematics start; absent: from the joints' home
  /// Actuated coordinates of the chain = controller · coordinates given by the user; empty: identity.
  MatrixX controller;
};

using Kinematics = std::variant<SixPsu, Chains>;
inline constexpr const char* family_names[] = {"6-psu", "chains"};
static_assert(std::size(family_names) == std::variant_size_v<Kinematics>);

/// A value that differs in one leg: `path` inside the leg ("guideway.bending_factor"), `value` as written in the file.
struct Variation {
  int leg = 0;  ///< 1-based
  std::string path, value;
};

/// One leg that is assembled off its drawing: deviations of its seats on the base and on the platform, in the axes of W
/// and T.
struct Misfit {
  int leg = 0;  ///< 1-based
  Placement base, platform;
};

/// Regions of the tool point, m, in base axes. Cubes, boxes, discs and cylinders are centred at the workspace's centre.
struct CubeSpace {
  double edge = 0;  ///< 0: the device has no workspace
};
struct BoxSpace {
  Vector3 edges = Vector3::Zero();  ///< along x, y, z; zero: flat along this axis
};
struct DiscSpace {
  double radius = 0;  ///< horizontal
};
struct CylinderSpace {
  double radius = 0, height = 0;  ///< axis vertical
};
/// Horizontal; corners in the base's x and y.
struct PolygonSpace {
  struct Corner {
    double x = 0, y = 0;
  };
  std::vector<Corner> corners;
  std::optional<double> z;  ///< absent: z of the centre
};
struct PoseSpace {
  std::vector<Placement> poses;  ///< of T
};
using WorkspaceShape = std::variant<CubeSpace, BoxSpace, DiscSpace, CylinderSpace, PolygonSpace, PoseSpace>;
inline constexpr const char* workspace_keys[] = {"cube_edge", "box", "disc", "cylinder", "polygon", "poses"};
static_assert(std::size(workspace_keys) == std::variant_size_v<WorkspaceShape>);

/// The region in which the device is validated, mapped and measured. The centre is a pose of T; absent: the home pose.
/// For a 6-psu this is the untilted pose at which every slider has the nominal length.
struct Workspace {
  double nominal_slider = 0;
  WorkspaceShape shape;
  std::optional<Placement> centre;
};

/// How loads and displacements are recorded: true load = gain · R(rotation) · recorded, its forces at T + point;
/// recorded displacement = R(rotation) · true, its translations those of T + point. Used where measurements are
/// compared or simulated; not part of the mechanics of the device.
struct LoadCell {
  double gain = 1;
  Vector3 rotation = Vector3::Zero();  ///< rad, small rotation vector
  Vector3 point = Vector3::Zero();     ///< m, from T, in platform axes: where the loads act that are recorded at T
};
struct Sensor {
  Vector3 rotation = Vector3::Zero();  ///< rad
  Vector3 point = Vector3::Zero();     ///< m, from T, in platform axes: whose displacement is recorded as that of T
  Vector3 drift = Vector3::Zero();     ///< m, over a whole sequence
  bool free_zero = false;              ///< readings are relative to an unknown zero, the same for all readings of a
                                       ///< file
  Vector6 zero = Vector6::Zero();      ///< that zero, m and rad, where it is known; not in files
};

/// How an instrument records: recorded = gain · true + zero. SI, by what it reads.
struct InstrumentErrors {
  std::string gain_text;            ///< as in the file: "1 ± 0.5 %"; empty: exactly 1
  double gain = 1, gain_sigma = 0;  ///< and its standard deviation
  double sigma = 0;                 ///< of one reading; 0: not given
  bool free_zero = false;           ///< as in Sensor
  double zero = 0;                  ///< where it is known: `offset` in files
};

/// A named instrument beside the one at T. It reads a displacement of a point of a body, in one direction, or a
/// rotation of the body about one axis; or the force of a drive (inside.h).
struct PointSensor : InstrumentErrors {
  std::string body = "platform";    ///< "platform", "tool": beyond the tool joint, or a part in a leg: "leg.2.link"
  Vector3 point = Vector3::Zero();  ///< m, from T, in platform axes; of a part in a leg from where the part ends, in
                                    ///< the part's axes; moves with the body
  std::string drive = {};           ///< whose force it reads: "leg.2.actuator"; empty: it reads a displacement
  std::string direction;            ///< as in the file: "uz", "rx", "[0, 0, 1]"
  Vector3 axis = Vector3::UnitZ();  ///< that direction: a unit vector in base axes
  bool rotation = false;            ///< it reads a rotation about the axis, or the moment of a drive
};

/// A named point at which loads act, beside T.
struct LoadPoint {
  std::string body = "platform";    ///< as in PointSensor
  Vector3 point = Vector3::Zero();  ///< m, from T, in platform axes
};

/// Standard deviations of what varies between machines built to one drawing.
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
  std::vector<Mount> mounts;  ///< chains: one per leg; empty: one leg from the base's frame to the tool's
  Named<Part> leg;            ///< the parts of every leg, base to platform
  std::vector<Variation> variations;
  /// 6-psu: joints in parallel with every leg between the base and the platform (friction of a link's joints, a
  /// bellows), each at a point and in axes of that leg.
  Named<Joint> beside;
  Joint base;          ///< between the world and the machine, at the base origin, axes "base"
  Joint tool;          ///< between the platform and the tool point T, axes "platform"
  double payload = 0;  ///< kg at T; its weight acts along −z of W
  std::vector<Misfit> misfits;
  Geometry geometry = Geometry::linear;  ///< shape in which equilibrium is written
  Workspace workspace;
  LoadCell load_cell;
  Sensor sensor;
  Named<PointSensor> sensors;
  Named<LoadPoint> loads;
  /// Kinds of place at which a diagnosis assumes nothing missing: "base", "tool", "load", "load cell", "sensor".
  std::vector<std::string> trusted;
  Tolerances tolerances;
  std::set<std::string> ours;  ///< paths of values that the source does not state and we assumed (YAML tag !ours)
  /// The parts of each leg with variations applied, set by resolved() once for many poses; not in files.
  std::vector<Named<Part>> legs;
};

}  // namespace deflect
