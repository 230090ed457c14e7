// What all sets together say of each method.
#pragma once

#include "tests/benchmark/record.h"
#include "validation/figures/gnuplot.h"
#include "validation/json/json_text.h"

namespace deflect::benchmark {

/// One row of the table: a share or a mean by method; NaN where a method has none.
struct Score {
  std::string name, goal;
  std::size_t sets = 0;
  std::vector<double> values;  ///< of method_names
};
std::vector<Score> scores(const std::vector<Record>&);

/// Whether the probability that a method gives to its first candidate is how often that is the truth.
struct Reliability {
  std::string method;
  double low = 0, high = 0;  ///< bin of probability
  double mean = 0, right = 0;
  std::size_t sets = 0;
};
std::vector<Reliability> reliability(const std::vector<Record>&);

/// The bins as a picture: share of the truth against mean probability, with 95 % intervals of the share.
figures::Figure reliability_figure(const std::vector<Record>&, const figures::FigureStyle& = {});

/// Tables in Markdown: scores, reliability, time, what was left out and why.
std::string report(const std::vector<Record>&);

/// The same with every set.
Json report_json(const std::vector<Record>&);

}  // namespace deflect::benchmark
