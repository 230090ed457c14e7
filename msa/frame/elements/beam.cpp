#include "msa/frame/elements/beam.h"

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

/// Forces and couples of bending in one plane for v_a, θ_a, v_b, θ_b: the rows of add_bending times the displacements.
void bend(Vector12& f, const Vector12& d, double EI, double GAs, double L, int va, int ta, double sign) {
  const int vb = va + 6, tb = ta + 6;
  const double phi = 12 * EI / (GAs * L * L), c = EI / ((1 + phi) * L * L * L);
  const double shear = c * (12 * (d(va) - d(vb)) + sign * 6 * L * (d(ta) + d(tb)));
  const double couple = sign * 6 * L * c * (d(va) - d(vb));
  f(va) = shear;
  f(vb) = -shear;
  f(ta) = couple + c * L * L * ((4 + phi) * d(ta) + (2 - phi) * d(tb));
  f(tb) = couple + c * L * L * ((2 - phi) * d(ta) + (4 + phi) * d(tb));
}

Vector12 local_pull(const BeamRigidity& r, double L, const Vector12& d) {
  Vector12 f;
  f(0) = r.EA / L * (d(0) - d(6));
  f(3) = r.GJ / L * (d(3) - d(9));
  f(6) = -f(0);
  f(9) = -f(3);
  bend(f, d, r.EIz, r.GAs_y, L, 1, 5, +1);
  bend(f, d, r.EIy, r.GAs_z, L, 2, 4, -1);
  return f;
}

}  // namespace

Vector12 turned(const Matrix3& R, const Vector12& d) {
  Vector12 out;
  for (int i = 0; i < 12; i += 3) out.segment<3>(i).noalias() = R * d.segment<3>(i);
  return out;
}

Matrix12 local_stiffness(const BeamRigidity& r, double L) {
  Matrix12 K = Matrix12::Zero();
  add_axial(K, r.EA / L, 0);
  add_axial(K, r.GJ / L, 3);
  add_bending(K, r.EIz, r.GAs_y, L, 1, 5, +1);  // v along y turns about +z
  add_bending(K, r.EIy, r.GAs_z, L, 2, 4, -1);  // w along z turns about −y
  return K;
}

Matrix12 stiffness(const Beam& beam) {
  const Matrix12 local = local_stiffness(beam.rigidity, beam.length);
  Matrix12 K;
  for (int j = 0; j < 12; j += 3)
    for (int i = 0; i < 12; i += 3) {
      const Matrix3 turned_once = beam.R_WM * local.block<3, 3>(i, j);
      K.block<3, 3>(i, j).noalias() = turned_once * beam.R_WM.transpose();
    }
  return K;
}

Vector12 pull(const Beam& beam, const Vector12& d_W) { return turned(beam.R_WM, end_forces(beam, d_W)); }

Vector12 end_displacements(const Beam& beam, const VectorX& u) {
  Vector12 d;
  if (beam.relative < 0)
    d << u.segment<6>(6 * beam.a), u.segment<6>(6 * beam.b);
  else
    d << Vector6::Zero(), u.segment<6>(beam.relative);
  return d;
}

Vector12 end_displacements(const Beam& beam, const ExtendedVector& u) {
  using Extended3 = Eigen::Matrix<Extended, 3, 1>;
  Vector12 d = Vector12::Zero();
  if (beam.relative >= 0) {
    d.tail<6>() = u.segment<6>(beam.relative).cast<double>();
    return d;
  }
  const Extended3 x = beam.length * beam.R_WM.col(0).cast<Extended>(), turned = u.segment<3>(6 * beam.a + 3);
  const Extended3 moved = u.segment<3>(6 * beam.b) - u.segment<3>(6 * beam.a) - turned.cross(x);
  d.segment<3>(6) = moved.cast<double>();
  d.segment<3>(9) = (u.segment<3>(6 * beam.b + 3) - turned).cast<double>();
  return d;
}

Vector12 end_forces(const Beam& beam, const Vector12& d_W) {
  return local_pull(beam.rigidity, beam.length, turned(beam.R_WM.transpose(), d_W));
}

}  // namespace deflect::frame
