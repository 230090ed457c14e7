// A co-rotational beam: rotations of any size, small strains. Its geometric stiffness at small displacements under
// given forces follows from the same derivation.
//
// The axes of the end sections are A and B (columns, base axes), M their mean (finite_rotation.h). The element is
// strained by the rotation between its ends and by the vector between them in the mean axes (p = position):
//   ψ = log(AᵀB),   r = Mᵀ (p_b − p_a),   l = |r|
// With L the length, Φz = 12 EIz/(GAs_y L²) and the same for y, its energy is
//   U = ½ EA L ε² + ½ (GJ ψ*x² + EIy ψ*y² + EIz ψ*z²)/L + 6 EIz/((1+Φz) L³) r*_y² + 6 EIy/((1+Φy) L³) r*_z²
//   ε = (l − L)/L + (ψy² + ψz²)/24 + (r_y²/(1+Φz)² + r_z²/(1+Φy)²)/(10 L²) − ε₀
// ψy, ψz bend the element to an arc, r_y, r_z to an S. The quadratic terms of ε are the mean of ½(v'² + w'²) over those
// shapes, v' being the slope of the centre line, so that a compressed element buckles between its nodes too: at ψ = 0,
// r = (L, 0, 0) the second derivative is the stiffness of beam.h plus the consistent geometric one (6N/5L, N/10,
// 2NL/15, −NL/30; J. S. Przemieniecki, Theory of Matrix Structural Analysis, 1968, eq. (15.24)), with shear that of
// Engesser: N turns with the centre line. Modes after S. Krenk, Non-linear Modeling and Analysis of Solids and
// Structures, 2009, ch. 5. Twist turns the plane of bending inside the element, to second order in r and ψ, with the
// slopes of the sections a_y = r_y/((1+Φz) L) and a_z = r_z/((1+Φy) L):
//   r*_y = r_y (1 − ε) − L ψx ψy/24,   ψ*x = ψx + a_y ψy + a_z ψz,
//   r*_z = r_z (1 − ε) − L ψx ψz/24,   ψ*y = ψy − a_y ψx,   ψ*z = ψz − a_z ψx
// A line of constant curvature κ in the axes of its sections ends at R_mᵀ∫R e_x ds = L e_x + L³ κ×(κ×e_x)/24 in its
// mean axes; ψ* are the means of the curvature in axes that turn with the S; 1 − ε makes the slope of the S an angle
// where the element is strained. Errors: relative (h κ)² of an element of length h bent to the curvature κ.
// Neglected: shortening by twist (Wagner effect), relative N/EA · E/G · (Iy + Iz)/J, which is negligible for closed
// sections.
//
// Moments are conjugate to the spins ω of the nodes (base axes, Q̇ = [ω]× Q): the work of m is m·ω dt. The derivative
// of these forces with respect to the spins is not symmetric; its skew part −½[m]× at each node depends only on the
// nodal moment. K here is the symmetric part, the second derivative of U with respect to rotation vectors applied to
// the state; see tangent.h.
//
// Valid while the rotation between the ends of an element is less than π.
#pragma once

#include "msa/frame/elements/beam.h"
#include "msa/frame/elements/finite_rotation.h"

namespace deflect::frame {

struct DeformedBeam {
  Vector12 forces = Vector12::Zero();  ///< on the ends, [f_a; m_a; f_b; m_b], base axes
  Matrix12 K = Matrix12::Zero();       ///< base axes
  Matrix3 A, B;                        ///< axes of the end sections
  double energy = 0;                   ///< J
};

/// `strain`: ε₀, free (thermal) strain.
DeformedBeam deformed(const Beam&, const BodyMotion& a, const BodyMotion& b, double strain);

/// Approximate upper bound of an element's error under its end forces. With λ = L |m|/k + L² |f|/k, μ = L² |q|/k, k²
/// the product of the two smaller ones of GJ, EIy and EIz, m the larger end moment, f the force and q its transverse
/// part: relative error λ²/12, and an error of twist λμ/12 by bending and transverse force together.
struct LeftOut {
  double relative = 0;
  double twist = 0;  ///< rad
};
LeftOut left_out(const Beam&, const Vector12& forces, const Vector3& axis);

/// K_G in base axes: the stiffness added by the end forces [f_a; m_a; f_b; m_b] (local axes; half their differences
/// count) at zero displacement. As in beam-column theory the stretch N/EA lengthens no lever, and N is the force along
/// the undeformed axis.
Matrix12 geometric_stiffness(const Beam&, const Vector12& ends);

}  // namespace deflect::frame
