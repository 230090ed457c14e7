// The same random frames in other words must get the same answers: other sizes, another unit of force, another order of
// what they consist of, turned and mirrored axes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>

#include "msa/base/error.h"
#include "msa/frame/file/frame_analysis.h"
#include "msa/frame/file/frame_file.h"
#include "tests/attack/count.h"
#include "tests/attack/frame_forms.h"
#include "tests/attack/frame_judge.h"

namespace deflect::attack {
namespace {

using frame::FrameDescription;

/// Displacements by case and node, or why there are none.
struct Said {
  bool answered = false;
  std::string words;
  std::vector<std::vector<Vector6>> cases;
};

using Restored = std::function<Vector6(const Vector6&)>;

/// The answer to another form of a frame, by the nodes of the first one and as it has them.
Said say(const FrameDescription& form, const FrameDescription& first, const Restored& restored) {
  Said out;
  try {
    const frame::FrameResult r = frame::analyse(form);
    out.words = frame::failed_check(r);
    out.answered = out.words.empty();
    for (const frame::CaseResult& c : r.cases) {
      out.cases.emplace_back();
      for (const auto& [name, p] : first.nodes)
        for (std::size_t i = 0; i < form.nodes.size(); ++i)
          if (form.nodes[i].first == name) out.cases.back().push_back(restored(c.displacements[i]));
    }
  } catch (const std::runtime_error& e) {
    out.words = e.what();
  }
  return out;
}

struct Form {
  std::string name;
  std::optional<FrameDescription> frame;
  Restored restored;
};

std::vector<Form> forms_of(const FrameDescription& f, unsigned seed) {
  Dice dice(seed + 777);
  const auto sized = [](double s) {
    return [s](const Vector6& d) { return Vector6((Vector6() << d.head<3>() / s, d.tail<3>()).finished()); };
  };
  const auto in_axes = [](const Matrix3& R) {
    return [R](const Vector6& d) {
      return Vector6(
          (Vector6() << R.transpose() * d.head<3>(), R.determinant() * (R.transpose() * d.tail<3>())).finished());
    };
  };
  const Restored same = [](const Vector6& d) { return d; };
  const Matrix3 R = any_rotation(dice), S = signed_permutation(dice);
  return {{"1000 times larger", scaled(f, 1e3), sized(1e3)},
          {"1000 times smaller", scaled(f, 1e-3), sized(1e-3)},
          {"forces in lbf", in_force_unit(f, 1 / 4.4482216152605), same},
          {"in another order", shuffled(f, dice), same},
          {S.determinant() > 0 ? "axes exchanged" : "mirrored", turned(f, S), in_axes(S)},
          {"turned", turned(f, R), in_axes(R)}};
}

class FrameInvariance : public ::testing::TestWithParam<unsigned> {};

TEST_P(FrameInvariance, TheSameFrameInOtherWordsGetsTheSameAnswer) {
  for (unsigned seed = GetParam(); seed < usual_count; seed += shards) {
    const RandomFrame random = random_frame(seed);
    const Judgement first = judge(random);
    if (is_wrong(first.outcome) || (random.kind == FrameKind::nearly_singular && !digits_left(first.condition)))
      continue;  // judged elsewhere
    const FrameDescription f = scaled(random.ideal, random.unit);
    const Said right = say(f, f, [](const Vector6& d) { return d; });
    const StandingVerdict verdict = can_stand(random.ideal);
    const double allowed = 2 * allowed_error(first.condition, first.warned);
    for (const Form& form : forms_of(f, seed)) {
      if (!form.frame) continue;
      const Said said = say(*form.frame, f, form.restored);
      double error = 0;
      for (std::size_t c = 0; c < right.cases.size() && said.answered && right.answered; ++c)
        error = std::max(error, field_difference(said.cases[c], right.cases[c], extent(f), verdict.turns,
                                                 1e-6 * first.largest_response * random.unit));
      if (said.answered == right.answered && error <= allowed) continue;
      const std::filesystem::path file =
          failures_folder() / fmt::format("frame-{}-{}.yaml", seed, form.name.substr(0, form.name.find(' ')));
      std::ofstream(file) << frame::write_frame(*form.frame);
      ADD_FAILURE() << form.name << ": " << (right.answered ? "answered" : "refused") << " before, then "
                    << (said.answered ? fmt::format("{:.1e} off (condition {:.1e})", error, first.condition)
                                      : "refused: " + said.words)
                    << "\n  " << reproduction(random, first) << "\n  deflect frame " << file.string();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shard, FrameInvariance, ::testing::Range(0u, shards));

}  // namespace
}  // namespace deflect::attack
