#include "analytic/beam_column.h"

#include <array>
#include <cmath>

#include "analytic/rotation_vector.h"

namespace deflect::analytic {
namespace {

/// A quantity with its first two derivatives by N.
struct Jet {
  double v, d = 0, dd = 0;

  friend Jet operator+(Jet a, Jet b) { return {a.v + b.v, a.d + b.d, a.dd + b.dd}; }
  friend Jet operator-(Jet a, Jet b) { return {a.v - b.v, a.d - b.d, a.dd - b.dd}; }
  friend Jet operator*(Jet a, Jet b) {
    return {a.v * b.v, a.d * b.v + a.v * b.d, a.dd * b.v + 2 * a.d * b.d + a.v * b.dd};
  }
  friend Jet operator/(Jet a, Jet b) {
    const double v = a.v / b.v, d = (a.d - v * b.d) / b.v;
    return {v, d, (a.dd - 2 * d * b.d - v * b.dd) / b.v};
  }
};

constexpr std::size_t functions = 9;
using Functions = std::array<double, functions>;

/// φ_0 … φ_8 at z, times a common factor that keeps them finite.
Functions phi(double z) {
  Functions f{};
  if (std::abs(z) < 60) {  // the highest two by series, the others by φ_n = 1/n! + z φ_{n+2}
    constexpr Functions factorial = {1, 1, 2, 6, 24, 120, 720, 5040, 40320};
    for (const std::size_t n : {functions - 2, functions - 1}) {
      double term = 1 / factorial[n];
      for (int k = 1; k < 40; ++k) {
        f[n] += term;
        const double m = 2.0 * k + static_cast<double>(n);
        term *= z / (m * (m - 1));
      }
    }
    for (std::size_t n = functions - 2; n-- > 0;) f[n] = 1 / factorial[n] + z * f[n + 2];
    return f;
  }
  const double s = std::sqrt(std::abs(z)), small = z > 0 ? std::exp(-s) : 1;
  f[0] = z > 0 ? (1 + small * small) / 2 : std::cos(s);
  f[1] = (z > 0 ? (1 - small * small) / 2 : std::sin(s)) / s;
  double inverse_factorial = small;
  for (std::size_t n = 0; n + 2 < functions; ++n) {
    f[n + 2] = (f[n] - inverse_factorial) / z;
    inverse_factorial /= static_cast<double>(n + 1);
  }
  return f;
}

/// φ_n(z) as a function of N: φ_n' = ½ (φ_{n+1} − n φ_{n+2}).
Jet jet(const Functions& f, std::size_t n, Jet z) {
  const auto slope = [&](std::size_t i) { return (f[i + 1] - static_cast<double>(i) * f[i + 2]) / 2; };
  const double d = slope(n), dd = (slope(n + 1) - static_cast<double>(n) * slope(n + 2)) / 2;
  return {f[n], d * z.d, dd * z.d * z.d + d * z.dd};
}

/// Torsion ½ k e² of what twist is left, e = φx − e0 with e0 = α Fy My + β Fz Mz + γ Fy Fz of the forces K0 x that the
/// linear theory sees: ∇ and second derivative by [u; φ].
TipLaw torsion_of_bent(const PlacedMember& m, const Matrix6& K0, const Vector6& x) {
  const double L = m.length(), EIy = m.E * m.section.Iy, EIz = m.E * m.section.Iz, GJ = m.G * m.section.J;
  const double cubed = L * L * L, both = cubed / (12 * EIy * EIz);
  const double alpha = cubed / (6 * GJ) * (1 / EIy + 0.5 / EIz) - both;
  const double beta = cubed / (6 * GJ) * (1 / EIz + 0.5 / EIy) - both;
  const double gamma = (1 / EIz - 1 / EIy) * cubed * L / (12 * GJ);
  const Vector6 f = K0 * x;  // –, Fy, Fz, –, My, Mz
  Vector6 by_forces;
  by_forces << 0, alpha * f(4) + gamma * f(2), beta * f(5) + gamma * f(1), 0, alpha * f(1), beta * f(2);
  Matrix6 second = Matrix6::Zero();
  second(1, 4) = second(4, 1) = alpha;
  second(2, 5) = second(5, 2) = beta;
  second(1, 2) = second(2, 1) = gamma;
  const double e = x(3) - f.dot(by_forces) / 2, T = GJ / L * e;
  const Vector6 gradient = Vector6::Unit(3) - K0 * by_forces;
  return {T * gradient, GJ / L * gradient * gradient.transpose() - T * K0 * second * K0, T * e / 2};
}

/// The stiffness that the tip forces K0 x of the state add by the second-order motion of the tip that they do work on.
Matrix6 stiffness_of_twisted_bending(const PlacedMember& m, const Matrix6& K0, const Vector6& x) {
  const double L = m.length(), a = 1 / (m.G * m.section.J), b = 1 / (m.E * m.section.Iy), c = 1 / (m.E * m.section.Iz);
  const Vector6 f = L * L * L / 12 * K0 * x;  // –, Fy, Fz, T, My, Mz
  Matrix6 second = Matrix6::Zero();
  second(3, 1) = a * c * (L * f(2) + f(4));
  second(3, 2) = a * b * (f(5) - L * f(1));
  second(3, 4) = 2 * a * b * f(1);
  second(3, 5) = 2 * a * c * f(2);
  second(4, 1) = second(5, 2) = -b * c * f(3);
  return -K0 * (second + second.transpose()) * K0;
}

/// Places a plane's 2×2 among the six: displacement along `v`, rotation along `t` with a sign.
void add(Matrix6& K, const Eigen::Matrix2d& plane, int v, int t, double sign) {
  K(v, v) += plane(0, 0);
  K(v, t) += sign * plane(0, 1);
  K(t, v) += sign * plane(1, 0);
  K(t, t) += plane(1, 1);
}

/// From the rotation vector as coordinate to one added to it.
void count_from_here(TipLaw& law, const Vector3& rotation) {
  const RotationChange change(rotation);
  Matrix6 back = Matrix6::Identity();
  back.bottomRightCorner<3, 3>() = change.J.inverse();
  law.s = back.transpose() * law.s;
  law.K.bottomRightCorner<3, 3>() -= change.curvature(law.s.tail<3>());
  law.K = back.transpose() * law.K * back;
}

}  // namespace

TipBending tip_bending(double L, double EI, double shear, double N, double EA) {
  const Jet force{N, 1, 0}, one{1};
  const Jet beta = shear > 0 ? one / (one + force * Jet{1 / shear}) : one;
  const Jet z = beta * force * Jet{L * L / EI};
  const Functions f = phi(z.v);
  const auto phi_n = [&](std::size_t n) { return jet(f, n, z); };
  const Jet D = phi_n(3) - Jet{2} * phi_n(4);
  // Of bending alone, then with v = β v_bending + (βL/GA_s) Q.
  Jet vv = Jet{EI / (L * L * L)} * phi_n(1) / D / (beta * beta), vt = Jet{-EI / (L * L)} * phi_n(2) / D / beta;
  Jet tt = Jet{EI / L} * (phi_n(2) - phi_n(3)) / D;
  if (shear > 0) {
    const Jet g = beta * Jet{L / shear}, share = one / (one + g * vv);
    tt = tt - g * share * vt * vt;
    vt = vt * share;
    vv = vv * share;
  }
  if (EA > 0) {
    const Jet longer = one + force * Jet{1 / EA};
    vv = vv / (longer * longer);
    vt = vt / longer;
  }
  TipBending out;
  out.K << vv.v, vt.v, vt.v, tt.v;
  out.dK << vv.d, vt.d, vt.d, tt.d;
  out.ddK << vv.dd, vt.dd, vt.dd, tt.dd;
  out.stable = z.v > -4 * pi * pi;
  return out;
}

TipLaw tip_law(const PlacedMember& m, const Vector6& x, double N, Geometry geometry) {
  const double L = m.length(), EIy = m.E * m.section.Iy, EIz = m.E * m.section.Iz;
  const bool shear = m.beam == BeamTheory::timoshenko;
  const double GAy = shear ? m.G * m.section.As_y : 0, GAz = shear ? m.G * m.section.As_z : 0;
  const auto six = [&](const Eigen::Matrix2d& xy, const Eigen::Matrix2d& xz) {
    Matrix6 K = Matrix6::Zero();
    add(K, xy, 1, 5, 1);
    add(K, xz, 2, 4, -1);
    return K;
  };
  const double EA = m.E * m.section.A, lever = geometry == Geometry::finite ? EA : 0;
  const TipBending y = tip_bending(L, EIz, GAy, N, lever), z = tip_bending(L, EIy, GAz, N, lever);
  const Matrix6 bending = six(y.K, z.K), by_N = six(y.dK, z.dK);
  TipLaw law;
  law.stable = y.stable && z.stable;
  law.K = bending;
  law.s = law.K * x;
  law.energy = N * N * L / (2 * EA) + 0.5 * x.dot(law.s) - 0.5 * N * x.dot(by_N * x);
  // u = u(N, p) linearised in N: a is what stretches the axis.
  Vector6 a = Vector6::Unit(0);
  double compliance = L / EA, excess = x(0) - N * compliance;
  if (geometry == Geometry::finite) {
    a += by_N * x;
    compliance -= 0.5 * x.dot(six(y.ddK, z.ddK) * x);
    excess += 0.5 * x.dot(by_N * x);
  }
  law.s += a * (excess / compliance);
  law.s(0) += N;
  law.K += a * a.transpose() / compliance;
  Matrix6 linear = six(tip_bending(L, EIz, GAy, 0).K, tip_bending(L, EIy, GAz, 0).K);
  if (geometry != Geometry::finite) {
    linear(3, 3) = m.G * m.section.J / L;
    Matrix6 twisted = stiffness_of_twisted_bending(m, linear, x);
    twisted(3, 3) += linear(3, 3);
    law.s += twisted * x;
    law.K += twisted;
    law.energy += linear(3, 3) * x(3) * x(3) / 2;
    return law;
  }
  const TipLaw torsion = torsion_of_bent(m, linear, x);
  law.s += torsion.s;
  law.K += torsion.K;
  law.energy += torsion.energy;
  count_from_here(law, x.tail<3>());
  return law;
}

}  // namespace deflect::analytic
