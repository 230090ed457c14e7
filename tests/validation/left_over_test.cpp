// Which effects stay named beside something unknown.
#include "validation/diagnosis/left_over.h"

#include <gtest/gtest.h>

#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/effects/place_effects.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"

namespace deflect {
namespace {

using namespace diagnosis;
using namespace effects;

/// A machine that turns on its base.
Mechanism on_a_turntable(const Mechanism& m) {
  return test::with(m, "base.rz", "{law: linear, stiffness: 1e6 Nmm/rad}", Edit::Action::append);
}

// Springs in the cables explain part of what a base that turns does. Beside something unknown they stay named, as long
// as nobody knows of a place where it may sit; a law at the base, which takes all that they take, leaves them none.
TEST(NamedBesideUnknown, NotWhatALawAtAnotherPlaceExplains) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const measurement::Measurements data =
      prediction::simulate(on_a_turntable(m), prediction::campaign("paper", m, 50, 15), {});
  const Observations o(m, data, {});
  const Hypothesis cables = {{&test::effect("cable_compliance"), {}}};
  const Fit fitted = fit_of_all(o, cables, start_values(*cables[0].effect));
  ASSERT_TRUE(fitted.found);
  const std::vector<Effect> entry = {*cables[0].effect}, places = place_effects(subject::Subject(m), {});
  std::vector<Effect> both = entry;
  for (const Effect& e : places)
    if (e.name.starts_with("linear@")) both.push_back(e);
  const auto named = [&](const std::vector<Effect>& known) {
    const std::vector<Signature> all = signatures(o, known, 1);
    const Candidates candidates(all, 1);
    return named_beside_unknown(o.whitened_patterns(), all, candidates, {o, {all[0].effect}, fitted, {}, {}})
        .effects.size();
  };
  EXPECT_EQ(named(entry), 1u);
  EXPECT_EQ(named(both), 0u);
}

}  // namespace
}  // namespace deflect
