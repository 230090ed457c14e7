#include "validation/prediction/as_built.h"
#include "msa/base/index.h"

namespace deflect::prediction {
namespace {

constexpr double slack = 5e-3;  // m: a machine does not refuse to stand where its drawing just can

void move_joints(SixPsu& k, Mechanism&, const AsBuilt& built) {
  for (std::size_t i = 0; i < built.legs.size(); ++i) {
    const LegAsBuilt& leg = built.legs[i];
    k.deviations.push_back({static_cast<int>(i) + 1, leg.base_joint, leg.platform_joint, leg.link_length});
  }
  k.slider_min = std::max(0.0, k.slider_min - slack);
  k.slider_max += slack;
}

void move_joints(Chains&, Mechanism& m, const AsBuilt& built) {
  for (std::size_t i = 0; i < std::min(built.legs.size(), m.mounts.size()); ++i) {
    m.mounts[i].base.shift += built.legs[i].base_joint;
    m.mounts[i].platform.shift += built.legs[i].platform_joint;
  }
}

void scale_first_member(PlacedLeg& leg, double diameter) {
  for (PlacedPart& part : leg.parts)
    if (auto* member = std::get_if<PlacedMember>(&part)) {
      const double area = diameter * diameter, inertia = area * area;
      SectionProperties& s = member->section;
      s.A *= area;
      s.As_y *= area;
      s.As_z *= area;
      s.Iy *= inertia;
      s.Iz *= inertia;
      s.J *= inertia;
      return;
    }
}

}  // namespace

Mechanism with_geometry(const Mechanism& drawn, const AsBuilt& built) {
  Mechanism m = drawn;
  std::visit([&](auto& k) { move_joints(k, m, built); }, m.kinematics);
  return m;
}

Configuration configure_as_built(const Mechanism& geometry, const AsBuilt& built, const Configuration& drawn,
                                 const VectorX& actuator_errors) {
  VectorX q(std::ssize(drawn.actuators));
  for (Eigen::Index i = 0; i < q.size(); ++i)
    q(i) = nth(drawn.actuators, i).value + (actuator_errors.size() > 0 ? actuator_errors(i) : 0);
  Configuration c = configure_joints(geometry, q, &drawn);
  for (std::size_t i = 0; i < std::min(built.legs.size(), c.legs.size()); ++i)
    scale_first_member(c.legs[i], 1 + built.legs[i].guide_diameter);
  for_each_part(c.legs, [&](auto& part) {
    if constexpr (std::is_same_v<std::decay_t<decltype(part)>, PlacedMember>) {
      part.E *= 1 + built.modulus;
      part.G *= 1 + built.modulus;
    }
  });
  return c;
}

}  // namespace deflect::prediction
