// Force–elongation curves of sites, estimated from the residuals without assuming a law: e = h(f), with h piecewise
// linear between knots on each side of f = 0, where it may jump.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "validation/compare/patterns.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {

/// Elongation in excess of the model's, at forces over the range of the data, without knots that have no data. f = 0
/// occurs twice: the limits of the curve from below and from above.
struct ElongationCurve {
  std::string site;
  bool rotation = false;  ///< in Nm and rad, else N and m
  std::vector<double> force, elongation, deviation;
};

/// One regression of the residual on all sites' knots at once (each site its own curve), by generalised least squares:
/// the curves are determined where the readings load the sites independently. Sites that no reading loads have none.
std::vector<ElongationCurve> elongation_curves(const ResidualStudy&, const statistics::Uncertainty&,
                                               const VectorX& residual, int knots = 10);

/// The curve of one site alone. `rows`: the change of the measured numbers by an elongation that is a function of the
/// site's force; `force`: by reading.
ElongationCurve curve_of(const statistics::Regressions&,
                         const std::function<VectorX(const std::function<double(double)>&)>& rows, const VectorX& force,
                         const std::string& name, bool rotation, int knots);

}  // namespace deflect::compare
