#include "validation/measurement/csv.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <functional>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "validation/studies/points_file.h"

namespace deflect {
namespace {

using namespace measurement;
using namespace studies;

using namespace std::string_literals;

std::string message(const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string refusal(const std::string& text) {
  return message([&] { parse_csv(text, "data.csv"); });
}

TEST(Csv, ReadsNamesCellsAndLines) {
  const CsvTable table = parse_csv("pose,x_mm,note\n0,1.5,first\n7,-2e-3,\n", "data.csv");
  EXPECT_EQ(table.header(), (std::vector<std::string>{"pose", "x_mm", "note"}));
  EXPECT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.column("note"), 2u);
  EXPECT_FALSE(table.column("y_mm"));
  EXPECT_EQ(table.text(0, 2), "first");
  EXPECT_EQ(table.text(1, 2), "");
  EXPECT_EQ(table.number(0, 1), 1.5);
  EXPECT_EQ(table.number(1, 1), -2e-3);
  EXPECT_EQ(table.line(1), 3u);
}

TEST(Csv, ALineForExcelNamesTheSeparator) {
  for (const char* text : {"sep=,\r\na,b\r\n1.5,2\r\n-3,4e2\r\n", "\xEF\xBB\xBFSEP=;\na;b\n1,5;2\n-3;4e2\n",
                           "\"sep=;\"\n\na;b\n1.5;2\n-3;4e2\n", "sep=\t\na\tb\n1.5\t2\n-3\t4e2\n"}) {
    SCOPED_TRACE(text);
    const CsvTable table = parse_csv(text, "data.csv");
    EXPECT_EQ(table.header(), (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(table.number(0, 0), 1.5);
    EXPECT_EQ(table.number(1, 1), 400);
    EXPECT_GE(table.line(1), 4u) << "the line counts";
  }
}

// As exported with a title: more words than one line above the names, padded by a spreadsheet or not.
TEST(Csv, LinesOfTitleAreToldFromTheHeader) {
  const std::string names = "pose,fx_N,ux_mm\n1,50,0.2\n1,-50,-0.2\n";
  for (const std::string title :
       {"Stand 3\n", "Stand 3;12.3.2024\n\n", "Stand 3,,\nby,A. B.,\n", "Stand 3; run 1, run 2\n"}) {
    const auto below = 1 + std::count(title.begin(), title.end(), '\n');
    EXPECT_EQ(refusal(title + names),
              "data.csv:1: this line is no header: the names of the columns seem to stand in line " +
                  std::to_string(below) + "; delete the lines above them, or begin each of those with '#'")
        << title;
  }
  EXPECT_EQ(refusal("sep=|\na|b\n1|2\n"),
            "data.csv:1: 'sep=|': columns are separated by commas, semicolons or tabs; save the file so");
  // No title, but a row with a cell too many.
  EXPECT_NE(refusal("pose,note\n1,here\n2,there,again\n3,4,5\n").find("data.csv:3: 3 cells"), std::string::npos);
}

TEST(Csv, SameTableHoweverItWasSaved) {
  const char* variants[] = {
      "a,b\n1.5,2\n-3,4e2\n",  // plain
      "a,b\n1.5,2\n-3,4e2",    // no end of line at the end
      "\xEF\xBB\xBF"
      "a,b\n1.5,2\n-3,4e2\n",                  // byte order mark
      "a,b\r\n1.5,2\r\n-3,4e2\r\n",            // CRLF
      "a,b\n1.5,2\n-3,4e2\n\n  \n\r\n",        // blank lines at the end
      "a;b\n1,5;2\n-3;4e2\n",                  // semicolons, decimal commas
      "a;b\n1.5;2\n-3;4e2\n",                  // semicolons, decimal points
      "a\tb\n1.5\t2\n-3\t4e2\n",               // tabs
      "a\tb\n1,5\t2\n-3\t 4e2\n",              // tabs, decimal commas
      "\"a\",\"b\"\n\"1.5\",2\n-3,\"4e2\"\n",  // quoted
      " a , b\n 1.5 ,\t2\n -3, +4e2 \n",       // spaces
  };
  for (const char* text : variants) {
    SCOPED_TRACE(text);
    const CsvTable table = parse_csv(text, "data.csv");
    ASSERT_EQ(table.rows(), 2u);
    EXPECT_EQ(table.header(), (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(table.number(0, 0), 1.5);
    EXPECT_EQ(table.number(0, 1), 2);
    EXPECT_EQ(table.number(1, 0), -3);
    EXPECT_EQ(table.number(1, 1), 400);
    EXPECT_EQ(table.line(1), 3u);
  }
}

TEST(Csv, QuotedCellsHoldSeparatorsQuotesAndLineEnds) {
  const CsvTable table = parse_csv("note,x\n\"a, \"\"b\"\"\nc\" ,1\n\"\",2\nµ,3\n", "data.csv");
  EXPECT_EQ(table.text(0, 0), "a, \"b\"\nc");
  EXPECT_EQ(table.text(1, 0), "");
  EXPECT_EQ(table.text(2, 0), "µ");
  EXPECT_EQ(table.line(1), 4u) << "the quoted line end counts";
}

TEST(Csv, SurvivesAMove) {
  CsvTable table = parse_csv("a\n1\n", "data.csv");  // short enough to live inside the string object
  const CsvTable moved = std::move(table);
  EXPECT_EQ(moved.number(0, 0), 1);
}

TEST(Csv, BlankLinesAndCommentsAreSkipped) {
  const CsvTable table =
      parse_csv("\n# bench 3, \"the left one\n\na,b\n# pause\n1,2\n\n ,  \n#1,9\n  # it's late\n3,4\n#", "data.csv");
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.line(0), 6u);
  EXPECT_EQ(table.line(1), 11u);
  EXPECT_EQ(table.number(1, 1), 4);
  EXPECT_EQ(table.comments(), (std::vector<std::size_t>{2, 5, 9, 10, 12}));
}

TEST(Csv, WhereEveryRowBeginsWithAHashTheyAreRows) {
  const CsvTable table = parse_csv("pose,b\n#1,2\n#2,3\n", "data.csv");
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.text(1, 0), "#2");
  EXPECT_TRUE(table.comments().empty());
}

TEST(Csv, RefusesBadFilesWithLineAndReason) {
  const struct {
    std::string text, line, reason;
  } cases[] = {
      {"", "data.csv:1:", "empty"},
      {"\n\n", "data.csv:1:", "empty"},
      {"\xEF\xBB\xBF", "data.csv:1:", "empty"},
      {"a,b\n", "data.csv:1:", "no row"},
      {"a,b\n\n", "data.csv:1:", "no row"},
      {"a,b,a\n1,2,3\n", "data.csv:1:", "'a' stands twice, as column 1 and column 3"},
      {"a,,c\n1,2,3\n", "data.csv:1:", "column 2 has no name"},
      {"a,b,\n1,2,3\n", "data.csv:1:", "separator at the end"},
      {"a|b|c\n1|2|3\n", "data.csv:1: columns are separated by '|' here", "put semicolons in place of it"},
      {"a,b;c\n1,2\n", "data.csv:1:", "both commas and semicolons"},
      {"a,b\n1,2\n1,2,3\n", "data.csv:3:", "3 cells where the header has 2"},
      {"a,b\n1,2,\n", "data.csv:2:", "separator at the end"},
      {"a,b\n1\n", "data.csv:2:", "1 cells"},
      {"a\tb\n1\t\t2\n", "data.csv:2:", "3 cells"},
      {"1,2\n3,4\n", "data.csv:1:", "there is no header: this line holds numbers"},
      {"0,0,0.5\n1,2,3\n", "data.csv:1:", "there is no header"},
      {"0;0,5\n1;2\n", "data.csv:1:", "both commas and semicolons"},
      {"# a,b\n1,2\n", "data.csv:2:", "without '#' where line 1 has them"},
      {"# a\n# b\n", "data.csv:1:", "every line is blank or begins with '#'"},
      {"PK\x03\x04 and more", "data.csv:1:", "save its sheet as CSV"},
      {"a,b\n1,\"2\n3,4\n", "data.csv:2:", "never ends"},
      {"a,b\n1,\"2\"x\n", "data.csv:2:", "closing quote"},
      {"a,b\n1,2\"\n", "data.csv:2:", "quote inside"},
      {"a,b\n1,2\r3,4\n", "data.csv:2:", "carriage return"},
      {"a,b\n1,\0\n"s, "data.csv:2:", "NUL"},
      {"a,b\n1,\xFC\n", "data.csv:2:", "0xFC is not UTF-8"},
      {"a,b\n1,\xC0\x80\n", "data.csv:2:", "not UTF-8"},
      {"a,b\n1,\xED\xA0\x80\n", "data.csv:2:", "not UTF-8"},
      {"a,b\n1,\xE2\x82", "data.csv:2:", "not UTF-8"},
      {"\xFF\xFE"
       "a\0"s,
       "data.csv:1:", "UTF-16"},
  };
  for (const auto& c : cases) {
    const std::string said = refusal(c.text);
    EXPECT_TRUE(said.starts_with(c.line)) << c.text << "\n" << said;
    EXPECT_NE(said.find(c.reason), std::string::npos) << c.text << "\n" << said;
  }
}

TEST(Csv, RefusesCellsThatAreNoNumber) {
  for (const char* cell : {"nan", "NaN", "inf", "-inf", "infinity", "1e999", "0x10", "12,,", "1.2.3", "1 2", "--1",
                           "+-1", "12 mm", "x", "1e", "."}) {
    const std::string said =
        message([&] { parse_csv("a,x_mm\n1,2\n1,\"" + std::string(cell) + "\"\n", "data.csv").number(1, 1); });
    EXPECT_EQ(said.find("data.csv:3: column 'x_mm': '" + std::string(cell) + "' is not a finite number; "), 0u) << said;
  }
  EXPECT_EQ(message([] { parse_csv("a,x_mm\n1,\n", "data.csv").number(0, 1); }),
            "data.csv:2: column 'x_mm': the cell is empty; a finite number is wanted");
}

TEST(Csv, DecimalCommasNeedSemicolonsAndDoNotMixWithPoints) {
  EXPECT_NE(message([] { parse_csv("a,b\n1,\"1,5\"\n", "data.csv").number(0, 1); }), "");
  const CsvTable table = parse_csv("a;b\n1,5;1.234\n1.234,5;2\n", "data.csv");
  EXPECT_EQ(table.number(0, 0), 1.5);
  EXPECT_NE(message([&] { table.number(0, 1); }).find("decimal point in a file with decimal commas"),
            std::string::npos);
  EXPECT_NE(message([&] { table.number(1, 0); }).find("data.csv:3: column 'a'"), std::string::npos);
}

TEST(Csv, AMillionRowsTakeSeconds) {
  std::string text = "pose,x_mm,y_mm,z_mm,fx_N,ux_mm\n";
  for (int i = 0; i < 1000000; ++i) text += "0,0.000000,0.000000,173.898547,-50.0000,-0.110991\n";
  const auto start = std::chrono::steady_clock::now();
  const CsvTable table = parse_csv(std::move(text), "data.csv");
  double sum = 0;
  for (std::size_t row = 0; row < table.rows(); ++row)
    for (std::size_t column = 0; column < 6; ++column) sum += table.number(row, column);
  EXPECT_EQ(table.rows(), 1000000u);
  EXPECT_NEAR(sum / 1e6, 173.898547 - 50.110991, 1e-6);
  // Half a second without optimisation on a slow machine; anything quadratic would take hours.
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
}

class Points : public ::testing::Test {
 protected:
  std::vector<ValidationPoint> read(const std::string& text) {
    write_text(file_, text);
    return read_points(file_);
  }
  std::string refused(const std::string& text) {
    return message([&] { read(text); });
  }
  void TearDown() override { std::filesystem::remove(file_); }

  std::filesystem::path file_ =
      std::filesystem::temp_directory_path() / ("points" + std::to_string(::getpid()) + ".csv");
};

TEST_F(Points, NumberedFromZeroWithoutLabelsAndUntiltedWithoutAngles) {
  const auto points = read("z_mm,x_mm,y_mm,note on it\n173.9,1,2,\n170,-1,0.5,soft\n");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].label, "0");
  EXPECT_EQ(points[1].label, "1");
  EXPECT_EQ(points[0].pose_mm_deg, (Vector6() << 1, 2, 173.9, 0, 0, 0).finished());
  EXPECT_EQ(points[1].pose_mm_deg, (Vector6() << -1, 0.5, 170, 0, 0, 0).finished());
}

TEST_F(Points, LabelsAndAngles) {
  const auto points = read("pose,x_mm,y_mm,z_mm,yaw_deg,roll_deg,pitch_deg\ncentre,0,0,174,3,1,2\n");
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].label, "centre");
  EXPECT_EQ(points[0].pose_mm_deg, (Vector6() << 0, 0, 174, 1, 2, 3).finished());
}

TEST_F(Points, RefusalsNameFileLineAndRemedy) {
  const std::string file = file_.string();
  const struct {
    std::string text, begins, reason;
  } cases[] = {
      {"x_mm,y_mm\n1,2\n", ":1:", "column 'z_mm' is missing"},
      {"x_mm,y_mm,z_mm,rol_deg\n1,2,3,4\n", ":1:", "unknown column 'rol_deg', did you mean 'roll_deg'?"},
      {"x_mm,y_mm,z\n1,2,3\n", ":1:", "unknown column 'z': the unit is missing, did you mean 'z_mm'?"},
      {"x_mm,y_mm,z_cm\n1,2,3\n", ":1:", "unknown column 'z_cm', did you mean 'z_mm', with its numbers in mm?"},
      {"x_mm,y_mm,z_mm\n1,2,3\n1,,3\n", ":3: column 'y_mm':", "empty"},
      {"x_mm,y_mm,z_mm\n1,2,nan\n", ":2: column 'z_mm':", "'nan' is not a finite number"},
      {"pose,x_mm,y_mm,z_mm\na,1,2,3\na,1,2,4\n", ":3: column 'pose':", "'a' is already the label of line 2"},
      {"pose,x_mm,y_mm,z_mm\n,1,2,3\n", ":2: column 'pose':", "empty"},
  };
  for (const auto& c : cases) {
    const std::string said = refused(c.text);
    EXPECT_TRUE(said.starts_with(file + c.begins)) << said;
    EXPECT_NE(said.find(c.reason), std::string::npos) << said;
  }
  EXPECT_NE(message([] { read_points("no/such/file.csv"); }).find("no/such/file.csv"), std::string::npos);
}

}  // namespace
}  // namespace deflect
