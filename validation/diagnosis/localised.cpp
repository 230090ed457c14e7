#include "validation/diagnosis/localised.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "validation/statistics/columns.h"

namespace deflect::diagnosis {
namespace {

constexpr double alike_place = 0.995;  // cosine from which one place stands for another
constexpr double beyond_chance = 30;   // in χ², of a few hundred that are looked at

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

std::vector<Localised> localised(const std::vector<Signature>& all, const Fit& fit, double numbers, std::size_t most) {
  const MatrixX fitted = statistics::orthonormal(fit.signature);
  std::vector<double> gain(all.size(), 0);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!all[i].effect.effect->place) continue;
    gain[i] = most_gain(all[i], fit.residual, fitted);
    order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return gain[a] > gain[b]; });
  const double beyond = std::max(1.0, fit.chi2 - numbers);
  std::vector<Localised> out;
  std::vector<std::size_t> taken;
  for (const std::size_t i : order) {
    if (out.size() == most || gain[i] < beyond_chance) break;
    if (std::any_of(taken.begin(), taken.end(), [&](std::size_t k) { return cosine(all[i], all[k]) > alike_place; }))
      continue;
    taken.push_back(i);
    std::string what = words_of(all[i].effect);
    if (all[i].one_sided && all[i].start_along(fit.residual) > 0)
      what += ", the other way: the machine yields less there than the model";
    out.push_back({all[i].effect, std::move(what), std::min(1.0, gain[i] / beyond)});
  }
  return out;
}

}  // namespace deflect::diagnosis
