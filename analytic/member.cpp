#include "analytic/member.h"

#include <Eigen/LU>
#include <cmath>

#include "msa/base/error.h"

namespace deflect::analytic {
namespace {

/// The tip block of the stiffness of a clamped-free beam as (35) and (41) mean it, x along the member.
Matrix6 tip_stiffness(const PlacedMember& m) {
  const double L = m.length(), EIy = m.E * m.section.Iy, EIz = m.E * m.section.Iz;
  Matrix6 K = Matrix6::Zero();
  K.diagonal() << m.E * m.section.A / L, 12 * EIz / (L * L * L), 12 * EIy / (L * L * L), m.G * m.section.J / L,
      4 * EIy / L, 4 * EIz / L;
  K(1, 5) = K(5, 1) = -6 * EIz / (L * L);
  K(2, 4) = K(4, 2) = 6 * EIy / (L * L);
  return K;
}

}  // namespace

Matrix6 tip_compliance(const PlacedMember& m) {
  const double L = m.length(), EIy = m.E * m.section.Iy, EIz = m.E * m.section.Iz;
  Matrix6 C = Matrix6::Zero();
  C.diagonal() << L / (m.E * m.section.A), L * L * L / (3 * EIz), L * L * L / (3 * EIy), L / (m.G * m.section.J),
      L / EIy, L / EIz;
  C(1, 5) = C(5, 1) = L * L / (2 * EIz);
  C(2, 4) = C(4, 2) = -L * L / (2 * EIy);
  if (m.beam == BeamTheory::timoshenko) {
    C(1, 1) += L / (m.G * m.section.As_y);
    C(2, 2) += L / (m.G * m.section.As_z);
  }
  return C;
}

Matrix6 tip_compliance_guideway_as_printed(const PlacedMember& m) {
  Matrix6 K = tip_stiffness(m);
  const double L = m.length();
  K(1, 5) = -6 * m.E * m.section.Iz / (L * L * (1e3 * L));
  K(4, 4) = 6 * m.E * m.section.Iy / L;
  return K.inverse();
}

Matrix6 tip_compliance_link_as_printed(const PlacedMember& m) {
  const double L = m.length(), EI = m.E * m.section.Iy;
  Matrix6 K = Matrix6::Zero();
  // mm²/mm read as N/mm and mm⁴/mm read as Nmm, in N/m and Nm.
  const double axial = 1e3 * (1e3 * m.section.A / L), turning = 1e-3 * (1e9 * 4 * m.section.Iy / L);
  K.diagonal() << 12 * EI / (L * L * L), 12 * EI / (L * L * L), axial, turning, 4 * EI / L, m.G * m.section.J / L;
  K(0, 4) = K(4, 0) = -6 * EI / (L * L);
  K(1, 3) = K(3, 1) = 6 * EI / (L * L);
  return K.inverse();
}

Matrix3 link_axes_as_printed(const PlacedMember& m) {
  const Vector3 along = (m.p_W_end - m.p_W_start).normalized();
  const double horizontal = std::hypot(along.x(), along.y());
  if (horizontal < 1e-12)
    throw ModelError(m.part + ": its frame after (40) as printed is undefined, the link is vertical");
  Matrix3 R;
  R.col(0) = Vector3(-along.y(), along.x(), 0) / horizontal;
  R.col(1) = along.cross(R.col(0));
  R.col(2) = along;
  return R;
}

Matrix6 moved_to(const Vector3& p_WT, const PlacedMember& m, const Matrix3& R_WM, const Matrix6& C_tip_M) {
  const Matrix6 J = shift_twist(p_WT - m.p_W_end) * rotate_twist(R_WM);
  return J * C_tip_M * J.transpose();
}

}  // namespace deflect::analytic
