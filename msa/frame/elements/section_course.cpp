#include "msa/frame/elements/section_course.h"

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <cmath>

#include "msa/frame/elements/finite_rotation.h"

namespace deflect::frame {
namespace {

/// The cubic in s = x/L from its end values and its slopes by x.
Vector3 cubic(const Vector3& a, const Vector3& slope_a, const Vector3& b, const Vector3& slope_b, double L, double s) {
  const double t = 1 - s;
  return t * t * ((1 + 2 * s) * a + s * L * slope_a) + s * s * ((1 + 2 * t) * b - t * L * slope_b);
}

Vector3 sheared(const BeamRigidity& r, const Vector3& F) { return {0, F.y() / r.GAs_y, F.z() / r.GAs_z}; }
Vector3 curvature(const BeamRigidity& r, const Vector3& M) { return M.cwiseQuotient(Vector3(r.GJ, r.EIy, r.EIz)); }
Vector3 sagging(const BeamRigidity& r, const Vector3& q) { return Vector3(0, q.y() / r.EIz, q.z() / r.EIy) / 24; }

/// d/dx of the semitangential moment; F, and of the linear theory F_l and M_l, at a section turned by θ.
Vector3 second_order_slope(const BeamRigidity& r, const Vector3& F, const Vector3& F_l, const Vector3& M_l,
                           const Vector3& theta) {
  const Vector3 along = Vector3::UnitX(), turning = theta.cross(along) + sheared(r, F_l);
  return F.cross(along) + F_l.cross(turning) - (curvature(r, M_l).cross(M_l) + theta.cross(F_l.cross(along))) / 2;
}

/// F × p' in the section's axes.
Vector3 finite_slope(const BeamRigidity& r, const Vector3& F, double free_strain) {
  return F.cross((1 + F.x() / r.EA + free_strain) * Vector3::UnitX() + sheared(r, F));
}

}  // namespace

SectionCourse second_order_course(const Beam& beam, const Vector12& d_W, const ElementLoad& load,
                                  const Vector12& ends) {
  const BeamRigidity& r = beam.rigidity;
  const Vector12 linear = end_forces(beam, d_W, load), d = turned(beam.R_WM.transpose(), d_W);
  SectionCourse c;
  c.length = beam.length;
  c.F_a = -ends.head<3>(), c.q = load.q_M;
  c.M_a = -ends.segment<3>(3), c.M_b = ends.tail<3>();
  c.slope_a = second_order_slope(r, c.F_a, -linear.head<3>(), -linear.segment<3>(3), d.segment<3>(3));
  c.slope_b = second_order_slope(r, ends.segment<3>(6), linear.segment<3>(6), linear.tail<3>(), d.tail<3>());
  c.sag = sagging(r, c.q);
  return c;
}

SectionCourse finite_course(const Beam& beam, const Matrix3& A, const Matrix3& B, const ElementLoad& load,
                            const Vector12& ends) {
  const BeamRigidity& r = beam.rigidity;
  const Eigen::Quaterniond Q(Matrix3(A.transpose() * B));
  const Vector3 F_b = ends.segment<3>(6), M_b = ends.tail<3>();
  SectionCourse c;
  c.length = beam.length;
  c.F_a = -ends.head<3>(), c.q = A.transpose() * beam.R_WM * load.q_M;
  c.M_a = -ends.segment<3>(3), c.M_b = Q * M_b;
  c.slope_a = finite_slope(r, c.F_a, load.strain);
  c.slope_b = Q * finite_slope(r, F_b, load.strain);
  c.turns = true;
  c.psi = rotation_vector(Q);
  const Eigen::Quaterniond half = rotation_by(c.psi / 2);
  c.sag = half * sagging(r, half.conjugate() * c.q);
  // The curvature of the section is the spin of its axes by x: φ' = J⁻¹ Q κ, J⁻¹ = S exp(−½ψ×) (finite_rotation.h).
  c.turn_a = curvature(r, c.M_a);
  c.turn_b = RelativeRotation(c.psi).S() * (half * curvature(r, M_b));
  return c;
}

Vector6 section_forces(const SectionCourse& c, double x) {
  const double L = c.length, within = x * (L - x);
  const Vector3 F = c.F_a - x * c.q;
  const Vector3 M = cubic(c.M_a, c.slope_a, c.M_b, c.slope_b, L, x / L) + within * within * F.cross(c.sag);
  Vector6 s;
  if (!c.turns) {
    s << F, M;
    return s + Vector6::Zero();  // 0 rather than -0
  }
  const Eigen::Quaterniond back = rotation_by(-cubic(Vector3::Zero(), c.turn_a, c.psi, c.turn_b, L, x / L));
  s << back * F, back * M;
  return s + Vector6::Zero();
}

double place_of_largest(const SectionCourse& c, Eigen::Index component) {
  constexpr int pieces = 8;
  constexpr int bits = 26;  // of x: half those of the moment, which is stationary there
  const auto lack = [&](double x) { return -std::abs(section_forces(c, x)(component)); };
  double best = 0, least = lack(0);
  const auto at = [&](int i) { return i < pieces ? c.length * i / pieces : c.length; };
  int nearest = 0;
  const auto keep = [&](double x, double value) {
    const bool lower = value < least * (1 + 1e-12);  // not by rounding
    if (lower) best = x, least = value;
    return lower;
  };
  for (int i = 1; i <= pieces; ++i)
    if (keep(at(i), lack(at(i)))) nearest = i;
  const double from = at(std::max(nearest - 1, 0)), to = at(std::min(nearest + 1, pieces));
  const auto [x, value] = boost::math::tools::brent_find_minima(lack, from, to, bits);
  keep(x, value);
  return best;
}

}  // namespace deflect::frame
