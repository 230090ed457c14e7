// Two-node straight beam in space, exact at its nodes for loads at its nodes.
#pragma once

#include <string>

#include "msa/base/spatial.h"

namespace deflect::frame {

/// Extended precision for displacements, because differences of them are needed: the deformation of a part 1e12 times
/// stiffer than its neighbours is a difference of numbers that agree to twelve digits.
#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 Extended;
#else
using Extended = long double;
#endif
using ExtendedVector = Eigen::Matrix<Extended, Eigen::Dynamic, 1>;
using ExtendedMatrix = Eigen::Matrix<Extended, Eigen::Dynamic, Eigen::Dynamic>;

using Vector12 = Eigen::Matrix<double, 12, 1>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// Rigidities about local axes, x along the member: N, Nm², Nm², Nm². Shear rigidities GAs_y (N, deflection along local
/// y, bending about z) and GAs_z; infinite for an Euler–Bernoulli beam.
struct BeamRigidity {
  double EA, EIy, EIz, GJ, GAs_y, GAs_z;
  bool operator==(const BeamRigidity&) const = default;
};

struct Beam {
  int a = 0, b = 0;  ///< nodes
  Matrix3 R_WM;      ///< columns: local x (from a to b), y, z in base axes
  double length = 0;
  BeamRigidity rigidity;
  std::string name, part;  ///< "leg 1 guideway [2]"; "guideway" groups energies
  /// First of six scalars for the motion of end b relative to the body of end a, [δ; θ] in base axes at b; −1 where the
  /// nodes' displacements are accurate enough (relative.h).
  int relative = -1;
  double expansion = 0;  ///< 1/K; not used by the beam itself
  int defined_by = -1;   ///< the first of the six constraints that define that motion
};

/// Stiffness in local axes on [u_a; θ_a; u_b; θ_b]. Timoshenko: Φ = 12EI/(GAs L²); Φ = 0 is Euler–Bernoulli
/// (J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968, eq. (5.116)).
Matrix12 local_stiffness(const BeamRigidity&, double length);

/// The same in base axes.
Matrix12 stiffness(const Beam&);

/// stiffness(beam) · d without forming the matrix: forces on the ends in base axes for displacements in base axes.
Vector12 pull(const Beam&, const Vector12& d_W);
/// Rotates each of the four vectors of the ends' displacements or forces: R v.
Vector12 turned(const Matrix3& R, const Vector12&);

/// [u_a; θ_a; u_b; θ_b] of a structure's displacements u; where the beam has relative coordinates, that relative motion
/// with a at rest, which strains it equally.
Vector12 end_displacements(const Beam&, const VectorX& u);

/// The same with the rigid motion of end a subtracted before rounding, so that stiff beams keep their digits.
Vector12 end_displacements(const Beam&, const ExtendedVector& u);

/// End forces in local axes, [f_a; m_a; f_b; m_b] acting on the beam, for nodal displacements in base axes.
Vector12 end_forces(const Beam&, const Vector12& d_W);

}  // namespace deflect::frame
