// What may happen where the parts of a frame are joined, whether or not a law describes it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <set>

#include "msa/frame/file/frame_file.h"
#include "tests/support/effects_everywhere.h"
#include "tests/support/paths.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/whatever_columns.h"
#include "validation/effects/place_effects.h"
#include "validation/effects/with_effect.h"
#include "validation/statistics/columns.h"
#include "validation/subject/simulate_frame.h"

namespace deflect::diagnosis {
namespace {

frame::FrameDescription built_in(const std::string& name) {
  return frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames" / (name + ".yaml"));
}

frame::FrameDescription in_finite_geometry(frame::FrameDescription f) {
  f.geometry = Geometry::finite;
  return f;
}

measurement::Measurements read(const subject::Subject& true_one, const frame::FrameDescription& drawn,
                               std::uint64_t seed = 5) {
  prediction::SimulationOptions o;
  o.seed = seed;
  return subject::simulate_frame(*true_one.frame(), subject::frame_campaign("rich", drawn, 1), o);
}

Diagnosis diagnosed_quickly(const subject::Subject& subject, const measurement::Measurements& data,
                            const std::vector<effects::Effect>& known) {
  DiagnosisOptions options;
  options.bootstrap_sets = 99;
  return diagnose(subject, data, known, options, {});
}

bool is_joint(const subject::Place& p) {
  return p.others.empty() && (p.kind == subject::PlaceKind::member_end || p.kind == subject::PlaceKind::support ||
                              p.path.starts_with("springs."));
}

/// A thousandth of the search's first size.
VectorX small(const effects::Effect& e) {
  const double start = e.parameters.front().start, vanishes = *e.parameters.front().vanishes;
  return VectorX::Constant(1, std::isinf(vanishes) ? 1e3 * start : vanishes + 1e-3 * (start - vanishes));
}

class JointsOfFrames : public ::testing::TestWithParam<const char*> {
 protected:
  /// What a little of an effect does.
  VectorX change_by(const effects::Effect& e) const {
    return o.residual(effects::with_effect(subject, {{&e, {}}, small(e)})) - o.residual(subject);
  }

  const frame::FrameDescription drawn = built_in(GetParam());
  const subject::Subject subject{drawn};
  const measurement::Measurements data = read(subject, drawn);
  const Observations o{subject, data, {}};
  const Changes changes{o, {}, 1};
  const std::vector<effects::Effect> all = test::effects_everywhere(subject);
};

// A spring in series, of small compliance c, moves its sides by c f under the force f of the drawn frame, up to terms
// of the order of c times the stiffness around. A prediction with it says the same as the columns at its place.
TEST_P(JointsOfFrames, ColumnsSpanWhatASpringInSeriesDoes) {
  const auto columns = whatever_columns(o, changes);
  std::size_t looked = 0;
  for (const effects::Effect& e : all) {
    const bool linear = e.name.starts_with("linear@") || e.name.starts_with("factor@spring.");
    if (!e.place || !is_joint(*e.place) || !linear) continue;
    const VectorX change = change_by(e);
    if (change.norm() == 0) continue;
    const auto here = columns.find(spot_of(*e.place, {}));
    ASSERT_NE(here, columns.end()) << e.name;
    const MatrixX span = statistics::orthonormal(here->second);
    EXPECT_LT((change - span * (span.transpose() * change)).norm(), 1e-3 * change.norm()) << e.name;
    ++looked;
  }
  EXPECT_GT(looked, 5u);
}

// A contact flattens as f^(2/3), which is neither a spring nor a step. Sums of powers and lines that bend come as near
// as 1.1e-3 of its norm, for contacts of any size: what is left is of the curve and not of the forces or the response.
TEST_P(JointsOfFrames, AnyCurveSpansWhatAContactDoes) {
  std::size_t looked = 0, groups = 0;
  for (const effects::Effect& e : all) {
    if (!e.place || !e.name.starts_with("contact@")) continue;
    const VectorX change = change_by(e);
    if (change.norm() == 0) continue;
    ASSERT_TRUE(changes.knows_forces_at(*e.place)) << e.name;
    const MatrixX powers = changes.by_any_curve({&e, {}}, Curves::powers),
                  lines = changes.by_any_curve({&e, {}}, Curves::broken_lines);
    const MatrixX span = statistics::orthonormal(statistics::side_by_side({powers, lines}, change.size()));
    EXPECT_LT((change - span * (span.transpose() * change)).norm(), 2e-3 * change.norm()) << e.name;
    ++looked;
    groups += e.place->others.empty() ? 0 : 1;
  }
  EXPECT_GT(looked, 2u);
  EXPECT_GT(groups, 0u);
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, JointsOfFrames,
                         testing::Values("beam-on-springs", "portal-semi-rigid", "lattice-girder"), [](const auto& at) {
                           std::string out = at.param;
                           std::replace(out.begin(), out.end(), '-', '_');
                           return out;
                         });

// Two rails meet at a node: what yields at the end of one does the same as at the start of the next. Without any law
// there the place is told all the same, and not its neighbours.
TEST(JointOfAFrame, WithoutALawIsToldAsThePlace) {
  const frame::FrameDescription drawn = built_in("beam-on-springs");
  const subject::Subject subject(drawn);
  std::vector<effects::Effect> all = test::effects_everywhere(subject);
  const effects::Effect hidden = effects::find_effect(all, "linear@rail5.end.ry");
  const measurement::Measurements data =
      read(effects::with_effect(subject, {{&hidden, {}}, VectorX::Constant(1, 2e8)}), drawn);
  const std::set<std::string> here = {"members.rail5.end", "members.rail6.start"};
  std::erase_if(all, [&](const effects::Effect& e) { return e.place && here.contains(e.place->path); });
  const Diagnosis d = diagnosed_quickly(subject, data, all);
  EXPECT_EQ(d.verdict, Verdict::unknown_effect);
  ASSERT_FALSE(d.localised.empty());
  for (const Localised& l : d.localised) EXPECT_TRUE(here.contains(l.place.path)) << l.what;
}

// What a contact at one support leaves beside a spring and play there, which were found, is told there too and not of
// both supports.
TEST(JointOfAFrame, AContactWithoutItsLawIsToldAtItsSupport) {
  const frame::FrameDescription drawn = in_finite_geometry(built_in("portal-semi-rigid"));
  const subject::Subject subject(drawn);
  std::vector<effects::Effect> all = test::effects_everywhere(subject);
  const effects::Effect hidden = effects::find_effect(all, "contact@support.A.ux");
  const measurement::Measurements data =
      read(effects::with_effect(subject, {{&hidden, {}}, VectorX::Constant(1, 3e-3)}), drawn);
  std::erase_if(all, [&](const effects::Effect& e) { return e.name == hidden.name; });
  const Diagnosis d = diagnosed_quickly(subject, data, all);
  EXPECT_EQ(d.verdict, Verdict::unknown_effect);
  ASSERT_FALSE(d.localised.empty());
  for (const Localised& l : d.localised) EXPECT_EQ(subject::id_of(l.place), "support.A.ux") << l.what;
}

// Play at both feet of a frame. A little of it moves the readings in another way than as much as there is, so that play
// at one foot seems to explain more; play at both is asked from there.
TEST(JointOfAFrame, PlayAtBothSupportsIsNamedOnce) {
  const frame::FrameDescription drawn = in_finite_geometry(built_in("portal-semi-rigid"));
  const subject::Subject subject(drawn);
  const std::vector<effects::Effect> all = test::effects_everywhere(subject);
  const effects::Effect hidden = effects::find_effect(all, "clearance@supports.ry");
  const measurement::Measurements data =
      read(effects::with_effect(subject, {{&hidden, {}}, VectorX::Constant(1, 2.6e-5)}), drawn, 1917001);
  const Diagnosis d = diagnosed_quickly(subject, data, all);
  EXPECT_EQ(d.verdict, Verdict::effect);
  ASSERT_EQ(d.missing.size(), 1u);
  EXPECT_EQ(d.missing.front().effect->name, hidden.name);
}

}  // namespace
}  // namespace deflect::diagnosis
