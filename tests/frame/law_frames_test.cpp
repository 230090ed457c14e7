// Random frames with laws of every kind against the numbers of tests/frame/laws/law_frames.py, which shares nothing
// with the solvers here.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "msa/base/files.h"
#include "tests/support/frames.h"
#include "tests/support/paths.h"

namespace deflect::frame {
namespace {

struct Stored {
  std::string name, text;
  bool in_sequence = false;
  struct Row {
    char kind = 0;  // u: of a node, r: reaction of a support
    std::size_t at_case = 0, index = 0;
    Vector6 values;
  };
  std::vector<Row> rows;
};

std::vector<Stored> stored_frames() {
  std::istringstream lines(read_text(std::filesystem::path(test::source_dir()) / "tests/frame/laws/law_frames.txt"));
  std::vector<Stored> out;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    if (line.starts_with("frame ")) {
      std::string how, frame;
      words >> frame >> frame >> how;
      out.push_back({frame, "", how == "sequence", {}});
    } else if (line.starts_with("u ") || line.starts_with("r ")) {
      Stored::Row row;
      words >> row.kind >> row.at_case >> row.index;
      for (double& x : row.values) words >> x;
      out.back().rows.push_back(row);
    } else {
      out.back().text += line + "\n";
    }
  }
  return out;
}

/// Relative to the largest of its kind in the frame: displacements and rotations (over 1 m), forces and moments.
TEST(LawFrames, AreWhatAnIndependentProgramSays) {
  const std::vector<Stored> all = stored_frames();
  ASSERT_EQ(all.size(), 52u);
  double worst = 0;
  for (const Stored& stored : all) {
    SCOPED_TRACE("frame " + stored.name);
    const FrameDescription f = parse_frame(stored.text, "frame " + stored.name);
    EXPECT_EQ(write_frame(parse_frame(write_frame(f), "written")), write_frame(f));
    FrameOptions options;
    options.in_sequence = stored.in_sequence;
    const FrameResult result = analyse(f, options);
    EXPECT_EQ(failed_check(result), "");
    double u = 0, r = 0;
    for (const Stored::Row& row : stored.rows) {
      double& most = row.kind == 'u' ? u : r;
      most = std::max(most, row.values.cwiseAbs().maxCoeff());
    }
    for (const Stored::Row& row : stored.rows) {
      const CaseResult& c = result.cases.at(row.at_case);
      const Vector6& found = row.kind == 'u' ? c.displacements.at(row.index) : c.reactions.at(row.index);
      const double error = (found - row.values).cwiseAbs().maxCoeff() / (row.kind == 'u' ? u : r);
      EXPECT_LT(error, 1e-9) << row.kind << " " << row.at_case << " " << row.index << ": " << found.transpose()
                             << "\n  stored " << row.values.transpose();
      worst = std::max(worst, error);
    }
  }
  RecordProperty("worst", fmt::format("{:.1e}", worst));
}

}  // namespace
}  // namespace deflect::frame
