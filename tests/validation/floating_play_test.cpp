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
#include "validation/statistics/open_play.h"

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

// What presses a drive that no force loads to one end of its play g is unknown: 2 g² along its axis, nothing along the
// one that is loaded. Along the diagonal nothing is open.
TEST(FloatingPlay, MayBeOffByAllOfIt) {
  const Mechanism drawn = test::device("tripteron");
  measurement::Measurements data = measured(drawn, 0.02, {});
  data.readings[1].load << 30, 30, 30, 0, 0, 0;
  const subject::Subject loose(
      effects::with_effect(drawn, test::effect("actuator_backlash"), VectorX::Constant(1, 0.02)));
  const std::vector<MatrixX> off = statistics::open_play(*loose.stand(data), data);
  ASSERT_EQ(off.size(), data.readings.size());
  constexpr double both = 2 * 2e-5 * 2e-5;  // m²
  for (std::size_t i = 0; i < off.size(); ++i) {
    const Matrix3 covariance = (off[i] * off[i].transpose()).topLeftCorner<3, 3>();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const bool open = i != 1 && data.readings[i].load(axis) == 0;
      // The little more load that closes play also bends the machine a little more.
      EXPECT_NEAR(covariance(axis, axis), open ? both : 0, 0.02 * both) << i << " " << axis;
    }
  }
  EXPECT_EQ(off[1].cols(), 0);
  EXPECT_TRUE(statistics::open_play(*subject::Subject(drawn).stand(data), data).empty());
}

// Errors of play are exchanged, not added to: the next machine that counts as right has play of its own.
TEST(FloatingPlay, IsExchangedBesideErrorsOfLoads) {
  const statistics::LoadErrors loads(0.1, {VectorX::Constant(2, 1), VectorX::Constant(2, 2)});
  const statistics::LoadErrors once = loads.with_play({MatrixX(2, 0), MatrixX::Constant(2, 3, 5)});
  EXPECT_EQ(once.readings_in_play(), 1u);
  EXPECT_EQ(once.of(0).cols(), 1);
  EXPECT_EQ(once.of(1).cols(), 4);
  const statistics::LoadErrors other = once.with_play({MatrixX::Constant(2, 1, 7), MatrixX(2, 0)});
  EXPECT_EQ(other.of(0), (MatrixX(2, 2) << 0.1, 7, 0.1, 7).finished());
  EXPECT_EQ(other.of(1), loads.of(1));
  EXPECT_EQ(other.with_play({}).of(0), loads.of(0));
  EXPECT_EQ(other.with_play({}).readings_in_play(), 0u);
}

// A moment alone puts no force on any drive as drawn: what the deformed shape makes is 1e-6 of it, a tolerance of a
// joint's axis more. So tolerances decide where the play stands in these 180 of the 720 readings.
TEST(FloatingPlay, WhereTolerancesDecideCountsAsUnknown) {
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
  EXPECT_EQ(d.set_aside, 0u);
  EXPECT_GE(d.in_play, 180u);
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
