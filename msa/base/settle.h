// Numbers that follow from themselves, x = g(x), where g brings any two x nearer to each other: friction grows with a
// load, of which friction takes a part.
#pragma once

#include <algorithm>
#include <optional>

#include "msa/base/spatial.h"

namespace deflect {

/// Finds x, none negative, from a first guess; false where it does not settle to `to` of the largest, or to `rounding`
/// where that is more. g(x) is asked last for the x that is found; it may return nothing, which ends the search (true).
/// Iteration with one step back (D. G. Anderson, J. ACM 12, 1965), which finds x in three steps where g is a straight
/// line.
template <class G>
bool settle(VectorX x, const G& g, double rounding, double to = 1e-13) {
  VectorX g_before, lacks_before;
  for (int round = 0; round < 300; ++round) {
    const std::optional<VectorX> there = g(x);
    if (!there) return true;
    const VectorX lacks = *there - x;
    const double size = std::max(there->cwiseAbs().maxCoeff(), x.cwiseAbs().maxCoeff());
    if (lacks.cwiseAbs().maxCoeff() <= std::max(to * size, rounding)) return true;
    VectorX next = *there;
    if (round > 0 && round % 20 != 19 && lacks.norm() < lacks_before.norm()) {
      const VectorX change = lacks - lacks_before;
      next -= lacks.dot(change) / change.squaredNorm() * (*there - g_before);
    }
    g_before = *there;
    lacks_before = lacks;
    x = next.cwiseMax(0);
  }
  return false;
}

}  // namespace deflect
