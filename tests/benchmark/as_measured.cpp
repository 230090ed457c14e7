#include "tests/benchmark/as_measured.h"

#include "msa/base/error.h"

namespace deflect::benchmark {

std::optional<measurement::Measurements> as_measured(const Plan& plan, const subject::Subject& subject,
                                                     std::optional<Stress> stress, std::uint64_t seed) {
  prediction::SimulationOptions o = plan.simulation;
  if (stress == Stress::tolerances) o.tolerances = 2;
  if (stress == Stress::outliers) o.outliers = 0.02;
  o.heavy_tails = stress == Stress::heavy_tails;
  for (std::uint64_t tries = 0; tries < 5; ++tries) try {
      o.seed = seed + tries;
      return simulated(subject, plan.readings, o);
    } catch (const NumericalError&) {
    }
  return std::nullopt;
}

}  // namespace deflect::benchmark
