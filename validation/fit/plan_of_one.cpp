#include "validation/fit/plan_of_one.h"

#include <fmt/format.h>

#include <algorithm>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/fields/yaml_tree.h"

namespace deflect::fit {
namespace {

measurement::Measurements one_reading(measurement::Reading r, measurement::PoseGroup pose, const char* origin) {
  measurement::Measurements out;
  out.origin = origin;
  r.line = 1;
  pose.label = "at";
  pose.readings = {0};
  out.readings = {std::move(r)};
  out.poses = {std::move(pose)};
  return out;
}

}  // namespace

measurement::Measurements plan_of_one(const Stand& at, const Vector6& F_T_W, bool by_joints) {
  measurement::Reading r;
  r.load = F_T_W;
  measurement::PoseGroup pose;
  pose.pose_mm_deg = at.pose_mm_deg;
  if (!by_joints) return one_reading(r, pose, "--at");
  const std::vector<Actuator>& driven = at.configuration.actuators;
  pose.joints.resize(std::ssize(driven));
  for (std::size_t i = 0; i < driven.size(); ++i) pose.joints(as_index(i)) = driven[i].value;
  measurement::Measurements out = one_reading(r, pose, "--joints");
  for (const Actuator& each : driven) out.joint_rotates.push_back(each.rotation);
  return out;
}

measurement::Measurements plan_of_one(const subject::Subject& frame,
                                      const std::vector<std::pair<std::string, double>>& factors) {
  const std::vector<std::string> cases = frame.instruments().load_cases;
  measurement::Reading r;
  r.factors.assign(cases.size(), 0);
  std::vector<bool> given(cases.size());
  for (const auto& [name, factor] : factors) {
    const auto found = std::find(cases.begin(), cases.end(), name);
    if (found == cases.end())
      throw InputError(fmt::format("'{}' is no load case of {}: write factors on load cases, as in {}=1{}", name,
                                   frame.name(), cases.empty() ? "snow" : cases.front(), suggestion(name, cases)));
    const auto at = as_size(found - cases.begin());
    if (given[at]) throw InputError(fmt::format("'{}' is given twice: write the factor of a load case once", name));
    given[at] = true;
    r.factors[at] = factor;
  }
  measurement::Measurements out = one_reading(r, {}, "--at");
  out.instruments.load_cases = cases;
  out.instruments.stationary = true;
  return out;
}

}  // namespace deflect::fit
