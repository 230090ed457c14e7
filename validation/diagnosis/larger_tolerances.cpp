#include "validation/diagnosis/larger_tolerances.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/statistics/evidence.h"

namespace deflect::diagnosis {
namespace {

constexpr double largest_tolerances = 3;  // times as declared
constexpr int sizes_tried = 24;
constexpr double rise_that_shows = 2;  // of ln of the likelihood
constexpr double same_size = 0.1;      // ln of a ratio
constexpr double falls_clearly = 0.75;

}  // namespace

LargerTolerances larger_tolerances(const Observations& o, double prior) {
  LargerTolerances out;
  // Observations that look larger than declared already count as far as they look.
  const double room = largest_tolerances / o.tolerance_scale();
  if (!(room > 1.01)) return out;
  std::vector<double> scales = statistics::log_spaced(1, room, sizes_tried);
  scales.push_back(1);
  std::vector<double> likelihood = o.log_likelihood_of_scales(o.subject(), scales);
  const double as_declared = likelihood.back();
  likelihood.pop_back();
  const auto best = std::max_element(likelihood.begin(), likelihood.end());
  out.scale = scales[as_size(best - likelihood.begin())];
  out.log_odds = std::log(prior) + statistics::log_mean_exp(likelihood) - as_declared;
  return out;
}

double tolerance_scale_beside(const Observations& o, const subject::Subject& right, std::optional<double> unknown) {
  if (unknown && larger_tolerances(o.about(right)).log_odds < *unknown) return o.tolerance_scale();
  std::vector<double> scales = statistics::log_spaced(1, largest_tolerances, sizes_tried);
  std::vector<double> weighed = scales;
  for (double& s : weighed) s /= o.tolerance_scale();
  const std::vector<double> likelihood = o.log_likelihood_of_scales(right, weighed);
  const auto best = std::max_element(likelihood.begin(), likelihood.end());
  const double out = *best > likelihood.front() + rise_that_shows ? nth(scales, best - likelihood.begin()) : 1;
  return std::abs(std::log(out / o.tolerance_scale())) < same_size ? o.tolerance_scale() : out;
}

std::vector<double> noise_beside(const compare::Comparison& before, const subject::Subject& right,
                                 const measurement::Measurements& data, compare::ComparisonOptions options,
                                 const parallel::Work& work) {
  if (!compare::is_any_estimated(before)) return {};
  options.as_recorded = true;
  options.sigma.clear();
  const auto after = outcome_of([&] { return compare::compare(right, data, options, work.quiet()).sigma; });
  if (!after) return {};
  for (std::size_t i = 0; i < after->size(); ++i)
    if ((*after)[i] < falls_clearly * before.sigma[i]) return *after.value;
  return {};
}

std::vector<double> log_weights(const std::vector<Candidate>& all, const LargerTolerances& larger, double together) {
  std::vector<double> out;
  for (const Candidate& c : all) out.push_back(c.log_odds);
  if (!out.empty())
    if (const double more = together - statistics::log_sum_exp(out); more > 0)
      for (double& each : out) each += more;
  out.push_back(larger.log_odds);
  out.push_back(0);
  return out;
}

}  // namespace deflect::diagnosis
