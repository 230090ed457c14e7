// Built-in devices, random poses and loads for tests.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "msa/base/error.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/six_psu.h"
#include "tests/support/paths.h"

namespace deflect::test {

inline Mechanism device(const std::string& name) {
  return read_mechanism(test::source_dir() + "/validation/devices/" + name + ".yaml");
}

/// All that are built in, in order.
inline std::vector<std::string> device_names() {
  std::vector<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(test::source_dir() + "/validation/devices"))
    names.push_back(file.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

inline const SixPsu& six_psu(const Mechanism& m) { return std::get<SixPsu>(m.kinematics); }

inline Pose home(const Mechanism& m) { return centred_pose(six_psu(m), m.workspace.nominal_slider); }

inline double uniform(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
}

inline Vector3 random_vector(std::mt19937& random, double size) {
  return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

/// Reachable poses within 25 mm and 8° of home, in a fixed order.
inline std::vector<Pose> random_poses(const Mechanism& m, int count, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::vector<Pose> poses;
  while (static_cast<int>(poses.size()) < count) {
    Pose pose = home(m);
    pose.p_WT += random_vector(random, 0.025);
    const Vector3 a = random_vector(random, 8 * pi / 180);
    pose.R_WT = rotation_from_rpy(a(0), a(1), a(2));
    try {
      configure(m, pose);
      poses.push_back(pose);
    } catch (const ModelError&) {  // out of reach
    }
  }
  return poses;
}

/// 50 N in a random direction with 1 Nm about another.
inline Vector6 random_wrench(std::mt19937& random) {
  Vector6 F;
  F << 50 * random_vector(random, 1).normalized(), random_vector(random, 1).normalized();
  return F;
}

inline Mechanism with(const Mechanism& m, const std::string& path, const std::string& value,
                      Edit::Action action = Edit::Action::set) {
  return edited(m, {path, value, action});
}

}  // namespace deflect::test
