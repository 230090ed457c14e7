#include "validation/diagnosis/detectable.h"
#include "msa/base/index.h"

#include <cmath>

namespace deflect::diagnosis {

std::vector<Detectable> detectable_sizes(const std::vector<Signature>& all, const MatrixX& cosines,
                                         bool laws_at_places) {
  std::vector<Detectable> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Signature& s = all[i];
    if (s.effect.effect->place && !laws_at_places) continue;
    Detectable d{s.effect, s.lambda, {}, "", 0};
    const VectorX start = effects::start_values(*s.effect.effect);
    for (Eigen::Index k = 0; k < start.size(); ++k) {
      const effects::EffectParameter& p = nth(s.effect.effect->parameters, k);
      if (!p.vanishes) continue;
      // The signature grows with the distance from where the effect vanishes, for stiffnesses with the compliance.
      const double value = std::isinf(*p.vanishes) ? start(k) * d.lambda_at_start / 4
                                                   : *p.vanishes + (start(k) - *p.vanishes) * 4 / d.lambda_at_start;
      if (p.low <= value && value <= p.high) d.smallest.push_back(value);
    }
    for (std::size_t k = 0; k < all.size(); ++k)
      if (all[k].effect.effect != s.effect.effect && (laws_at_places || !all[k].effect.effect->place))
        if (const double c = cosines(as_index(i), as_index(k)); c > d.cosine)
          d.cosine = c, d.mistaken_for = name_of(all[k].effect);
    if (d.cosine < 0.9) d.mistaken_for.clear();
    out.push_back(std::move(d));
  }
  return out;
}

}  // namespace deflect::diagnosis
