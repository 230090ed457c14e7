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
// Finite shape: tip displacement u and rotation vector φ against the start's axes, with the foreshortening and, of
// torsion T = GJ φx/L and bending together, the cubic term of the energy of a space rod (the complementary energy of a
// cantilever under F, M at its tip to third order, ∫ (L−x) φx F·κ + ½ M·(φ×κ) dx over its linear state),
//   U3 = −T e0,   e0 = α Fy My + β Fz Mz + γ Fy Fz,   γ = (1/EIz − 1/EIy) L⁴/12GJ,
//   α = L³/6GJ (1/EIy + 1/2EIz) − L³/12EIyEIz,   β = α with y and z changed,
// taken as ½ GJ/L (φx − e0)², which holds where GJ ≫ EI too, so that what is left out is of third order in the loads
// (of second, relative), of the strain N/EA, and of EI/GA_sL² times U3. Second order: small displacements and V without
// foreshortening; of torsion and bending what the forces of the state do on second-order motions of the tip, −Q(F, T,
// M; κ) with the integral above as Q.
#pragma once

#include "msa/base/geometry.h"
#include "msa/mechanism/configuration.h"

namespace deflect::analytic {

/// Stiffness [Q; M] by [v; θ] of the tip in one plane, and its derivatives by N.
struct TipBending {
  Eigen::Matrix2d K, dK, ddK;
  bool stable = true;  ///< z > −4π²
};
/// shear: GA_s, or 0 where shear deforms nothing; EA where the stretch N/EA lengthens the lever of Q, else 0. SI.
TipBending tip_bending(double length, double EI, double shear, double N, double EA = 0);

/// The wrench [f; m] that the tip demands, s + K d for a small further motion d = [δ; ψ], ψ a rotation vector added to
/// what the tip has turned; member axes.
struct TipLaw {
  Vector6 s;
  Matrix6 K;          ///< symmetric
  double energy = 0;  ///< J, of the member as it is
  bool stable = true;
};

/// At the tip displacement [u; φ] with the axial force N, which statics knows better than the stretch: s and K are
/// those of the tangent in N too, and N has converged when s(0) = N. Geometry: second_order or finite.
TipLaw tip_law(const PlacedMember&, const Vector6& displacement, double N, Geometry);

}  // namespace deflect::analytic
