#include "msa/frame/elements/jumping_springs.h"

#include <algorithm>
#include <limits>

#include "msa/base/index.h"

namespace deflect::frame {
namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

}  // namespace

ScalarLaw scalar_law(const SpringLaw& law) {
  const double P = law.preload, rest = law.at_rest;
  if (const auto* gap = std::get_if<GapSpring>(&law))
    return {-gap->gap - rest, gap->gap - rest, [P](double) { return -P; }, [](double) { return 0.0; }, -rest, gap->gap};
  if (const auto* one = std::get_if<OneSidedSpring>(&law)) {
    const auto k = [pull = one->pull, push = one->push](double d) {
      const double c = d < 0 ? push : pull;
      return c > 0 ? 1 / c : 0;
    };
    return {one->push > 0 ? -unbounded : -rest, one->pull > 0 ? unbounded : -rest,
            [k, P, rest](double d) { return k(d + rest) * (d + rest) - P; },
            [k, rest](double d) { return k(d + rest); }};
  }
  const auto force = [&law](double d) { return frame::force(law, d); };
  const auto slope = [&law](double d) { return tangent(law, d); };
  if (const auto* friction = std::get_if<FrictionSpring>(&law))
    return {
        -unbounded, unbounded, force, slope, friction->before - rest, std::max(friction->most / friction->k, 1e-15)};
  return {-unbounded, unbounded, force, slope};
}

double tangent_at(const SpringLaw& law, double d, double s, int end) {
  if (std::holds_alternative<GapSpring>(law)) return end != 0 ? unbounded : 0;
  if (const auto* one = std::get_if<OneSidedSpring>(&law)) return 1 / one->compliance(s + law.preload);
  if (const auto* friction = std::get_if<FrictionSpring>(&law)) return end != 0 ? 0 : friction->k;
  return tangent(law, d);
}

void keep_slips(const SpringLaw& law, double d, double s, int end, std::vector<double>& slips) {
  const auto keep = [&](int number, double x) {
    if (number < 0) return;
    slips.resize(std::max(slips.size(), as_size(number) + 1));
    slips[as_size(number)] = x;
  };
  if (const auto* friction = std::get_if<FrictionSpring>(&law))
    keep(friction->number, end == 0 ? friction->before : friction->slip(law.at_rest + d));
  const auto* table = std::get_if<TableSpring>(&law);
  if (!table || !table->memory || table->number < 0) return;
  const std::array<double, 2> left = table->left_after(s + law.preload);
  keep(table->number, left[0]);
  keep(table->number + 1, left[1]);
}

}  // namespace deflect::frame
