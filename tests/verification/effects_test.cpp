// Every effect of the catalogue acts in both theories, each with its own mathematics.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "msa/mechanism/stand.h"
#include "tests/support/catalogue_names.h"
#include "tests/support/chains.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "validation/effects/with_effect.h"
#include "validation/measurement/configure_all.h"
#include "validation/prediction/prediction.h"
#include "validation/theories/agreement.h"

namespace deflect {
namespace {

using namespace effects;
using namespace measurement;
using namespace prediction;
using namespace theories;

/// Fifty poses, each with a load that rises, falls and turns round, and a temperature of its own.
Measurements plan(const Mechanism& m, std::mt19937& random) {
  Measurements data;
  data.origin = "plan";
  data.temperature_recorded = true;
  const bool chains = std::holds_alternative<Chains>(m.kinematics);
  for (const Pose& pose : chains ? test::workspace_poses(m, 50) : test::random_poses(m, 50, 7)) {
    PoseGroup group{std::to_string(data.poses.size()), mm_deg_from(pose), {}, {}};
    const Vector6 F = test::random_wrench(random);
    for (const double share : {1.0, 0.3, -0.8}) {
      Reading r;
      r.pose = data.poses.size();
      r.load = share * F;
      r.sequence = static_cast<double>(data.readings.size());
      r.temperature_C = test::uniform(random, 10, 30);
      group.readings.push_back(data.readings.size());
      data.readings.push_back(r);
    }
    data.poses.push_back(group);
  }
  return data;
}

/// Within a factor of ten of the start, inside the bounds.
VectorX drawn_values(const Effect& e, std::mt19937& random) {
  VectorX out = start_values(e);
  for (std::size_t i = 0; i < e.parameters.size(); ++i) {
    const EffectParameter& p = e.parameters[i];
    double& value = out(static_cast<Eigen::Index>(i));
    value = p.log ? p.start * std::pow(10, test::uniform(random, -1, 1)) : test::uniform(random, p.low, p.high);
    value = std::clamp(value, p.low, p.high);
  }
  return out;
}

/// How far the theories may differ, relative to the displacement, and why.
double tolerance(const std::string& effect) {
  // Finite displacement: the closed form leaves out terms of third order in the load; u/L is below 1 % here.
  if (effect == "geometric_nonlinearity") return 3e-4;
  // Laws that are solved to equilibrium: Newton stops at 1e-12 of the step and 1e-9 of the residual.
  return 1e-7;
}

std::optional<int> leg_of(const Effect& e) { return e.scope == Scope::one_leg ? std::optional<int>(2) : std::nullopt; }

/// The first of these devices in which the effect has a place.
Mechanism bare_device(const Effect& e) {
  for (const char* name : {"haptic-6psu-ideal-joints", "haptic-6psu", "delta"})
    if (Mechanism m = test::device(name); !why_not(e, m, leg_of(e))) return m;
  throw std::runtime_error(e.name + " has no place in any device");
}

class EveryEffect : public testing::TestWithParam<std::size_t> {};

TEST_P(EveryEffect, ActsAlikeInBothTheories) {
  const Effect& e = test::effect(test::catalogue_names().at(GetParam()));
  const Mechanism bare = bare_device(e);
  std::mt19937 random(static_cast<unsigned>(GetParam()) + 1);
  const Measurements data = plan(bare, random);
  PredictionOptions closed, matrix;
  matrix.theory = &theory("msa");
  if (e.name == "geometric_nonlinearity")
    for (const char* part : {"guideway", "link"}) matrix.division[part] = {0, 0.25, 0.5, 0.75, 1};
  double worst = 0;
  bool acts = false;
  for (int draw = 0; draw < 3; ++draw) {
    const Mechanism m = with_effect(bare, e, drawn_values(e, random), leg_of(e));
    const std::vector<Configuration> machines = configure_all(m, data);
    const std::vector<VectorX> a = predict(m, machines, data, closed), b = predict(m, machines, data, matrix);
    const std::vector<VectorX> without = predict(bare, configure_all(bare, data), data, closed);
    for (std::size_t i = 0; i < a.size(); ++i) {
      worst = std::max(worst, relative_difference(twist_in_mm(a[i]), twist_in_mm(b[i])));
      acts = acts || (a[i] - without[i]).norm() > 1e-6 * without[i].norm();
    }
  }
  EXPECT_LT(worst, tolerance(e.name)) << e.name;
  EXPECT_TRUE(acts) << e.name << " changes nothing";
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEffect, testing::Range<std::size_t>(0, test::catalogue_names().size()),
                         [](const auto& place) { return test::catalogue_names().at(place.param); });

}  // namespace
}  // namespace deflect
