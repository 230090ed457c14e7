// What readings are weighed by in a diagnosis.
#include "validation/diagnosis/observations.h"

#include <gtest/gtest.h>

#include "tests/support/devices.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"

namespace deflect {
namespace {

// Without tolerances Σ = σ² + s² h hᵀ, with h what equilibrium in the deformed shape contributes, known to s = 20 %.
// So hᵀΣ⁻¹h = q/(1 + s² q), q = |h|²/σ² (J. Sherman, W. J. Morrison 1950).
TEST(Observations, KnowTheDeformedShapeToAFifth) {
  Mechanism m = test::device("haptic-6psu-ideal-joints");
  m.tolerances = {};
  prediction::SimulationOptions simulated;
  simulated.sigma_u = 2e-8;
  const measurement::Measurements data = prediction::simulate(m, prediction::campaign("paper", m, 50, 1), simulated);
  const diagnosis::Observations o(m, data, {});
  const compare::ResidualStudy& study = o.comparison().study;
  ASSERT_EQ(o.set_aside(), 0u);
  ASSERT_FALSE(study.deformed_shape.empty());
  const VectorX h = statistics::rows_of(study.values, study.deformed_shape);
  double q = 0;
  for (Eigen::Index i = 0; i < h.size(); ++i)
    q += std::pow(h(i) / o.comparison().sigma[static_cast<std::size_t>(i)], 2);
  ASSERT_GT(q, 10);
  const double expected = q / (1 + 0.2 * 0.2 * q);
  EXPECT_NEAR(o.uncertainty().whitened(h).squaredNorm(), expected, 1e-9 * expected);
}

}  // namespace
}  // namespace deflect
