// Places inside frames: what passes through them, what statics alone determines, what each would have to yield.
#include <gtest/gtest.h>

#include <filesystem>

#include "msa/base/index.h"
#include "msa/frame/file/frame_file.h"
#include "tests/support/effects.h"
#include "tests/support/paths.h"
#include "validation/compare/comparison.h"
#include "validation/effects/place_effects.h"
#include "validation/effects/with_effect.h"
#include "validation/subject/simulate_frame.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

using subject::InnerSite;
using subject::InnerSites;
using subject::Subject;

Subject built_in(const std::string& name) {
  return frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames" / (name + ".yaml"));
}

measurement::Measurements readings_of(const Subject& drawn, const Subject& true_one) {
  return subject::simulate_frame(*true_one.frame(), subject::frame_campaign("rich", *drawn.frame(), 1), {});
}

Subject with(const Subject& s, const std::string& effect, double value) {
  std::vector<effects::Effect> all = test::all_effects();
  for (effects::Effect& e : effects::place_effects(s, all)) all.push_back(std::move(e));
  return effects::with_effect(s, {{&effects::find_effect(all, effect), {}}, VectorX::Constant(1, value)});
}

const InnerSite& site(const InnerSites& sites, const std::string& name) {
  for (const InnerSite& s : sites.all)
    if (s.name == name) return s;
  throw std::out_of_range(name);
}

// Two rods of one material side by side between the ground and a node that slides: E A1/L = 2k and E A2/L = k. A misfit
// of one strains it by the share that the other holds against.
constexpr const char* two_rods = R"(
name: two-rods
materials: {steel: {E: 200 GPa, nu: 0.3}}
sections: {thick: {shape: rectangle, width_y: 20 mm, height_z: 10 mm}, thin: {shape: rectangle, width_y: 10 mm, height_z: 10 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m], C: [2 m, 0 m, 0 m], D: [3 m, 0 m, 0 m]}
members:
  thick: {from: A, to: B, section: thick, material: steel}
  thin: {from: C, to: B, section: thin, material: steel}
  tail: {from: C, to: D, section: thin, material: steel}
supports: {A: clamped, B: [uy, uz, rx, ry, rz], C: clamped}
loads: {push: {nodes: {B: {fx: 300 N}, D: {fx: 70 N}}}}
sensors: {x: {node: B, direction: ux, sigma: 1 um}, end: {node: D, direction: ux, sigma: 1 um, gain: 2}}
)";

// A rigid link between held nodes: what passes through either support nobody can say, so that neither is a place whose
// deformation explains a reading. The third support can be one.
TEST(FrameSites, WhatIsHeldTwiceIsNone) {
  const Subject s = frame::parse_frame(R"(
name: twice-held
plane: xz
materials: {steel: {E: 200 GPa, nu: 0.3}}
sections: {bar: {shape: rectangle, width_y: 10 mm, height_z: 10 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m], C: [2 m, 0 m, 0 m]}
members: {left: {from: A, to: B, section: bar, material: steel}, right: {from: B, to: C, section: bar, material: steel}}
supports: {A: clamped, B: [ux], C: [ux, uz]}
rigid_links: {link: {master: B, nodes: [C], freedoms: [ux]}}
loads: {push: {nodes: {B: {fx: 100 N, fz: 50 N}}}}
sensors: {z: {node: B, direction: uz, sigma: 1 um}}
)",
                                       "twice-held");
  const auto data = readings_of(s, s);
  const InnerSites sites = s.stand(data)->inner_sites(data);
  EXPECT_THROW(site(sites, "support B ux"), std::out_of_range);
  EXPECT_THROW(site(sites, "support C ux"), std::out_of_range);
  EXPECT_TRUE(site(sites, "support C uz").per_load.allFinite());
  EXPECT_EQ(sites.response.rows(), std::ssize(sites.all));
  EXPECT_EQ(sites.response.cols(), std::ssize(sites.all));
}

TEST(FrameSites, ForcesAndRedundanciesByHand) {
  const Subject s = frame::parse_frame(two_rods, "two-rods");
  const auto data =
      s.placed(measurement::parse_measurements("load.push,x_mm,end_mm\n1,0,0\n2,0,0\n", "d", s.instruments()));
  const InnerSites sites = s.stand(data)->inner_sites(data);
  const double k = 200e9 * 1e-4;
  EXPECT_NEAR(site(sites, "thick").per_load(0), 200, 1e-9);
  EXPECT_NEAR(site(sites, "thin").per_load(0), -100, 1e-9);
  EXPECT_NEAR(site(sites, "tail").per_load(0), 70, 1e-9);
  EXPECT_NEAR(site(sites, "thick").redundancy, 1.0 / 3, 1e-12);
  EXPECT_NEAR(site(sites, "thin").redundancy, 2.0 / 3, 1e-12);
  EXPECT_TRUE(site(sites, "tail").determinate);
  EXPECT_EQ(site(sites, "tail").redundancy, 0);
  EXPECT_FALSE(site(sites, "support A ux").determinate);
  // A rod that is longer by 1 moves B by the share of its stiffness; the tail the sensor behind it, gain included.
  EXPECT_NEAR(site(sites, "thick").moves(0), 2.0 / 3, 1e-12);
  EXPECT_NEAR(site(sites, "thin").moves(0), -1.0 / 3, 1e-12);
  EXPECT_NEAR(site(sites, "tail").moves(1), 2, 1e-12);
  EXPECT_NEAR(site(sites, "tail").moves(0), 0, 1e-12);
  // A rod that is longer presses itself and the other: both pass the force of the series of the two.
  const auto index_of = [&](const std::string& name) { return &site(sites, name) - sites.all.data(); };
  const double series = -2.0 / 3 * k;
  EXPECT_NEAR(sites.response(index_of("thick"), index_of("thick")) / series, 1, 1e-9);
  EXPECT_NEAR(sites.response(index_of("thick"), index_of("thin")) / series, 1, 1e-9);
  EXPECT_NEAR(sites.response(index_of("thin"), index_of("thick")) / series, 1, 1e-9);
}

// Σ r = degree of static indeterminacy: members + reactions − 3 equations for each node, all ball joints.
TEST(FrameSites, RedundanciesOfATrussAddUpToItsDegree) {
  const Subject s = built_in("truss-45");
  const frame::FrameDescription& f = *s.frame();
  const auto data = subject::frame_campaign("paper", f, 1);
  const InnerSites sites = s.stand(data)->inner_sites(data);
  double sum = 0;
  for (const InnerSite& each : sites.all)
    if (each.place.kind == subject::PlaceKind::member) sum += each.redundancy;
  const double reactions = 3.0 * static_cast<double>(f.supports.size());
  EXPECT_NEAR(sum, static_cast<double>(f.members.size()) + reactions - 3 * static_cast<double>(f.nodes.size()), 1e-9);
}

// The compliance that a weak member adds, (1/0.7 − 1) L/EA, is read off the residuals of its place, which explains
// them.
TEST(FrameSites, AWeakMemberIsTheOneThatWouldHaveToYield) {
  const Subject drawn = built_in("truss-45"), weak = with(drawn, "factor@C0a", 0.7);
  const compare::Comparison c = compare::compare(drawn, readings_of(drawn, weak));
  ASSERT_FALSE(c.inner.empty());
  EXPECT_GT(c.inner.front().share, 0.9);
  const auto own = std::find_if(c.inner.begin(), c.inner.end(), [](const auto& s) { return s.site == "C0a"; });
  ASSERT_NE(own, c.inner.end());
  EXPECT_GT(own->gain, 0.95 * c.inner.front().gain);
  // The model's redundancy r takes the factor: elongation beyond the model's per force of the model, to first order in
  // r.
  const double E = 210e9, A = M_PI / 4 * (0.03 * 0.03 - 0.025 * 0.025), L = 0.8, more = 1 / 0.7 - 1;
  const double expected = L / (E * A) * more / (1 + own->redundancy * more);
  EXPECT_NEAR(own->per_force, expected, 4 * own->deviation + 0.02 * expected);
  EXPECT_EQ(c.curves.size(), 6u);
}

// What statics determines is carried as predicted, whatever the sensors say.
TEST(FrameSites, NoResidualForceWhereStaticsDeterminesIt) {
  const Subject drawn = built_in("truss-45"), weak = with(drawn, "factor@C1b", 0.5);
  const compare::Comparison c = compare::compare(drawn, readings_of(drawn, weak));
  ASSERT_EQ(c.residual_forces.size(), std::ssize(c.study.inner.all));
  double most = 0, determinate = 0;
  for (std::size_t k = 0; k < c.study.inner.all.size(); ++k) {
    const double f = std::abs(c.residual_forces(as_index(k)));
    double& to = c.study.inner.all[k].determinate ? determinate : most;
    to = std::max(to, f);
  }
  EXPECT_GT(most, 1);
  EXPECT_LT(determinate, 1e-6 * most);
}

// A soft spring between a node and the ground changes what a sensor records by −k times the node's motion times what a
// unit force there does, to first order in k. A newton per metre is little beside what these frames hold with.
TEST(NodeMotions, TellWhatASoftSpringAtTheNodeChanges) {
  for (const char* name : {"truss-45", "portal-semi-rigid", "lattice-girder", "beam-on-springs"}) {
    const Subject s = built_in(name);
    const measurement::Measurements data = readings_of(s, s);
    const auto standing = s.stand(data);
    prediction::PredictionOptions linear;
    linear.geometry = Geometry::linear;
    const std::vector<VectorX> drawn = standing->predict(data, linear, parallel::alone);
    const std::vector<subject::NodeMotion> all = standing->node_motions(data);
    ASSERT_FALSE(all.empty()) << name;
    std::size_t at_nodes = 0;
    for (const subject::NodeMotion& node : all) {
      if (node.place.kind != subject::PlaceKind::node) continue;
      const std::size_t freedom = node.place.freedoms.front();
      const double k = freedom < 3 ? 1 : 1e-2;  // N/m, Nm/rad
      frame::FrameDescription held = *s.frame();
      frame::FrameSpring spring;
      spring.node = node.place.path.substr(std::string("nodes.").size());
      spring.stiffness[freedom] = k;
      held.springs.emplace_back("soft", spring);
      const std::vector<VectorX> after = Subject(held).stand(data)->predict(data, linear, parallel::alone);
      double apart = 0, size = 0, rounding = 0;
      for (std::size_t i = 0; i < after.size(); ++i) {
        const VectorX told = -k * node.by_reading(as_index(i)) * node.moves;
        apart += ((after[i] - drawn[i]).tail(told.size()) - told).squaredNorm();
        size += told.squaredNorm();
        rounding += drawn[i].squaredNorm();
      }
      EXPECT_LE(std::sqrt(apart), 1e-2 * std::sqrt(size) + 1e-12 * std::sqrt(rounding))
          << name << " " << subject::id_of(node.place);
      ++at_nodes;
    }
    EXPECT_GT(at_nodes, 3u) << name;
  }
}

}  // namespace
}  // namespace deflect
