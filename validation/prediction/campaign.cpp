#include "validation/prediction/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "msa/mechanism/configuration.h"
#include "msa/mechanism/stand.h"
#include "validation/measurement/random.h"
#include "validation/studies/workspace.h"

namespace deflect::prediction {
namespace {

constexpr double most_tilt_deg = 7.5;
constexpr int most_tries = 1000;

/// Six decimals, in mm and deg.
Vector6 as_written(const Vector6& pose) { return ((pose * 1e6).array().round() / 1e6).matrix(); }

/// Builds a plan pose by pose; sequence numbers in the order of building.
class Plan {
 public:
  Plan(const Mechanism& m, std::uint64_t seed) : mechanism_(m), random_(seed) { plan_.origin = "campaign"; }

  void pose(const std::string& label, const Vector6& mm_deg) { plan_.poses.push_back({label, mm_deg, {}, {}}); }

  void add_points() {
    for (const studies::ValidationPoint& point : studies::workspace_points(mechanism_)) {
      const Vector6 at = as_written(point.pose_mm_deg);
      configure(mechanism_, pose_from(at));
      pose(point.label, at);
    }
  }

  void add_tilted(int count) {
    for (const Vector6& at : tilted_poses(mechanism_, count, random_)) pose(std::to_string(plan_.poses.size()), at);
  }

  void read(std::size_t pose, const Vector6& load) {
    measurement::Reading r;
    r.pose = pose;
    r.load = load + Vector6::Zero();  // no −0
    r.sequence = static_cast<double>(plan_.readings.size());
    r.line = plan_.readings.size() + 2;
    plan_.poses[pose].readings.push_back(plan_.readings.size());
    plan_.readings.push_back(r);
  }

  std::size_t poses() const { return plan_.poses.size(); }
  measurement::Random& random() { return random_; }
  measurement::Measurements take() { return std::move(plan_); }

 private:
  const Mechanism& mechanism_;
  measurement::Random random_;
  measurement::Measurements plan_;
};

measurement::Measurements paper(Plan plan, double F) {
  plan.add_points();
  for (std::size_t p = 0; p < plan.poses(); ++p)
    for (int axis = 0; axis < 3; ++axis) plan.read(p, F * Vector6::Unit(axis));
  return plan.take();
}

measurement::Measurements cycle(Plan plan, double F) {
  plan.add_points();
  for (std::size_t p = 0; p < plan.poses(); ++p)
    for (int axis = 0; axis < 3; ++axis)
      for (const double step : {1, 2, 3, 4, 3, 2, 1, 0, -1, -2, -3, -4, -3, -2, -1, 0})
        plan.read(p, step * F / 4 * Vector6::Unit(axis));
  return plan.take();
}

measurement::Measurements rich(Plan plan, double F) {
  plan.add_points();
  plan.add_tilted(6);
  for (int round = 0; round < 2; ++round)
    for (std::size_t p = 0; p < plan.poses(); ++p) {
      for (int axis = 0; axis < 3; ++axis)
        for (const double share : {-1.0, -0.5, -0.2, 0.2, 0.5, 1.0}) plan.read(p, share * F * Vector6::Unit(axis));
      for (int axis = 3; axis < 6; ++axis)
        for (const double sign : {-1.0, 1.0}) plan.read(p, sign * F * lever * Vector6::Unit(axis));
    }
  return plan.take();
}

measurement::Measurements random(Plan plan, double F) {
  plan.add_tilted(20);
  for (std::size_t p = 0; p < plan.poses(); ++p)
    for (int i = 0; i < 14; ++i) {
      Vector6 load = Vector6::Zero();
      load.head<3>() = plan.random().normal3().normalized();
      load *= F * plan.random().uniform(0.2, 1);
      load = (load * 1e4).array().round() / 1e4;
      plan.read(p, load);
    }
  return plan.take();
}

}  // namespace

std::vector<Vector6> tilted_poses(const Mechanism& m, int count, measurement::Random& random) {
  const bool tilts = actuators_of(m).size() >= 6;
  const studies::Region region = studies::region_of(m);
  std::vector<Vector6> out;
  for (int tries = 0; std::ssize(out) < count; ++tries) {
    Vector6 at = studies::draw_pose(region, random);
    const Vector3 tilt = random.uniform3(-most_tilt_deg, most_tilt_deg);
    if (tilts) at.tail<3>() += tilt;
    at = as_written(at);
    const auto configured = outcome_of<ModelError>([&] { return configure(m, pose_from(at)); });
    if (!configured && tries < most_tries) continue;
    if (!configured) throw ModelError(configured.why, configured.cause);
    out.push_back(at);
    tries = -1;
  }
  return out;
}

measurement::Measurements campaign(const std::string& name, const Mechanism& m, double force, std::uint64_t seed) {
  constexpr measurement::Measurements (*plans[])(Plan, double) = {paper, cycle, rich, random};
  static_assert(std::size(plans) == std::size(campaign_names));
  const auto found = std::find(std::begin(campaign_names), std::end(campaign_names), name);
  if (found == std::end(campaign_names))
    throw InputError(fmt::format("there is no campaign '{}': take {}, or a file of poses and loads", name,
                                 fmt::join(campaign_names, ", ")));
  return plans[found - std::begin(campaign_names)](Plan(m, seed), force);
}

}  // namespace deflect::prediction
