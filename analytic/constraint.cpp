#include "analytic/constraint.h"

#include "analytic/chain.h"

namespace deflect::analytic {
namespace {

int redundant(const Group& g) {
  auto count = static_cast<int>(g.J.cols()) - 6;  // minus the rank
  for (const Chain& c : g.branches) {
    count += static_cast<int>(c.N.cols());
    for (const Group& inner : c.groups) count += redundant(inner);
  }
  return count;
}

/// What stands side by side with the legs, or with laws of a joint, yields where it is elastic and constrains nothing
/// there.
Configuration with_yielding_beside(Configuration c) {
  for (PlacedLeg& leg : c.legs)
    for (PlacedPart& part : leg.parts) {
      if (std::holds_alternative<PlacedParallel>(part))
        if (const PlacedJoint* alone = joint_of(part)) part = PlacedJoint(*alone);
      if (auto* joint = std::get_if<PlacedJoint>(&part); joint && leg.beside) {
        for (std::size_t i = 0; i < 6; ++i)
          if (joint->elastic(i)) joint->freedoms[i] = Freedom::free;
        joint->laws = {};
        joint->stiffness.reset();
      }
    }
  return c;
}

}  // namespace

int redundant_constraints(const Configuration& c) { return redundant(legs_of(with_yielding_beside(c))); }

}  // namespace deflect::analytic
