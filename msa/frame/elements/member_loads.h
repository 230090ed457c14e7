// Loads along a straight member: equivalent nodal forces, section forces between the nodes, strain energy.
//
// Uniform line load q (N/m, member axes): a clamped member has end reactions qL/2 and end couples qL²/12, for
// Euler–Bernoulli and Timoshenko alike. By symmetry the shear is q(L/2 − x) and the moment M(x) = M0 + q(Lx − x²)/2;
// the section's rotation grows by ∫M/EI dx, which vanishes between clamped ends, so M0 = −qL²/12 whatever the shear
// stiffness. With these forces the displacements of the element's nodes are exact for any length. Uniform strain ε
// (thermal: α ΔT): a clamped member has the axial force −EA ε.
#pragma once

#include "msa/frame/elements/beam.h"

namespace deflect::frame {

struct ElementLoad {
  Vector3 q_M = Vector3::Zero();  ///< N/m, member axes
  double strain = 0;
};

/// Nodal forces equivalent to the load, local axes, [f_a; m_a; f_b; m_b].
Vector12 equivalent_forces(const BeamRigidity&, double length, const ElementLoad&);

/// End forces that act on the loaded beam, local axes: K d − equivalent forces, for displacements in base axes.
Vector12 end_forces(const Beam&, const Vector12& d_W, const ElementLoad&);

/// [N, Vy, Vz, T, My, Mz] at the distance x from end a: force and moment, in local axes, on the face with outward
/// normal +x. Tension is positive, Mz = EIz v'' and My = −EIy w''. They are continuous from one element to the next.
Vector6 section_forces(const Vector12& end_forces, const ElementLoad&, double x);

/// Distances from end a, within the element, at which My and Mz are stationary; −1 where there is none.
std::array<double, 2> stationary_moments(const Vector12& end_forces, const ElementLoad&, double length);

/// Strain energy, J, with d0 the free expansion and the energy of the clamped element, which is orthogonal to the rest:
/// ½ (d − d0)ᵀ K (d − d0) + Σ over bending planes (q²L⁵/1440EI + q²L³/24GAs) + q²L³/24EA.
double strain_energy(const Beam&, const Vector12& d_W, const ElementLoad&);

/// The energy that a line load stores in an element with fixed ends.
double clamped_energy(const BeamRigidity&, double length, const ElementLoad&);

}  // namespace deflect::frame
