#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <sstream>

#include "msa/base/files.h"
#include "msa/base/outcome.h"
#include "tests/attack/count.h"
#include "tests/attack/pipeline_run.h"
#include "tests/support/program.h"

namespace deflect::attack {
namespace {

namespace fs = std::filesystem;
using Lines = std::vector<std::string>;
using Fails = std::function<bool(const Lines&)>;

constexpr auto longest = std::chrono::minutes(4);

Lines lines_of(const std::string& text) {
  Lines out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

std::string text_of(const Lines& lines) {
  std::string out;
  for (const std::string& line : lines) out += line + "\n";
  return out;
}

std::size_t indent(const std::string& line) { return std::min(line.find_first_not_of(" -"), line.size()); }

/// Lines first … last without which it is tried: halves, quarters … of what follows the header.
Lines fewer_rows(Lines lines, const Fails& fails) {
  for (std::size_t piece = lines.size() / 2; piece > 0; piece /= 2)
    for (std::size_t at = 1; at + piece <= lines.size();) {
      Lines without = lines;
      without.erase(without.begin() + static_cast<long>(at), without.begin() + static_cast<long>(at + piece));
      if (fails(without))
        lines = std::move(without);
      else
        at += piece;
    }
  return lines;
}

/// A line with all that is indented below it.
Lines fewer_parts(Lines lines, const Fails& fails) {
  for (std::size_t at = 0; at < lines.size();) {
    std::size_t end = at + 1;
    while (end < lines.size() && indent(lines[end]) > indent(lines[at])) ++end;
    Lines without = lines;
    without.erase(without.begin() + static_cast<long>(at), without.begin() + static_cast<long>(end));
    if (fails(without))
      lines = std::move(without);
    else
      ++at;
  }
  return lines;
}

}  // namespace

std::string shrunk(const Pipeline& p, const Contradiction& failure) {
  const test::Folder folder;
  const fs::path at = folder / ".";
  PipelineJudgement made;
  const bool simulated = simulate(p, at, made);
  const auto until = std::chrono::steady_clock::now() + longest;
  const auto fails_with = [&](const char* file) {
    return [&, file](const Lines& lines) {
      if (std::chrono::steady_clock::now() > until) return false;
      const std::string before = read_text(at / file);
      write_text(at / file, text_of(lines));
      PipelineJudgement j;
      const auto thrown = thrown_by([&] { run_from_data(at, failure.check.starts_with("report"), j); });
      const bool same = !thrown && std::any_of(j.wrong.begin(), j.wrong.end(),
                                               [&](const auto& each) { return each.check == failure.check; });
      if (!same) write_text(at / file, before);
      return same;
    };
  };
  const fs::path kept = failures_folder() / fmt::format("pipeline-{}", p.seed);
  if (simulated && fails_with("data.csv")(lines_of(read_text(at / "data.csv")))) {
    fewer_rows(lines_of(read_text(at / "data.csv")), fails_with("data.csv"));
    fewer_parts(lines_of(read_text(at / "subject.yaml")), fails_with("subject.yaml"));
  }
  fs::create_directories(kept);
  for (const char* file : {"subject.yaml", "data.csv", "plan.csv"})
    if (fs::exists(at / file)) write_text(kept / file, read_text(at / file));
  return kept.string();
}

}  // namespace deflect::attack
