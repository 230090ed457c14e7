#include "validation/diagnosis/larger_sizes.h"

#include <algorithm>
#include <cmath>

#include "msa/base/outcome.h"
#include "validation/diagnosis/fit_problem.h"

namespace deflect::diagnosis {
namespace {

constexpr int doublings = 7;

/// So many times as far from where it vanishes; a factor on a logarithmic scale runs towards 0 or up by its logarithm.
double times_as_large(const effects::EffectParameter& p, double small, double times) {
  if (std::isinf(*p.vanishes)) return small / times;
  if (p.log && *p.vanishes > 0) return *p.vanishes * std::pow(small / *p.vanishes, times);
  return *p.vanishes + times * (small - *p.vanishes);
}

}  // namespace

std::optional<SizedEffect> best_size(const Observations& o, const Hypothesis& h, const VectorX& from,
                                     const VectorX& small) {
  const effects::EffectParameter& p = h.back().effect->parameters.front();
  const auto best = outcome_of([&] {
    const FitProblem problem(o, h);
    std::optional<SizedEffect> out;
    double last = NAN;
    for (int k = 0; k <= doublings; ++k) {
      const double value = std::clamp(times_as_large(p, small(0), std::exp2(k)), p.low, p.high);
      if (value == last) break;  // at the bound
      last = value;
      VectorX values(from.size() + 1);
      values << from, value;
      const std::optional<VectorX> r = problem.residual(problem.coordinates(values));
      if (!r) continue;
      if (out && out->chi2 <= r->squaredNorm()) break;
      out = SizedEffect{VectorX::Constant(1, value), r->squaredNorm()};
    }
    return out;
  });
  return best ? *best.value : std::nullopt;  // the effects may not go together in this subject
}

}  // namespace deflect::diagnosis
