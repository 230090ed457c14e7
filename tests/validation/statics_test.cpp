// Forces at places by statics against predictions with a small law there.
#include <gtest/gtest.h>

#include <regex>

#include "msa/base/index.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "validation/effects/law_of_effect.h"
#include "validation/effects/place_effects.h"
#include "validation/effects/with_effect.h"
#include "validation/prediction/campaign.h"

namespace deflect {
namespace {

using namespace effects;
using namespace measurement;
using namespace parallel;
using namespace prediction;
using namespace subject;

class StaticsAtPlaces : public testing::TestWithParam<const char*> {};

// A spring of compliance ε at a place moves the point by ε g gᵀF to first order in ε, in determinate and in
// over-constrained machines: what is left is of the second order, here below a hundredth.
TEST_P(StaticsAtPlaces, AgreesWithThePredictionOfASmallSpring) {
  const Mechanism m = test::device(GetParam());
  const Measurements all = campaign("random", m, 50, 3);
  const Measurements data = one_pose(all, 0);
  const Subject subject = m;
  const auto standing = subject.stand(data);
  const auto transmissions = standing->transmissions();
  ASSERT_TRUE(transmissions);
  const std::vector<VectorX> drawn = standing->predict(data, {}, alone);
  int looked_at = 0;
  for (const Effect& e : place_effects(subject, test::all_effects())) {
    if (!e.name.starts_with("linear@")) continue;
    VectorX stiff = start_values(e);
    stiff *= 1e3;  // far from what bends the structure's own forces
    const auto law = law_in_series(e, stiff);
    ASSERT_TRUE(law) << e.name;
    const std::optional<int> leg = e.scope == Scope::one_leg ? std::optional(2) : std::nullopt;
    const auto told = transmissions->change(*e.place, leg, *law, data);
    ASSERT_TRUE(told) << e.name;
    const std::vector<VectorX> with = Subject(with_effect(m, e, stiff, leg)).stand(data)->predict(data, {}, alone);
    double off = 0, size = 0, rounding = 0;
    for (std::size_t i = 0; i < with.size(); ++i) {
      off += (with[i] - drawn[i] - VectorX((*told)[i])).squaredNorm();
      size += (*told)[i].squaredNorm();
      rounding += drawn[i].squaredNorm();
    }
    EXPECT_LE(std::sqrt(off), 1e-2 * std::sqrt(size) + 1e-9 * std::sqrt(rounding)) << e.name;
    ++looked_at;
  }
  EXPECT_GT(looked_at, 10);
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, StaticsAtPlaces,
                         testing::Values("haptic-6psu-ideal-joints", "tripteron", "delta", "stewart-6ups", "hybrid",
                                         "arm", "scara", "gantry", "3-rrr", "3-upu"),
                         [](const auto& at) {
                           return std::regex_replace(std::string(at.param), std::regex("-"), "_");
                         });

}  // namespace
}  // namespace deflect
