#include "msa/mechanism/six_psu.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"

namespace deflect {
namespace {

constexpr double third = 2 * pi / 3;

Vector3 on_circle(double radius, double angle) { return {radius * std::cos(angle), radius * std::sin(angle), 0}; }

double side(int leg) { return leg % 2 == 1 ? 1 : -1; }
double pair_angle(int leg) { return third * ((leg - 1) / 2); }

/// Sum of what is noted for the leg.
template <class T>
T deviation(const SixPsu& k, int leg, T LegDeviation::*what, T sum) {
  for (const LegDeviation& d : k.deviations)
    if (d.leg == leg) sum += d.*what;
  return sum;
}

Vector3 base_joint(const SixPsu& k, int leg) {
  return deviation(k, leg, &LegDeviation::base_joint,
                   on_circle(k.base_radius, pair_angle(leg) + side(leg) * k.base_angle / 2));
}

Vector3 platform_joint(const SixPsu& k, int leg) {
  return deviation(k, leg, &LegDeviation::platform_joint,
                   on_circle(k.platform_radius, pair_angle(leg) + side(leg) * (third / 2 - k.platform_angle / 2)));
}

double link_length(const SixPsu& k, int leg) { return deviation(k, leg, &LegDeviation::link_length, k.link_length); }

}  // namespace

SixPsuDrawing drawing_of(const SixPsu& k, int leg) {
  return {leg, base_joint(k, leg), platform_joint(k, leg), on_circle(1, pair_angle(leg) + side(leg) * k.base_angle / 2),
          link_length(k, leg)};
}

SixPsuLeg leg_at(const SixPsu& k, const SixPsuDrawing& drawn, const Pose& pose) {
  SixPsuLeg g;
  g.p_WA = drawn.p_WA;
  g.p_WC = pose.p_WT + pose.R_WT * drawn.p_TC;
  g.radial = drawn.radial;
  const Vector3 d = g.p_WC - g.p_WA;
  const double beside = std::hypot(d.x(), d.y()), L2 = drawn.link_length;
  if (!(beside <= L2))
    throw ModelError(fmt::format("leg {}: the link does not reach: its platform joint is {:.6g} mm beside the "
                                 "guideway, the link is {:.6g} mm "
                                 "long",
                                 drawn.leg, 1e3 * beside, 1e3 * L2),
                     {"the link does not reach", drawn.leg});
  g.slider = d.z() - std::sqrt(L2 * L2 - beside * beside);
  if (g.slider < k.slider_min || g.slider > k.slider_max)
    throw ModelError(
        fmt::format("leg {}: the slider would stand at {:.6g} mm, outside its range of {:.6g} to {:.6g} mm", drawn.leg,
                    1e3 * g.slider, 1e3 * k.slider_min, 1e3 * k.slider_max),
        {"the slider would stand at … mm, outside its range of … to … mm", drawn.leg});
  g.p_WB = g.p_WA + g.slider * Vector3::UnitZ();
  return g;
}

SixPsuLeg leg_at(const SixPsu& k, int leg, const Pose& pose) { return leg_at(k, drawing_of(k, leg), pose); }

Pose centred_pose(const SixPsu& measured, double slider) {
  SixPsu k = measured;
  k.deviations.clear();
  const double beside = (platform_joint(k, 1) - base_joint(k, 1)).norm();
  if (!(beside <= k.link_length))
    throw ModelError(
        fmt::format("the links do not reach from the base circle to the platform circle: {:.6g} mm are "
                    "to be bridged by {:.6g} mm",
                    1e3 * beside, 1e3 * k.link_length));
  Pose pose;
  pose.p_WT.z() = slider + std::sqrt(k.link_length * k.link_length - beside * beside);
  return pose;
}

ForwardKinematics forward_kinematics(const SixPsu& k, const std::array<double, 6>& sliders, const Pose& start) {
  ForwardKinematics result{start};
  for (result.iterations = 0; result.iterations < 50; ++result.iterations) {
    // Closure r_i = (|BC|² − L²)/2L, in metres near the solution; its row is [nᵀ, ((C − T) × n)ᵀ] with n = BC/L.
    Vector6 r;
    Matrix6 J;
    result.closure_error = 0;
    for (int i = 0; i < 6; ++i) {
      const double L = link_length(k, i + 1);
      const Vector3 c = result.pose.R_WT * platform_joint(k, i + 1);
      const Vector3 b = base_joint(k, i + 1) + nth(sliders, i) * Vector3::UnitZ();
      const Vector3 link = result.pose.p_WT + c - b;
      r(i) = (link.squaredNorm() - L * L) / (2 * L);
      J.row(i) << link.transpose() / L, c.cross(link).transpose() / L;
      result.closure_error = std::max(result.closure_error, std::abs(link.norm() - L));
    }
    if (result.closure_error < 1e-15) break;
    const Eigen::FullPivLU<Matrix6> lu(J);
    if (!lu.isInvertible()) return result;
    const Vector6 step = lu.solve(-r);
    if (!step.allFinite() || step.head<3>().norm() > 10 * k.link_length) return result;
    result.pose.p_WT += step.head<3>();
    result.pose.R_WT = rotation_from_vector(step.tail<3>()) * result.pose.R_WT;
    if (step.head<3>().norm() < 1e-16 && step.tail<3>().norm() < 1e-15) break;
  }
  result.converged = result.closure_error < 1e-12;
  return result;
}

}  // namespace deflect
