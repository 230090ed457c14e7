#include "validation/report/map_correlation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "validation/report/map_results.h"

namespace deflect::report {
namespace {

std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> rank(values.size());
  for (std::size_t from = 0; from < order.size();) {
    std::size_t to = from;
    while (to < order.size() && values[order[to]] == values[order[from]]) ++to;
    for (std::size_t i = from; i < to; ++i) rank[order[i]] = static_cast<double>(from + to - 1) / 2;
    from = to;
  }
  return rank;
}

double pearson(const std::vector<double>& a, const std::vector<double>& b) {
  const auto n = static_cast<double>(a.size());
  const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / n;
  const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / n;
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean_a) * (b[i] - mean_b);
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return aa > 0 && bb > 0 ? std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0) : 0;
}

}  // namespace

Correlation correlation(const std::vector<double>& a, const std::vector<double>& b) {
  return {pearson(a, b), pearson(ranks(a), ranks(b))};
}

Correlation with_slides(const studies::StiffnessMap& map, int axis) {
  std::vector<double> length, stiffness;
  for (const studies::MapPose& p : map.poses)
    if (const studies::MapValues* v = shown(p)) {
      length.push_back(p.slide_mean_mm);
      stiffness.push_back(v->stiffness_N_mm(axis));
    }
  return correlation(length, stiffness);
}

}  // namespace deflect::report
