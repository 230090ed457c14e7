#include "validation/diagnosis/scan.h"

#include <fmt/format.h>

#include <algorithm>

#include "validation/diagnosis/signatures.h"
#include "validation/effects/scanned_effects.h"
#include "validation/statistics/columns.h"

namespace deflect {
namespace {

constexpr double alike_place = 0.995;  // cosine from which one place stands for another
constexpr double beyond_chance = 30;   // in χ², of a few hundred that are looked at

}  // namespace

std::vector<Localised> scan(const Observations& o, const Fit& fit, int threads, std::size_t most) {
  const std::vector<Effect> all = scanned_effects(o.subject());
  const std::vector<Signature> found = signatures(o, all, threads);
  const MatrixX fitted = orthonormal(fit.signature);
  std::vector<double> gain;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Signature& s = found[i];
    gain.push_back(most_gain(s, fit.residual, fitted));
    order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return gain[a] > gain[b]; });
  const double beyond = std::max(1.0, fit.chi2 - static_cast<double>(o.numbers()));
  std::vector<Localised> out;
  std::vector<std::size_t> taken;
  for (const std::size_t i : order) {
    if (out.size() == most || gain[i] < beyond_chance) break;
    if (std::any_of(taken.begin(), taken.end(),
                    [&](std::size_t k) { return cosine(found[i], found[k]) > alike_place; }))
      continue;
    taken.push_back(i);
    const PlacedEffect& e = found[i].effect;
    std::string what = e.leg ? fmt::format("{} of {}", e.effect->name, site_of(e)) : e.effect->name;
    if (found[i].at_start.dot(fit.residual) > 0)
      what += ", the other way: the machine yields less there than the model";
    out.push_back({std::move(what), std::min(1.0, gain[i] / beyond)});
  }
  return out;
}

}  // namespace deflect
