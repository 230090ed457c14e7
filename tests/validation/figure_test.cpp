#include <gtest/gtest.h>
#include <stdlib.h>
#include <unistd.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "tests/support/theories.h"
#include "validation/figures/fig10.h"
#include "validation/figures/gnuplot.h"
#include "validation/parallel/child_process.h"

namespace deflect {
namespace {

using namespace figures;
using namespace studies;
using namespace theories;

namespace fs = std::filesystem;

/// A folder of its own for each test.
class FigureTest : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  const fs::path folder_ = fs::temp_directory_path() / ("deflect figures' " + std::to_string(::getpid()));
};

/// Deflections of the ideal-joint device along the load (mm) at its nine points; further points are scaled
/// copies.
Validation validation(int points, bool as_printed, double difference) {
  const double along[3][9] = {
      {0.084092, 0.703127, 0.477092, 0.477092, 0.703127, 0.204568, 0.124437, 0.124437, 0.204568},
      {0.084092, 0.604736, 0.557969, 0.557969, 0.604736, 0.174057, 0.139384, 0.139384, 0.174057},
      {0.026865, 0.055196, 0.098311, 0.098311, 0.055196, 0.009520, 0.019823, 0.019823, 0.009520}};
  Validation v;
  v.device = "haptic-6psu";
  v.theories = all_theories();
  if (as_printed) v.as_printed = {Erratum::passive_joints};
  for (int p = 0; p < points; ++p)
    for (int axis = 0; axis < 3; ++axis) {
      ValidationRow row;
      row.point.label = std::to_string(p);
      row.axis = axis;
      row.load_N = 50;
      row.displacements.assign(2, Vector6::Zero());
      test::msa(row)[axis] = along[axis][p % 9] * (1 + p / 9);
      test::analytic(row) = test::msa(row) * (1 + difference * std::sin(3.1 * p + axis));
      if (as_printed) row.as_printed = test::msa(row) / 2.1;
      v.rows.push_back(row);
    }
  return v;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_F(FigureTest, ThreeFormatsAndTheSameBytesAgain) {
  const Figure figure = fig10(validation(9, true, 1e-9));
  const auto paths = render(figure, folder_ / "new");
  ASSERT_EQ(paths.size(), 4u);
  std::vector<std::string> first;
  for (const fs::path& path : paths) first.push_back(read_text(path));
  EXPECT_EQ(paths[0].filename(), "fig10.svg");
  EXPECT_TRUE(first[0].starts_with("<?xml"));
  EXPECT_TRUE(has(first[0], "width=\"160mm\""));
  EXPECT_TRUE(has(first[0], "</svg>"));
  EXPECT_TRUE(first[1].starts_with("%PDF"));
  EXPECT_TRUE(has(first[1], "%%EOF"));
  EXPECT_TRUE(first[2].starts_with("\x89PNG"));
  EXPECT_TRUE(has(first[2], "IEND"));
  EXPECT_EQ(paths[3].filename(), "fig10.txt");

  ::sleep(1);  // a time stamp of whole seconds would show now
  EXPECT_EQ(render(figure, folder_ / "new"), paths);
  for (std::size_t i = 0; i < paths.size(); ++i) EXPECT_TRUE(read_text(paths[i]) == first[i]) << paths[i];
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "new"), fs::directory_iterator()), 4)
      << "nothing else is left";
}

TEST_F(FigureTest, BrokenScriptIsReportedAndLeavesTheFolderAsItWas) {
  write_text(folder_ / "good.svg", "kept");
  for (const char* body : {"plot [0:1] nonsense(x)", "plot x\nset no_such_option", "print 'and no picture'"}) {
    try {
      render({"good", body, 80, 60}, folder_);
      ADD_FAILURE() << body;
    } catch (const std::logic_error& error) {
      EXPECT_TRUE(has(error.what(), "figure good: gnuplot")) << error.what();
      EXPECT_TRUE(!has(body, "nonsense") || has(error.what(), "undefined function")) << error.what();
    }
    EXPECT_EQ(files(), std::vector<std::string>{"good.svg"}) << body;
    EXPECT_EQ(read_text(folder_ / "good.svg"), "kept") << body;
  }
}

TEST_F(FigureTest, MuchErrorTextDoesNotBlock) {
  EXPECT_EQ(
      render({"loud", "do for [i=1:20000] { print 'a line that goes to standard error, again and again' }\nplot x"},
             folder_)
          .size(),
      3u);
}

TEST_F(FigureTest, WithoutGnuplotTheMessageNamesTheRemedy) {
  const std::string path = ::getenv("PATH");
  ::setenv("PATH", folder_.c_str(), 1);
  try {
    render({"any", "plot x"}, folder_);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_TRUE(has(error.what(), "apt-get install gnuplot-nox")) << error.what();
  }
  ::setenv("PATH", path.c_str(), 1);
  EXPECT_TRUE(files().empty());
}

TEST_F(FigureTest, NamesAndFoldersThatCannotBe) {
  EXPECT_THROW(render({"../out", "plot x"}, folder_), std::logic_error);
  EXPECT_THROW(render({"", "plot x"}, folder_), std::logic_error);
  write_text(folder_ / "file", "");
  EXPECT_THROW(render({"any", "plot x"}, folder_ / "file"), InputError);
}

TEST_F(FigureTest, AnyTextPrintsAsItIs) {
  EXPECT_EQ(gnuplot_quote("it's_{x}\n`ls`"), "'it''s_{x} `ls`'");
  EXPECT_EQ(gnuplot_tic_label("50 %"), "'50 %%'");
  Validation v = validation(2, false, 1e-9);
  const std::string nasty = "a_{b}^c '\"%s `touch " + (folder_ / "run").string() + "` @x \\";
  v.device = nasty;
  for (ValidationRow& row : v.rows) row.point.label = nasty.substr(0, 12) + row.point.label;
  const std::string svg = read_text(render(fig10(v), folder_).front());
  EXPECT_TRUE(has(svg, "a_{b}^c '")) << "neither a format nor a subscript";
  EXPECT_TRUE(has(svg, "%s1"));
  EXPECT_FALSE(fs::exists(folder_ / "run"));
}

TEST_F(FigureTest, Fig10ShowsTheSeriesLoadAndDevice) {
  const std::string svg = read_text(render(fig10(validation(9, false, 1e-9)), folder_).front());
  for (const char* text : {"haptic-6psu", "50 N", "base axes", "X-Analytical", "X-MSA", "Y-Analytical", "Y-MSA",
                           "Z-Analytical", "Z-MSA", "(mm)", "analytic − MSA", "−0.2", "0.8", "point of the workspace"})
    EXPECT_TRUE(has(svg, text)) << text;
  EXPECT_FALSE(has(svg, "As printed"));
}

TEST_F(FigureTest, PointsOfTheWorkspaceAreNoSeriesAndNoLineJoinsThem) {
  const std::string body = fig10(validation(9, true, 1e-9)).body;
  EXPECT_FALSE(has(body, "linespoints"));
  EXPECT_FALSE(has(body, "with lines"));
  EXPECT_TRUE(has(body, "with points"));
}

TEST_F(FigureTest, SeveralFiguresAreDrawnTogetherAsEachByItself) {
  Figure other = fig10(validation(5, false, 1e-9));
  other.name = "other";
  const std::vector<Figure> figures = {fig10(validation(9, true, 1e-9)), other};
  const auto together = render_all(figures, folder_ / "together");
  ASSERT_EQ(together.size(), 8u);
  std::size_t i = 0;
  for (const Figure& figure : figures)
    for (const fs::path& alone : render(figure, folder_ / "alone")) {
      EXPECT_EQ(together[i].filename(), alone.filename());
      EXPECT_TRUE(read_text(together[i++]) == read_text(alone)) << alone;
    }
  EXPECT_TRUE(render_all({}, folder_).empty());
  EXPECT_THROW(render_all({figures[0], {"bad", "plot [0:1] nonsense(x)"}}, folder_ / "none"), std::logic_error);
  EXPECT_FALSE(fs::exists(folder_ / "none"));
}

TEST_F(FigureTest, Fig10NamesTheErrataAsPrinted) {
  Validation v = validation(9, true, 1e-9);
  std::string svg = read_text(render(fig10(v), folder_).front());
  EXPECT_TRUE(has(svg, "X-As printed"));
  EXPECT_TRUE(has(svg, "passive-joints"));
  for (const ErratumInfo& erratum : errata()) v.as_printed.insert(erratum.erratum);
  svg = read_text(render(fig10(v), folder_).front());
  EXPECT_TRUE(has(svg, "all errata"));
}

TEST_F(FigureTest, Fig10ChoosesTheUnitOfTheResidual) {
  // The largest residual is 0.49 mm times the difference.
  const struct {
    double difference;
    const char* unit;
  } cases[] = {{4e-3, "'(µm)'"},  {4e-5, "'(nm)'"},  {4e-8, "'(pm)'"},
               {4e-11, "'(fm)'"}, {4e-14, "'(fm)'"}, {0, "'(nm)'"}};
  for (const auto& c : cases) EXPECT_TRUE(has(fig10(validation(9, false, c.difference)).body, c.unit)) << c.difference;
}

TEST_F(FigureTest, Fig10OfOtherSetsOfPoints) {
  for (const int points : {1, 2, 10, 40, 343}) {
    SCOPED_TRACE(points);
    EXPECT_EQ(render(fig10(validation(points, points == 1, 1e-9)), folder_).size(), 4u);
  }
  Validation one_axis = validation(9, false, 1e-9);
  std::erase_if(one_axis.rows, [](const ValidationRow& row) { return row.axis != 1; });
  const std::string svg = read_text(render(fig10(one_axis), folder_).front());
  EXPECT_TRUE(has(svg, "Y-MSA"));
  EXPECT_FALSE(has(svg, "X-MSA"));
}

TEST_F(FigureTest, CaptionSaysWhatUnitsLoadFrameAndProgram) {
  const auto paths = render(fig10(validation(9, true, 1e-9)), folder_);
  const std::string caption = read_text(folder_ / "fig10.txt"), svg = read_text(paths.front());
  for (const char* text : {"haptic-6psu", "50 N", "mm", "base axes", "positive", "9 points", "passive-joints",
                           "no noise", "deflect 0.", "analytic − MSA"})
    EXPECT_TRUE(has(caption, text)) << text << "\n" << caption;
  EXPECT_EQ(std::count(caption.begin(), caption.end(), '\n'), 1) << "one paragraph";
  EXPECT_TRUE(has(svg, "<title>haptic-6psu: linear deflection under 50 N in x, y, z</title>"));
  EXPECT_TRUE(has(svg, "<desc>" + caption.substr(0, 40)));
}

/// Sizes of the text in an SVG, points; and the ends of each line of text, supposing wide letters.
TEST_F(FigureTest, WidthFontAndSizeAreThoseAskedFor) {
  for (const double width : {88.0, 180.0})
    for (const double size : {7.0, 10.0}) {
      const FigureStyle style{width, "DejaVu Serif", size};
      const Figure figure = fig10(validation(9, false, 1e-9), style);
      EXPECT_EQ(figure.width_mm, width);
      const auto paths = render(figure, folder_);
      const std::string svg = read_text(paths[0]), pdf = read_text(paths[1]), png = read_text(paths[2]);
      EXPECT_TRUE(has(svg, fmt::format("width=\"{}mm\"", width)));
      EXPECT_TRUE(has(svg, "font-family=\"DejaVu Serif"));
      EXPECT_FALSE(has(svg, "DejaVu Sans"));
      EXPECT_TRUE(has(svg, fmt::format("font-size=\"{:.2f}\"", size)));
      EXPECT_TRUE(has(pdf, "DejaVuSerif"));
      EXPECT_FALSE(has(pdf, "DejaVuSans"));
      // The width in the PNG's header, big-endian pixels; 300 dpi.
      const auto byte = [&](std::size_t i) { return static_cast<double>(static_cast<unsigned char>(png[16 + i])); };
      EXPECT_NEAR(((byte(0) * 256 + byte(1)) * 256 + byte(2)) * 256 + byte(3), width / 25.4 * 300, 1);
    }
}

/// Lines of text are 1.164 times as high as DejaVu Sans is large.
TEST_F(FigureTest, TextOfThePdfHasItsSize) {
  const auto paths =
      render({"word", "set key off\nset xlabel 'Sizes'\nplot x", 80, 60, "", "", {0, "DejaVu Sans", 10}}, folder_);
  const parallel::ChildOutcome boxes = parallel::run_child({"pdftotext", "-bbox", paths[1].string(), "-"}, "");
  if (!boxes.succeeded()) GTEST_SKIP() << "pdftotext (poppler-utils) is not installed";
  const std::string& text = boxes.output;
  const std::size_t word = text.rfind("<word", text.find(">Sizes<"));
  const auto number = [&](const char* name) {
    return std::stod(text.substr(text.find(name, word) + std::string(name).size()));
  };
  EXPECT_NEAR(number("yMax=\"") - number("yMin=\""), 11.64, 0.15) << text;
}

TEST_F(FigureTest, TextThatDoesNotFitOrIsNotInstalledIsRefused) {
  EXPECT_THROW(fig10(validation(9, false, 1e-9), {40, "DejaVu Sans", 8}), InputError);
  EXPECT_THROW(fig10(validation(9, false, 1e-9), {160, "DejaVu Sans", 60}), InputError);
  check_font("DejaVu Sans");
  check_font("dejavu serif");
  try {
    check_font("No Such Family-7");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_TRUE(has(error.what(), "'No Such Family-7' is not installed; fontconfig would take '")) << error.what();
    EXPECT_TRUE(has(error.what(), "fc-list")) << error.what();
  }
  for (const char* name : {"", "a,12", "a:bold", "it's", "a\nb"}) EXPECT_THROW(check_font(name), InputError) << name;
}

TEST_F(FigureTest, Fig10RefusesWhatCannotBeDrawn) {
  EXPECT_THROW(fig10(Validation{}), std::invalid_argument);
  Validation v = validation(1, false, 0);
  test::msa(v.rows[1])[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(fig10(v), std::invalid_argument);
  v.rows[1].axis = 3;
  EXPECT_THROW(fig10(v), std::invalid_argument);
}

}  // namespace
}  // namespace deflect
