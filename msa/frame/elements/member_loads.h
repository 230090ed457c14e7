// Loads along a straight member: equivalent nodal forces, section forces between the nodes, strain energy.
//
// Uniform line load q (N/m, member axes): the ends of a clamped member push back with qL/2 and the couple qL²/12, for
// Euler–Bernoulli and Timoshenko alike. By symmetry the shear is q(L/2 − x) and the moment M(x) = M0 + q(Lx − x²)/2;
// the section's rotation grows by ∫M/EI dx, which vanishes between clamped ends, so M0 = −qL²/12 whatever the shear
// stiffness. With these forces the nodes of the element are exact, however long it is.
// Uniform strain ε (heat: α ΔT): the clamped member pushes with EA ε.
#pragma once

#include "msa/frame/elements/beam.h"

namespace deflect::frame {

struct ElementLoad {
  Vector3 q_M = Vector3::Zero();  ///< N/m, member axes
  double strain = 0;
};

/// Forces that act on the nodes in the load's place, local axes, [f_a; m_a; f_b; m_b].
Vector12 equivalent_forces(const BeamRigidity&, double length, const ElementLoad&);

/// End forces that act on the loaded beam, local axes: K d − equivalent forces, for displacements in base axes.
Vector12 end_forces(const Beam&, const Vector12& d_W, const ElementLoad&);

/// [N, Vy, Vz, T, My, Mz] at the distance x from end a: force and moment, in local axes, on the face that looks along
/// +x. Tension is positive, Mz = EIz v'' and My = −EIy w''. They run without a jump from one element into the next.
Vector6 section_forces(const Vector12& end_forces, const ElementLoad&, double x);

/// Distances from end a, within the element, at which My and Mz are stationary; −1 where there is none.
std::array<double, 2> stationary_moments(const Vector12& end_forces, const ElementLoad&, double length);

/// Strain energy, J. With d0 the free expansion and the clamped element's own part, which is orthogonal to the rest:
/// ½ (d − d0)ᵀ K (d − d0) + Σ over bending planes (q²L⁵/1440EI + q²L³/24GAs) + q²L³/24EA.
double strain_energy(const Beam&, const Vector12& d_W, const ElementLoad&);

/// The clamped element's own part: what a line load stores between ends that do not move.
double clamped_energy(const BeamRigidity&, double length, const ElementLoad&);

}  // namespace deflect::frame
