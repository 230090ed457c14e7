// Frames as measured things: sensors, loads by case and at nodes, tolerances, and what commands find in them.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "msa/base/error.h"
#include "msa/frame/file/frame_file.h"
#include "tests/support/cantilever.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "validation/compare/comparison.h"
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

const std::string cantilever = test::cantilever::file(R"(sensors:
  z: {node: B, direction: uz, sigma: 1 um, gain: 2}
  turn: {node: B, direction: ry, sigma: 1e-3 mrad}
  N: {member: beam, force: axial, sigma: 0.01 N}
  gauge: {member: beam, strain: {at: 0.25, y: 0 mm, z: 10 mm}, sigma: 0.01 um/m}
  root: {support: A, reaction: my, sigma: 1 Nmm, offset: 5 Nmm}
tolerances: {modulus: 1 %, node.position: 1 mm, member.bending_factor: 2 %}
)",
                                                      "pull: {nodes: {B: {fx: 100 N}}}");

Subject frame_of(const std::string& yaml = cantilever) { return frame::parse_frame(yaml, "frame.yaml"); }

Measurements read(const Subject& s, const std::string& csv) {
  return s.placed(parse_measurements(csv, "data.csv", s.instruments()));
}

/// A frame of validation/frames.
Subject built_in(const std::string& name) {
  return frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames" / (name + ".yaml"));
}

// Of a frame with a member that is all but missing, tolerances are read beside the frame it was made of as by the
// analysis of each.
TEST(MeasuredFrame, ToleranceBesideAMissingMember) {
  const Subject s = built_in("truss-45");
  const Measurements data = subject::frame_campaign("paper", *s.frame(), 1);
  frame::FrameDescription without = *s.frame();
  without.members.front().second.factor = 1e-9;
  const Subject granted(without);
  const auto drawn = s.stand(data);
  const auto near = granted.stand(data, drawn.get()), alone = granted.stand(data);
  const auto quick = near->deviations(data), whole = alone->deviations(data);
  for (const std::size_t k : {0, 40, 90}) {
    const std::vector<VectorX> a = quick->with(k)->predict(data, {}), b = whole->with(k)->predict(data, {});
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LE((a[i] - b[i]).norm(), 1e-9 * b[i].norm()) << k << " " << i;
  }
}

// Hooke and Euler–Bernoulli by hand: tip −P L³/3EI with the gain 2, its slope, N, strain M z/EI at a quarter, the
// clamp's moment with its offset.
TEST(MeasuredFrame, SensorsReadWhatBeamTheorySays) {
  const Subject s = frame_of();
  const Measurements data = read(s,
                                 "load.tip,load.pull,node.B.fz_N,z_mm,turn_rad,N_N,gauge_um_per_m,root_Nmm\n"
                                 "1,0,0,0,0,0,0,0\n0,2,0,0,0,0,0,0\n,,-10,0,0,0,0,0\n-1,1,5,0,0,0,0,0\n");
  ASSERT_EQ(data.readings.size(), 4u);
  EXPECT_EQ(data.poses.size(), 1u);
  const std::vector<VectorX> d = s.stand(data)->predict(data, {});
  const double P = 10, gauge = P * 0.75 * 0.01 / (E * I), tolerance = 1e-9;
  const auto expect = [&](std::size_t row, std::vector<double> wanted) {
    for (std::size_t k = 0; k < wanted.size(); ++k)
      EXPECT_NEAR(d[row](static_cast<Eigen::Index>(6 + k)), wanted[k], tolerance * (1e-3 + std::abs(wanted[k])))
          << row << " " << k;
  };
  // The load down bends the beam's upper fibre in tension; ry turns z towards x, so the tip's slope is positive.
  expect(0, {-2 * P / (3 * E * I), P / (2 * E * I), 0, gauge, -P * 1 + 0.005});
  expect(1, {0, 0, 200, 200 / (E * A), 0.005});
  expect(2, {-2 * P / (3 * E * I), P / (2 * E * I), 0, gauge, -P * 1 + 0.005});
  expect(3, {2 * 15 / (3 * E * I), -15 / (2 * E * I), 100, 100 / (E * A) - 1.5 * gauge, 15 + 0.005});
}

TEST(MeasuredFrame, FileOfReadingsComesBack) {
  const Subject s = frame_of();
  const Measurements data = read(s, "load.tip,node.B.fz_lbf,z_in,gauge_um_per_m,sequence\n1,2,0.1,3,1\n0.5,,,4,2\n");
  EXPECT_NEAR(data.readings[0].at_points[0](2), 2 * 4.4482216152605, 1e-12);
  EXPECT_NEAR(*data.readings[0].sensors[0], 2.54e-3, 1e-15);
  EXPECT_NEAR(*data.readings[1].sensors[1], 4e-6, 1e-20);
  EXPECT_FALSE(data.readings[1].sensors[0]);
  const Measurements again = read(s, measurements_text(data));
  EXPECT_EQ(measurements_text(again), measurements_text(data));
  EXPECT_EQ(loads_of(again), loads_of(data));
  EXPECT_EQ(load_channels(data)[1].name, "node.B.fz");
}

TEST(MeasuredFrame, RefusesWhatItCannotRead) {
  const auto refusal = [](const std::string& csv, const Subject& s) -> std::string {
    try {
      read(s, csv);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const Subject s = frame_of();
  EXPECT_NE(refusal("load.tap,z_mm\n1,2\n", s).find("did you mean 'load.tip'"), std::string::npos);
  EXPECT_NE(refusal("load.tip,z_N\n1,2\n", s).find("did you mean 'z_mm'"), std::string::npos);
  EXPECT_NE(refusal("load.tip,ux_mm\n1,2\n", s).find("unknown column 'ux_mm'"), std::string::npos);
  EXPECT_NE(refusal("load.tip,q1_rad,z_mm\n1,2,3\n", s).find("unknown column 'q1_rad'"), std::string::npos);
  EXPECT_NE(refusal("node.C.fz_N,z_mm\n1,2\n", s).find("did you mean 'node."), std::string::npos);
  EXPECT_NE(refusal("load.tip\n1\n", s).find("z_mm"), std::string::npos);
  EXPECT_NE(refusal("z_mm\n1\n", s).find("load.tip"), std::string::npos);
  EXPECT_NE(refusal("load.tip,z_mm\nx,2\n", s).find("data.csv:2: column 'load.tip'"), std::string::npos);
  std::string bare = cantilever;
  bare.erase(bare.find("sensors:"), bare.find("tolerances:") - bare.find("sensors:"));
  EXPECT_NE(refusal("load.tip,z_mm\n1,2\n", frame_of(bare)).find("has no sensors"), std::string::npos);
}

TEST(MeasuredFrame, RefusesSensorsThatCannotBe) {
  const auto refusal = [](const std::string& from, const std::string& to) -> std::string {
    std::string yaml = cantilever;
    yaml.replace(yaml.find(from), from.size(), to);
    try {
      frame_of(yaml);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("{node: B, direction: uz", "{node: b, direction: uz").find("sensors.z.node"), std::string::npos);
  EXPECT_NE(refusal("direction: uz", "direction: up").find("sensors.z.direction"), std::string::npos);
  EXPECT_NE(refusal("force: axial", "force: N").find("axial"), std::string::npos);
  EXPECT_NE(refusal("at: 0.25", "at: 1.5").find("sensors.gauge.strain.at"), std::string::npos);
  EXPECT_NE(refusal("sigma: 0.01 um/m", "sigma: 0.01 mm").find("um/m"), std::string::npos);
  EXPECT_NE(refusal("support: A, reaction", "support: B, reaction").find("sensors.root.support"), std::string::npos);
  EXPECT_NE(
      refusal("member.bending_factor: 2 %", "member.bend_factor: 2 %").find("did you mean 'member.bending_factor'"),
      std::string::npos);
  EXPECT_NE(refusal("modulus: 1 %", "modulus: -1 %").find("modulus"), std::string::npos);
  EXPECT_NE(refusal("modulus: 1 %", "modulus: 1e300 %").find("tolerances.modulus: '1e300 %' must be"),
            std::string::npos);
  EXPECT_NE(refusal("bending_factor: 2 %", "bending_factor: 1e300 %").find("larger than the number itself"),
            std::string::npos);
  EXPECT_NE(refusal("position: 1 mm", "position: 1e300 m").find("'1e300 m' is too large for a length"),
            std::string::npos);
  EXPECT_NE(refusal("gain: 2", "gain: 2 ± 1e300 %").find("sensors.z.gain"), std::string::npos);
}

TEST(MeasuredFrame, FileRoundTrip) {
  const frame::FrameDescription f = frame::parse_frame(cantilever, "a");
  const std::string text = frame::write_frame(f);
  EXPECT_EQ(frame::write_frame(frame::parse_frame(text, "b")), text);
  EXPECT_NE(text.find("gain: \"2\""), std::string::npos) << text;
  for (const char* name : {"truss-45", "portal-semi-rigid", "lattice-girder", "beam-on-springs"}) {
    const std::string once = frame::write_frame(*built_in(name).frame());
    EXPECT_EQ(frame::write_frame(frame::parse_frame(once, name)), once) << name;
  }
}

// A longer beam: the tip goes as L³; a bending factor and a modulus in proportion; each in the description alone. By a
// standard deviation, but where that is more than 1 % of the number.
TEST(MeasuredFrame, IsOffByItsTolerances) {
  const Subject s = frame_of();
  const Measurements data = read(s, "load.tip,z_mm\n1,0\n");
  const auto standing = s.stand(data);
  const auto off = standing->deviations(data);
  std::vector<std::string> names;
  for (const subject::Tolerance& t : off->tolerances()) names.push_back(t.name);
  EXPECT_EQ(names, (std::vector<std::string>{"modulus", "node A x", "node A z", "node B x", "node B z",
                                             "beam bending_factor"}));
  const double tip = standing->predict(data, {})[0](6);
  const auto with = [&](std::size_t k) { return off->with(k)->predict(data, {})[0](6) / tip; };
  EXPECT_NEAR(with(0), 1 / 1.01, 1e-9);
  EXPECT_NEAR(with(3), 1.001 * 1.001 * 1.001, 1e-9);
  EXPECT_EQ(off->tolerances()[5].step, 0.5);
  EXPECT_NEAR(with(5), 1 / 1.01, 1e-9);
}

// Friction at a support keeps its slip from row to row, in the order taken: a loop, by hand. The spring to the ground
// (k) carries what the slider (limit F, stiffness ks) does not.
TEST(MeasuredFrame, FrictionAtASupportMakesALoop) {
  const Subject s = frame_of(R"(
name: slider
plane: xz
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {bar: {shape: rectangle, width_y: 20 mm, height_z: 20 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m]}
members: {bar: {from: A, to: B, section: bar, material: steel}}
supports: {A: {holds: [uz, ry], beside: {ux: {law: friction, force: 100 N, stiffness: 1e4 N/mm}}}}
springs: {ground: {node: A, ux: 1000 N/mm}}
loads: {push: {nodes: {B: {fx: 1 N}}}}
sensors: {x: {node: A, direction: ux, sigma: 1 um}}
)");
  const Measurements data = read(s, "load.push,x_mm,sequence\n300,0,1\n0,0,2\n-300,0,3\n50,0,4\n");
  EXPECT_TRUE(s.stand(data)->has_history());
  const std::vector<VectorX> d = s.stand(data)->predict(data, {});
  // The slider slips at ±100 N throughout: the spring carries what is left, 200, 100, −200 and −50 N.
  const std::array<double, 4> carried = {200, 100, -200, -50};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(d[i](6), carried[i] / 1e6, 1e-13);
  const Measurements unordered = read(s, "load.push,x_mm\n300,0\n0,0\n");
  EXPECT_THROW(s.stand(unordered)->predict(unordered, {}), InputError);
}

// A sensor that sticks lags behind by its band.
TEST(MeasuredFrame, SensorSticks) {
  std::string yaml = cantilever;
  yaml.replace(yaml.find("sigma: 1 um, gain: 2"), 20, "sigma: 1 um, stick: 0.1 mm");
  const Subject s = frame_of(yaml);
  const Measurements data = read(s, "load.tip,z_mm,sequence\n0,0,1\n1,0,2\n0.99,0,3\n0,0,4\n");
  const std::vector<VectorX> d = s.stand(data)->predict(data, {});
  const double tip = -10 / (3 * E * I);
  EXPECT_NEAR(d[0](6), 0, 1e-15);
  EXPECT_NEAR(d[1](6), tip + 1e-4, 1e-12);
  EXPECT_NEAR(d[2](6), tip + 1e-4, 1e-12);
  EXPECT_NEAR(d[3](6), -1e-4, 1e-12);
}

std::vector<effects::Effect> known_effects(const Subject& s) {
  std::vector<effects::Effect> all = test::all_effects();
  for (effects::Effect& e : effects::place_effects(s, all)) all.push_back(std::move(e));
  return all;
}

/// Readings of a frame with an effect, and what is found in them.
diagnosis::Diagnosis diagnosed(const Subject& s, const std::string& effect, const VectorX& values,
                               const std::string& campaign = "rich") {
  const std::vector<effects::Effect> all = known_effects(s);
  const effects::Effect& hidden = effects::find_effect(all, effect);
  const Subject with = effects::with_effect(s, {{&hidden, {}}, values});
  prediction::SimulationOptions o;
  const Measurements data = subject::simulate_frame(*with.frame(), subject::frame_campaign(campaign, *s.frame(), 1), o);
  static std::vector<std::vector<effects::Effect>> keep;
  keep.push_back(all);
  return diagnosis::diagnose(s, data, keep.back(), {{}, 199});
}

std::vector<std::string> named(const diagnosis::Diagnosis& d) {
  std::vector<std::string> out;
  for (const effects::PlacedEffect& e : d.missing) out.push_back(e.effect->name);
  for (const auto& tie : d.indistinguishable) out.insert(out.end(), tie.begin(), tie.end());
  return out;
}

bool names_one_of(const diagnosis::Diagnosis& d, const std::string& effect) {
  for (const std::string& each : named(d))
    if (each.starts_with(effect)) return true;
  return false;
}

TEST(MeasuredFrame, HealthyOnesAreHealthy) {
  for (const char* name : {"truss-45", "portal-semi-rigid", "lattice-girder", "beam-on-springs"}) {
    const Subject s = built_in(name);
    const Measurements data = subject::simulate_frame(*s.frame(), subject::frame_campaign("rich", *s.frame(), 1), {});
    const auto effects = known_effects(s);
    EXPECT_GE(effects.size(), 50u);
    const diagnosis::Diagnosis d = diagnosis::diagnose(s, data, effects, {{}, 199});
    EXPECT_EQ(d.verdict, diagnosis::Verdict::nothing_missing) << name;
  }
}

TEST(MeasuredFrame, NamesWhatIsHidden) {
  struct Case {
    const char *frame, *effect;
    double value;
    const char* campaign = "rich";
  };
  for (const Case& c : {Case{"truss-45", "factor@C0a", 0.8},
                        {"truss-45", "gain@F_C0c", 0.95},
                        {"truss-45", "zero@tip_z", 0.05},
                        {"truss-45", "linear@support.P0b.ux", 3e4},
                        {"beam-on-springs", "factor@spring.pad2.uz", 0.6},
                        {"lattice-girder", "factor@llow1", 0.7},
                        {"lattice-girder", "linear@support.l4.uz", 5e4},
                        {"lattice-girder", "factor@wind", 1.1},
                        {"truss-45", "factor@D1bc", 0.02},
                        {"truss-45", "stiction@tip_z", 0.05, "cycle"}}) {
    const diagnosis::Diagnosis d = diagnosed(built_in(c.frame), c.effect, VectorX::Constant(1, c.value), c.campaign);
    EXPECT_TRUE(names_one_of(d, c.effect))
        << c.frame << " " << c.effect << ": " << fmt::format("{}", fmt::join(named(d), ", "));
  }
}

// B moves along x by 0.02 mm under these loads, C down by 30 mm. With 2 % of the one in the other, x reads 30 times
// what it should: a thousandth of that is nothing, which is not what it should read either.
TEST(MeasuredFrame, CrosstalkOfAChannelThatReadsMuchMoreIsNotAUnit) {
  const Subject s = frame::parse_frame(R"(
name: arm
about: an arm, pushed down and along
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {bar: {shape: round, diameter: 20 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [0.5 m, 0 m, 0 m], C: [1 m, 0 m, 0 m]}
members: {inner: {from: A, to: B, section: bar, material: steel}, outer: {from: B, to: C, section: bar, material: steel}}
supports: {A: clamped}
loads: {down: {nodes: {C: {fz: -50 N}}}, along: {nodes: {C: {fx: 2 kN}}}}
sensors:
  x: {node: B, direction: ux, sigma: 0.01 mm}
  y: {node: C, direction: uy, sigma: 0.01 mm}
  z: {node: C, direction: uz, sigma: 0.01 mm}
tolerances: {modulus: 1 %, load: 0.3 %}
)",
                                       "arm");
  for (const char* effect : {"crosstalk@x.z", "crosstalk@y.z"}) {
    const diagnosis::Diagnosis d = diagnosed(s, effect, VectorX::Constant(1, 0.02));
    EXPECT_TRUE(d.mistakes.empty()) << effect << ": " << d.mistakes.front().sentence;
    EXPECT_TRUE(names_one_of(d, effect)) << effect << ": " << fmt::format("{}", fmt::join(named(d), ", "));
  }
}

// What reads enough is still seen to be in another unit, from a zero of its own as well.
TEST(MeasuredFrame, ChannelsInOtherUnitsAreSeen) {
  for (const auto& [name, sensor] : {std::pair{"truss-45", "tip_z"}, {"truss-45", "tip_x"}}) {
    for (const bool free : {false, true}) {
      frame::FrameDescription f = *built_in(name).frame();
      for (auto& [each, of] : f.sensors)
        if (each == sensor) of.free_zero = free;
      const Subject s = f;
      Measurements data = subject::simulate_frame(f, subject::frame_campaign("rich", f, 1), {});
      for (std::size_t k = 0; k < data.instruments.sensors.size(); ++k)
        if (data.instruments.sensors[k].name == sensor)
          for (measurement::Reading& r : data.readings) *r.sensors[k] *= 1e3;
      const compare::Comparison c = compare::compare(s, data);
      ASSERT_FALSE(c.mistakes.empty()) << sensor << free;
      EXPECT_EQ(c.mistakes.front().ids.front(), fmt::format("{}_in_um", sensor));
    }
  }
}

// Two springs in series between the beams of a portal: the sensors read what both do together, the rotation of the
// node between them is what tells them apart. It is 0 to the left of a soft end and the beam's to the right.
TEST(MeasuredFrame, ATieComesWithTheReadingThatSplitsIt) {
  const diagnosis::Diagnosis d =
      diagnosed(built_in("portal-semi-rigid"), "linear@beam_1.end.ry", VectorX::Constant(1, 4e9));
  ASSERT_EQ(d.verdict, diagnosis::Verdict::ambiguous);
  ASSERT_EQ(d.splitting.size(), 1u);
  const diagnosis::Splitting& split = d.splitting.front();
  const std::vector<std::string> both = {split.between.front(), split.between.back()};
  EXPECT_TRUE(std::is_permutation(both.begin(), both.end(),
                                  std::array{"linear@beam_1.end.ry", "linear@beam_2.start.ry"}.begin()));
  EXPECT_TRUE(split.reading.starts_with("ry of node M as ")) << split.reading;
  EXPECT_GT(split.deviations, 5);
}

}  // namespace
}  // namespace deflect
