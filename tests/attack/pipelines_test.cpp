// Random measurements through every command. DEFLECT_ATTACK=2000 test_attack --gtest_filter='PipelinesOnDemand*' prints
// the table of as many; each that fails is shrunk and kept in the folder attack/.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "msa/base/files.h"
#include "tests/attack/count.h"
#include "tests/attack/pipeline_run.h"
#include "tests/support/paths.h"
#include "tests/support/program.h"

namespace deflect::attack {
namespace {

constexpr unsigned usual_pipelines = 50, pipeline_shards = 10;

/// λ² from which the hidden effect is large: 2 Δ ln L.
constexpr double large = 64;

struct PipelineTable {
  std::map<std::string, int> kinds, verdicts, refusals;
  std::map<std::string, int> healthy, hidden;  ///< by what was reported
  std::string failures;
  int shrunk = 0;

  void add(const Pipeline& p, const PipelineJudgement& j) {
    ++kinds[pipeline_kind_names[static_cast<int>(p.kind)]];
    if (!j.refused.empty()) ++refusals[j.refused.substr(0, std::min<std::size_t>(120, j.refused.find('\n')))];
    if (!j.verdict.empty()) ++verdicts[j.verdict];
    if (!j.verdict.empty() && !j.mistaken) count_truth(p, j);
    for (const Contradiction& c : j.wrong)
      failures += fmt::format("seed {} ({}): {}: {}\n", p.seed, pipeline_kind_names[static_cast<int>(p.kind)], c.check,
                              c.words);
    if (!j.wrong.empty() && shrunk++ < 3) failures += "  shrunk: " + attack::shrunk(p, j.wrong.front()) + "\n";
  }

  void count_truth(const Pipeline& p, const PipelineJudgement& j) {
    if (p.hidden.empty()) {
      ++healthy[j.missing.empty() && j.verdict == "nothing_missing" ? "nothing" : "an alarm"];
      return;
    }
    if (p.hidden.size() > 1 || j.gain < large) return;
    const std::string truth = placed_name(p.hidden.front().name, p.hidden.front().leg.value_or(0));
    const bool reported = std::find(j.reported.begin(), j.reported.end(), truth) != j.reported.end();
    const bool sure = j.verdict == "effect" && j.probability > 0.95;
    ++hidden[reported                        ? "the truth among what is reported"
             : j.verdict == "unknown_effect" ? "unknown"
             : j.missing.empty()             ? "nothing"
             : sure                          ? "another with confidence"
                                             : "another"];
  }

  std::string text() const {
    std::string out;
    for (const auto& [title, counts] : {std::pair{"pipelines", kinds},
                                        {"refused by", refusals},
                                        {"verdicts", verdicts},
                                        {"healthy, reported", healthy},
                                        {"one large effect hidden, reported", hidden}}) {
      out += fmt::format("{}\n", title);
      for (const auto& [name, count] : counts) out += fmt::format("  {:<34}{:>6}\n", name, count);
    }
    return out;
  }
};

/// `every` > 0: the table so far is printed after as many, so that work of hours that is stopped has told something.
PipelineTable judged(unsigned first, unsigned last, unsigned step, unsigned every = 0) {
  PipelineTable table;
  for (unsigned seed = first; seed < last; seed += step) {
    if (const auto p = random_pipeline(seed)) table.add(*p, judge(*p));
    if (every == 0 || (seed + 1) % every != 0) continue;
    fmt::print("before seed {}\n{}{}", seed + 1, table.text(), table.failures);
    std::fflush(stdout);
  }
  return table;
}

class Pipelines : public ::testing::TestWithParam<unsigned> {};

TEST_P(Pipelines, NeverContradictThemselves) {
  const PipelineTable table = judged(GetParam(), usual_pipelines, pipeline_shards);
  EXPECT_TRUE(table.failures.empty()) << table.failures;
}

INSTANTIATE_TEST_SUITE_P(Shard, Pipelines, ::testing::Range(0u, pipeline_shards));

TEST(PipelinesOnDemand, NeverContradictThemselves) {
  if (count_on_demand() == 0) GTEST_SKIP() << "set DEFLECT_ATTACK to the number of pipelines";
  const PipelineTable table = judged(first_on_demand(), count_on_demand(), 1, 50);
  fmt::print("{}", table.text());
  EXPECT_TRUE(table.failures.empty()) << table.failures;
}

// Files that once failed, as small as they could be made.
class KeptPipelines : public ::testing::TestWithParam<std::string> {};

std::vector<std::string> kept_pipelines() {
  std::vector<std::string> out;
  const std::filesystem::path folder = std::filesystem::path(test::source_dir()) / "tests/attack/pipelines";
  if (!std::filesystem::exists(folder)) return out;  // none has been kept
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (entry.path().extension() == ".yaml") out.push_back(entry.path().stem().string());
  std::sort(out.begin(), out.end());
  return out;
}

TEST_P(KeptPipelines, NeverContradictThemselves) {
  // Play in a machine that bends by its own size: a minute and more.
  if (GetParam() == "shape-against-readings" && count_on_demand() == 0) GTEST_SKIP() << "set DEFLECT_ATTACK to 1";
  const std::filesystem::path from = std::filesystem::path(test::source_dir()) / "tests/attack/pipelines";
  const test::Folder folder;
  write_text(folder / "subject.yaml", read_text(from / (GetParam() + ".yaml")));
  write_text(folder / "data.csv", read_text(from / (GetParam() + ".csv")));
  PipelineJudgement j;
  run_from_data(folder / ".", true, j);
  for (const Contradiction& c : j.wrong) ADD_FAILURE() << c.check << ": " << c.words;
}

INSTANTIATE_TEST_SUITE_P(Case, KeptPipelines, ::testing::ValuesIn(kept_pipelines()), [](const auto& kept) {
  std::string name = kept.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(KeptPipelines);

}  // namespace
}  // namespace deflect::attack
