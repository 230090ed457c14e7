// What a frame and its rig can lack beside laws and factors: cross-talk, resolution, turned loads, heat, settlements,
// misfits.
#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "msa/frame/file/frame_file.h"
#include "tests/support/cantilever.h"
#include "tests/support/effects.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/effects/effect_file.h"
#include "validation/effects/place_effects.h"
#include "validation/effects/with_effect.h"
#include "validation/subject/simulate_frame.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

using namespace measurement;
using subject::Subject;

using test::cantilever::A;
using test::cantilever::E;
using test::cantilever::I;

// The cantilever, which grows with temperature.
std::string cantilever(const std::string& from = "", const std::string& to = "") {
  std::string text = test::cantilever::file(R"(sensors:
  z: {node: B, direction: uz, sigma: 1 um, gain: 2}
  x: {node: B, direction: ux, sigma: 0.01 um}
  N: {member: beam, force: axial, sigma: 0.01 N}
  turn: {node: B, direction: ry, sigma: 1e-3 mrad}
tolerances: {load: 0.1 %}
)",
                                            "pull: {nodes: {B: {fx: 100 N}}}");
  const auto replace = [&](const std::string& old, const std::string& by) {
    text.replace(text.find(old), old.size(), by);
  };
  replace("nu: 0.3", "nu: 0.3, expansion: 1e-5 1/K");
  if (!from.empty()) replace(from, to);
  return text;
}

std::vector<VectorX> predicted(const std::string& yaml, const std::string& rows) {
  const Subject s = frame::parse_frame(yaml, "frame.yaml");
  const Measurements data =
      s.placed(parse_measurements("load.tip,load.pull,z_mm,x_mm,N_N,turn_rad\n" + rows, "d", s.instruments()));
  const std::string again = frame::write_frame(*s.frame());
  EXPECT_EQ(frame::write_frame(frame::parse_frame(again, "b")), again);
  // By what is known of another frame, too.
  const Subject drawn = frame::parse_frame(cantilever(), "frame.yaml");
  const std::vector<VectorX> near = s.stand(data, drawn.stand(data).get())->predict(data),
                             whole = s.stand(data)->predict(data);
  for (std::size_t i = 0; i < whole.size(); ++i)
    EXPECT_LE((near[i] - whole[i]).norm(), 1e-9 * (1e-3 + whole[i].norm())) << i;
  return whole;
}

TEST(FrameEffects, CrosstalkAddsAShareOfTheTrueReading) {
  const auto d = predicted(cantilever("gain: 2}", "gain: 2, crosstalk: {x: 10 %}}"), "1,3,0,0,0,0\n");
  const double z = -10 / (3 * E * I), x = 300 / (E * A);
  EXPECT_NEAR(d[0](6), 2 * (z + 0.1 * x), 1e-12);
  EXPECT_NEAR(d[0](7), x, 1e-15);
}

// −10 N along z, turned by 0.1 rad about y: z turns towards x.
TEST(FrameEffects, ATurnedLoadPushesSideways) {
  const auto d = predicted(cantilever("{tip: {nodes", "{tip: {turned: [0 rad, 0.1 rad, 0 rad], nodes"),
                           "1,0,0,0,0,0\n2,1,0,0,0,0\n");
  EXPECT_NEAR(d[0](8), -10 * std::sin(0.1), 1e-9);
  EXPECT_NEAR(d[0](6), -2 * 10 * std::cos(0.1) / (3 * E * I), 1e-12);
  EXPECT_NEAR(d[1](8), 100 - 20 * std::sin(0.1), 1e-9);
}

// 12 K lengthen the beam by 1e-5 · 12 m in every reading, without a force.
TEST(FrameEffects, HeatIsThereUnderEveryLoad) {
  const auto d = predicted(cantilever("y_axis: [0, 1, 0]", "heated: 12 K, y_axis: [0, 1, 0]"),
                           "0,0,0,0,0,0\n1,2,0,0,0,0\n-3,0,0,0,0,0\n");
  EXPECT_NEAR(d[0](7), 1.2e-4, 1e-15);
  EXPECT_NEAR(d[1](7), 1.2e-4 + 200 / (E * A), 1e-15);
  EXPECT_NEAR(d[2](7), 1.2e-4, 1e-15);
  EXPECT_NEAR(d[1](8), 200, 1e-9);
}

// A turn of 1 mrad about y lowers what is 1 m along x by 1 mm.
TEST(FrameEffects, ASettledSupportMovesAllThatItHolds) {
  const auto d = predicted(cantilever("A: clamped", "A: {holds: clamped, settled: {uz: -1 mm, ry: 1 mrad}}"),
                           "0,0,0,0,0,0\n-2,0,0,0,0,0\n");
  EXPECT_NEAR(d[0](6), 2 * -2e-3, 1e-12);
  EXPECT_NEAR(d[0](9), 1e-3, 1e-12);
  EXPECT_NEAR(d[1](6), 2 * (-2e-3 + 20 / (3 * E * I)), 1e-12);
}

TEST(FrameEffects, RefusesWhatCannotBe) {
  const auto refusal = [](const std::string& from, const std::string& to) -> std::string {
    try {
      frame::parse_frame(cantilever(from, to), "frame.yaml");
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("gain: 2}", "gain: 2, crosstalk: {N: 10 %}}").find("same quantity"), std::string::npos);
  EXPECT_NE(refusal("gain: 2}", "gain: 2, crosstalk: {z: 10 %}}").find("another sensor"), std::string::npos);
  EXPECT_NE(refusal("gain: 2}", "gain: 2, resolution: -1 mm}").find("sensors.z.resolution"), std::string::npos);
  EXPECT_NE(refusal("A: clamped", "A: {holds: [ux, uz, ry], settled: {uy: 1 mm}}").find("supports.A.settled.uy"),
            std::string::npos);
  std::string cold = cantilever("y_axis: [0, 1, 0]", "heated: 12 K, y_axis: [0, 1, 0]");
  cold.replace(cold.find(", expansion: 1e-5 1/K"), 21, "");
  EXPECT_THROW(frame::parse_frame(cold, "frame.yaml"), InputError);
}

// Two rods between walls with a misfit carry E A misfit/(2 L) before any load; what a load cell reads is that and what
// the load adds, once, however large the load is.
TEST(FrameEffects, PrestressIsReadOnceUnderAnyLoad) {
  const Subject s = frame::parse_frame(R"(
name: rods
plane: xz
materials: {steel: {E: 200 GPa, nu: 0.3}}
sections: {bar: {shape: rectangle, width_y: 10 mm, height_z: 10 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m], C: [2 m, 0 m, 0 m]}
members: {left: {from: A, to: B, section: bar, material: steel, misfit: 0.1 mm}, right: {from: B, to: C, section: bar, material: steel}}
supports: {A: clamped, C: clamped}
loads: {push: {nodes: {B: {fx: 100 N}}}, other: {nodes: {B: {fx: -30 N}}}}
sensors: {N: {member: left, force: axial, sigma: 1 N}}
)",
                                       "rods");
  const Measurements data =
      s.placed(parse_measurements("load.push,load.other,N_N\n0,0,0\n1,0,0\n3,2,0\n", "d", s.instruments()));
  const std::vector<VectorX> d = s.stand(data)->predict(data);
  const double prestress = -200e9 * 1e-4 * 1e-4 / 2;
  EXPECT_NEAR(d[0](6), prestress, 1e-8);
  EXPECT_NEAR(d[1](6), prestress + 50, 1e-8);
  EXPECT_NEAR(d[2](6), prestress + 150 - 30, 1e-8);
}

struct Case {
  const char* effect;
  double value;
};
class Hidden : public testing::TestWithParam<Case> {};

// Each is hidden by name, found, and written into a file that reads back.
TEST_P(Hidden, IsFound) {
  const Subject s = frame::parse_frame(cantilever(), "frame.yaml");
  std::vector<effects::Effect> all = test::all_effects();
  for (effects::Effect& e : effects::place_effects(s, all)) all.push_back(std::move(e));
  const effects::Effect& hidden = effects::find_effect(all, GetParam().effect);
  const Subject with = effects::with_effect(s, {{&hidden, {}}, VectorX::Constant(1, GetParam().value)});
  EXPECT_EQ(frame::write_frame(frame::parse_frame(frame::write_frame(*with.frame()), "b")),
            frame::write_frame(*with.frame()));
  const Measurements data = subject::simulate_frame(*with.frame(), subject::frame_campaign("rich", *s.frame(), 1), {});
  const diagnosis::Diagnosis d = diagnosis::diagnose(s, data, all, {{}, 199});
  std::vector<std::string> found;
  for (const effects::PlacedEffect& e : d.missing) found.push_back(e.effect->name);
  for (const auto& tie : d.indistinguishable) found.insert(found.end(), tie.begin(), tie.end());
  EXPECT_TRUE(std::find(found.begin(), found.end(), GetParam().effect) != found.end())
      << (found.empty() ? "nothing" : found.front());
  EXPECT_FALSE(hidden.pages.machine.empty());
}

INSTANTIATE_TEST_SUITE_P(FrameEffects, Hidden,
                         testing::Values(Case{"crosstalk@x.z", 5e-4}, Case{"turned@tip", 0.05}, Case{"heat@beam", 4},
                                         Case{"settled@support.A.ry", 0.002}));

// Readings in steps far above the scatter are as uncertain as the step says, and simulated ones come in it.
TEST(FrameEffects, ResolutionIsPartOfTheNoise) {
  const Subject s = frame::parse_frame(cantilever("gain: 2}", "resolution: 0.1 mm}"), "frame.yaml");
  const auto sensors = s.instruments().sensors;
  EXPECT_NEAR(*sensors[0].sigma, std::hypot(1e-6, 1e-4 / std::sqrt(12)), 1e-15);
  const Measurements data = subject::simulate_frame(*s.frame(), subject::frame_campaign("rich", *s.frame(), 1), {});
  for (const Reading& r : data.readings) {
    const double steps = *r.sensors[0] / 1e-4;
    EXPECT_NEAR(steps, std::round(steps), 1e-6);
  }
}

}  // namespace
}  // namespace deflect
