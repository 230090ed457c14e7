// What can be wrong with a sensor's channel: the shapes by definition, and a fault that no law describes is told at its
// sensor.
#include "validation/compare/channel_shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "msa/frame/file/frame_file.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/effects/place_effects.h"
#include "validation/effects/with_effect.h"
#include "validation/report/diagnosis_results.h"
#include "validation/subject/simulate_frame.h"

namespace deflect {
namespace {

using subject::Subject;

// A bar of 2 m, E A = 200π kN: 2 kN move its end by 20/π mm and its middle by half of that.
constexpr const char* bar = R"(
name: bar
about: a bar that is pulled
materials: {soft: {E: 2 GPa, nu: 0.3}}
sections: {rod: {shape: round, diameter: 20 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m], C: [2 m, 0 m, 0 m]}
members: {inner: {from: A, to: B, section: rod, material: soft}, outer: {from: B, to: C, section: rod, material: soft}}
supports: {A: clamped}
loads: {pull: {nodes: {C: {fx: 2 kN}}}}
sensors:
  middle: {node: B, direction: ux, sigma: 0.01 mm}
  end: {node: C, direction: ux, sigma: 0.01 mm}
  force: {member: inner, force: axial, sigma: 1 N}
tolerances: {modulus: 1 %}
)";

TEST(ChannelShapes, AreThoseOfTheDefinition) {
  const Subject s = frame::parse_frame(bar, "bar");
  const measurement::Measurements data = s.placed(measurement::parse_measurements(
      "load.pull,sequence,middle_mm,end_mm,force_N\n1,1,0,0,0\n-1,2,0,0,0\n-0.9,3,0,0,0\n1,4,0,0,0\n", "readings.csv",
      s.instruments()));
  const compare::ResidualStudy study = compare::residual_study(s, data);
  const std::map<std::string, MatrixX> all = compare::channel_shapes(study);
  ASSERT_EQ(all.size(), 3u);
  const MatrixX& end = all.at("end");
  // 1, |p|, p, that of the middle, time, and the lags.
  ASSERT_EQ(end.cols(), 8);
  MatrixX expected(4, 8);
  expected.col(0).setOnes();
  expected.col(1) << 1, 1, 0.9, 1;
  expected.col(2) << 1, -1, -0.9, 1;
  expected.col(3) = expected.col(2) / 2;
  expected.col(4) << -1, -1.0 / 3, 1.0 / 3, 1;
  // It lags by the whole band, or by less where the load turns: with the widest it shows −0.7 at −1 and at −0.9.
  expected.col(5) << 0, -1e-6, 1e-6, 1e-6;
  expected.col(6) << 0, -0.1, 0, 0.1;
  expected.col(7) << 0, -0.3, -0.2, 0.3;
  const double end_moves = 0.02 / M_PI;  // m
  for (const Eigen::Index k : {1, 2, 3, 5, 6, 7}) expected.col(k) *= end_moves;
  std::size_t row = 0;
  for (std::size_t i = 0; i < study.values.size(); ++i) {
    const VectorX found = end.row(static_cast<Eigen::Index>(i));
    if (study.values[i].channel != 7) {
      EXPECT_TRUE(found.isZero(0));
      continue;
    }
    const VectorX told = expected.row(static_cast<Eigen::Index>(row++));
    for (Eigen::Index k = 0; k < 8; ++k) EXPECT_NEAR(found(k), told(k), 1e-9 * std::abs(told(k)) + 1e-12) << k;
  }
  EXPECT_EQ(row, 4u);
  EXPECT_EQ(all.at("force").cols(), 7);  // no other reads a force
}

/// The diagnosis of a frame in which an effect is hidden that is not among the candidates.
struct Unnamed {
  Unnamed(const std::string& name, const std::string& effect, double value, const std::string& campaign)
      : subject(frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames" / (name + ".yaml"))),
        known(test::all_effects()) {
    for (effects::Effect& e : effects::place_effects(subject, known)) known.push_back(std::move(e));
    const effects::Effect hidden = effects::find_effect(known, effect);
    std::erase_if(known, [&](const effects::Effect& e) { return e.name == effect; });
    const Subject with = effects::with_effect(subject, {{&hidden, {}}, VectorX::Constant(1, value)});
    data = subject::simulate_frame(*with.frame(), subject::frame_campaign(campaign, *subject.frame(), 1), {});
    told = diagnosis::diagnose(subject, data, known, {{}, 199});
  }

  Subject subject;
  std::vector<effects::Effect> known;
  measurement::Measurements data;
  diagnosis::Diagnosis told;  // its effects are among those known
};

// Without its entry a fault of a channel is unknown; what is told is the sensor, and no part of the frame is blamed.
TEST(ChannelShapes, AFaultThatNoEntryDescribesIsToldAtItsSensor) {
  struct Case {
    const char *frame, *effect;
    double value;
    const char *sensor, *campaign = "rich";
  };
  for (const Case& c : {Case{"beam-on-springs", "zero@z8", 0.04, "z8"},
                        {"truss-45", "stiction@tip_z", 0.05, "tip_z", "cycle"},
                        {"lattice-girder", "crosstalk@R_r4.R_l0", 0.04, "R_r4"},
                        {"portal-semi-rigid", "gain@mid_z", 0.9, "mid_z"},
                        {"portal-semi-rigid", "stiction@turn_C", 2e-5, "turn_C", "cycle"}}) {
    const Unnamed u(c.frame, c.effect, c.value, c.campaign);
    const diagnosis::Diagnosis& d = u.told;
    EXPECT_TRUE(d.unexplained) << c.effect;
    ASSERT_FALSE(d.localised.empty()) << c.effect;
    EXPECT_EQ(subject::sensor_of(d.localised.front().place), c.sensor);
    const auto told =
        nlohmann::json::parse(report::diagnosis_json(d)).at("unexplained").at("localised").at(0).at("place");
    EXPECT_EQ(told.at("part"), c.sensor);
    EXPECT_EQ(told.at("path"), std::string("sensors.") + c.sensor);
    for (const effects::PlacedEffect& e : d.missing)
      EXPECT_TRUE(e.effect->place && subject::sensor_of(*e.effect->place) == c.sensor) << e.effect->name;
  }
}

// A sensor that lags does nearly what friction at its node does, to itself alone. No part of the frame is blamed for
// it.
TEST(ChannelShapes, ASensorThatSticksIsToldAsThat) {
  for (const auto& [sensor, band] : {std::pair("S_left", 4.0), {"top_x", 0.03}}) {
    const Unnamed u("portal-semi-rigid", std::string("stiction@") + sensor, band, "cycle");
    EXPECT_EQ(u.told.verdict, diagnosis::Verdict::unknown_effect);
    EXPECT_TRUE(u.told.missing.empty()) << u.told.missing.front().effect->name;
    ASSERT_EQ(u.told.localised.size(), 1u) << sensor;
    EXPECT_EQ(u.told.localised.front().what, fmt::format("sensor {}, which sticks", sensor));
    EXPECT_EQ(u.told.localised.front().effect, nullptr);  // none of the laws that are there
  }
}

}  // namespace
}  // namespace deflect
