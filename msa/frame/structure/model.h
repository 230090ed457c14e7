// A structure: nodes with six freedoms, beams, scalar springs and linear constraints. Data with a few builders,
// independent of mechanisms. SI, base axes.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "msa/base/spatial.h"
#include "msa/frame/elements/beam.h"
#include "msa/frame/elements/spring_law.h"

namespace deflect::frame {

/// Σ coefficient · u[dof].
struct Term {
  int dof = 0;
  double coefficient = 0;
};
using LinearForm = std::vector<Term>;

struct Node {
  std::string name;
  Vector3 position;
};

/// A spring with the elongation δ = form(u).
struct Spring {
  LinearForm elongation;
  SpringLaw law;
  std::string name, part;
  int defined_by = -1;  ///< the constraint that defines the elongation as a coordinate (relative.h); −1: none
};

/// form(u) = value.
struct Constraint {
  LinearForm form;
  double value = 0;
  std::string name;
  int eliminates = -1;      ///< the preferred freedom to eliminate; −1: chosen by the elimination
  bool may_repeat = false;  ///< redundancy is expected and not reported
};

/// A freedom that a connection leaves free: form(u) is not resisted.
struct Release {
  LinearForm form;
  std::string name;
};

/// One of the six freedoms between the two sides of a connection: free, rigid, or elastic by laws in series; each law
/// of `beside` acts side by side with that.
struct ConnectionFreedom {
  bool rigid = true;
  std::vector<SpringLaw> laws = {}, beside = {};
};

using FreedomNames = std::array<const char*, 6>;
inline constexpr FreedomNames connection_freedoms = {"tx", "ty", "tz", "rx", "ry", "rz"};

/// Definition of a connection's constraints and springs at finite displacement: the components tx … rz of the motion of
/// node b's body relative to node a's (joint_motion.h). Constraints and springs outside connections keep their linear
/// forms in displacements and sums of spins (small rotations about the base axes).
struct Connection {
  int a = -1, b = 0;  ///< nodes; a = −1: the ground
  Vector3 p;
  std::array<Matrix3, 2> axes;  ///< of tx ty tz and of rx ry rz (columns), attached to body a
  std::array<int, 6> constraint = {-1, -1, -1, -1, -1, -1}, spring = constraint;  ///< by component; −1: none
};

struct Model {
  std::vector<Node> nodes;           ///< node i owns the freedoms 6i … 6i+5: [ux uy uz θx θy θz]
  std::vector<std::string> scalars;  ///< further freedoms, numbered after those of the nodes
  std::vector<Beam> beams;
  std::vector<Spring> springs;
  std::vector<Constraint> constraints;
  std::vector<Release> releases;           ///< for messages about free motions; no effect on equilibrium
  std::vector<std::pair<int, int>> welds;  ///< nodes of one rigid body
  std::vector<Connection> connections;     ///< their springs and constraints are in the lists above
  int watched = -1;  ///< the node that is read and loaded; −1: all nodes. Free motions that do not move it are
                     ///< harmless.

  int dofs() const { return static_cast<int>(6 * nodes.size() + scalars.size()); }
  /// "node 'leg 1 B' uz".
  std::string dof_name(int dof) const;

  int add_node(std::string name, const Vector3& position);
  void add_beam(int a, int b, const Matrix3& R_WM, const BeamRigidity&, std::string name, std::string part);
  /// u_node = 0, six constraints "name ux" …; their values may be changed to prescribe displacements.
  /// At finite displacement the rotations are the angles of Rx Ry Rz from the base axes.
  void fix(int node, const std::string& name);
  /// Adds a connection between the ground and a node at the node's position, in base axes. The caller sets the indices
  /// of its constraints and springs.
  Connection& grounded(int node);
  /// Node b moves as one body with node a.
  void join(int a, int b, const std::string& name);
  /// A joint at p with axes R (columns x y z) between the body of node a and the body of node b: the relative twist
  /// Rᵀ(d_b(p) − d_a(p)) is constrained where rigid and has springs where it has laws. Intermediate freedoms of laws in
  /// series become scalars, so all nodes must have been added before the first connection with two laws on a freedom.
  /// a = −1: the ground, whose free freedoms are not listed as releases. `names`: of the freedoms in constraints and
  /// springs.
  void connect(int a, int b, const Vector3& p, const Matrix3& R, const std::array<ConnectionFreedom, 6>&,
               const std::string& name, const std::string& part, const FreedomNames& names = connection_freedoms);
};

/// Displacement along `axis` of the point p of the body of `node`, or its rotation about it.
LinearForm translation_of(const Model&, int node, const Vector3& p, const Vector3& axis, double factor = 1);
LinearForm rotation_of(int node, const Vector3& axis, double factor = 1);

}  // namespace deflect::frame
