// Play that a load leaves open in linear geometry: the small forces of the deformed shape say where it stands.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "msa/base/index.h"
#include "tests/support/devices.h"
#include "tests/support/effects_everywhere.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/signatures.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/simulate.h"

namespace deflect {
namespace {

using namespace prediction;

/// As the MSA has it in the deformed shape.
measurement::Measurements measured(const Mechanism& drawn, double gap_mm, const SimulationOptions& o,
                                   const std::string& plan = "paper") {
  const Mechanism loose = effects::with_effect(drawn, test::effect("actuator_backlash"), VectorX::Constant(1, gap_mm));
  return simulate(loose, campaign(plan, drawn, 50, 1), o);
}

// Along x, y and z only one drive of a tripteron is loaded at a time. The play of the two others moves T by 20 µm to
// one side, ten σ, of which linear geometry says nothing.
TEST(FloatingPlay, OfATripteronsDrivesIsNamed) {
  const Mechanism drawn = test::device("tripteron");
  const std::vector<effects::Effect> all = test::effects_everywhere(drawn);
  for (const std::uint64_t seed : {3, 4}) {
    SimulationOptions o;
    o.seed = seed;
    const diagnosis::Diagnosis d = diagnosis::diagnose(drawn, measured(drawn, 0.02, o), all, {{}, 199});
    EXPECT_FALSE(d.unexplained) << seed;
    ASSERT_EQ(d.missing.size(), 1u) << seed;
    std::vector<std::string> named = {d.missing[0].effect->name};
    for (const auto& tie : d.indistinguishable) named.insert(named.end(), tie.begin(), tie.end());
    EXPECT_NE(std::find(named.begin(), named.end(), "actuator_backlash"), named.end()) << seed << " " << named.front();
    EXPECT_NEAR(d.fit.values(0), 0.02, 0.004) << seed;
  }
}

// The three joints of a leg turn about lines along its drive, so play along one of them moves the tool as play in the
// drive does, wherever a load leaves it.
TEST(FloatingPlay, LooksAlikeInADriveAndAlongTheJointsBehindIt) {
  const Mechanism drawn = test::device("tripteron");
  SimulationOptions o;
  o.seed = 3;
  const measurement::Measurements data = measured(drawn, 0.02, o);
  const std::vector<effects::Effect> all = test::effects_everywhere(drawn);
  const std::vector<diagnosis::Signature> looked_at = diagnosis::signatures({drawn, data, {}}, all, 2);
  const auto of = [&](const std::string& name) {
    const auto found = std::find_if(looked_at.begin(), looked_at.end(), [&](const diagnosis::Signature& s) {
      return s.effect.effect->name == name && !s.effect.leg;
    });
    EXPECT_NE(found, looked_at.end()) << name;
    return found == looked_at.end() ? diagnosis::Signature() : *found;
  };
  const diagnosis::Signature drive = of("actuator_backlash");
  for (const char* joint : {"shoulder", "elbow", "wrist"})
    EXPECT_GT(diagnosis::cosine(drive, of(fmt::format("clearance@{}.tz", joint))), 1 - 1e-6) << joint;
}

// A force along one axis loads one drive; one along the diagonal, all three.
TEST(FloatingPlay, IsToldByReading) {
  const Mechanism drawn = test::device("tripteron");
  measurement::Measurements data = measured(drawn, 0.02, {});
  data.readings[1].load << 30, 30, 30, 0, 0, 0;
  const subject::Subject loose(
      effects::with_effect(drawn, test::effect("actuator_backlash"), VectorX::Constant(1, 0.02)));
  PredictionOptions linear;
  linear.geometry = Geometry::linear;
  const Predicted predicted = loose.stand(data)->predicted(data, linear);
  ASSERT_EQ(predicted.floating.at_readings.size(), data.readings.size());
  for (std::size_t i = 0; i < data.readings.size(); ++i)
    EXPECT_EQ(predicted.floating.at_readings[i].size(), i == 1 ? 0u : 2u) << i;
  EXPECT_TRUE(subject::Subject(drawn).stand(data)->predicted(data, linear).floating.at_readings.empty());
  linear.only.assign(data.readings.size(), false);
  linear.only[2] = true;
  const Predicted one = loose.stand(data)->predicted(data, linear);
  EXPECT_EQ(one.readings[2], predicted.readings[2]);
  EXPECT_EQ(one.floating.at_readings[2], predicted.floating.at_readings[2]);
  EXPECT_TRUE(one.readings[0].isZero(0));
}

// A moment alone puts no force on any drive as drawn: what the deformed shape makes is 1e-6 of it, a tolerance of a
// joint's axis more. So tolerances decide where the play stands in these 180 of the 720 readings.
TEST(FloatingPlay, WhereTolerancesDecideIsSetAside) {
  const Mechanism drawn = test::device("tripteron");
  SimulationOptions o;
  o.seed = 3;
  const measurement::Measurements data = measured(drawn, 0.02, o, "rich");
  const std::vector<effects::Effect> all = test::effects_everywhere(drawn);
  const diagnosis::Diagnosis d = diagnosis::diagnose(drawn, data, all, {{}, 199});
  EXPECT_FALSE(d.unexplained);
  ASSERT_EQ(d.missing.size(), 1u);
  EXPECT_EQ(d.missing[0].effect->name, "actuator_backlash");
  EXPECT_NEAR(d.fit.values(0), 0.02, 0.0005);
  const auto moments = std::count_if(data.readings.begin(), data.readings.end(),
                                     [](const auto& r) { return r.load.template head<3>().isZero(0); });
  EXPECT_EQ(moments, 180);
  EXPECT_EQ(d.set_aside, 180u);
  EXPECT_EQ(d.set_aside_in_play, 180u);
}

// The machine with that play is the one that was measured.
TEST(FloatingPlay, ThatIsAddedLeavesNothing) {
  const Mechanism drawn = test::device("tripteron");
  SimulationOptions o;
  o.tolerances = 0;
  o.sigma_u = 1e-8;
  const measurement::Measurements data = measured(drawn, 0.02, o);
  const subject::Subject loose(
      effects::with_effect(drawn, test::effect("actuator_backlash"), VectorX::Constant(1, 0.02)));
  PredictionOptions finite;
  finite.geometry = Geometry::finite;
  const std::vector<VectorX> predicted = loose.stand(data)->predict(data, finite);
  for (std::size_t i = 0; i < predicted.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(predicted[i](as_index(k)), *data.readings[i].displacement[k], 5 * o.sigma_u + 1e-9) << i;
}

}  // namespace
}  // namespace deflect
