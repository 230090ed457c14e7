// Force–elongation curves of sites, read off the residuals without a law: e = h(f), h piecewise linear over knots
// on each side of f = 0, where it may jump.
#pragma once

#include <string>
#include <vector>

#include "validation/compare/patterns.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {

/// Elongation beyond the model's at forces over the range that the data cover, knots without data left out; f = 0
/// stands twice, for what the curve comes to from below and from above.
struct ElongationCurve {
  std::string site;
  bool rotation = false;  ///< Nm and rad, else N and m
  std::vector<double> force, elongation, deviation;
};

/// One regression of the residual on all sites' knots at once (each site its own curve), by generalised least squares:
/// determined where the readings load sites independently. Empty without sites.
std::vector<ElongationCurve> elongation_curves(const ResidualStudy&, const statistics::Uncertainty&,
                                               const VectorX& residual, int knots = 10);

}  // namespace deflect::compare
