// Which patterns a residual holds, said in words.
#pragma once

#include "validation/compare/patterns.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {

/// A pattern that the residual holds, in the order found: each given those before it.
struct Finding {
  PatternId id = PatternId::elastic;
  std::string pattern;   ///< its name (patterns.h), "elastic at SITE" of a single one
  std::string site;      ///< of a single one its name
  std::string sentence;  ///< what, where, how large, with numbers
  std::vector<std::string> columns;
  VectorX amplitude, deviation;  ///< with standard deviations; in `unit`
  std::string unit;
  double size = 0;   ///< m: root mean square of what it adds to readings
  double share = 0;  ///< of the misfit beyond noise and tolerances (χ²) that it explains
  double gain = 0;   ///< χ² taken away
  int freedoms = 0;
  double p_value = 1;
  MatrixX shape;                     ///< columns over the measured numbers
  std::vector<std::string> instead;  ///< other patterns that would do nearly as well
};

struct Findings {
  std::vector<Finding> findings;
  std::vector<statistics::Regression> alone;  ///< of the residual on each pattern by itself
  MatrixX columns;                            ///< of all findings, over the measured numbers
  double chi2_left = 0;                       ///< of the residual with them
};

/// One at a time, that which takes most away beyond what chance gives (χ² gain − k ln n for k columns and n readings),
/// as long as this is more than 10 and chance would do as well in less than one of 10⁴ sets; then what is left is asked
/// again. Patterns that come within 10 of the best one are named beside it. `columns`: of the patterns, over the
/// measured numbers. `in_words`: whether sentences are wanted, which take longer than the findings.
Findings find_patterns(const ResidualStudy&, const statistics::Uncertainty&, const VectorX& residual,
                       const std::vector<Pattern>&, const std::vector<MatrixX>& columns, bool in_words = true);

}  // namespace deflect::compare
