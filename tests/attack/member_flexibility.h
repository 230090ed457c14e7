// The flexibility of a clamped straight member in 50 digits.
//
// Its end b carries the forces q = [N Vy Vz T My Mz] in member axes. At the distance r from the end the section carries
// N, Vy, Vz, T, My − r Vz, Mz + r Vy. The works of unit loads are
//   C_ij = ∫ (N_i N_j / EA + T_i T_j / GJ + My_i My_j / EIy + Mz_i Mz_j / EIz + Vy_i Vy_j / GAy + Vz_i Vz_j / GAz) dr.
#pragma once

#include "tests/attack/full_pivot.h"

namespace deflect::attack {

struct MemberRigidity {
  Real EA, EIy, EIz, GJ, per_GAy = 0, per_GAz = 0;  ///< shear as 1/GA, 0 for Euler–Bernoulli
};

/// The motion of end b, [δ; θ] in member axes, is C q.
inline RealMatrix member_flexibility(const MemberRigidity& k, const Real& L) {
  RealMatrix C(6, 6);
  const Real L2 = L * L / 2, L3 = L * L * L / 3;
  C(0, 0) = L / k.EA;
  C(1, 1) = L3 / k.EIz + L * k.per_GAy;
  C(1, 5) = C(5, 1) = L2 / k.EIz;
  C(2, 2) = L3 / k.EIy + L * k.per_GAz;
  C(2, 4) = C(4, 2) = -L2 / k.EIy;
  C(3, 3) = L / k.GJ;
  C(4, 4) = L / k.EIy;
  C(5, 5) = L / k.EIz;
  return C;
}

}  // namespace deflect::attack
