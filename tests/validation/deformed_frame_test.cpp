// Diagnosis of a frame that stands in equilibrium in its deformed shape: fits use linear geometry plus what the
// deformed shape of the frame that was found adds.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "msa/base/index.h"
#include "msa/frame/file/frame_file.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/observations.h"
#include "validation/effects/place_effects.h"
#include "validation/subject/simulate_frame.h"

namespace deflect {
namespace {

using subject::Subject;

/// A slender column, clamped below, loaded on top by a sixth of what buckles it, or a third where two cases stand
/// together: 1/P = 4 L²/(π² EI) = 0.17 /kN.
const frame::FrameDescription& column() {
  static const frame::FrameDescription f = frame::parse_frame(R"(
name: column
geometry: finite
plane: xz
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {post: {shape: box, width_y: 40 mm, height_z: 40 mm, wall: 3 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [0 m, 0 m, 1.5 m], C: [0 m, 0 m, 3 m]}
members:
  low: {from: A, to: B, section: post, material: steel}
  high: {from: B, to: C, section: post, material: steel}
supports: {A: clamped}
loads:
  push: {nodes: {C: {fx: 60 N, fz: -1 kN}}}
  lean: {nodes: {C: {fx: -60 N, fz: -1 kN}}}
  mid: {nodes: {B: {fx: 150 N}, C: {fz: -1 kN}}}
sensors:
  top_x: {node: C, direction: ux, sigma: 0.05 mm}
  mid_x: {node: B, direction: ux, sigma: 0.02 mm}
  turn_C: {node: C, direction: ry, sigma: 0.02 mrad}
  S: {member: low, strain: {at: 0.1, y: 20 mm}, sigma: 2 um/m, gain: 1 ± 0.5 %}
tolerances: {modulus: 0.5 %, load: 0.1 %}
)",
                                                              "column");
  return f;
}

measurement::Measurements read_of(const Subject& s) {
  const frame::FrameDescription& f = *s.frame();
  prediction::SimulationOptions o;
  o.tolerances = 0;
  o.seed = 7;
  return subject::simulate_frame(f, subject::frame_campaign("rich", f, 7), o);
}

std::vector<effects::Effect> effects_of_column() {
  std::vector<effects::Effect> all = test::all_effects();
  for (effects::Effect& e : effects::place_effects(Subject(column()), all)) all.push_back(std::move(e));
  return all;
}

// A value that is fitted with the deformed shape of the frame as drawn would leave a structured misfit of some σ, which
// is something unknown, or another effect that makes up for it.
TEST(DeformedFrame, WhatIsFoundLeavesNothing) {
  const std::vector<effects::Effect> all = effects_of_column();
  for (const auto& [name, value] :
       {std::pair{"factor@low", 0.7}, {"linear@support.A.ry", 3e7}, {"clearance@support.A.ry", 2e-3}}) {
    const effects::EffectInstance hidden{{&effects::find_effect(all, name), {}}, test::values({value})};
    const measurement::Measurements data = read_of(effects::with_effect(column(), hidden));
    const diagnosis::Diagnosis d = diagnosis::diagnose(column(), data, all, {{}, 199});
    EXPECT_FALSE(d.unexplained) << name;
    ASSERT_EQ(d.missing.size(), 1u) << name;
    EXPECT_NEAR(d.final.chi2_per_dof, 1, 0.15) << name;
    ASSERT_EQ(d.fit.limits.size(), 1u) << name;
    EXPECT_LT(d.fit.limits[0].first, value) << name;
    EXPECT_GT(d.fit.limits[0].second, value) << name;
  }
}

// A column that amplifies what bends it by 1/(1 − λ) has a deformed shape of λ/(1 − λ) of its displacement d. λ and d
// grow alike where it yields more: the shape by 1 + 1/(1 − λ) times their growth. That is 2 for small λ, which is what
// the estimate takes, and 2.52 at λ = 0.34, of the cases that have most of the shape.
TEST(DeformedFrame, ChangeOfShapeIsThatOfALoadOnWhatItDisplaces) {
  const Subject drawn(column()), softer = drawn.edited({{"materials.steel.E", "0.98", Edit::Action::multiply}});
  const measurement::Measurements data = read_of(drawn);
  const diagnosis::Observations o(drawn, data, {{}, {}, true});
  const diagnosis::Observations then = o.granted(softer);
  const VectorX sigma = Eigen::Map<const VectorX>(o.comparison().sigma.data(), std::ssize(o.comparison().sigma));
  const double changed = (o.residual(drawn) - then.residual(drawn)).cwiseQuotient(sigma).norm();
  const double estimated = o.change_of_shape(softer);
  EXPECT_GT(estimated, 10);
  EXPECT_GT(changed, estimated);
  EXPECT_LT(changed, 2.52 / 2 * estimated);
}

/// The column under a part of the load from above, whose nodes may stand a millimetre beside the drawing.
frame::FrameDescription column_off_plumb(double from_above = 0.5) {
  frame::FrameDescription f = column();
  f.tolerances.numbers.emplace_back("node.position", "1 mm");
  for (auto& [name, load] : f.loads)
    for (auto& [node, wrench] : load.nodes) wrench(2) *= from_above;
  return f;
}

measurement::Measurements laboratory(const Subject& s, std::uint64_t seed) {
  prediction::SimulationOptions o;
  o.seed = seed;
  return subject::simulate_frame(*s.frame(), subject::frame_campaign("rich", *s.frame(), seed), o);
}

// A column that leans by e is pushed at its top by P e/L, which a beam-column amplifies by 3 (tan u − u)/u³, u = L
// √(P/EI). Both nodes together make it lean: B by half as much as C. It has moved by a hundredth of its length already.
TEST(DeformedFrame, TolerancesActInTheDeformedShape) {
  const Subject leaning(column_off_plumb());
  const measurement::Measurements data = read_of(Subject(column()));
  const std::vector<measurement::MeasuredValue> values = measurement::measured_values(data);
  const auto lean = [&](const Subject& s) {
    const statistics::ToleranceModel model = statistics::tolerance_model(*s.stand(data), data, values);
    VectorX out = VectorX::Zero(std::ssize(values));
    for (std::size_t k = 0; k < model.nuisances.size(); ++k)
      for (const auto& [name, share] : {std::pair{"node B x", 0.5}, {"node C x", 1.0}})
        if (model.nuisances[k].name == name) out += share * model.A.shared.col(as_index(k));
    return out;
  };
  const VectorX finite = lean(leaning), linear = lean(leaning.edited({{"geometry", "linear", Edit::Action::set}}));
  const double EI = 210e9 * (std::pow(0.040, 4) - std::pow(0.034, 4)) / 12, u = 3 * std::sqrt(500 / EI);
  const double amplified = 3 * (std::tan(u) - u) / (u * u * u);
  int compared = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::vector<double>& factors = data.readings[values[i].reading].factors;
    if (values[i].channel != 6 || factors[0] != 1 || factors[1] != 0 || factors[2] != 0) continue;
    EXPECT_NEAR(finite(as_index(i)) / linear(as_index(i)), amplified, 3e-3 * amplified);
    ++compared;
  }
  EXPECT_GT(compared, 0);
}

TEST(DeformedFrame, OffPlumbWithinTolerancesNothingIsMissing) {
  const Subject leaning(column_off_plumb());
  const std::vector<effects::Effect> all = effects_of_column();
  for (const std::uint64_t seed : {1, 2, 3}) {
    const diagnosis::Diagnosis d = diagnosis::diagnose(leaning, laboratory(leaning, seed), all, {{}, 199});
    EXPECT_EQ(d.verdict, diagnosis::Verdict::nothing_missing) << seed;
  }
}

// What makes it yield two or three times as much changes what the deformed shape adds by more than itself. Beside such
// an effect the fixed contribution of the drawn column leaves hundreds of σ; one load case that is larger changes its
// own part of it alone.
TEST(DeformedFrame, OffPlumbWhatIsHiddenIsAmongWhatIsNamed) {
  const std::vector<effects::Effect> all = effects_of_column();
  struct Hidden {
    const char* name;
    double value, from_above;
  };
  for (const auto& [name, value, from_above] : {Hidden{"factor@low", 0.8, 1},
                                                {"linear@support.A.ry", 3e7, 1},
                                                {"factor@lean", 1.03, 0.5},
                                                {"linear@support.A.ry", 4e8, 0.5}})
    for (const std::uint64_t seed : {1, 2}) {
      const Subject leaning(column_off_plumb(from_above));
      const effects::EffectInstance hidden{{&effects::find_effect(all, name), {}}, test::values({value})};
      const diagnosis::Diagnosis d =
          diagnosis::diagnose(leaning, laboratory(effects::with_effect(leaning, hidden), seed), all, {{}, 199});
      const std::string words = fmt::format("{} {} seed {}", name, value, seed);
      EXPECT_FALSE(d.unexplained) << words;
      ASSERT_EQ(d.missing.size(), 1u) << words;
      std::vector<std::string> named = {d.missing[0].effect->name};
      for (const auto& tie : d.indistinguishable) named.insert(named.end(), tie.begin(), tie.end());
      EXPECT_NE(std::find(named.begin(), named.end(), name), named.end()) << words << ": " << named.front();
    }
}

// A portal off the drawing, so that its nodes have no round coordinates. Sums leave −1.1e-16 and 5.6e-17 of a factor of
// none, which is what they mean: the deformed shape is solved in coordinates, whose rounding is more.
TEST(DeformedFrame, AFactorThatASumLeavesOfNoneIsNone) {
  frame::FrameDescription f =
      frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames/portal-semi-rigid.yaml");
  f.geometry = Geometry::finite;
  for (auto& [name, at] : f.nodes) at += Vector3(3e-4 * std::sin(at.z() + 1), 0, 2e-4 * std::cos(at.x()));
  const Subject s(f);
  std::string csv = "load.side,load.above,load.twist,top_x_mm\n";
  for (const char* factor : {"0", "-1.1102230246251565e-16", "5.551115123125783e-17"})
    csv += fmt::format("0,0,{},0\n", factor);
  const measurement::Measurements data =
      s.placed(measurement::parse_measurements(csv, "readings.csv", s.instruments()));
  prediction::PredictionOptions o;
  o.geometry = Geometry::finite;
  for (const VectorX& read : s.stand(data)->predict(data, o)) EXPECT_TRUE(read.isZero(1e-15)) << read.transpose();
}

// Where one case is drawn twice for a reading its factors add up, to hundredths as they are drawn.
TEST(DeformedFrame, FactorsOfARandomCampaignAreHundredths) {
  for (const std::uint64_t seed : {7, 8, 9})
    for (const measurement::Reading& r : subject::frame_campaign("random", column(), seed).readings)
      for (const double factor : r.factors) EXPECT_EQ(factor, std::round(factor * 100) / 100);
}

}  // namespace
}  // namespace deflect
