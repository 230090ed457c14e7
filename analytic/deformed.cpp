#include "analytic/deformed.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "analytic/flexibility.h"
#include "analytic/rotation_vector.h"

namespace deflect::analytic {
namespace {

std::size_t legs_step(const VirtualChain& whole) {
  return static_cast<std::size_t>(
      std::find_if(whole.steps.begin(), whole.steps.end(),
                   [](const VirtualStep& s) { return std::holds_alternative<VirtualGroup>(s); }) -
      whole.steps.begin());
}

const VirtualGroup& legs_of(const VirtualChain& whole) { return std::get<VirtualGroup>(whole.steps[legs_step(whole)]); }

double largest_wrench(const VirtualGroup& group);

/// On the chain and on all branches within, N.
double largest_wrench(const VirtualChain& chain) {
  double largest = chain.F.head<3>().norm() + chain.F.tail<3>().norm() / chain.length;
  for (const VirtualStep& step : chain.steps)
    if (const auto* group = std::get_if<VirtualGroup>(&step)) largest = std::max(largest, largest_wrench(*group));
  return largest;
}

double largest_wrench(const VirtualGroup& group) {
  double largest = 0;
  for (const VirtualChain& branch : group.branches) largest = std::max(largest, largest_wrench(branch));
  return largest;
}

Vector3 translation(const VirtualChain& whole, const Linearised& l, Geometry geometry) {
  return geometry == Geometry::finite ? l.end.displacement(whole.p_E) : Vector3(l.J.topRows<3>() * l.x);
}

/// What the freedoms that the whole chain has under a known wrench resist with.
struct Tangent {
  Tangent(const Linearised& l, const Vector3& moment) : J(l.J * l.Z), A(l.Z.transpose() * (l.K - l.H) * l.Z) {
    const MatrixX spins = J.bottomRows<3>();
    A -= 0.5 * spins.transpose() * skew(moment) * spins;
  }

  MatrixX solve(const MatrixX& right) const { return A.size() == 0 ? right : MatrixX(A.partialPivLu().solve(right)); }
  /// Without moment.
  bool positive() const {
    if (A.size() == 0) return true;
    const VectorX s = A.diagonal().cwiseAbs().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
    const MatrixX scaled = s.asDiagonal() * A * s.asDiagonal();
    return Eigen::SelfAdjointEigenSolver<MatrixX>(scaled, Eigen::EigenvaluesOnly).eigenvalues()(0) > 1e-13;
  }

  MatrixX J, A;
};

/// Newton's method in finite motions needs the stiffness by spins of a dead moment; second order solves by K_E + K_G.
Vector3 turning_moment(const Deformed& d) {
  return d.outlook.geometry == Geometry::finite ? Vector3(d.whole.F.tail<3>()) : Vector3::Zero();
}

/// Newton's method under the wrench F and a share of the misfits.
bool equilibrium(Deformed& d, const Vector6& F, double misfit) {
  Outlook& c = d.outlook;
  VirtualChain& whole = d.whole;
  whole.F = F;
  c.misfit = misfit;
  double largest = largest_wrench(whole), previous = 1;
  // Contacts have no stiffness at rest: where nothing is strained yet they are taken as under the whole load.
  const bool at_rest = largest_wrench(std::get<VirtualGroup>(whole.steps[legs_step(whole)])) == 0;
  c.least = !at_rest ? 1e-9 * largest : largest > 0 ? largest : 1;
  for (int i = 0; i < 50; ++i) {
    ++d.iterations;
    const Linearised l = whole.linearise(c);
    const Tangent tangent(l, turning_moment(d));
    const MatrixX difference = l.K - l.H;
    const VectorX delta =
        l.offset + l.Z * tangent.solve(l.Z.transpose() * (l.J.transpose() * F - l.s - difference * l.offset));
    if (!delta.allFinite()) return false;
    const Progress progress = whole.advance(l, delta, c);
    largest = largest_wrench(whole);
    if (!std::isfinite(progress.step + largest)) return false;
    c.least = 1e-9 * (largest > 0 ? largest : 1);
    // Shapes are known to rounding, 1e-16 of their size, at best.
    d.residual = progress.step / (progress.reach + 1e-3 * whole.length);
    if (d.residual <= 1e-12 || (d.residual <= 1e-9 && d.residual > 0.3 * previous)) return true;
    previous = d.residual;
  }
  return false;
}

/// Reads off the state what is asked of it; false where it is not stable.
bool conclude(Deformed& d) {
  Outlook asked = d.outlook;
  asked.judged = true;
  const Linearised l = d.whole.linearise(asked);
  const Geometry geometry = d.outlook.geometry;
  d.translation = translation(d.whole, l, geometry);
  d.turning = l.end.D;
  d.rotation_vector = geometry == Geometry::finite ? rotation_vector(l.end.D) : Vector3(l.J.bottomRows<3>() * l.x);
  const Matrix6 axes = rotate_twist(d.whole.axes_before(legs_step(d.whole), geometry));
  d.leg_wrenches.clear();
  for (const VirtualChain& leg : legs_of(d.whole).branches) d.leg_wrenches.push_back(axes * leg.F);
  return l.stable && Tangent(l, Vector3::Zero()).positive();
}

bool all_fit(const std::vector<PlacedLeg>& legs) {
  return std::all_of(legs.begin(), legs.end(), [](const PlacedLeg& leg) {
    return leg.misfit.isZero(0) && std::all_of(leg.parts.begin(), leg.parts.end(), [](const PlacedPart& part) {
             const auto* group = std::get_if<PlacedParallel>(&part);
             return !group || all_fit(group->branches);
           });
  });
}

/// From the state as it is to all of the misfits under F, where F is given to a state that has them already.
void approach(Deformed& d, const Vector6& F, bool fitting) {
  d.load_factor = 0;
  bool unstable = false;
  for (double step = 1; d.load_factor < 1;) {
    Deformed next = d;
    const double factor = std::min(1.0, d.load_factor + step);
    next.converged = equilibrium(next, fitting ? Vector6::Zero() : Vector6(factor * F), fitting ? factor : 1);
    const bool stable = next.converged && conclude(next);
    if (stable) {
      d = std::move(next);
      d.load_factor = factor;
      continue;
    }
    unstable = next.converged || unstable;
    d.iterations = next.iterations;
    d.residual = next.residual;
    step /= 2;
    if (step > 1e-4) continue;
    d.converged = false;
    d.message =
        fmt::format("{}: the last {} that was found carries {:.4g} of the {}",
                    unstable ? "beyond the first buckling load" : "Newton's method does not converge",
                    unstable ? "stable equilibrium" : "equilibrium", d.load_factor, fitting ? "misfits" : "load");
    return;
  }
}

}  // namespace

Deformed deform(const Configuration& c, Geometry geometry, const Vector6& F) {
  Deformed d;
  const PlacedParallel legs{"legs", Vector3::Zero(), c.pose.p_WT, c.legs};
  d.whole = virtual_chain_of({"the mechanism", {c.base, legs, c.tool}}, c.pose.p_WT, c.pose.p_WT, c.size);
  d.outlook.geometry = geometry;
  d.leg_wrenches.assign(c.legs.size(), Vector6::Zero());
  const bool fits = all_fit(c.legs);
  if (!fits || F.isZero(0)) approach(d, F, true);
  if ((fits || d.converged) && !F.isZero(0)) approach(d, F, false);
  return d;
}

Matrix6 stiffness(const Deformed& d) {
  VirtualChain whole = d.whole;
  const Tangent tangent(whole.linearise(d.outlook), d.whole.F.tail<3>());
  if (tangent.J.cols() == 6) {  // as when base and tool are rigid: no digits are lost by inverting twice
    const Eigen::FullPivLU<Matrix6> lu(tangent.J.transpose());
    if (lu.isInvertible()) {
      const Matrix6 half = lu.solve(tangent.A);
      return lu.solve(half.transpose()).transpose();
    }
  }
  const Matrix6 C = tangent.J * tangent.solve(tangent.J.transpose());
  return stiffness(
      Flexibility{C, Matrix6X(6, 0), false, Matrix6X(6, 0), carried_wrenches(Matrix6X(6, 0), whole.length)},
      whole.length, whole.name);
}

Matrix6 compliance(const Deformed& d) {
  VirtualChain whole = d.whole;
  const Tangent tangent(whole.linearise(d.outlook), d.whole.F.tail<3>());
  return tangent.J * tangent.solve(tangent.J.transpose());
}

Matrix6 leg_stiffness(const Deformed& d, std::size_t leg) {
  VirtualChain whole = d.whole;
  whole.linearise(d.outlook);
  const Matrix6 axes = rotate_twist(d.whole.axes_before(legs_step(d.whole), d.outlook.geometry));
  return axes * legs_of(whole).branches[leg].restraint().K * axes.transpose();
}

}  // namespace deflect::analytic
