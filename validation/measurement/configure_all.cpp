#include "validation/measurement/configure_all.h"

#include <fmt/format.h>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/stand.h"
#include "validation/measurement/measurement_columns.h"

namespace deflect::measurement {
namespace {

void check_joints(const Mechanism& mechanism, const Measurements& m) {
  std::vector<std::string> wanted, given;
  for (const Actuator& actuator : actuators_of(mechanism))
    wanted.push_back(joint_column(wanted.size(), actuator.rotation));
  for (const bool rotates : m.joint_rotates) given.push_back(joint_column(given.size(), rotates));
  if (wanted != given)
    throw InputError(fmt::format("{}:1: joint coordinates {} are given, but {} has {}", m.origin,
                                 fmt::join(given, ", "), mechanism.name, fmt::join(wanted, ", ")));
}

}  // namespace

std::vector<Configuration> configure_all(const Mechanism& mechanism, const Measurements& m,
                                         std::span<const Configuration> known) {
  if (m.by_joints() && known.empty()) check_joints(mechanism, m);
  std::vector<Configuration> configurations;
  configurations.reserve(m.poses.size());
  for (const PoseGroup& group : m.poses) {
    const auto place = [&] {
      return fmt::format("{}:{}: column 'pose': '{}': ", m.origin, m.readings.at(group.readings.front()).line,
                         excerpt(group.label));
    };
    const std::size_t p = configurations.size();
    const Configuration* before = p < known.size() ? &known[p] : nullptr;
    configurations.push_back(told_at<ModelError>(place, [&] {
      return m.by_joints() ? configure_joints(mechanism, group.joints, before)
                           : configure(mechanism, pose_from(group.pose_mm_deg), before);
    }));
  }
  return configurations;
}

}  // namespace deflect::measurement
