#include "validation/statistics/tail.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <limits>

namespace deflect::statistics {

double chi_squared_tail(double freedoms, double chi2) {
  if (freedoms > 0 && chi2 > std::numeric_limits<double>::max()) return 0;
  return freedoms > 0 ? boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedoms), chi2)) : 1;
}

double chi_squared_at_tail(double freedoms, double tail) {
  if (!(tail > 0)) return std::numeric_limits<double>::infinity();
  return boost::math::quantile(boost::math::complement(boost::math::chi_squared(freedoms), tail));
}

double normal_distribution(double x) { return boost::math::cdf(boost::math::normal(), x); }

}  // namespace deflect::statistics
