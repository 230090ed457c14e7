#include "validation/diagnosis/localised.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "validation/diagnosis/evidence.h"

namespace deflect::diagnosis {
namespace {

constexpr double together_told = 0.95;  // probability
constexpr double beyond_chance = 30;    // in χ², of a few hundred that are looked at

/// The effect's title in the middle of a sentence, with the leg's number where it is one.
std::string words_of(const effects::PlacedEffect& e) {
  std::string out = e.effect->title;
  out.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(out.front())));
  const std::string one = "of one leg";
  if (const std::size_t at = out.find(one); e.leg && at != out.npos)
    out.replace(at, one.size(), fmt::format("of leg {}", *e.leg));
  return out;
}

}  // namespace

std::vector<Localised> localised(const std::vector<AtPlace>& places, double chi2, double numbers, std::size_t most) {
  if (places.empty()) return {};
  const AtPlace& first = *std::max_element(places.begin(), places.end(),
                                           [](const AtPlace& a, const AtPlace& b) { return a.gain < b.gain; });
  const double scale = std::max(1.0, (chi2 - first.gain) / std::max(1.0, numbers - first.dimension));
  std::vector<double> weights;
  std::vector<std::size_t> order;
  for (const AtPlace& p : places) {
    order.push_back(order.size());
    weights.push_back(std::log(p.prior) + log_evidence(p.gain / scale, p.dimension, false));
  }
  const std::vector<double> probability = normalised(weights);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return probability[a] > probability[b]; });

  const double beyond = std::max(1.0, chi2 - numbers);
  std::vector<Localised> out;
  double sum = 0;
  for (const std::size_t i : order) {
    const AtPlace& p = places[i];
    if (out.size() == most || sum > together_told || p.gain < beyond_chance) break;
    sum += probability[i];
    std::string what = words_of(p.best->effect);
    if (p.other_way) what += ", the other way: the machine yields less there than the model";
    out.push_back({p.best->effect, std::move(what), std::min(1.0, p.gain / beyond), probability[i]});
  }
  return out;
}

}  // namespace deflect::diagnosis
