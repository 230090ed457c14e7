// Frames whose nodes are off the drawing: what is known of the frame drawn serves, or each is solved by itself, and
// both read the same. Loads that are held while they are read again.
#include <gtest/gtest.h>

#include <filesystem>

#include "msa/frame/file/frame_file.h"
#include "msa/frame/file/frame_tolerances.h"
#include "tests/support/paths.h"
#include "validation/compare/comparison.h"
#include "validation/subject/simulate_frame.h"
#include "validation/subject/subject.h"

namespace deflect {
namespace {

using namespace measurement;
using subject::Subject;

frame::FrameDescription drawn(const std::string& name) {
  return frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames" / (name + ".yaml"));
}

// The portal has semi-rigid ends: a node that moves turns the axes in which they are rigid. One of its feet has play.
TEST(MovedFrame, SemiRigidEndsBesidePlayAreReadAsByTheAnalysisOfEachReading) {
  const frame::FrameDescription healthy = drawn("portal-semi-rigid");
  frame::FrameDescription loose = healthy;
  for (auto& [node, support] : loose.supports)
    if (node == "D") support.laws.set(0, {ClearanceLaw{1e-4}});
  const Measurements data = subject::frame_campaign("paper", healthy, 1);
  const Subject s(healthy), granted(loose);
  const auto known = s.stand(data);
  const auto quick = granted.stand(data, known.get())->deviations(data);
  const std::vector<NumberMove> moves = frame::number_moves(loose);
  std::size_t nodes = 0;
  for (std::size_t k = 0; k < moves.size(); ++k) {
    ASSERT_EQ(quick->tolerances()[k].name, moves[k].name);
    nodes += moves[k].name.starts_with("node ");
    const std::vector<VectorX> near = quick->with(k)->predict(data, {});
    const frame::FrameDescription moved = frame::moved(loose, moves[k], quick->tolerances()[k].step);
    const std::vector<VectorX> alone = Subject(moved).stand(data)->predict(data, {});
    ASSERT_EQ(near.size(), alone.size());
    for (std::size_t i = 0; i < near.size(); ++i) {
      EXPECT_GT(alone[i].norm(), 0);
      EXPECT_LE((near[i] - alone[i]).norm(), 1e-9 * alone[i].norm()) << moves[k].name << ", reading " << i;
    }
  }
  EXPECT_EQ(nodes, 10u);
}

// Each step of a loop is read twice, while its load is held: the second reading belongs to the branch of the first.
TEST(MovedFrame, AStepThatIsReadAgainStaysOnItsBranch) {
  const frame::FrameDescription f = drawn("beam-on-springs");
  const auto branches = [&](const Measurements& plan) {
    const compare::Comparison c = compare::compare(Subject(f), subject::simulate_frame(f, plan, {}));
    std::vector<std::size_t> out;
    for (const compare::Errors& e : c.by_heading) out.push_back(e.readings);
    return out;
  };
  const Measurements once = subject::frame_campaign("cycle", f, 1);
  Measurements twice = once;
  twice.readings.clear();
  twice.poses.front().readings.clear();
  for (const Reading& r : once.readings)
    for (int k = 0; k < 2; ++k) {
      twice.poses.front().readings.push_back(twice.readings.size());
      twice.readings.push_back(r);
      twice.readings.back().sequence = static_cast<double>(twice.readings.size());
    }
  std::vector<std::size_t> expected = branches(once);
  ASSERT_EQ(expected.size(), 2u);
  for (std::size_t& count : expected) count *= 2;
  EXPECT_EQ(branches(twice), expected);
}

}  // namespace
}  // namespace deflect
