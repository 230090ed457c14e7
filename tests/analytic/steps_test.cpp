// Laws that jump beside laws that bend: what the search asks of a mechanism.
#include "analytic/steps.h"

#include <gtest/gtest.h>

namespace deflect::analytic {
namespace {

/// Zero of a rising function between −1 and 1.
template <class F>
double zero_of(const F& rising) {
  double low = -1, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double at = (low + high) / 2;
    (rising(at) < 0 ? low : high) = at;
  }
  return (low + high) / 2;
}

/// Two branches that share a load of 40 N. In each a spring s ↦ k (s + s³/r²) is in series with a law: play in one,
/// friction in the other. The springs harden, so that what offsets do depends on the load.
struct TwoBranches {
  std::vector<SteppedLaw> laws = std::vector<SteppedLaw>(2);
  std::vector<std::vector<Step>> asked;

  TwoBranches() {
    FrictionLaw friction;
    friction.force = 5, friction.stiffness = 1e6, friction.number = 0;
    laws[0].law = ClearanceLaw{2e-5}, laws[1].law = friction;
  }

  SteppedForces answer(const std::vector<Step>& steps) {
    constexpr double F = 40, k = 1e6, r = 2e-5;
    asked.push_back(steps);
    SteppedForces out{VectorX::Zero(2), Vector6::Zero(), F, 1};
    if (steps.size() != 2) return out;
    const auto spring = [](double s) { return k * (s + s * s * s / (r * r)); };
    const auto force = [&](const Step& law, double x) {
      return spring(zero_of([&](double s) { return s + law.offset + law.compliance * spring(s) - x; }));
    };
    const double x = zero_of([&](double at) { return force(steps[0], at) + force(steps[1], at) - F; });
    out.forces << force(steps[0], x), force(steps[1], x);
    out.displacement(0) = x;
    return out;
  }

  BalancedSteps balanced() {
    Imposed imposed;
    return balance(
        laws, {}, [&](const std::vector<Step>& s) { return answer(s); }, imposed, false);
  }
};

/// By hand: the friction slips at 5 N, and the other branch carries 35 N with its play closed.
TEST(Steps, PlayBesideFrictionByHand) {
  const BalancedSteps found = TwoBranches().balanced();
  ASSERT_TRUE(found.converged) << found.reason;
  EXPECT_NEAR(found.steps[0].offset, 2e-5, 1e-12);
  EXPECT_FALSE(found.steps[0].released);
  ASSERT_TRUE(found.steps[1].released);
  const double at_35 = zero_of([](double s) { return 1e6 * (s + s * s * s / 4e-10) - 35; });
  const double at_5 = zero_of([](double s) { return 1e6 * (s + s * s * s / 4e-10) - 5; });
  EXPECT_NEAR(found.steps[1].offset, 2e-5 + at_35 - at_5, 1e-12);
}

/// Without steps a law would be where its force alone puts it, and would jump to and fro as that is sought: a mechanism
/// is asked with each law held at an offset, by a compliance, only.
TEST(Steps, TheMechanismIsAskedWithEveryLawHeld) {
  TwoBranches two;
  two.balanced();
  ASSERT_FALSE(two.asked.empty());
  for (const std::vector<Step>& steps : two.asked) {
    ASSERT_EQ(steps.size(), 2u);
    for (const Step& step : steps) {
      EXPECT_FALSE(step.released);
      EXPECT_GT(step.compliance, 0);
    }
  }
}

}  // namespace
}  // namespace deflect::analytic
