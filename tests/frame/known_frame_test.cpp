// Readings of frames near a known one against the whole analysis of each.
#include "msa/frame/file/known_frame.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

#include "msa/base/index.h"
#include "msa/frame/file/frame_analysis.h"
#include "msa/frame/file/frame_file.h"
#include "msa/frame/file/frame_sensors.h"
#include "msa/frame/file/frame_tolerances.h"
#include "tests/support/paths.h"

namespace deflect::frame {
namespace {

/// One of every kind that the frame allows: all motions of all nodes, all reactions, forces at three places of all
/// members.
Named<FrameSensor> everything(const FrameDescription& f) {
  Named<FrameSensor> out;
  const auto add = [&](FrameSensor s) { out.emplace_back(fmt::format("s{}", out.size()), std::move(s)); };
  for (std::size_t i = 0; i < 6; ++i) {
    FrameSensor s;
    s.component = i;
    s.axis = Vector3::Unit(as_index(i % 3));
    s.rotation = i >= 3;
    s.reads = FrameSensor::Reads::displacement;
    for (const auto& [name, at] : f.nodes) s.of = name, add(s);
    s.reads = FrameSensor::Reads::reaction;
    for (const auto& [name, support] : f.supports) s.of = name, add(s);
    s.reads = FrameSensor::Reads::force;
    for (const auto& [name, member] : f.members)
      for (const double at : {0.0, 0.3, 1.0}) s.of = name, s.at = at, add(s);
  }
  return out;
}

/// Sums over the loads of unit size, each alone, then all together by halves.
MatrixX some_factors(std::size_t loads) {
  const auto n = as_index(loads);
  MatrixX out = MatrixX::Zero(n, 2 * n + 2);
  out.leftCols(n).setIdentity();
  out.middleCols(n, n) = -0.7 * MatrixX::Identity(n, n);
  out.col(2 * n).setConstant(0.5);
  return out;
}

/// By analyse(), each column a load case.
MatrixX analysed(FrameDescription f, const Named<FrameSensor>& sensors, const MatrixX& factors, bool in_sequence) {
  const Named<LoadCase> loads = f.loads;
  f.loads.clear();
  for (Eigen::Index c = 0; c < factors.cols(); ++c) {
    LoadCase sum;
    for (Eigen::Index k = 0; k < factors.rows(); ++k) {
      const LoadCase& load = nth(loads, k).second;
      const double times = load.factor * factors(k, c);
      for (const auto& [node, wrench] : load.nodes) sum.nodes.emplace_back(node, times * wrench);
      for (const auto& [member, line] : load.members)
        sum.members.emplace_back(member, LineLoad{times * line.q, line.member_axes});
      for (const auto& [member, kelvin] : load.temperature) sum.temperature.emplace_back(member, times * kelvin);
      sum.gravity += times * load.gravity;
      EXPECT_TRUE(load.displacements.empty());
    }
    f.loads.emplace_back(fmt::format("{}", c), sum);
  }
  FrameOptions options;
  options.in_sequence = in_sequence;
  const FrameResult result = analyse(f, options);
  EXPECT_EQ(failed_check(result), "");
  MatrixX out(std::ssize(sensors), factors.cols());
  for (Eigen::Index c = 0; c < factors.cols(); ++c)
    for (Eigen::Index k = 0; k < out.rows(); ++k)
      out(k, c) = true_reading(nth(sensors, k).second, f, result.structure, nth(result.cases, c));
  return out;
}

/// The largest difference, relative to the largest displacement or force of the frame, rotations and moments by a
/// metre; −1: not near enough.
double off(const KnownFrame& known, const FrameDescription& f, bool in_sequence = false) {
  const Named<FrameSensor> sensors = everything(f);
  std::vector<const FrameSensor*> all;
  for (const auto& [name, sensor] : sensors) all.push_back(&sensor);
  const MatrixX factors = some_factors(f.loads.size());
  const std::optional<MatrixX> read = known.readings(f, f.loads, all, factors, in_sequence);
  if (!read) return -1;
  const MatrixX wanted = analysed(f, sensors, factors, in_sequence);
  const auto kind = [&](std::size_t k) {
    const bool moves = all[k]->reads == FrameSensor::Reads::displacement;
    return (moves ? 0 : 2) + ((moves ? all[k]->rotation : all[k]->component >= 3) ? 1 : 0);
  };
  Eigen::Vector4d most = Eigen::Vector4d::Zero(), worst = most;
  for (std::size_t k = 0; k < all.size(); ++k) {
    most(kind(k)) = std::max(most(kind(k)), wanted.row(as_index(k)).cwiseAbs().maxCoeff());
    worst(kind(k)) = std::max(worst(kind(k)), (wanted - *read).row(as_index(k)).cwiseAbs().maxCoeff());
  }
  const double moves = std::max(most(0), most(1)), forces = std::max(most(2), most(3));
  return std::max({worst(0) / moves, worst(1) / moves, worst(2) / forces, worst(3) / forces});
}

FrameDescription built_in(const std::string& name) {
  return read_frame(std::filesystem::path(test::source_dir()) / "validation/frames" / (name + ".yaml"));
}

FrameDescription with(const FrameDescription& f, const std::vector<std::pair<std::string, std::string>>& appended) {
  std::vector<Edit> edits;
  for (const auto& [path, law] : appended) edits.push_back({path, law, Edit::Action::append});
  return edited(f, edits);
}

constexpr double rounding = 1e-9;

// Tolerances of every kind that the built-in frames declare, ten times as large, and members that are soft or missing.
TEST(KnownFrame, ReadsWhatAnAnalysisOfOtherNumbersReads) {
  for (const char* name : {"truss-45", "portal-semi-rigid", "lattice-girder", "beam-on-springs"}) {
    const FrameDescription f = built_in(name);
    const KnownFrame known(f, f.loads);
    EXPECT_LT(off(known, f), rounding) << name;
    EXPECT_GE(off(known, f), 0) << name;
    const std::vector<NumberMove> moves = number_moves(f);
    int near = 0, all = 0;
    for (std::size_t k = 0; k < moves.size(); k += 7) {
      const double each = off(known, moved(f, moves[k], 10));
      EXPECT_LT(each, rounding) << name << " " << moves[k].name;
      near += each >= 0;
      ++all;
    }
    EXPECT_EQ(near, all) << name;
    for (std::size_t m = 0; m < f.members.size(); m += 5)
      for (const double factor : {0.9, 0.02, 30.0}) {
        FrameDescription other = f;
        other.members[m].second.factor = factor;
        const double each = off(known, other);
        EXPECT_LT(each, rounding) << name << " " << f.members[m].first << " times " << factor;
        EXPECT_GE(each, 0) << name << " " << f.members[m].first << " times " << factor;
      }
  }
}

struct Case {
  const char* frame;
  std::vector<std::pair<std::string, std::string>> laws;
  bool in_sequence = false;
};

class WithLaws : public testing::TestWithParam<Case> {};

// Laws where the known frame is rigid, elastic or free; alone, several, in series, side by side, with other numbers.
TEST_P(WithLaws, ReadsWhatAnAnalysisReads) {
  const Case& c = GetParam();
  const FrameDescription f = built_in(c.frame), other = with(f, c.laws);
  const KnownFrame known(f, f.loads);
  const double once = off(known, other, c.in_sequence);
  EXPECT_LT(once, rounding);
  EXPECT_GE(once, 0);
  FrameDescription softer = other;
  softer.members.front().second.factor = 0.6;
  const double twice = off(known, softer, c.in_sequence);
  EXPECT_LT(twice, rounding);
  EXPECT_GE(twice, 0);
  // The frame with the laws is known, and read without some of its numbers.
  const KnownFrame of_other(other, other.loads);
  EXPECT_LT(off(of_other, softer, c.in_sequence), rounding);
}

INSTANTIATE_TEST_SUITE_P(
    KnownFrame, WithLaws,
    testing::Values(
        Case{"truss-45", {{"supports.P0a.ux", "{law: linear, stiffness: 3e4 N/mm}"}}},
        Case{"truss-45", {{"supports.P0b.ux", "{law: clearance, gap: 0.1 mm}"}}},
        Case{"truss-45",
             {{"supports.P0b.ux", "{law: one_sided, pull: 1e-5 mm/N}"},
              {"supports.P0b.uz", "{law: power, deflection: 1 um, force: 1 N, exponent: 0.66666666666666663}"},
              {"supports.P0a.uz", "{law: linear, stiffness: 1e5 N/mm}"}}},
        Case{"portal-semi-rigid", {{"members.beam_1.end.ry", "{law: linear, stiffness: 4000 Nm/rad}"}}},
        Case{"portal-semi-rigid", {{"members.beam_1.start.ry", "{law: clearance, gap: 0.5 mrad}"}}},
        Case{"portal-semi-rigid",
             {{"members.beam_2.start.ry", "{law: linear, stiffness: 4000 Nm/rad}"},
              {"members.left.start.rz", "{law: clearance, gap: 0.5 mrad}"},
              {"supports.D.ux", "{law: one_sided, push: 1e-4 mm/N}"}}},
        // All linear, of sizes three decades apart.
        Case{"portal-semi-rigid",
             {{"members.beam_1.start.ry", "{law: linear, stiffness: 4000 Nm/rad}"},
              {"members.beam_1.end.ry", "{law: linear, stiffness: 4e6 Nm/rad}"},
              {"members.beam_2.start.ry", "{law: linear, stiffness: 9e4 Nm/rad}"},
              {"members.left.start.rz", "{law: linear, stiffness: 2e5 Nm/rad}"}}},
        Case{"lattice-girder", {{"supports.r4.ux", "{law: linear, stiffness: 2e3 N/mm}"}}},
        Case{"lattice-girder", {{"supports.r4.ux", "{law: friction, force: 300 N, stiffness: 1e4 N/mm}"}}, true},
        Case{"lattice-girder",
             {{"supports.r4.ux", "{law: friction, force: 300 N, stiffness: 1e4 N/mm}"},
              {"supports.l4.uz", "{law: linear, stiffness: 5e4 N/mm}"}},
             true},
        Case{"beam-on-springs", {{"springs.pad2.uz", "{law: clearance, gap: 0.05 mm}"}}},
        Case{"beam-on-springs",
             {{"springs.pad2.beside.uz", "{law: friction, force: 400 N, stiffness: 1e4 N/mm}"},
              {"springs.pad3.uz", "{law: one_sided, push: 1e-5 mm/N}"}},
             true},
        Case{"beam-on-springs", {{"members.rail3.end.ry", "{law: linear, stiffness: 1e6 Nm/rad}"}}}));

// Friction of any stiffness beside a spring, through loads in a sequence: stuck it may yield next to nothing.
TEST(KnownFrame, FrictionOfAnyStiffness) {
  const FrameDescription f = built_in("beam-on-springs");
  const KnownFrame known(f, f.loads);
  for (const double stiffness : {1e3, 1e5, 1e6, 1e7})
    for (const double force : {5.0, 68.0, 500.0}) {
      const std::string law = fmt::format("{{law: friction, force: {} N, stiffness: {} N/mm}}", force, stiffness);
      const FrameDescription rubs = with(f, {{"springs.pad3.beside.uz", law}});
      EXPECT_LT(off(known, rubs, true), rounding) << stiffness << " N/mm, " << force << " N";
      EXPECT_GE(off(known, rubs, true), 0) << stiffness << " N/mm, " << force << " N";
    }
}

// By hand: a bar EA/L = k_b behind a spring k_s; play g in series with the spring, then the bar's end moves by
// F/k_s + F/k_b + g, of which the spring's law is known and the play is not.
TEST(KnownFrame, PlayInSeriesByHand) {
  const FrameDescription f = parse_frame(R"(
name: rod
plane: xz
materials: {steel: {E: 200 GPa, nu: 0.3}}
sections: {bar: {shape: rectangle, width_y: 10 mm, height_z: 10 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m]}
members: {bar: {from: A, to: B, section: bar, material: steel}}
supports: {A: {holds: [uz, ry], ux: {law: linear, stiffness: 1e4 N/mm}}}
loads: {pull: {nodes: {B: {fx: 1 N}}}}
)",
                                         "rod");
  const KnownFrame known(f, f.loads);
  const FrameDescription loose = with(f, {{"supports.A.ux", "{law: clearance, gap: 0.3 mm}"}});
  FrameSensor end;
  end.of = "B";
  end.axis = Vector3::UnitX();
  const MatrixX factors = (MatrixX(1, 3) << 500, -500, 0).finished();
  const std::optional<MatrixX> read = known.readings(loose, loose.loads, {&end}, factors, false);
  ASSERT_TRUE(read);
  const double elastic = 500 / 1e7 + 500 / (200e9 * 1e-4);
  EXPECT_NEAR((*read)(0, 0), elastic + 3e-4, 1e-15);
  EXPECT_NEAR((*read)(0, 1), -elastic - 3e-4, 1e-15);
  EXPECT_NEAR((*read)(0, 2), 0, 1e-15);
}

// B and C are one rigid body along x, and both are held: with play at C's support B still holds the body. What passes
// through two rigid supports nobody can say, and a deformation of one of them contradicts the other.
TEST(KnownFrame, PlayBesideWhatHoldsTheSameIsLeftToTheAnalysis) {
  const FrameDescription f = parse_frame(R"(
name: twice-held
plane: xz
materials: {steel: {E: 200 GPa, nu: 0.3}}
sections: {bar: {shape: rectangle, width_y: 10 mm, height_z: 10 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m], C: [2 m, 0 m, 0 m]}
members: {left: {from: A, to: B, section: bar, material: steel}, right: {from: B, to: C, section: bar, material: steel}}
supports: {A: clamped, B: [ux], C: [ux, uz]}
rigid_links: {link: {master: B, nodes: [C], freedoms: [ux]}}
loads: {push: {nodes: {B: {fx: 100 N, fz: 50 N}}}}
)",
                                         "twice-held");
  const KnownFrame known(f, f.loads);
  const FrameDescription loose = with(f, {{"supports.C.ux", "{law: clearance, gap: 0.3 mm}"}});
  EXPECT_EQ(off(known, loose), -1);
  const FrameDescription raised = with(f, {{"supports.C.uz", "{law: clearance, gap: 0.3 mm}"}});
  EXPECT_LT(off(known, raised), rounding);
  EXPECT_GE(off(known, raised), 0);
}

// Loads that the known frame was not solved for are solved by what is known of it.
TEST(KnownFrame, TakesLoadsOfOtherNames) {
  for (const char* name : {"truss-45", "beam-on-springs"}) {
    const FrameDescription f = built_in(name);
    const KnownFrame known(f, f.loads);
    FrameDescription other = f;
    std::reverse(other.loads.begin(), other.loads.end());
    other.loads.front().first += " again";
    EXPECT_LT(off(known, other), rounding) << name;
    EXPECT_GE(off(known, other), 0) << name;
  }
}

// What differs in more than numbers and laws is left to the analysis.
TEST(KnownFrame, KnowsWhatIsNotNear) {
  const FrameDescription f = built_in("truss-45");
  const KnownFrame known(f, f.loads);
  FrameDescription other = f;
  other.members.pop_back();
  EXPECT_EQ(off(known, other), -1);
  other = f;
  other.members.front().second.to = "P2c";
  EXPECT_EQ(off(known, other), -1);
  other = f;
  other.members.front().second.misfit = 1e-4;
  EXPECT_EQ(off(known, other), -1);
  other = f;
  other.supports.front().second[0] = false;
  EXPECT_EQ(off(known, other), -1);
  const FrameDescription yielding = with(f, {{"supports.P0a.ux", "{law: linear, stiffness: 3e4 N/mm}"}});
  EXPECT_EQ(off(KnownFrame(yielding, yielding.loads), f), -1);
  // Beside a member that is all but missing the others are so stiff that they need coordinates of their own.
  FrameDescription soft = f;
  soft.members.front().second.factor = 1e-9;
  EXPECT_EQ(off(KnownFrame(soft, soft.loads), soft), -1);
  EXPECT_LT(off(known, soft), rounding);
}

}  // namespace
}  // namespace deflect::frame
