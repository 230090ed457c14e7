#include "validation/validity/metrics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "validation/statistics/tail.h"

namespace deflect::validity {
namespace {

/// ∫ |c − u| du from a to b.
double area_beside(double c, double a, double b) {
  const auto half_square = [](double x) { return 0.5 * x * std::abs(x); };
  return half_square(b - c) - half_square(a - c);
}

/// Antiderivative of Φ.
double integral_of_normal(double z) {
  return z * statistics::normal_distribution(z) + std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
}

}  // namespace

double area_from_uniform(std::vector<double> u) {
  std::sort(u.begin(), u.end());
  const auto n = static_cast<double>(u.size());
  double area = 0, from = 0;
  for (std::size_t i = 0; i <= u.size() && !u.empty(); ++i) {
    const double to = i < u.size() ? u[i] : 1;
    area += area_beside(static_cast<double>(i) / n, from, to);
    from = to;
  }
  return area;
}

double area_from_normal(std::vector<double> z) {
  std::sort(z.begin(), z.end());
  const auto n = static_cast<double>(z.size());
  if (z.empty()) return 0;
  // Left of all values F_n = 0, right of them 1; 1 − Φ(z) = Φ(−z).
  double area = integral_of_normal(z.front()) + integral_of_normal(-z.back());
  for (std::size_t i = 0; i + 1 < z.size(); ++i) {
    const double c = static_cast<double>(i + 1) / n, a = z[i], b = z[i + 1];
    const auto signed_area = [&](double from, double to) {
      return integral_of_normal(to) - integral_of_normal(from) - c * (to - from);
    };
    if (c <= statistics::normal_distribution(a) || c >= statistics::normal_distribution(b)) {
      area += std::abs(signed_area(a, b));
      continue;
    }
    double low = a, high = b;  // where Φ crosses c
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (statistics::normal_distribution(middle) < c ? low : high) = middle;
    }
    area += std::abs(signed_area(a, low)) + std::abs(signed_area(low, b));
  }
  return area;
}

double expected_area(std::size_t n) {
  return n > 0 ? std::sqrt(2 / std::numbers::pi) * std::numbers::pi / 8 / std::sqrt(static_cast<double>(n)) : 0;
}

std::optional<Bias> bias_of(const std::vector<Pair>& all) {
  std::vector<double> logarithms;
  double experiment = 0;
  for (const Pair& p : all) {
    if (!(p.S * p.D > 0) || !(std::abs(p.S) > 10 * p.u)) continue;
    logarithms.push_back(std::log(p.S / p.D));
    experiment += p.u * p.u / (p.D * p.D);
  }
  const auto n = static_cast<double>(logarithms.size());
  if (n < 3) return std::nullopt;
  double mean = 0, squares = 0;
  for (const double x : logarithms) mean += x / n;
  for (const double x : logarithms) squares += (x - mean) * (x - mean);
  experiment /= n;
  Bias out;
  out.pairs = logarithms.size();
  const double model = squares / (n - 1) - experiment;
  out.scatter_from_experiment = model < experiment;
  out.scatter = std::sqrt(std::max(model, experiment));
  out.experiment = std::sqrt(experiment);
  out.factor = std::exp(mean + 0.5 * (out.scatter * out.scatter - experiment));
  return out;
}

}  // namespace deflect::validity
