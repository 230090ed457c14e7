#include "msa/frame/elements/member_loads.h"

namespace deflect::frame {

Vector12 equivalent_forces(const BeamRigidity& r, double L, const ElementLoad& load) {
  Vector12 f = Vector12::Zero();
  f.segment<3>(0) = f.segment<3>(6) = load.q_M * L / 2;
  f(5) = load.q_M.y() * L * L / 12, f(11) = -f(5);   // v along y turns about +z
  f(4) = -load.q_M.z() * L * L / 12, f(10) = -f(4);  // w along z turns about −y
  f(0) -= r.EA * load.strain, f(6) += r.EA * load.strain;
  return f;
}

Vector12 end_forces(const Beam& beam, const Vector12& d_W, const ElementLoad& load) {
  return end_forces(beam, d_W) - equivalent_forces(beam.rigidity, beam.length, load);
}

Vector6 section_forces(const Vector12& ends, const ElementLoad& load, double x) {
  // Equilibrium of the piece from a to x.
  const Vector3 f = ends.head<3>(), &q = load.q_M;
  Vector6 s = -ends.head<6>();
  s.head<3>() -= x * q;
  s(4) -= x * f.z() + x * x / 2 * q.z();
  s(5) += x * f.y() + x * x / 2 * q.y();
  return s + Vector6::Zero();  // 0 rather than -0
}

std::array<double, 2> stationary_moments(const Vector12& ends, const ElementLoad& load, double L) {
  const auto zero_of_shear = [&](int axis) {
    const double q = load.q_M(axis), x = q == 0 ? -1 : -ends(axis) / q;
    return x > 0 && x < L ? x : -1;
  };
  return {zero_of_shear(2), zero_of_shear(1)};
}

double clamped_energy(const BeamRigidity& r, double L, const ElementLoad& load) {
  const Vector3 q2 = load.q_M.cwiseAbs2();
  const double L3 = L * L * L, bending = L3 * L * L / 1440;
  return q2.x() * L3 / (24 * r.EA) + q2.y() * (bending / r.EIz + L3 / (24 * r.GAs_y)) +
         q2.z() * (bending / r.EIy + L3 / (24 * r.GAs_z));
}

double strain_energy(const Beam& beam, const Vector12& d_W, const ElementLoad& load) {
  Vector12 d = d_W;
  d.segment<3>(6) -= beam.R_WM.col(0) * (load.strain * beam.length);
  Vector12 local;
  for (int i = 0; i < 12; i += 3) local.segment<3>(i) = beam.R_WM.transpose() * d.segment<3>(i);
  return 0.5 * local.dot(local_stiffness(beam.rigidity, beam.length) * local) +
         clamped_energy(beam.rigidity, beam.length, load);
}

}  // namespace deflect::frame
