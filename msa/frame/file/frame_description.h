// A frame: the contents of a frame file as plain data. SI units throughout, base axes unless a field says otherwise.
//
// A member's axes: x runs from `from` to `to`; y lies in the plane of x and the vector `y_axis`, on its side; z = x ×
// y. Without y_axis that vector is the base z (local y points up), and the base x for a member within 1e-3 rad of
// vertical.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "msa/base/geometry.h"
#include "msa/base/spatial.h"
#include "msa/frame/file/freedom_laws.h"
#include "msa/mechanism/description.h"

namespace deflect::frame {

using FreedomNames = std::array<const char*, 6>;
inline constexpr FreedomNames node_freedoms = {"ux", "uy", "uz", "rx", "ry", "rz"};    ///< base axes
inline constexpr FreedomNames member_freedoms = {"tx", "ty", "tz", "rx", "ry", "rz"};  ///< member axes
inline constexpr std::array<const char*, 6> wrench_names = {"fx", "fy", "fz", "mx", "my", "mz"};

using FreedomValues = std::array<std::optional<double>, 6>;

/// E and G of a frame's material are independent: members need no isotropy.
struct FrameMaterial {
  Material elastic;
  std::optional<double> density;    ///< kg/m³, for self-weight
  std::optional<double> expansion;  ///< 1/K, for temperature
};

/// bending_factor multiplies EIy and EIz, factor E and G: all stiffnesses of this member. A released freedom of an end
/// is not connected to the node; one with laws is connected by them, whether released or not. A truss member connects
/// no rotation at either end. misfit: how much longer the member is, unstrained, than the distance of its nodes.
struct FrameMember {
  std::string from, to, section, material;
  BeamTheory beam = BeamTheory::euler_bernoulli;
  Vector3 y_axis = Vector3::Zero();  ///< zero: the rule above
  Freedoms release_from{}, release_to{};
  bool truss = false;
  double bending_factor = 1, factor = 1;
  double misfit = 0;  ///< m
  double heated = 0;  ///< K above the temperature of the assembly, in every load case
  int elements = 1;   ///< number of equal elements in a row
  /// In member axes. Near and far side of the laws: at the start the node and the member, at the end the member and the
  /// node, so that tension pulls at both.
  FreedomLaws start, end;
};

/// What holds a node against the ground: rigidly in the freedoms of the list, unless they have laws. The ground is the
/// near side of the laws, the node the far side: a force that pushes the node down in uz is negative, and so is its
/// displacement. A pad that only pushes upwards is one_sided with its compliance as `push` (rigid where absent) and a
/// large one as `pull`.
struct FrameSupport : Freedoms {
  FrameSupport() : Freedoms{} {}
  FrameSupport(const Freedoms& held) : Freedoms(held) {}  // NOLINT: freedoms that are held are a support
  FreedomLaws laws;
  Vector6 settled = Vector6::Zero();  ///< m, rad: how far it has moved since the assembly, where it holds rigidly

  bool rigid(std::size_t i) const { return (*this)[i] && !laws.has(i); }
  Freedoms acting() const { return laws.or_in(*this); }  ///< rigid or elastic
};

/// Between the body of `node` and the ground, or the body of the node `to`. It is located at `node`; where `to` is
/// elsewhere, a rigid arm connects them. N/m, Nm/rad, base axes. `to` is the near side of its laws, `node` the far one.
struct FrameSpring {
  std::string node, to;                 ///< to: "" for the ground
  FreedomValues stiffness;              ///< where a freedom has one linear law in series
  FreedomLaws laws = {};                ///< of the others
  std::optional<Matrix6> coupled = {};  ///< 6×6 of [δ; θ], instead of stiffness and laws

  Freedoms acting() const {
    Freedoms out = laws.or_in({});
    for (std::size_t i = 0; i < 6; ++i) out[i] = out[i] || stiffness[i] || coupled;
    return out;
  }
};

/// `nodes` follow the body of `master` in these freedoms, lever arms included.
struct RigidLink {
  std::string master;
  std::vector<std::string> nodes;
  Freedoms freedoms{true, true, true, true, true, true};
};

/// Σ factor · arm · u = 0. `arm` (m) turns a rotation into a length; all terms must be lengths, or all angles.
struct ConstraintTerm {
  std::string node;
  int freedom = 0;
  double factor = 1;
  std::optional<double> arm;
};
struct FrameConstraint {
  std::vector<ConstraintTerm> terms;
};

/// Constant along the member, per unit length of the member, in base axes or in the member's.
struct LineLoad {
  Vector3 q = Vector3::Zero();  ///< N/m
  bool member_axes = false;
};

struct LoadCase {
  double factor = 1;                   ///< true load over the load of the case: multiplies all that follows
  Vector3 turned = Vector3::Zero();    ///< rotation vector from the loads below to the true ones, those in base axes
  Named<Vector6> nodes;                ///< wrench [f; m] at a node, base axes
  Named<LineLoad> members;             ///< by member
  Named<double> temperature;           ///< K above the unstrained state, by member
  Vector3 gravity = Vector3::Zero();   ///< m/s², acts on the mass of all members
  Named<FreedomValues> displacements;  ///< of supported freedoms, by node; m, rad
};

/// A plane frame moves in its plane: the displacement along the normal and the rotations about the plane's axes are
/// held at every node. The value is the normal's axis.
enum class Plane { yz = 0, xz = 1, xy = 2, none = 3 };
inline constexpr std::array<const char*, 4> plane_names = {"yz", "xz", "xy", "none"};
/// 0 … 2 for x … z; 3: none.
constexpr int normal_axis(Plane p) { return static_cast<int>(p); }

/// The component of a section's forces that a load cell in a member reads, in member axes: [N, Vy, Vz, T, My, Mz].
inline constexpr std::array<const char*, 6> section_force_names = {"axial", "Vy", "Vz", "T", "My", "Mz"};

/// A named instrument. It reads one of: the displacement or rotation of a node, a force in a member, the strain of a
/// fibre of a member, a reaction of a support.
struct FrameSensor : InstrumentErrors {
  enum class Reads { displacement, force, strain, reaction };
  Reads reads = Reads::displacement;
  std::string of;                   ///< the node, the member or the supported node
  std::string direction;            ///< of a node, as in the file: "uz", "rx", "[0, 0, 1]"
  Vector3 axis = Vector3::UnitZ();  ///< that direction: a unit vector in base axes
  bool rotation = false;            ///< a rotation about the axis
  std::size_t component = 0;        ///< of section_force_names; of a reaction, of wrench_names, base axes, on the frame
  double at = 0.5;                  ///< along the member, as a share of its length
  double stick = 0;                 ///< the reading follows only where it lags by more than this: SI, of what is read
  double resolution = 0;            ///< the step in which it reads: SI, of what is read; 0: none
  Named<double> crosstalk = {};  ///< by other sensors of the same quantity: the share of their true reading in its own
  double y = 0, z = 0;           ///< of the fibre, m, member axes; strain is N/EA − y Mz/EIz + z My/EIy
};

/// Standard deviations of what varies between frames built to one drawing.
struct FrameTolerances {
  double modulus = 0;  ///< relative, of each material
  double load = 0;     ///< relative, of a recorded load
  Named<std::string>
      numbers;  ///< of single numbers, as in the file: "member.bending_factor" "5 %" (frame_tolerances.h)
};

struct FrameDescription {
  std::string name, about, source;
  Plane plane = Plane::none;
  Geometry geometry = Geometry::linear;
  int load_steps = 1;  ///< at least; finite geometry only
  Named<FrameMaterial> materials;
  Named<Section> sections;
  Named<Vector3> nodes;  ///< m
  Named<FrameMember> members;
  Named<FrameSupport> supports;  ///< by node
  Named<FrameSpring> springs;
  Named<RigidLink> rigid_links;
  Named<FrameConstraint> constraints;
  Named<LoadCase> loads;
  Named<FrameSensor> sensors;
  double load_gain = 1;              ///< true over recorded load, for all loads
  std::vector<std::string> trusted;  ///< kinds of place at which a diagnosis assumes nothing missing
  FrameTolerances tolerances;
  std::set<std::string> ours;  ///< paths of values that carry the tag !ours: assumed, not from the source
};

}  // namespace deflect::frame
