#include "validation/scene/scene_numbers.h"

#include <fmt/format.h>

#include <cmath>

#include "validation/report/text.h"

namespace deflect::scene {
namespace {

/// "500 N", "20 kN": the larger unit is a thousand times the other.
std::string in_unit(double value, const char* unit, const char* larger) {
  return value < 1e4 ? fmt::format("{:.4g} {}", value, unit) : fmt::format("{:.4g} {}", value / 1000, larger);
}

}  // namespace

double scene_digits(double x) {
  if (x == 0) return 0;
  const double step = std::pow(10, std::floor(std::log10(std::abs(x))) - 6);
  return std::round(x / step) * step;
}

Json scene_position(const Vector3& p) {
  const auto rounded = [](double x) { return std::round(report::mm * x / 1e-4) * 1e-4; };
  return {rounded(p.x()), rounded(p.y()), rounded(p.z())};
}

Json scene_displacement(const Vector3& u) {
  return {scene_digits(report::mm * u.x()), scene_digits(report::mm * u.y()), scene_digits(report::mm * u.z())};
}

void put_outline(Json& body, const figures::SectionOutline& o, const SectionProperties& p) {
  const bool shaped = o.size_y > 0 && o.size_z > 0;
  const double y = shaped ? o.size_y : 4 * std::sqrt(p.Iz / p.A), z = shaped ? o.size_z : 4 * std::sqrt(p.Iy / p.A);
  body["size_mm"] = {scene_digits(report::mm * y), scene_digits(report::mm * z)};
  body["round"] = !shaped || o.round;
}

void put_load_arrows(Json& arrows, int point, const Vector6& load) {
  const auto put = [&](const char* kind, const Vector3& v, const std::string& words) {
    if (v.norm() > 0)
      arrows.push_back({{"point", point},
                        {"kind", kind},
                        {"vector", {scene_digits(v.x()), scene_digits(v.y()), scene_digits(v.z())}},
                        {"words", words}});
  };
  const Vector3 force = load.head<3>(), moment = load.tail<3>();
  put("force", force, in_unit(force.norm(), "N", "kN"));
  put("moment", moment, in_unit(report::mm * moment.norm(), "Nmm", "Nm"));
}

}  // namespace deflect::scene
