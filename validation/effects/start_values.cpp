// What with_effect.h says of values alone: readers of results need it without the descriptions.
#include <fmt/format.h>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "validation/effects/with_effect.h"

namespace deflect::effects {

VectorX start_values(const Effect& e) {
  VectorX out(std::ssize(e.parameters));
  for (std::size_t i = 0; i < e.parameters.size(); ++i) out(as_index(i)) = e.parameters[i].start;
  return out;
}

void require_in_bounds(const std::string& given, const Effect& e, const EffectParameter& p, double value) {
  if (p.low <= value && value <= p.high) return;
  throw InputError(
      fmt::format("{}: the value must lie between {:g} and {:g} ({}). For another range, copy the effect with 'deflect "
                  "effects {} --yaml', rename it and pass its file with --effects",
                  given, p.low, p.high, p.about, e.name));
}

}  // namespace deflect::effects
