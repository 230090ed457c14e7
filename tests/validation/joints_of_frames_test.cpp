// What may happen where the parts of a frame are joined, whether or not a law describes it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
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

measurement::Measurements read(const subject::Subject& true_one, const frame::FrameDescription& drawn) {
  prediction::SimulationOptions o;
  o.seed = 5;
  return subject::simulate_frame(*true_one.frame(), subject::frame_campaign("rich", drawn, 1), o);
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

class JointsOfFrames : public ::testing::TestWithParam<const char*> {};

// A spring in series, of small compliance c, moves its sides by c f under the force f of the drawn frame, up to terms
// of the order of c times the stiffness around. A prediction with it says the same as the columns at its place.
TEST_P(JointsOfFrames, ColumnsSpanWhatASpringInSeriesDoes) {
  const frame::FrameDescription drawn = built_in(GetParam());
  const subject::Subject subject(drawn);
  const measurement::Measurements data = read(subject, drawn);
  const Observations o(subject, data, {});
  const Changes changes(o, {}, 1);
  const auto columns = whatever_columns(o, changes);
  const std::vector<effects::Effect> all = test::effects_everywhere(subject);
  std::size_t looked = 0;
  for (const effects::Effect& e : all) {
    const bool linear = e.name.starts_with("linear@") || e.name.starts_with("factor@spring.");
    if (!e.place || !is_joint(*e.place) || !linear) continue;
    const VectorX change = o.residual(effects::with_effect(subject, {{&e, {}}, small(e)})) - o.residual(subject);
    if (change.norm() == 0) continue;
    const auto here = columns.find(spot_of(*e.place, {}));
    ASSERT_NE(here, columns.end()) << e.name;
    const MatrixX span = statistics::orthonormal(here->second);
    EXPECT_LT((change - span * (span.transpose() * change)).norm(), 1e-3 * change.norm()) << e.name;
    ++looked;
  }
  EXPECT_GT(looked, 5u);
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
  DiagnosisOptions options;
  options.bootstrap_sets = 99;
  const Diagnosis d = diagnose(subject, data, all, options, {});
  EXPECT_EQ(d.verdict, Verdict::unknown_effect);
  ASSERT_FALSE(d.localised.empty());
  for (const Localised& l : d.localised) EXPECT_TRUE(here.contains(l.place.path)) << l.what;
}

}  // namespace
}  // namespace deflect::diagnosis
