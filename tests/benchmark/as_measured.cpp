#include "tests/benchmark/as_measured.h"

#include "msa/base/error.h"
#include "validation/measurement/random.h"

namespace deflect::benchmark {
namespace {

/// Student's t with three degrees of freedom, scaled to the deviation 1.
double heavy_tailed(measurement::Random& random) {
  const double z = random.normal();
  return z / random.normal3().norm();
}

}  // namespace

std::optional<measurement::Measurements> as_measured(const Plan& plan, const subject::Subject& subject,
                                                     std::optional<Stress> stress, std::uint64_t seed) {
  prediction::SimulationOptions o = plan.simulation;
  const double sigma = o.sigma_u;
  if (stress == Stress::tolerances) o.tolerances = 2;
  if (stress == Stress::outliers) o.outliers = 0.02;
  const bool own_noise = stress == Stress::heavy_tails && subject.machine();
  if (own_noise) o.sigma_u = 0;
  for (std::uint64_t tries = 0; tries < 5; ++tries) try {
      o.seed = seed + tries;
      measurement::Measurements data = simulated(subject, plan.readings, o);
      if (!own_noise) return data;
      measurement::Random random(o.seed + 7);
      for (measurement::Reading& r : data.readings) {
        r.sigma_u = sigma;
        for (std::size_t k = 0; k < 3; ++k) *r.displacement[k] += sigma * heavy_tailed(random);
      }
      return data;
    } catch (const NumericalError&) {
    }
  return std::nullopt;
}

}  // namespace deflect::benchmark
