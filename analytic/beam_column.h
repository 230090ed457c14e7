// A flexible member as six virtual freedoms at its tip: what its tip demands for being displaced against its clamped
// start, the force along it and large loads taken into account.
//
// Bending in the plane xy (in xz likewise, with w and −θy) under the constant axial force N, tension positive, of a
// beam whose cross-sections follow EI ψ' = m, GA_s (v' − ψ) = q and whose axial force does its work on the slope v' of
// the axis (F. Engesser): with β = 1/(1 + N/GA_s), z = βNL²/EI and φ_n(z) = Σ z^k/(2k + n)! (φ0 = cosh √z, φ1 = sinh
// √z/√z; trigonometric in compression), integration gives the tip compliance [v; θ] of [Q; M]
//   c_vv = β² L³/EI (φ2 − φ3)/φ0 + βL/GA_s,  c_vθ = βL²/EI φ2/φ0,  c_θθ = L/EI φ1/φ0
// and as its inverse K(N), for GA_s = ∞ the stability functions [φ1 EI/L³, −φ2 EI/L²; ·, (φ2 − φ3) EI/L]/(φ3 − 2φ4).
// It is regular down to z = −4π², where the member buckles between clamped ends.
//
// The mixed potential V(N, p) = ½ pᵀK(N) p − N²L/2EA, p = (v, θ), makes force and shape consistent:
//   [Q; M] = ∂V/∂p,   u = −∂V/∂N = NL/EA − ½ pᵀK'(N) p,
// the second term being the foreshortening ½ ∫ v'² dx of the bent axis.
//
// Finite shape: tip displacement u and rotation vector φ against the start's axes; the mean axes of the two ends are
// turned by φ/2 and see r' = e^{−φ/2} (L e_x + u) − L e_x and the force N along themselves. There the chord has the end
// slopes ∓θ/2, so that an arc (θ) and an S (v') come apart: K_vv as above and K_θθ + ½ L K_vθ. An arc of any angle has
// its moment EI θ/L exactly, and its chord to θ⁴/1920. The stretch N/EA lengthens the lever of Q. To this come, with
// T = GJ φx/L and M = EI φ/L halfway along and the transverse forces F, the cubic and quartic terms of the energy of a
// space rod. Under M alone, constant in space, its moment in the section's axes grows by m = M×κ per length; all orders
// of L are those of R' = R[κ], κ = Cm (W. Magnus, Comm. Pure Appl. Math. 7 (1954) 649), counted from the mean axes:
//   U3 = −T e0,   e0 = α Fy My + β Fz Mz,   α = L³/12GJ (1/2EIy + 1/EIz) − L³/12EIyEIz,   β = α with y and z changed,
//   U4 = −L³/24 m·Cm + ½ K_y (α T My)² + ½ K_z (β T Mz)²,   K_y, K_z: of v' and w',
// U3 taken as ½ GJ/L (φx − e0)², which holds where GJ ≫ EI too. What is left out is, relative, of the fourth order in
// rotations between the ends and falls with the fourth power of the length; the strain N/EA and EI/GA_sL² times U3 and
// U4 fall with its square. Bent members are divided (deformed.h).
//
// Second order: small displacements and V without foreshortening; of torsion and bending what the forces of the state
// do on second-order motions of the tip, −Q(F, T, M; κ) with the integral above as Q.
#pragma once

#include "msa/base/geometry.h"
#include "msa/mechanism/configuration.h"

namespace deflect::analytic {

/// Stiffness [Q; M] by [v; θ] of the tip in one plane, and its derivatives by N.
struct TipBending {
  Eigen::Matrix2d K, dK, ddK;
  bool stable = true;  ///< z > −4π²
};
/// shear: GA_s, or 0 where shear deforms nothing. SI.
TipBending tip_bending(double length, double EI, double shear, double N);
/// The same against the mean axes: diagonal, by v' and θ; EA gives the stretch N/EA that lengthens the lever.
TipBending mean_bending(double length, double EI, double shear, double N, double EA);

/// The wrench [f; m] that the tip demands, s + K d for a small further motion d = [δ; ψ], ψ a rotation vector added to
/// what the tip has turned; member axes.
struct TipLaw {
  Vector6 s;
  Matrix6 K;          ///< symmetric
  double energy = 0;  ///< J, of the member as it is
  bool stable = true;
};

/// At the tip displacement [u; φ] under `force`, which statics knows at the tip in the start's axes. Its part along the
/// member, N (second order: along the start's axis), is known better by it than by the stretch: s and K are those of
/// the tangent in N too, and N has converged when s has it. Geometry: second_order or finite.
TipLaw tip_law(const PlacedMember&, const Vector6& displacement, const Vector3& force, Geometry);

/// No less, by and large, than what the law leaves out at the tip displacement [u; φ], relative: with λ = L |M|/k of
/// the moment halfway along and μ = L² |Q|/k of the transverse force, k² the product of the two smaller ones of GJ, EIy
/// and EIz (a strip turns aside under a moment about its stiff axis at λ ≈ π), (λ⁴ + μ²)/12 in finite shape, (λ +
/// ½μ)²/12 in second order.
double left_out(const PlacedMember&, const Vector6& displacement, Geometry);

}  // namespace deflect::analytic
