// Methods that a competent user would try first, each in its simplest form, on the same data.
#pragma once

#include "tests/benchmark/judge.h"
#include "tests/benchmark/plan.h"

namespace deflect::benchmark {

/// With what it adds to the prediction at the plan's new poses, m.
struct BaselineAnswer {
  Answer answer;
  VectorX elsewhere;
};

inline constexpr const char* baseline_names[] = {"fixed nuisances", "all parameters", "BIC"};

/// The answers of all of them, in the order of their names; `residual`: measured − predicted with nothing added.
/// `left_out` names an entry that they must not know.
///
/// fixed nuisances  the model is taken as exact: each effect's amplitude along its signature by least squares against
///                  the noise of readings alone, the smallest p-value named where it is below 5 %
/// all parameters   all effects and all tolerances at once by least squares, the largest |t| of an effect named where
///                  it is above 1.96
/// BIC              tolerances with their priors, each effect's gain in χ² less ln n for each parameter, against none
std::vector<BaselineAnswer> baselines(const Plan&, const VectorX& residual, const std::string& left_out);

}  // namespace deflect::benchmark
