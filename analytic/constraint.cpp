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

}  // namespace

int redundant_constraints(const Configuration& c) { return redundant(legs_of(c)); }

}  // namespace deflect::analytic
