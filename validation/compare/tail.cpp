#include "validation/compare/tail.h"

#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>

namespace deflect {

double chi_squared_tail(double freedoms, double chi2) {
  return freedoms > 0 ? boost::math::cdf(boost::math::complement(boost::math::chi_squared(freedoms), chi2)) : 1;
}

double normal_distribution(double x) { return boost::math::cdf(boost::math::normal(), x); }

}  // namespace deflect
