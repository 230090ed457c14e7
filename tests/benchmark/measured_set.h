// A set of the benchmark: the data, and what is in them.
#pragma once

#include "tests/benchmark/cases.h"
#include "tests/benchmark/hidden.h"
#include "tests/benchmark/judge.h"

namespace deflect::benchmark {

struct MeasuredSet {
  const Plan* plan = nullptr;
  measurement::Measurements data;
  Truth truth;
  std::vector<effects::EffectInstance> hidden;
  Mechanism machine;                   ///< as drawn, with what is hidden, where that is effects
  double lambda = 0;                   ///< of what is hidden, all together
  double separation = 0;               ///< of each effect from the entry nearest to it, the least (hidden.h)
  double lambda_left = 0;              ///< of what the catalogue handed to the diagnosis cannot describe
  std::vector<effects::Effect> known;  ///< that catalogue
  std::string skipped;                 ///< why there is no such set; empty where there is one
};

/// Measured on a machine within its tolerances, by the MSA in the deformed shape.
MeasuredSet measured_set(const Case&, const Mechanism&, const std::vector<effects::Effect>&, Plans&);

}  // namespace deflect::benchmark
