#include "validation/subject/machine_sites.h"

#include <fmt/format.h>

#include <optional>

#include "analytic/model.h"
#include "msa/base/index.h"

namespace deflect::subject {
namespace {

/// What the platform exerts on each leg, at T, under the six unit loads: columns of W.
std::vector<Matrix6> leg_wrenches(const Configuration& c, const analytic::AnalyticModel& model) {
  const std::vector<Vector6> at_rest = model.solve(Vector6::Zero()).leg_wrenches;
  std::vector<Matrix6> W(c.legs.size());
  for (Eigen::Index i = 0; i < 6; ++i) {
    const std::vector<Vector6> loaded = model.solve(Vector6::Unit(i)).leg_wrenches;
    for (std::size_t leg = 0; leg < W.size(); ++leg) W[leg].col(i) = loaded[leg] - at_rest[leg];
  }
  return W;
}

/// Unit vector along the last member, towards the platform.
std::optional<Vector3> direction_of(const PlacedLeg& leg) {
  std::optional<Vector3> n;
  for (const PlacedPart& part : leg.parts)
    if (const auto* member = std::get_if<PlacedMember>(&part)) n = (member->p_W_end - member->p_W_start).normalized();
  return n;
}

bool is_driven(const PlacedJoint& joint, std::size_t i) { return joint.freedoms[i] == Freedom::actuated; }

bool has_drive(const PlacedLeg& leg) {
  for (const PlacedPart& part : leg.parts)
    if (const PlacedJoint* joint = joint_of(part))
      for (std::size_t i = 0; i < 6; ++i)
        if (is_driven(*joint, i)) return true;
  return false;
}

/// The leg's line, where all that it can carry is a force along one.
std::optional<Vector6> line_of(const PlacedLeg& leg, const analytic::Chain& chain) {
  if (chain.N.cols() != 1) return std::nullopt;
  Vector6 s = chain.N.col(0);
  const double force = s.head<3>().norm();
  if (!(force * chain.length > 1e-6 * s.tail<3>().norm())) return std::nullopt;  // a couple
  s /= force;
  const std::optional<Vector3> n = direction_of(leg);
  return n && n->dot(s.head<3>()) < 0 ? Vector6(-s) : s;
}

}  // namespace

std::vector<Site> sites_of(const Configuration& c) {
  const analytic::AnalyticModel model(c);
  const std::vector<Matrix6> W = leg_wrenches(c, model);
  std::vector<Site> sites;
  std::size_t actuator = 0;
  for (std::size_t l = 0; l < c.legs.size(); ++l) {
    const PlacedLeg& leg = c.legs[l];
    if (!has_drive(leg)) continue;
    const auto number = c.legs.size() == 1 ? std::nullopt : std::optional(static_cast<int>(l) + 1);
    const std::optional<Vector6> line = line_of(leg, model.chains()[l]);
    if (line) {
      // The wrench is f s at T: f = n · force, since n is a unit vector.
      sites.push_back(
          {leg.name, {PlaceKind::line, number, "", ""}, false, W[l].topRows<3>().transpose() * line->head<3>(), *line});
    }
    for (const PlacedPart& part : leg.parts) {
      const PlacedJoint* joint = joint_of(part);
      if (!joint) continue;
      for (std::size_t i = 0; i < 6; ++i) {
        if (!is_driven(*joint, i)) continue;
        const bool slides = actuator < c.actuators.size() && !c.actuators[actuator].rotation;
        const double extension = slides ? c.actuators[actuator].value : 0;
        ++actuator;
        if (line) {
          if (slides) {
            sites.back().extension = extension;
            const double cosine = line->head<3>().dot(joint->R_WJ.col(as_index(i)));
            sites.back().along = cosine * cosine;
          }
          continue;
        }
        const std::string where = c.legs.size() == 1 ? joint->part : leg.name + " " + joint->part;
        const Place place{PlaceKind::drive,     number, joint->part,
                          "leg." + joint->part, {i},    joint->elastic(i) ? Hold::elastic : Hold::rigid};
        sites.push_back({fmt::format("{} {}", where, freedom_names[i]), place, i >= 3,
                         W[l].transpose() * analytic::freedom_twist(*joint, i, c.pose.p_WT), Vector6::Zero(),
                         extension});
      }
    }
  }
  return sites;
}

}  // namespace deflect::subject
