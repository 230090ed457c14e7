// Mistakes of recording, planted into measurements.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "validation/measurement/measurements.h"

namespace deflect::test {

using measurement::Measurements;
using measurement::PoseGroup;
using measurement::Reading;

struct Planted {
  std::string id;  ///< by which it must be named
  std::function<void(Measurements&)> plant;
};

/// What the file has instead of each reading's numbers.
inline std::function<void(Measurements&)> in_readings(std::function<void(Reading&)> change) {
  return [change](Measurements& data) {
    for (Reading& r : data.readings) change(r);
  };
}

inline std::function<void(Measurements&)> in_poses(std::function<void(Vector6&)> change) {
  return [change](Measurements& data) {
    for (PoseGroup& group : data.poses) change(group.pose_mm_deg);
  };
}

/// Displacements k from … to − 1 and loads times a factor.
inline std::function<void(Measurements&)> displacements_times(std::size_t from, std::size_t to, double factor,
                                                              bool sigma_too = true) {
  return in_readings([=](Reading& r) {
    for (std::size_t k = from; k < to; ++k)
      if (r.displacement[k]) *r.displacement[k] *= factor;
    auto& sigma = from < 3 ? r.sigma_u : r.sigma_th;
    if (sigma_too && sigma) *sigma *= std::abs(factor);
  });
}

inline std::function<void(Measurements&)> loads_times(double force, double moment) {
  return in_readings([=](Reading& r) {
    r.load.head<3>() *= force;
    r.load.tail<3>() *= moment;
  });
}

inline std::vector<Planted> planted_mistakes() {
  constexpr double g = 9.80665, lbf = 4.4482216152605;
  std::vector<Planted> out = {
      {"displacement_in_m", displacements_times(0, 3, 1e-3)},
      {"displacement_in_um", displacements_times(0, 3, 1e3)},
      {"displacement_in_um", displacements_times(0, 3, 1e3, false)},
      {"displacement_in_inch", displacements_times(0, 3, 1 / 25.4)},
      {"displacement_in_inch", displacements_times(0, 3, 1 / 25.4, false)},
      {"rotation_in_deg", displacements_times(3, 6, 180 / pi)},
      {"rotation_in_mrad", displacements_times(3, 6, 1e3)},
      {"translation_axes_mx_my_mz", displacements_times(0, 3, -1)},
      {"displacement_axes_mx_my_mz", displacements_times(0, 6, -1)},
      {"translation_axes_x_my_z", displacements_times(1, 2, -1)},
      {"translation_axes_x_y_mz", displacements_times(2, 3, -1)},
      {"rotation_axes_mx_my_mz", displacements_times(3, 6, -1)},
      {"translation_axes_y_x_z", in_readings([](Reading& r) { std::swap(r.displacement[0], r.displacement[1]); })},
      {"translation_axes_x_z_y", in_readings([](Reading& r) { std::swap(r.displacement[1], r.displacement[2]); })},
      {"force_axes_y_x_z", in_readings([](Reading& r) { std::swap(r.load(0), r.load(1)); })},
      {"load_axes_y_x_z",
       in_readings([](Reading& r) { std::swap(r.load(0), r.load(1)), std::swap(r.load(3), r.load(4)); })},
      {"force_axes_x_y_mz", in_readings([](Reading& r) { r.load(2) *= -1; })},
      {"force_axes_mx_y_z", in_readings([](Reading& r) { r.load(0) *= -1; })},
      {"load_in_kgf", loads_times(1 / g, 1 / g)},
      {"force_in_kgf", loads_times(1 / g, 1)},
      {"load_times_g", loads_times(g, g)},
      {"load_in_lbf", loads_times(1 / lbf, 1 / lbf)},
      {"load_in_kN", loads_times(1e-3, 1e-3)},
      {"moment_in_Nm", loads_times(1, 1e-3)},
      {"moment_axes_mx_my_mz", loads_times(1, -1)},
      {"moment_axes_x_y_mz", in_readings([](Reading& r) { r.load(5) *= -1; })},
      {"force_elsewhere", in_readings([](Reading& r) {
         r.load.tail<3>() += Vector3(-0.02, 0.01, -0.08).cross(Vector3(r.load.head<3>()));
       })},
      {"pose_x_y_swapped", in_poses([](Vector6& p) { std::swap(p(0), p(1)); })},
      {"pose_x_mirrored", in_poses([](Vector6& p) { p(0) *= -1; })},
      {"pose_y_mirrored", in_poses([](Vector6& p) { p(1) *= -1; })},
      {"angles_in_rad", in_poses([](Vector6& p) { p.tail<3>() *= pi / 180; })},
      {"yaw_in_rad", in_poses([](Vector6& p) { p(5) *= pi / 180; })},
      {"pose_shifted_z", in_poses([](Vector6& p) { p(2) += 10; })},
      {"sigma_unit", in_readings([](Reading& r) {
         if (r.sigma_u) *r.sigma_u *= 1e3;
       })},
      {"nothing_measured", displacements_times(0, 6, 0, false)},
      {"nothing_loaded", loads_times(0, 0)},
      {"zero_column_uz_mm", displacements_times(2, 3, 0, false)},
      {"identical_rows",
       [](Measurements& data) {
         const std::size_t n = data.readings.size();
         for (Reading& r : data.readings) r.sequence.reset();
         for (std::size_t i = 0; i < n; ++i) {
           Reading copy = data.readings[i];
           copy.line += n;
           data.poses[copy.pose].readings.push_back(data.readings.size());
           data.readings.push_back(copy);
         }
       }},
  };
  return out;
}

}  // namespace deflect::test
