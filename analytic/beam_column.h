// A flexible member as six virtual freedoms at its tip: the wrench needed to displace the tip relative to the clamped
// start, with the effects of the axial force and of large loads.
//
// Bending in the plane xy (likewise in xz, with w and −θy) under a constant axial force N, tension positive. The beam
// obeys EI ψ' = m and GA_s (v' − ψ) = q, and its axial force does work on the slope v' of the axis (F. Engesser). With
// β = 1/(1 + N/GA_s), z = βNL²/EI and φ_n(z) = Σ z^k/(2k + n)! (φ0 = cosh √z, φ1 = sinh √z/√z; trigonometric in
// compression), integration gives the tip compliance [v; θ] of [Q; M]
//   c_vv = β² L³/EI (φ2 − φ3)/φ0 + βL/GA_s,  c_vθ = βL²/EI φ2/φ0,  c_θθ = L/EI φ1/φ0
// K(N) is its inverse; for GA_s = ∞ these are the stability functions [φ1 EI/L³, −φ2 EI/L²; ·, (φ2 − φ3) EI/L]/(φ3 −
// 2φ4). K is regular down to z = −4π², where the member buckles between clamped ends.
//
// The mixed potential V(N, p) = ½ pᵀK(N) p − N²L/2EA, p = (v, θ), makes force and shape consistent:
//   [Q; M] = ∂V/∂p,   u = −∂V/∂N = NL/EA − ½ pᵀK'(N) p,
// where the second term is the foreshortening ½ ∫ v'² dx of the bent axis.
//
// Finite shape: u and the rotation vector φ of the tip are relative to the start's axes. The mean axes of the two ends
// are turned by φ/2; in them the displacement is r' = e^{−φ/2} (L e_x + u) − L e_x, and N acts along them. There the
// end slopes relative to the chord are ∓θ/2, so that an arc (θ) and an S shape (v') decouple: K_vv as above and K_θθ +
// ½ L K_vθ. An arc of any angle has its moment EI θ/L exactly, and its chord to θ⁴/1920. The stretch N/EA lengthens the
// lever of Q. The cubic and quartic terms of the energy of a space rod are added, with T = GJ φx/L and M = EI φ/L at
// midspan and the transverse forces F. Under M alone, constant in space, the moment in the section's axes grows by m =
// M×κ per length. All orders of L follow from R' = R[κ], κ = Cm (W. Magnus, Comm. Pure Appl. Math. 7 (1954) 649),
// relative to the mean axes:
//   U3 = −T e0,   e0 = α Fy My + β Fz Mz,   α = L³/12GJ (1/2EIy + 1/EIz) − L³/12EIyEIz,   β = α with y and z changed,
//   U4 = −L³/24 m·Cm + ½ K_y (α T My)² + ½ K_z (β T Mz)²,   K_y, K_z: of v' and w',
// U3 is taken as ½ GJ/L (φx − e0)², which also holds where GJ ≫ EI. Under moments alone what is left out is of fourth
// order in the rotation between the ends in the rotation, in the energy and in the displacement over L, and of third
// order in the displacement over itself, which is of first order, and in the wrench at a given displacement: a rod of
// GJ : EIy : EIz = 0.7 : 1 : 1.9 that is twisted and bent by 0.13 errs by 3e-7, 5e-7, 2e-7, 6e-6 and 3e-5 of them.
// Under forces F across the relative errors are of second order in L²F/EI. Of pieces of a member the relative error in
// energy falls with the fourth power of their length. The neglected products of U3 and U4 with the strain N/EA and with
// EI/GA_sL² fall with its square. Bent members are therefore divided (deformed.h).
//
// Second order: small displacements, and V without foreshortening. For coupled torsion and bending, the work of the
// state's forces on second-order motions of the tip is added, −Q(F, T, M; κ), with Q the integral above.
#pragma once

#include "msa/base/geometry.h"
#include "msa/mechanism/configuration.h"

namespace deflect::analytic {

/// Tip stiffness ∂[Q; M]/∂[v; θ] in one plane, and its derivatives with respect to N.
struct TipBending {
  Eigen::Matrix2d K, dK, ddK;
  bool stable = true;  ///< z > −4π²
};
/// `shear`: GA_s, or 0 for no shear deformation. SI.
TipBending tip_bending(double length, double EI, double shear, double N);
/// The same relative to the mean axes: diagonal, in v' and θ. EA is used for the stretch N/EA that lengthens the lever.
TipBending mean_bending(double length, double EI, double shear, double N, double EA);

/// The wrench [f; m] on the tip, linearised: s + K d for a small further motion d = [δ; ψ], with ψ a rotation vector
/// that follows the rotation so far; member axes.
struct TipLaw {
  Vector6 s;
  Matrix6 K;          ///< symmetric
  double energy = 0;  ///< J, of the member in this state
  bool stable = true;
};

/// At the tip displacement [u; φ] under `force`, which statics gives at the tip, in the start's axes. Its component
/// along the member, N (second order: along the start's axis), is more accurate than one from the stretch. s and K
/// contain the tangent in N, and N has converged when s agrees with it. Geometry: second_order or finite.
TipLaw tip_law(const PlacedMember&, const Vector6& displacement, const Vector3& force, Geometry);

/// Approximate upper bound of the relative error of rotation and energy under the wrench that holds the tip
/// displacement [u; φ], and of the displacement, down to 1e-7: with λ = L |M|/k from the moment at midspan and μ = L²
/// |Q|/k of the transverse force, k² the product of the two smaller ones of GJ, EIy and EIz (a strip buckles laterally
/// under a moment about its stiff axis at λ ≈ π), (λ⁴ + μ²)/12 in finite shape, (λ + ½μ)²/12 in second order.
double left_out(const PlacedMember&, const Vector6& displacement, Geometry);

}  // namespace deflect::analytic
