#include "analytic/beam_column.h"

#include <algorithm>
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
      for (int k = 1; k < 40; ++k) {  // |term| falls from the first one on
        if (f[n] + term == f[n]) break;
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

/// α and β of e0.
struct TwistByForces {
  double alpha, beta;

  explicit TwistByForces(const PlacedMember& m) {
    const double L = m.length(), y = m.E * m.section.Iy, z = m.E * m.section.Iz, GJ = m.G * m.section.J;
    alpha = L * L * L / 12 * ((0.5 / y + 1 / z) / GJ - 1 / (y * z));
    beta = L * L * L / 12 * ((0.5 / z + 1 / y) / GJ - 1 / (y * z));
  }
};

/// Torsion ½ k e² of what twist is left, e = φx − e0 with e0 = α Fy My + β Fz Mz of the forces K0 x that the linear
/// theory sees: ∇ and second derivative by [r'; φ].
TipLaw torsion_of_bent(const PlacedMember& m, const Matrix6& K0, const Vector6& x) {
  const TwistByForces by(m);
  const Vector6 f = K0 * x;  // –, Fy, Fz, –, My, Mz
  Vector6 by_forces;
  by_forces << 0, by.alpha * f(4), by.beta * f(5), 0, by.alpha * f(1), by.beta * f(2);
  Matrix6 second = Matrix6::Zero();
  second(1, 4) = second(4, 1) = by.alpha;
  second(2, 5) = second(5, 2) = by.beta;
  const double GJ = m.G * m.section.J, L = m.length(), e = x(3) - f.dot(by_forces) / 2, T = GJ / L * e;
  const Vector6 gradient = Vector6::Unit(3) - K0 * by_forces;
  return {T * gradient, GJ / L * gradient * gradient.transpose() - T * K0 * second * K0, T * e / 2};
}

/// The fourth power of the rotations, U4 = ½ Σ c_k M_i² M_j² over the axes i, j, k = x, y, z in turn.
TipLaw bent_about_two_axes(const PlacedMember& m, const Matrix6& K0, const Vector6& x) {
  const double L = m.length();
  const Vector3 k(m.G * m.section.J, m.E * m.section.Iy, m.E * m.section.Iz), M = k.cwiseProduct(x.tail<3>()) / L;
  const TwistByForces by(m);
  const Vector3 moved(0, K0(2, 2) * by.beta * by.beta,
                      K0(1, 1) * by.alpha * by.alpha);  // by Fz with T Mz, Fy with T My
  TipLaw law{Vector6::Zero(), Matrix6::Zero()};
  for (Eigen::Index a = 0; a < 3; ++a) {
    const Eigen::Index i = (a + 1) % 3, j = (a + 2) % 3;
    const double apart = 1 / k(i) - 1 / k(j), c = moved(a) - L * L * L / 12 * apart * apart / k(a);
    law.energy += c / 2 * M(i) * M(i) * M(j) * M(j);
    law.s(3 + i) += c * M(i) * M(j) * M(j) * k(i) / L;
    law.s(3 + j) += c * M(j) * M(i) * M(i) * k(j) / L;
    law.K(3 + i, 3 + i) += c * M(j) * M(j) * k(i) * k(i) / (L * L);
    law.K(3 + j, 3 + j) += c * M(i) * M(i) * k(j) * k(j) / (L * L);
    const double mixed = 2 * c * M(i) * M(j) * k(i) * k(j) / (L * L);
    law.K(3 + i, 3 + j) += mixed;
    law.K(3 + j, 3 + i) += mixed;
  }
  return law;
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

/// From the coordinates [r'; φ] of the mean axes to [u; φ] of the start's. `r`: from start to tip, start's axes. With
/// the spin χ of the mean axes, r' = e^{−φ/2} e^{−χ} (r + δ), and χ = ½ J d + ⅛ Q(d, d) of rotation_vector.h at φ/2.
void count_from_start(TipLaw& law, const Vector3& r, const Vector3& rotation) {
  const Vector3 half = rotation / 2;
  const RotationChange change(half);
  const Matrix3 R = Matrix3::Identity() + turning(half), spin = change.J / 2;
  const Vector3 f = R * law.s.head<3>(), moment = f.cross(r);
  Matrix6 by = Matrix6::Identity();
  by.topLeftCorner<3, 3>() = R.transpose();
  by.topRightCorner<3, 3>() = R.transpose() * skew(r) * spin;
  law.s = by.transpose() * law.s;
  law.K = by.transpose() * law.K * by;
  const Matrix3 turns = (f * r.transpose() + r * f.transpose()) / 2 - f.dot(r) * Matrix3::Identity();
  law.K.bottomRightCorner<3, 3>() += spin.transpose() * turns * spin + change.curvature(moment) / 4;
  law.K.bottomLeftCorner<3, 3>() += spin.transpose() * skew(f);
  law.K.topRightCorner<3, 3>() = law.K.bottomLeftCorner<3, 3>().transpose();
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

namespace {

/// K of [Q; M] by [v; θ] as it changes with N; shear: GA_s or 0.
struct Plane {
  Jet vv, vt, tt;
  bool stable;

  Plane(double L, double EI, double shear, double N);
};

Plane::Plane(double L, double EI, double shear, double N) : vv{0}, vt{0}, tt{0} {
  const Jet force{N, 1, 0}, one{1};
  const Jet beta = shear > 0 ? one / (one + force * Jet{1 / shear}) : one;
  const Jet z = beta * force * Jet{L * L / EI};
  const Functions f = phi(z.v);
  const auto phi_n = [&](std::size_t n) { return jet(f, n, z); };
  const Jet D = phi_n(3) - Jet{2} * phi_n(4);
  // Of bending alone, then with v = β v_bending + (βL/GA_s) Q.
  vv = Jet{EI / (L * L * L)} * phi_n(1) / D / (beta * beta);
  vt = Jet{-EI / (L * L)} * phi_n(2) / D / beta;
  tt = Jet{EI / L} * (phi_n(2) - phi_n(3)) / D;
  if (shear > 0) {
    const Jet g = beta * Jet{L / shear}, share = one / (one + g * vv);
    tt = tt - g * share * vt * vt;
    vt = vt * share;
    vv = vv * share;
  }
  stable = z.v > -4 * pi * pi;
}

TipBending collected(const Jet& vv, const Jet& vt, const Jet& tt, bool stable) {
  TipBending out;
  out.K << vv.v, vt.v, vt.v, tt.v;
  out.dK << vv.d, vt.d, vt.d, tt.d;
  out.ddK << vv.dd, vt.dd, vt.dd, tt.dd;
  out.stable = stable;
  return out;
}

/// The two planes among the six.
struct Bending {
  Matrix6 K = Matrix6::Zero(), dK = K, ddK = K;
  bool stable = true;

  /// `along`: the displacement's place; `about`: the rotation's, with the sign it has in this plane.
  void add(const TipBending& b, int along, int about, double sign) {
    deflect::analytic::add(K, b.K, along, about, sign);
    deflect::analytic::add(dK, b.dK, along, about, sign);
    deflect::analytic::add(ddK, b.ddK, along, about, sign);
    stable = stable && b.stable;
  }
};

Bending bending_of(const PlacedMember& m, double N, Geometry geometry) {
  const double L = m.length(), EA = m.E * m.section.A;
  const bool shear = m.beam == BeamTheory::timoshenko, finite = geometry == Geometry::finite;
  Bending out;
  for (const bool xy : {true, false}) {
    const double EI = m.E * (xy ? m.section.Iz : m.section.Iy);
    const double GA = shear ? m.G * (xy ? m.section.As_y : m.section.As_z) : 0;
    out.add(finite ? mean_bending(L, EI, GA, N, EA) : tip_bending(L, EI, GA, N), xy ? 1 : 2, xy ? 5 : 4, xy ? 1 : -1);
  }
  return out;
}

/// Bending and stretch under the force N along the x axis that x is counted in; u = u(N, p) linearised in N.
TipLaw bent_and_stretched(const PlacedMember& m, const Bending& bending, const Vector6& x, double N, bool shortens) {
  const double EA = m.E * m.section.A;
  TipLaw law;
  law.stable = bending.stable;
  law.K = bending.K;
  law.s = law.K * x;
  law.energy = N * N * m.length() / (2 * EA) + 0.5 * x.dot(law.s) - 0.5 * N * x.dot(bending.dK * x);
  Vector6 stretches = Vector6::Unit(0);
  double compliance = m.length() / EA, excess = x(0) - N * compliance;
  if (shortens) {
    stretches += bending.dK * x;
    compliance -= 0.5 * x.dot(bending.ddK * x);
    excess += 0.5 * x.dot(bending.dK * x);
  }
  law.s += stretches * (excess / compliance);
  law.s(0) += N;
  law.K += stretches * stretches.transpose() / compliance;
  return law;
}

void add(TipLaw& law, const TipLaw& more) {
  law.s += more.s;
  law.K += more.K;
  law.energy += more.energy;
}

TipLaw second_order_law(const PlacedMember& m, const Vector6& x, double N) {
  TipLaw law = bent_and_stretched(m, bending_of(m, N, Geometry::second_order), x, N, false);
  Matrix6 linear = bending_of(m, 0, Geometry::second_order).K;
  linear(3, 3) = m.G * m.section.J / m.length();
  Matrix6 twisted = stiffness_of_twisted_bending(m, linear, x);
  twisted(3, 3) += linear(3, 3);
  add(law, {twisted * x, twisted, linear(3, 3) * x(3) * x(3) / 2});
  return law;
}

Vector6 seen_by_mean_axes(const PlacedMember& m, Vector6 x) {
  x.head<3>() += turning(-x.tail<3>() / 2) * (x.head<3>() + m.length() * Vector3::UnitX());
  return x;
}

TipLaw finite_law(const PlacedMember& m, const Vector6& x, const Vector3& force) {
  const Vector3 rotation = x.tail<3>(), r = x.head<3>() + m.length() * Vector3::UnitX();
  const Vector6 seen = seen_by_mean_axes(m, x);
  const double N = force.x() + turning(-rotation / 2).row(0).dot(force);
  TipLaw law = bent_and_stretched(m, bending_of(m, N, Geometry::finite), seen, N, true);
  const Matrix6 K0 = bending_of(m, 0, Geometry::finite).K;
  add(law, torsion_of_bent(m, K0, seen));
  add(law, bent_about_two_axes(m, K0, seen));
  count_from_start(law, r, rotation);
  count_from_here(law, rotation);
  return law;
}

}  // namespace

TipBending tip_bending(double L, double EI, double shear, double N) {
  const Plane p(L, EI, shear, N);
  return collected(p.vv, p.vt, p.tt, p.stable);
}

TipBending mean_bending(double L, double EI, double shear, double N, double EA) {
  const Plane p(L, EI, shear, N);
  const Jet longer = Jet{1} + Jet{N, 1, 0} * Jet{1 / EA};
  return collected(p.vv / (longer * longer), Jet{0}, p.tt + Jet{L / 2} * p.vt, p.stable);
}

TipLaw tip_law(const PlacedMember& m, const Vector6& x, const Vector3& force, Geometry geometry) {
  return geometry == Geometry::finite ? finite_law(m, x, force) : second_order_law(m, x, force.x());
}

double left_out(const PlacedMember& m, const Vector6& x, Geometry geometry) {
  const double L = m.length();
  Matrix6 K = bending_of(m, 0, Geometry::finite).K;
  std::array<double, 3> k = {m.G * m.section.J, m.E * m.section.Iy, m.E * m.section.Iz};
  K(3, 3) = k[0] / L;
  const Vector6 F = K * seen_by_mean_axes(m, x);
  std::sort(k.begin(), k.end());
  const double size = std::sqrt(k[0] * k[1]);
  const double bent = L * F.tail<3>().norm() / size, curved = L * L * F.head<3>().norm() / size;
  return (geometry == Geometry::finite ? std::pow(bent, 4) + curved * curved : std::pow(bent + curved / 2, 2)) / 12;
}

}  // namespace deflect::analytic
