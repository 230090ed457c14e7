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
  const double of_length = o.sigma_u, of_angle = o.sigma_th.value_or(0);
  if (stress == Stress::tolerances) o.tolerances = 2;
  if (stress == Stress::outliers) o.outliers = 0.02;
  const bool own_noise = stress == Stress::heavy_tails && subject.machine();
  if (own_noise) {
    o.sigma_u = 0;
    if (o.sigma_th) o.sigma_th = 0;
  }
  for (std::uint64_t tries = 0; tries < 5; ++tries) try {
      o.seed = seed + tries;
      measurement::Measurements data = simulated(subject, plan.readings, o);
      if (!own_noise) return data;
      measurement::Random random(o.seed + 7);
      for (measurement::Reading& r : data.readings) {
        r.sigma_u = of_length;
        if (of_angle > 0) r.sigma_th = of_angle;
        for (std::size_t k = 0; k < 6; ++k)
          if (r.displacement[k]) *r.displacement[k] += (k < 3 ? of_length : of_angle) * heavy_tailed(random);
      }
      return data;
    } catch (const NumericalError&) {
    }
  return std::nullopt;
}

}  // namespace deflect::benchmark
