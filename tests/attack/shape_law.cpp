#include "tests/attack/shape_law.h"

#include <cmath>
#include <stdexcept>

namespace deflect::attack {
namespace {

LawPoint point(const LinearLaw& l, Long s, Long) { return {l.stiffness * s, s, l.stiffness}; }

LawPoint point(const PowerLaw& l, Long s, Long) {
  const Long n = 1 / Long(l.exponent), x = std::abs(s) / l.deflection, f = l.force * std::pow(x, n);
  return {std::copysign(f, s), s, l.force / l.deflection * n * std::pow(x, n - 1)};
}

LawPoint point(const HardeningLaw& l, Long s, Long) {
  const Long square = s / l.reference * (s / l.reference);
  return {l.stiffness * s * (1 + square), s, l.stiffness * (1 + 3 * square)};
}

LawPoint point(const OneSidedLaw& l, Long s, Long c) {
  const Long yields = s > 0 ? l.pull.value_or(0) : l.push.value_or(0), f = s / (yields + c);
  return {f, yields * f, 1 / (yields + c), yields / (yields + c)};
}

LawPoint point(const ClearanceLaw& l, Long s, Long c) {
  const Long gap = l.gap;
  if (std::abs(s) <= gap) return {0, s, 0};
  return {(s - std::copysign(gap, s)) / c, std::copysign(gap, s), 1 / c, 0};
}

LawPoint point(const FrictionLaw& l, Long s, Long) {
  const Long sticks = l.force / l.stiffness;
  if (std::abs(s) <= sticks) return {l.stiffness * s, s, l.stiffness};
  return {std::copysign(Long(l.force), s), s, 0};
}

/// Odd tables without a branch for unloading.
LawPoint point(const TableLaw& l, Long s, Long) {
  if (l.remembers()) throw std::logic_error("a table that remembers is not drawn");
  std::size_t i = 1;
  while (i + 1 < l.points.size() && std::abs(s) > l.points[i][1]) ++i;
  const auto& [f0, d0] = l.points[i - 1];
  const auto& [f1, d1] = l.points[i];
  const Long slope = (Long(f1) - f0) / (Long(d1) - d0);
  return {std::copysign(f0 + slope * (std::abs(s) - d0), s), s, slope};
}

}  // namespace

LawPoint along_law(const Law& law, Long s, Long c) {
  return std::visit(
      [&](const auto& l) -> LawPoint {
        if constexpr (requires { point(l, s, c); }) return point(l, s, c);
        throw std::logic_error("a law that is not drawn");
      },
      law);
}

}  // namespace deflect::attack
