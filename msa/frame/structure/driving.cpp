#include "msa/frame/structure/driving.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/frame/structure/relative.h"

namespace deflect::frame {
namespace {

constexpr double of_moved_supports = 1e-5;

}  // namespace

double Driving::size(double k, double arm) const { return std::max(force * arm, of_moved_supports * k * moved / arm); }

Driving driving(const Model& m, const VectorX& loads, const VectorX& values) {
  const double length = characteristic_length(m);
  const auto arm = [&](Eigen::Index dof) { return dof < as_index(6 * m.nodes.size()) && dof % 6 > 2 ? length : 1; };
  Driving out;
  for (Eigen::Index i = 0; i < loads.size(); ++i) out.force = std::max(out.force, std::abs(loads(i)) / arm(i));
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    if (values(k) == 0) continue;
    double motion = 0;  // of the freedom that gives way least
    for (const Term& t : nth(m.constraints, k).form) motion = std::max(motion, std::abs(t.coefficient) / arm(t.dof));
    if (motion > 0) out.moved = std::max(out.moved, std::abs(values(k)) / motion);
  }
  return out;
}

}  // namespace deflect::frame
