#include "validation/compare/placebo.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "validation/measurement/random.h"

namespace deflect::compare {

double placebo_rmse(const Comparison& before, const Comparison& after) {
  const ResidualStudy& s = before.study;
  const VectorX change =
      statistics::rows_of(s.values, after.study.predicted) - statistics::rows_of(s.values, s.predicted);
  const VectorX& r = before.residual;
  const measurement::Quantity quantity = quantity_of_errors(s.values);
  measurement::Random random(20110101);
  std::vector<double> reached;
  for (int draw = 0; draw < 99; ++draw) {
    std::vector<double> sign(s.data->poses.size());
    for (double& each : sign) each = random.normal() < 0 ? -1 : 1;
    VectorX x = change;
    for (std::size_t i = 0; i < s.values.size(); ++i)
      x(as_index(i)) *= sign[s.data->readings[s.values[i].reading].pose];
    const double own = x.squaredNorm();
    const VectorX left = own > 0 ? VectorX(r - x * (x.dot(r) / own)) : r;
    double squares = 0, n = 0;
    for (std::size_t i = 0; i < s.values.size(); ++i)
      if (s.values[i].quantity == quantity) {
        squares += left(as_index(i)) * left(as_index(i));
        n += 1;
      }
    reached.push_back(n > 0 ? std::sqrt(squares / n) : 0);
  }
  std::nth_element(reached.begin(), reached.begin() + 49, reached.end());
  return reached[49];
}

}  // namespace deflect::compare
