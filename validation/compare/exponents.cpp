#include "validation/compare/exponents.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/compare/slides.h"
#include "validation/parallel/cases.h"

namespace deflect::compare {
namespace {

/// The exponent that takes most χ² away: grid, then a parabola through the best three. `column(p)`: of the exponent.
std::optional<Exponent> best_exponent(double low, double high, double step, const statistics::Regressions& regressions,
                                      const std::function<VectorX(double)>& column) {
  std::vector<double> at;
  for (double p = low; p <= high + 1e-9; p += step) at.push_back(p);
  std::vector<double> gains(at.size());
  constexpr std::size_t some = 8;  // columns that are whitened together
  parallel::for_each_case((at.size() + some - 1) / some, 1, regressions.threads(), [&](std::size_t part) {
    const std::size_t first = part * some, end = std::min(first + some, at.size());
    MatrixX columns;
    for (std::size_t i = first; i < end; ++i) {
      const VectorX one = column(at[i]);
      if (i == first) columns.resize(one.size(), as_index(end - first));
      columns.col(as_index(i - first)) = one;
    }
    columns = regressions.whitened(columns);
    for (std::size_t i = first; i < end; ++i) gains[i] = regressions.on_whitened(columns.col(as_index(i - first))).gain;
  });
  const auto best = as_size(std::max_element(gains.begin(), gains.end()) - gains.begin());
  if (best == 0 || best + 1 == at.size() || gains[best] < 25) return std::nullopt;
  const double curvature = (gains[best - 1] - 2 * gains[best] + gains[best + 1]) / (step * step);
  if (!(curvature < 0)) return std::nullopt;
  const double slope = (gains[best + 1] - gains[best - 1]) / (2 * step);
  return Exponent{at[best] - slope / curvature, std::sqrt(-2 / curvature)};
}

}  // namespace

std::optional<Exponent> force_exponent(const ResidualStudy& s, const statistics::Regressions& regressions,
                                       const std::function<double(const subject::Site&)>& weight) {
  return best_exponent(-0.5, 2.5, 0.1, regressions, [&](double p) {
    return rows_of_sites(s, [&](std::size_t i, std::size_t k) {
      const double f = s.force[i](as_index(k));
      return f == 0 ? 0 : weight(s.sites[s.data->readings[i].pose][k]) * std::copysign(std::pow(std::abs(f), p), f);
    });
  });
}

std::optional<Exponent> extension_exponent(const ResidualStudy& s, const statistics::Regressions& regressions) {
  if (!varies_in_extension(s)) return std::nullopt;
  return best_exponent(-2, 5, 0.1, regressions, [&](double p) { return elastic_across(s, p); });
}

}  // namespace deflect::compare
