// The power with which a misfit grows with force or extension.
#pragma once

#include <functional>
#include <optional>

#include "validation/compare/patterns.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {

/// The exponent p of e ∝ x^p that fits best, with its standard deviation. force_exponent(): x is a site's force, e is
/// odd in it, and each site has a weight. extension_exponent(): x is the extension of slides that yield across their
/// axis. Nullopt where the data do not determine it.
struct Exponent {
  double value = 0, deviation = 0;
};
std::optional<Exponent> force_exponent(const ResidualStudy&, const statistics::Regressions&,
                                       const std::function<double(const subject::Site&)>& weight);
std::optional<Exponent> extension_exponent(const ResidualStudy&, const statistics::Regressions&);

}  // namespace deflect::compare
