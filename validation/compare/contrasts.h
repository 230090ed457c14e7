// Tests of the readings that assume nothing about what may be missing. A contrast is a sum or difference of residuals
// of one pose that vanishes, except for noise and tolerances, where the model is right in that respect.
//
//   parity            [r(F) + r(−F)]/2 of pairs of opposite loads: what is even in the load
//   proportionality   the intercept at no load of r along one line of loads, from two or more magnitudes of one sense:
//                     free travel, contact
//   hysteresis        r after the load rose − r after it fell, at the same load of the same pose
//   zero return       r at no load
//   drift             r of the same load later − earlier
//   reciprocity       the antisymmetric part of a compliance fitted to all force readings of a pose: no structure has
//                     one, turned axes of a sensor or load cell have
#pragma once

#include <string>
#include <vector>

#include "validation/compare/patterns.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {

struct ContrastTest {
  std::string id, question;
  std::size_t contrasts = 0;  ///< number of contrasts; 0: the plan of measurements does not allow the test
  double size = 0;            ///< m: root mean square in excess of noise and tolerances; 0 where there is none
  double p_value = 1;
  std::string missing;  ///< what the plan would have to contain for the test
};

std::vector<ContrastTest> contrast_tests(const ResidualStudy&, const statistics::Uncertainty&, const VectorX& residual,
                                         const std::vector<bool>& set_aside);

}  // namespace deflect::compare
