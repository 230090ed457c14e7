#include "validation/statistics/evidence.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "validation/statistics/tail.h"

namespace deflect::statistics {

double log_mean_exp(const std::vector<double>& x) {
  const double most = *std::max_element(x.begin(), x.end());
  double sum = 0;
  for (const double v : x) sum += std::exp(v - most);
  return most + std::log(sum / static_cast<double>(x.size()));
}

double log_sum_exp(const std::vector<double>& x) { return log_mean_exp(x) + std::log(static_cast<double>(x.size())); }

double probability_of(double log_evidence, double prior_odds) { return 1 / (1 + std::exp(-log_evidence) / prior_odds); }

double most_by_noise(double numbers) { return numbers + 2 * std::sqrt(2 * numbers); }

std::vector<double> log_spaced(double low, double high, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(low * std::pow(high / low, (i + 0.5) / count));
  return out;
}

double log_evidence(double gain, int parameters, bool one_sided) {
  std::vector<double> terms;
  for (const double tau : log_spaced(0.5, 500, 40)) {
    const double share = tau * tau / (1 + tau * tau);
    double term = -0.5 * parameters * std::log1p(tau * tau) + 0.5 * gain * share;
    if (one_sided) term += std::log(2 * statistics::normal_distribution(std::sqrt(std::max(0.0, gain) * share)));
    terms.push_back(term);
  }
  return log_mean_exp(terms);
}

std::vector<double> normalised(const std::vector<double>& x) {
  const double most = *std::max_element(x.begin(), x.end());
  std::vector<double> out;
  double sum = 0;
  for (const double v : x) sum += std::exp(v - most);
  for (const double v : x) out.push_back(std::exp(v - most) / sum);
  return out;
}

}  // namespace deflect::statistics
