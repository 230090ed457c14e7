// Which patterns a residual holds, said in words.
#pragma once

#include "validation/compare/comparison.h"

namespace deflect {

struct Findings {
  std::vector<Finding> findings;
  std::vector<Regression> alone;  ///< of the residual on each pattern by itself
  MatrixX columns;                ///< of all findings, over the measured numbers
  double chi2_left = 0;           ///< of the residual with them
};

/// One at a time, that which takes most away beyond what chance gives (χ² gain − k ln n for k columns and n readings),
/// as long as this is more than 10 and chance would do as well in less than one of 10⁴ sets; then what is left is asked
/// again. Patterns that come within 10 of the best one are named beside it. `columns`: of the patterns, over the
/// measured numbers. `in_words`: whether sentences are wanted, which take longer than the findings.
Findings find_patterns(const ResidualStudy&, const Uncertainty&, const VectorX& residual, const std::vector<Pattern>&,
                       const std::vector<MatrixX>& columns, bool in_words = true);

/// The exponent p of e ∝ x^p that fits best, x a site's force (odd in it; each site with a weight) or the extension of
/// slides across which it yields, with its standard deviation;
/// empty where the data do not determine it.
struct Exponent {
  double value = 0, deviation = 0;
};
std::optional<Exponent> force_exponent(const ResidualStudy&, const Regressions&,
                                       const std::function<double(const Site&)>& weight);
std::optional<Exponent> extension_exponent(const ResidualStudy&, const Regressions&);

}  // namespace deflect
