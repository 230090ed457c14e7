#include "validation/compare/slides.h"
#include "msa/base/index.h"

#include <algorithm>
#include <cmath>

namespace deflect::compare {

bool has_slides(const ResidualStudy& s) {
  for (const auto& sites : s.sites)
    for (const subject::Site& site : sites)
      if (site.along < 0.999) return true;
  return false;
}

bool varies_in_extension(const ResidualStudy& s) {
  double low = INFINITY, high = 0;
  for (const auto& sites : s.sites)
    for (const subject::Site& site : sites) low = std::min(low, site.extension), high = std::max(high, site.extension);
  return low > 0 && high > 1.2 * low;
}

double mean_extension(const ResidualStudy& s) {
  double sum = 0, n = 0;
  for (const auto& sites : s.sites)
    for (const subject::Site& site : sites) sum += site.extension, n += 1;
  return n > 0 && sum > 0 ? sum / n : 1;
}

VectorX elastic_along(const ResidualStudy& s) {
  return rows_of_sites(s, [&](std::size_t i, std::size_t k) {
    return s.force[i](as_index(k)) * s.sites[s.data->readings[i].pose][k].along;
  });
}

VectorX elastic_across(const ResidualStudy& s, double power) {
  const double mean = mean_extension(s);
  std::vector<std::vector<double>> weight;  // by pose and site
  for (const std::vector<subject::Site>& sites : s.sites) {
    weight.emplace_back();
    for (const subject::Site& site : sites)
      weight.back().push_back((1 - site.along) * std::pow(site.extension / mean, power));
  }
  return rows_of_sites(
      s, [&](std::size_t i, std::size_t k) { return s.force[i](as_index(k)) * weight[s.data->readings[i].pose][k]; });
}

}  // namespace deflect::compare
