#include "msa/frame/elements/deformed_beam.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace deflect::frame {
namespace {

using Matrix3x12 = Eigen::Matrix<double, 3, 12>;
using Matrix6x12 = Eigen::Matrix<double, 6, 12>;

double shear_number(double EI, double GAs, double L) { return 12 * EI / (GAs * L * L); }

/// U's derivatives by [r; ψ]; what of them is a force may come from elsewhere (second order).
struct Potential {
  double energy = 0, N = 0;
  Vector3 rho = Vector3::Zero(), mu = Vector3::Zero();  // ∂U/∂r, ∂U/∂ψ
  Matrix6 H = Matrix6::Zero();
};

/// ε with its derivatives, and the coefficients of U.
struct Strain {
  double epsilon;
  Vector3 by_r, by_psi;  // the second by ψ is diag(0, 1, 1)/12
  Matrix3 by_rr;
  Vector3 across;                 // of r_y², r_z² in ε, times two
  Vector3 stiffness, twist_bend;  // of r², ψ² in U, times two

  Strain(const BeamRigidity& k, double L, const Vector3& r, const Vector3& psi, double stretch, double strain) {
    const double l = r.norm(), phi_z = shear_number(k.EIz, k.GAs_y, L), phi_y = shear_number(k.EIy, k.GAs_z, L);
    across = Vector3(0, 1 / ((1 + phi_z) * (1 + phi_z)), 1 / ((1 + phi_y) * (1 + phi_y))) / (5 * L * L);
    stiffness = Vector3(0, 12 * k.EIz / (1 + phi_z), 12 * k.EIy / (1 + phi_y)) / (L * L * L);
    twist_bend = Vector3(k.GJ, k.EIy, k.EIz) / L;
    by_psi = Vector3(0, psi.y(), psi.z()) / 12;
    by_r = r / (l * L) + across.cwiseProduct(r);
    by_rr = (Matrix3::Identity() - r * r.transpose() / (l * l)) / (l * L);
    by_rr.diagonal() += across;
    epsilon = stretch / L + by_psi.dot(psi) / 2 + across.dot(r.cwiseAbs2()) / 2 - strain;
  }
};

/// N L times the second derivative of ε.
Matrix6 stressed(const Strain& s, double L, double N) {
  Matrix6 H = Matrix6::Zero();
  H.topLeftCorner<3, 3>() = N * L * s.by_rr;
  H.bottomRightCorner<3, 3>().diagonal() = N * L / 12 * Vector3(0, 1, 1);
  return H;
}

/// r* and ψ* of the header as one vector e with its derivatives by [r; ψ]; the first of r* is not used.
struct Shape {
  Vector6 e, stiffness, stretch;  // the last: ε by [r; ψ]
  Matrix6 by = Matrix6::Identity(), stretch_bends;
  Vector3 slope, across;  // of the sections, by r_y and r_z; r
  double helix;

  Shape(const Strain& s, double L, const Vector3& r, const Vector3& psi)
      : stretch_bends(stressed(s, L, 1 / L)), across(r), helix(L / 24) {
    stiffness << s.stiffness, s.twist_bend;
    stretch << s.by_r, s.by_psi;
    slope = (5 * L * L * s.across).cwiseSqrt() / L;
    const Vector3 a = slope.cwiseProduct(r), b = slope.cwiseProduct(psi);
    const double shorter = 1 - s.epsilon;
    e << 0, r.y() * shorter - helix * psi.x() * psi.y(), r.z() * shorter - helix * psi.x() * psi.z(),
        psi.x() + a.dot(psi), psi.y() - a.y() * psi.x(), psi.z() - a.z() * psi.x();
    by.row(0).setZero();
    by.row(1) << 0, shorter, 0, -helix * psi.y(), -helix * psi.x(), 0;
    by.row(2) << 0, 0, shorter, -helix * psi.z(), 0, -helix * psi.x();
    for (const int k : {1, 2}) by.row(k) -= r(k) * stretch.transpose();
    by.row(3) << 0, b.y(), b.z(), 1, a.y(), a.z();
    by.row(4) << 0, -slope.y() * psi.x(), 0, -a.y(), 1, 0;
    by.row(5) << 0, 0, -slope.z() * psi.x(), -a.z(), 0, 1;
  }

  /// Σ f_i ∂²e_i.
  Matrix6 curved(const Vector6& f) const {
    Matrix6 H = Matrix6::Zero();
    const auto add = [&](int i, int j, double x) { H(i, j) += x, H(j, i) += x; };
    for (const int k : {1, 2}) {  // y, z
      add(3, 3 + k, -helix * f(k));
      add(k, 3 + k, slope(k) * f(3));
      add(k, 3, -slope(k) * f(3 + k));
      H.row(k) -= f(k) * stretch.transpose();
      H.col(k) -= f(k) * stretch;
      H -= f(k) * across(k) * stretch_bends;
    }
    return H;
  }
};

/// U's second derivative: what the rigidities give, and what the axial force N gives.
Matrix6 elastic(const Strain& s, const Shape& shape, double EA, double L) {
  Vector6 by;
  by << s.by_r, s.by_psi;
  return EA * L * by * by.transpose() + shape.by.transpose() * shape.stiffness.asDiagonal() * shape.by;
}

/// `stretch`: l − L, which the caller knows to more digits than the difference of lengths.
Potential potential(const BeamRigidity& k, double L, const Vector3& r, const Vector3& psi, double stretch,
                    double strain) {
  const Strain s(k, L, r, psi, stretch, strain);
  const Shape shape(s, L, r, psi);
  const Vector6 f = shape.stiffness.cwiseProduct(shape.e), by = shape.by.transpose() * f;
  Potential p;
  p.N = k.EA * s.epsilon;
  p.rho = p.N * L * s.by_r + by.head<3>();
  p.mu = p.N * L * s.by_psi + by.tail<3>();
  p.H = elastic(s, shape, k.EA, L) + stressed(s, L, p.N) + shape.curved(f);
  p.energy = (k.EA * L * s.epsilon * s.epsilon + f.dot(shape.e)) / 2;
  return p;
}

/// Forces on the ends and their symmetric tangent in the mean axes.
struct Ends {
  Vector12 forces;
  Matrix12 K;
};

Ends ends_of(const Vector3& r, const Vector3& psi, const Potential& p) {
  const RelativeRotation relative(psi);
  const Matrix3 I = Matrix3::Identity(), S = relative.S(), tau = skew(relative.tau());
  // Spin of the mean axes, change of ψ and of r for the motions [δ_a; ω_a; δ_b; ω_b].
  Matrix3x12 spin = Matrix3x12::Zero(), difference = Matrix3x12::Zero(), by_r = Matrix3x12::Zero();
  spin.middleCols<3>(3) = I / 2 + tau;
  spin.middleCols<3>(9) = I / 2 - tau;
  difference.middleCols<3>(3) = -I;
  difference.middleCols<3>(9) = I;
  by_r.middleCols<3>(0) = -I;
  by_r.middleCols<3>(6) = I;
  by_r += skew(r) * spin;
  Matrix6x12 by;
  by << by_r, S * difference;

  Ends out;
  out.forces = by_r.transpose() * p.rho + difference.transpose() * (S * p.mu);
  // The forces change with U's derivatives, with the motions they are conjugate to, and by turning with the mean axes.
  const Matrix3 relative_moment = relative.derivative_of_S(p.mu) - skew(p.rho.cross(r)) * relative.derivative_of_tau();
  Matrix12 K = by.transpose() * p.H * by + spin.transpose() * skew(p.rho) * by_r +
               difference.transpose() * relative_moment * S * difference;
  for (int i = 0; i < 12; i += 3) K.middleRows<3>(i) -= skew(out.forces.segment<3>(i)) * spin;
  out.K = (K + K.transpose()) / 2;
  return out;
}

Matrix12 turned(const Matrix3& R, const Matrix12& K) {
  Matrix12 out;
  for (int j = 0; j < 12; j += 3)
    for (int i = 0; i < 12; i += 3) out.block<3, 3>(i, j) = R * K.block<3, 3>(i, j) * R.transpose();
  return out;
}

}  // namespace

DeformedBeam deformed(const Beam& beam, const BodyMotion& a, const BodyMotion& b, double strain) {
  const double sign = a.Q.coeffs().dot(b.Q.coeffs()) < 0 ? -1 : 1;
  const Eigen::Quaterniond mean = Eigen::Quaterniond(a.Q.coeffs() + sign * b.Q.coeffs()).normalized();
  const Matrix3 M = mean.toRotationMatrix() * beam.R_WM;
  const Vector3 line = beam.length * beam.R_WM.col(0), du = b.u - a.u, now = line + du;
  // The undeformed line, and what is added to it: small displacements keep their digits.
  const Vector3 added = turned_away(mean.conjugate(), line) + mean.conjugate() * du;
  const Vector3 r = Vector3(beam.length, 0, 0) + beam.R_WM.transpose() * added;
  const Vector3 psi = beam.R_WM.transpose() * rotation_vector(a.Q.conjugate() * b.Q);
  const double stretch = (2 * line + du).dot(du) / (now.norm() + beam.length);
  const Potential p = potential(beam.rigidity, beam.length, r, psi, stretch, strain);
  const Ends ends = ends_of(r, psi, p);
  return {turned(M, ends.forces), turned(M, ends.K), a.Q.toRotationMatrix() * beam.R_WM,
          b.Q.toRotationMatrix() * beam.R_WM, p.energy};
}

LeftOut left_out(const Beam& beam, const Vector12& f, const Vector3& axis) {
  std::array<double, 3> k = {beam.rigidity.GJ, beam.rigidity.EIy, beam.rigidity.EIz};
  std::sort(k.begin(), k.end());
  const double L = beam.length, size = std::sqrt(k[0] * k[1]);
  const Vector3 force = f.segment<3>(6);
  const double moment = std::max(f.segment<3>(3).norm(), f.tail<3>().norm());
  const double bent = L * (moment + L * force.norm()) / size, across = L * L * force.cross(axis).norm() / size;
  return {bent * bent / 12, bent * across / 12};
}

Matrix12 geometric_stiffness(const Beam& beam, const Vector12& ends) {
  const Vector3 r(beam.length, 0, 0), none = Vector3::Zero();
  Potential p;
  p.N = (ends(6) - ends(0)) / 2;
  p.rho = (ends.segment<3>(6) - ends.segment<3>(0)) / 2;
  p.mu = (ends.segment<3>(9) - ends.segment<3>(3)) / 2;
  const Strain strain(beam.rigidity, beam.length, r, none, 0, 0);
  Vector6 state;
  state << p.rho, p.mu;
  p.H = stressed(strain, beam.length, p.N) + Shape(strain, beam.length, r, none).curved(state);
  Matrix12 K = ends_of(r, none, p).K;
  // Axial motions count by their mean alone.
  K.row(0) = K.row(6) = (K.row(0) + K.row(6)) / 2;
  K.col(0) = K.col(6) = (K.col(0) + K.col(6)) / 2;
  return turned(beam.R_WM, K);
}

}  // namespace deflect::frame
