#include "validation/theories/agreement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "msa/base/error.h"

namespace deflect {
namespace {

constexpr double linear_bound = 1e-9, contact_bound = 1e-7;

Vector6 in_metres(const Vector6& d, double length) {
  Vector6 out = d;
  out.tail<3>() *= length;
  return out;
}

Matrix6 per_metre(const Matrix6& K, double length) {
  Vector6 weight = Vector6::Ones();
  weight.tail<3>().setConstant(1 / length);
  return weight.asDiagonal() * K * weight.asDiagonal();
}

/// |a − b| against |b|, or against |a| where b vanishes.
double relative(double apart, double size_a, double size_b) {
  const double size = size_b > 0 ? size_b : size_a;
  return apart > 0 ? apart / size : 0;
}

/// Of the ends of two plays, in metres.
double ends_apart(const Vector6& a, const Vector6& b, double size) {
  double apart = 0;
  for (int i = 0; i < 6; ++i) {
    if (std::isinf(a(i)) && a(i) == b(i)) continue;
    const double here = std::abs(a(i) - b(i));
    if (std::isfinite(b(i))) size = std::max(size, std::abs(b(i)));
    apart = std::max(apart, here);
  }
  return relative(apart, size, size);
}

}  // namespace

double Difference::largest() const { return std::max({displacement, stiffness, play}); }

Difference difference(const Answer& a, const Answer& b, double length) {
  const Vector6 d_a = in_metres(a.displacement, length), d_b = in_metres(b.displacement, length);
  const Matrix6 K_a = per_metre(a.stiffness, length), K_b = per_metre(b.stiffness, length);
  const auto ends = [&](const Vector6& in_a, const Vector6& in_b) {
    return ends_apart(in_metres(in_a, length), in_metres(in_b, length), d_b.norm());
  };
  // Where some motions are held rigidly the load may move nothing: what is left is the rounding of coordinates.
  const bool held = b.rigid > 0 && std::max(d_a.norm(), d_b.norm()) < std::numeric_limits<double>::epsilon() * length;
  return {held ? 0 : relative((d_a - d_b).norm(), d_a.norm(), d_b.norm()),
          relative((K_a - K_b).cwiseAbs().maxCoeff(), K_a.cwiseAbs().maxCoeff(), K_b.cwiseAbs().maxCoeff()),
          std::max(ends(a.floating.least, b.floating.least), ends(a.floating.most, b.floating.most))};
}

double agreement_bound(bool linear, double rounding) {
  return bound_with(linear ? linear_bound : contact_bound, rounding);
}

void require_agreement(const Answer& analytic, const Answer& msa, double length, double bound,
                       const std::string& where) {
  if (analytic.rigid != msa.rigid)
    throw NumericalError(
        fmt::format("{}: the two theories disagree: {} motions have an infinite stiffness in closed form, {} by MSA. "
                    "One of the two is wrong here: no answer is given",
                    where, analytic.rigid, msa.rigid));
  const Difference apart = difference(analytic, msa, length);
  if (apart.largest() <= bound) return;
  const auto words = [](const Vector6& SI) {
    const Vector6 d = twist_in_mm(SI);
    return fmt::format("({:.6g}, {:.6g}, {:.6g}) mm, ({:.6g}, {:.6g}, {:.6g}) rad", d(0), d(1), d(2), d(3), d(4), d(5));
  };
  throw NumericalError(
      fmt::format("{}: the two theories disagree: displacements differ by {:.1e}, stiffnesses by {:.1e}{}, bound "
                  "{:.0e}. Closed form "
                  "{}; MSA {}. One of the two is wrong here: no answer is given",
                  where, apart.displacement, apart.stiffness,
                  apart.play > 0 ? fmt::format(", free play by {:.1e}", apart.play) : "", bound,
                  words(analytic.displacement), words(msa.displacement)));
}

}  // namespace deflect
