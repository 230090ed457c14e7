// Which patterns a residual contains, also in words.
#pragma once

#include "validation/compare/patterns.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {

/// A pattern that the residual contains. Findings are in the order in which they were found, each given those before
/// it.
struct Finding {
  PatternId id = PatternId::elastic;
  std::string pattern;   ///< its name (patterns.h); "elastic at SITE" for a single site
  std::string site;      ///< for a single site, its name
  std::string sentence;  ///< what it is, where and how large, with numbers
  std::vector<std::string> columns;
  VectorX amplitude, deviation;  ///< and standard deviation; in `unit`
  std::string unit;
  double size = 0;   ///< m: root mean square of its contribution to the readings
  double share = 0;  ///< of the misfit (χ²) beyond noise and tolerances that it explains
  double gain = 0;   ///< reduction of χ²
  int freedoms = 0;
  double p_value = 1;
  MatrixX shape;                     ///< columns over the measured numbers
  std::vector<std::string> instead;  ///< other patterns that explain nearly as much
};

struct Findings {
  std::vector<Finding> findings;
  std::vector<statistics::Regression> alone;  ///< regression of the residual on each pattern alone
  MatrixX columns;                            ///< of all findings, over the measured numbers
  double chi2_left = 0;                       ///< of the residual after all findings
};

/// Stepwise search: in each step the pattern with the largest score is added, the score being the gain in χ² − k ln n
/// for k columns and n readings. It ends where the score is not more than 10 or the p-value of the gain not below 1e-4.
/// Patterns whose score is within 10 of the best are listed in Finding::instead. `columns`: of the patterns, over the
/// measured numbers. `in_words`: whether to write sentences, which takes longer than the search.
Findings find_patterns(const ResidualStudy&, const statistics::Uncertainty&, const VectorX& residual,
                       const std::vector<Pattern>&, const std::vector<MatrixX>& columns, bool in_words = true);

}  // namespace deflect::compare
