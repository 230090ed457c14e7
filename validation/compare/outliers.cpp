#include "validation/compare/outliers.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "msa/base/index.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/open_play.h"

namespace deflect::compare {

namespace {

constexpr double gross = 4.5;

/// More than chance sets aside: one of ten or more may be, and one in twenty.
bool many(const std::vector<bool>& aside) {
  const auto count = as_size(std::count(aside.begin(), aside.end(), true));
  return 20 * count > aside.size() && !(count == 1 && aside.size() >= 10);
}

Outliers outliers_beside(const ResidualStudy& s, const statistics::LoadErrors& loads,
                         const statistics::PartedColumns& A, const std::vector<double>& sigma, const VectorX& residual,
                         const MatrixX& patterns, int threads) {
  const auto without = [&](const std::vector<bool>& aside) {
    return statistics::Uncertainty(A, s.values, sigma, loads, aside, threads);
  };
  std::vector<bool> aside(s.data->readings.size(), false);
  std::optional<statistics::Uncertainty> uncertainty;
  for (int round = 0; round < 5; ++round) {
    uncertainty = without(aside);
    const statistics::Uncertainty& u = *uncertainty;
    const VectorX rest = patterns.cols() > 0
                             ? VectorX(residual - patterns * statistics::regress(u, residual, patterns).amplitude)
                             : residual;
    const VectorX left = rest - A * u.nuisances(rest);
    std::vector<double> worst(aside.size(), 0);
    for (std::size_t i = 0; i < s.values.size(); ++i) {
      const measurement::MeasuredValue& v = s.values[i];
      const double scatter = std::hypot(sigma[i], loads.deviation(v));
      worst[v.reading] = std::max(worst[v.reading], std::abs(left(as_index(i))) / scatter);
    }
    std::vector<double> sorted = worst;
    std::nth_element(sorted.begin(), sorted.begin() + as_index(sorted.size() / 2), sorted.end());
    const double typical = sorted[sorted.size() / 2];  // about 1.2 for three Gaussian numbers
    std::vector<bool> next(aside.size());
    for (std::size_t i = 0; i < worst.size(); ++i) next[i] = worst[i] > gross * std::max(1.0, typical / 1.2);
    if (next == aside) return {std::move(aside), std::move(*uncertainty)};
    aside = next;
  }
  return {aside, without(aside)};
}

}  // namespace

Outliers gross_outliers(const ResidualStudy& s, const statistics::LoadErrors& loads, const statistics::PartedColumns& A,
                        const std::vector<double>& sigma, const VectorX& residual, const MatrixX& patterns,
                        int threads) {
  Outliers found = outliers_beside(s, loads, A, sigma, residual, patterns, threads);
  if (s.standing->has_tool_point() || !many(found.aside)) return found;
  std::vector<MatrixX> columns = {linear_answers(s)};
  if (patterns.cols() > 0) columns.push_back(patterns);
  const MatrixX all = statistics::side_by_side(columns, residual.size());
  Outliers fewer = outliers_beside(s, loads, A, sigma, residual, all, threads);
  return std::count(fewer.aside.begin(), fewer.aside.end(), true) <
                 std::count(found.aside.begin(), found.aside.end(), true)
             ? std::move(fewer)
             : std::move(found);
}

statistics::LoadErrors with_open_play(const ResidualStudy& s, const statistics::LoadErrors& loads,
                                      const std::vector<MatrixX>& play, const statistics::PartedColumns& A,
                                      const std::vector<double>& sigma, const VectorX& residual, int threads) {
  statistics::LoadErrors without = loads.with_play({});
  if (play.empty()) return without;
  statistics::LoadErrors with = loads.with_play(play);
  const Outliers beside = gross_outliers(s, with, A, sigma, residual, {}, threads);
  const statistics::Uncertainty placed(A, s.values, sigma, without, beside.aside, threads);
  return statistics::is_anywhere_in_play(beside.uncertainty, placed, residual) ? with : without;
}

}  // namespace deflect::compare
