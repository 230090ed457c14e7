// Section forces along an element in second-order or finite geometry.
//
// F and M are the resultants on the face with outward normal +x at the distance x (unstrained) from end a, p(x) is the
// deformed axis. Equilibrium of the piece from a to x where it stands gives, with the forces f, m on the ends,
//   F = −f_a − x q,   M' = F × p',   M(0) = −m_a,   M(L) = m_b.
// M is the cubic with these end values and with the slopes F × p' at both ends, where p' follows from the sections'
// rotation, N/EA and V/GAs, plus F times the deflection q x²(L − x)²/24EI that the line load adds between them. In a
// plane that is −m_a with the lever arms of f_a on the element's own cubic shape; on a straight axis the parabola of
// member_loads.h. Relative error of M inside an element between right ends: (kL)⁴/384, k² = |N|/EI.
//
// Finite: components are in the axes of the section, turned from those of end a by the rotation vector φ(x): the cubic
// with the ends' rotations and curvatures C M. The line load acts as on the chord (geometric_solver.h).
//
// Second order: components are in the undeformed axes. There p' × F counts to first order in the displacements, with
// the forces F_l, M_l of the linear theory (geometric_stiffness, deformed_beam.h), and the stretch lengthens no lever.
// End moments are semitangential, as K_G is symmetric: M − ½ θ × M_l with θ the section's rotation, which is 0 in a
// plane.
#pragma once

#include "msa/frame/elements/member_loads.h"

namespace deflect::frame {

/// Vectors are in the axes of end a: finite those of its section, second order the undeformed ones.
struct SectionCourse {
  double length = 0;
  Vector3 F_a, q;            ///< N; N/m
  Vector3 M_a, M_b;          ///< Nm
  Vector3 slope_a, slope_b;  ///< dM/dx, N
  Vector3 sag;               ///< q/24EI: the line load's deflection between fixed ends is sag x²(L − x)², 1/m³
  bool turns = false;        ///< in finite geometry, with
  Vector3 psi = Vector3::Zero();                               ///< φ(L); φ(0) = 0
  Vector3 turn_a = Vector3::Zero(), turn_b = Vector3::Zero();  ///< dφ/dx, rad/m
};

/// `ends`: [f_a; m_a; f_b; m_b] on the loaded element in undeformed axes; `d_W`: displacements of the ends, base axes.
SectionCourse second_order_course(const Beam&, const Vector12& d_W, const ElementLoad&, const Vector12& ends);

/// `ends`: in the axes A and B (columns, base axes) of the end sections. The line load keeps its direction.
SectionCourse finite_course(const Beam&, const Matrix3& A, const Matrix3& B, const ElementLoad&, const Vector12& ends);

/// [N, Vy, Vz, T, My, Mz] as section_forces() of member_loads.h.
Vector6 section_forces(const SectionCourse&, double x);

/// Where |My| (component 4) or |Mz| (5) is largest within an element, ends included: m from end a.
double place_of_largest(const SectionCourse&, Eigen::Index component);

}  // namespace deflect::frame
