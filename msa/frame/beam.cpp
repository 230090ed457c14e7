#include "msa/frame/beam.h"

namespace deflect::frame {
namespace {

/// Bending in one plane: transverse freedoms v_a, v_b and the rotations θ = sign · dv/dx.
void add_bending(Matrix12& K, double EI, double GAs, double L, int va, int ta, double sign) {
  const int vb = va + 6, tb = ta + 6;
  const double phi = 12 * EI / (GAs * L * L), c = EI / ((1 + phi) * L * L * L);
  const double shear = 12 * c, couple = sign * 6 * L * c, near = (4 + phi) * L * L * c, far = (2 - phi) * L * L * c;
  const auto set = [&K](int i, int j, double value) { K(i, j) = K(j, i) = value; };
  set(va, va, shear), set(vb, vb, shear), set(va, vb, -shear);
  set(va, ta, couple), set(va, tb, couple), set(vb, ta, -couple), set(vb, tb, -couple);
  set(ta, ta, near), set(tb, tb, near), set(ta, tb, far);
}

void add_axial(Matrix12& K, double k, int a) {
  K(a, a) = K(a + 6, a + 6) = k;
  K(a, a + 6) = K(a + 6, a) = -k;
}

Matrix12 to_local(const Matrix3& R_WM) {
  Matrix12 X = Matrix12::Zero();
  for (int i = 0; i < 12; i += 3) X.block<3, 3>(i, i) = R_WM.transpose();
  return X;
}

}  // namespace

Matrix12 local_stiffness(const BeamRigidity& r, double L) {
  Matrix12 K = Matrix12::Zero();
  add_axial(K, r.EA / L, 0);
  add_axial(K, r.GJ / L, 3);
  add_bending(K, r.EIz, r.GAs_y, L, 1, 5, +1);  // v along y turns about +z
  add_bending(K, r.EIy, r.GAs_z, L, 2, 4, -1);  // w along z turns about −y
  return K;
}

Matrix12 stiffness(const Beam& beam) {
  const Matrix12 X = to_local(beam.R_WM);
  return X.transpose() * local_stiffness(beam.rigidity, beam.length) * X;
}

Vector12 end_displacements(const Beam& beam, const VectorX& u) {
  Vector12 d;
  if (beam.relative < 0)
    d << u.segment<6>(6 * beam.a), u.segment<6>(6 * beam.b);
  else
    d << Vector6::Zero(), u.segment<6>(beam.relative);
  return d;
}

Vector12 end_forces(const Beam& beam, const Vector12& d_W) {
  return local_stiffness(beam.rigidity, beam.length) * (to_local(beam.R_WM) * d_W);
}

}  // namespace deflect::frame
