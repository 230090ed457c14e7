// Effects that explain a frame's readings only together: against larger tolerances, and against each other. The
// readings are the frame solver's own; foreign_pairs_test.cpp has sets of foreign make.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "msa/frame/file/frame_file.h"
#include "tests/support/effects.h"
#include "tests/support/effects_everywhere.h"
#include "tests/support/paths.h"
#include "validation/diagnosis/diagnosis.h"
#include "validation/diagnosis/larger_tolerances.h"
#include "validation/effects/with_effect.h"
#include "validation/statistics/evidence.h"
#include "validation/subject/simulate_frame.h"

namespace deflect {
namespace {

frame::FrameDescription portal() {
  frame::FrameDescription f =
      frame::read_frame(std::filesystem::path(test::source_dir()) / "validation/frames/portal-semi-rigid.yaml");
  f.geometry = Geometry::finite;
  return f;
}

struct Hidden {
  std::string effect;
  double value;
};

/// What is said to be missing in a portal within its tolerances that hides these, sorted.
std::vector<std::string> missing_in(const std::vector<Hidden>& hidden, std::uint64_t seed) {
  const subject::Subject drawn = portal();
  const std::vector<effects::Effect> all = test::effects_everywhere(drawn);
  subject::Subject truth = drawn;
  for (const Hidden& h : hidden) {
    const auto e =
        std::find_if(all.begin(), all.end(), [&](const effects::Effect& each) { return each.name == h.effect; });
    truth = effects::with_effect(truth, {{&*e, {}}, test::values({h.value})});
  }
  prediction::SimulationOptions o;
  o.seed = seed;
  const measurement::Measurements data =
      subject::simulate_frame(*truth.frame(), subject::frame_campaign("random", *truth.frame(), seed), o);
  const diagnosis::Diagnosis d = diagnosis::diagnose(drawn, data, all, {{}, 199});
  std::vector<std::string> out;
  if (!d.unexplained)
    for (const effects::PlacedEffect& e : d.missing) out.push_back(e.effect->name);
  std::sort(out.begin(), out.end());
  return out;
}

// Each alone leaves what the other does, which strains the tolerances of many parts: with all of them three times as
// large the readings are likelier than with one effect, and less likely than with both. Before, nothing was called
// missing.
TEST(SeveralEffects, AreLikelierThanLargerTolerancesThoughNoneAloneIs) {
  for (const std::uint64_t seed : {1, 2})
    EXPECT_EQ(missing_in({{"factor@beam_1.start.ry", 1.65}, {"load_gain", 0.968}}, seed),
              (std::vector<std::string>{"factor@beam_1.start.ry", "load_gain"}))
        << seed;
}

// Once one of them counts as right, the other alone looks likelier: they took each other's place, and were never asked
// for together.
TEST(SeveralEffects, ThatTakeEachOthersPlaceAreFoundTogether) {
  for (const std::uint64_t seed : {1, 2})
    EXPECT_EQ(missing_in({{"factor@sections.post.wall", 0.829}, {"settled@support.D.ry", 2.4e-5}}, seed),
              (std::vector<std::string>{"factor@sections.post.wall", "settled@support.D.ry"}))
        << seed;
}

// A modulus is a tolerance of this frame: a change of it is learnt at the other poses, and the held-out error changes
// by chance alone, to one side or the other. A sensor that reads a fifth too much is not.
TEST(SeveralEffects, TheHeldOutErrorMayStay) {
  const subject::Subject drawn = portal();
  const std::vector<effects::Effect> all = test::effects_everywhere(drawn);
  prediction::SimulationOptions one;
  one.seed = 1;
  const measurement::Measurements data =
      subject::simulate_frame(*drawn.frame(), subject::frame_campaign("random", *drawn.frame(), 1), one);
  const diagnosis::Observations o(drawn, data, {});
  const auto with = [&](const std::string& name, double value) {
    const auto e = std::find_if(all.begin(), all.end(), [&](const effects::Effect& each) { return each.name == name; });
    return effects::with_effect(drawn, {{&*e, {}}, test::values({value})});
  };
  const subject::Subject stiffer = with("modulus", 1.02), misread = with("gain@mid_z", 1.2);
  EXPECT_NE(o.held_out_rmse(stiffer), o.held_out_rmse(drawn));
  EXPECT_TRUE(o.falls_held_out(stiffer, drawn));
  EXPECT_TRUE(o.falls_held_out(drawn, stiffer));
  EXPECT_FALSE(o.falls_held_out(misread, drawn));
  EXPECT_TRUE(o.falls_held_out(drawn, misread));
}

TEST(SeveralEffects, ShareTheirWeightAmongTheCandidatesAsTheseShareTheirOwn) {
  std::vector<diagnosis::Candidate> all(2);
  all[0].log_odds = 3;
  all[1].log_odds = 1;
  diagnosis::LargerTolerances larger;
  larger.log_odds = 5;
  EXPECT_EQ(diagnosis::log_weights(all, larger), (std::vector<double>{3, 1, 5, 0})) << "each alone";
  EXPECT_EQ(diagnosis::log_weights(all, larger, 2), (std::vector<double>{3, 1, 5, 0})) << "no likelier than one";
  const std::vector<double> together = diagnosis::log_weights(all, larger, 7);
  EXPECT_NEAR(statistics::log_sum_exp({together[0], together[1]}), 7, 1e-12);
  EXPECT_NEAR(together[0] - together[1], 2, 1e-12);
  EXPECT_EQ(together[2], 5);
  EXPECT_EQ(together[3], 0);
}

}  // namespace
}  // namespace deflect
