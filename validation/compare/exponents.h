// The power with which a misfit grows with force or extension.
#pragma once

#include <functional>
#include <optional>

#include "validation/compare/patterns.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {

/// The exponent p of e ∝ x^p that fits best, x a site's force (odd in it; each site with a weight) or the extension of
/// slides across which it yields, with its standard deviation;
/// empty where the data do not determine it.
struct Exponent {
  double value = 0, deviation = 0;
};
std::optional<Exponent> force_exponent(const ResidualStudy&, const statistics::Regressions&,
                                       const std::function<double(const subject::Site&)>& weight);
std::optional<Exponent> extension_exponent(const ResidualStudy&, const statistics::Regressions&);

}  // namespace deflect::compare
