#include "validation/measurement/in_order.h"

#include <algorithm>

namespace deflect::measurement {

std::vector<std::size_t> in_order(const PoseGroup& group, const Measurements& m) {
  std::vector<std::size_t> order = group.readings;
  if (m.readings[order.front()].sequence)
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return *m.readings[a].sequence < *m.readings[b].sequence; });
  return order;
}

}  // namespace deflect::measurement
