#include "msa/base/motion_text.h"

#include <fmt/format.h>

#include <cmath>

namespace deflect {
namespace {

std::string triple(const Vector3& v, double scale) {
  const auto rounded = [&](int i) { return std::abs(v(i)) < 1e-9 * scale ? 0.0 : v(i); };
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", rounded(0), rounded(1), rounded(2));
}

}  // namespace

std::string motion_text(const Vector6& d, double length) {
  const Vector3 v = d.head<3>(), w = d.tail<3>();
  if (w.norm() * length < 1e-6 * v.norm()) return "translation along " + triple(v.normalized(), 1);
  const Vector3 axis = w.normalized(), through = 1e3 * w.cross(v) / w.squaredNorm();
  const double pitch = 1e3 * axis.dot(v) / w.norm();
  std::string text = "rotation about " + triple(axis, 1);
  text += through.norm() < 1e-6 * 1e3 * length ? " through T"
                                               : fmt::format(" through T + {} mm", triple(through, 1e3 * length));
  if (std::abs(pitch) > 1e-6 * 1e3 * length) text += fmt::format(", advancing {:.4g} mm per rad", pitch);
  return text;
}

}  // namespace deflect
