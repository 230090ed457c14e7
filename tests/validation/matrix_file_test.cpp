// Matrices as programs print them: every layout, how well the digits are known, and refusals.
#include "validation/matrix/matrix_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "msa/base/error.h"
#include "tests/support/program.h"
#include "tests/support/stiffnesses.h"

namespace deflect {
namespace {

using namespace matrix;

const MatrixX two_by_three = (MatrixX(2, 3) << 1.5, -2, 3e5, 4, 5.25, -0.006).finished();

TEST(MatrixFile, SameMatrixHoweverItWasPrinted) {
  const char* layouts[] = {
      "1.5,-2,3e5\n4,5.25,-0.006\n",  // CSV
      "\xEF\xBB\xBF"
      "1.5,-2,3e5\r\n4,5.25,-0.006\r\n",                                      // byte order mark, CRLF
      "1.5, -2 ,  3e5\n\n4, 5.25, -0.006",                                    // blanks, blank line, no end of line
      "1.5,-2,3e5,\n4,5.25,-0.006,\n",                                        // separator at the end
      "1,5;-2;3e5\n4;5,25;-0,006\n",                                          // decimal commas
      "1.5;-2;3e5\n4;5.25;-0.006\n",                                          // semicolons
      "1,5\t-2\t3e5\n4\t5,25\t-0,006\n",                                      // from a spreadsheet
      "  1.5   -2  +3e5\n   4  5.25  -0.006\n",                               // blanks
      "1,5 -2 3e5\n4 5,25 -0,006\n",                                          // blanks and decimal commas
      "1.5D+00 -2.0d0 3.0D5\n4. 5.25 -6D-03\n",                               // Fortran
      "# from Ansys\n% and MATLAB\n1.5,-2,3e5 % row 1\n4,5.25,-0.006 # 2\n",  // comments
      "ux,uy,uz\n1.5,-2,3e5\n4,5.25,-0.006\n",                                // header
      "\"ux\",\"uy\",\"uz\"\n\"1.5\",-2,3e5\n4,5.25,-0.006\n",                // quotes
      ",ux,uy,uz\nfx,1.5,-2,3e5\nfy,4,5.25,-0.006\n",                         // header and names
      "ux uy uz\nfx 1.5 -2 3e5\nfy 4 5.25 -0.006\n",                          // header without a cell above the names
      ",0,1,2\n0,1.5,-2,3e5\n1,4,5.25,-0.006\n",                              // pandas, CSV
      "     0     1       2\n0  1.5 -2.00  3e5\n1  4.0  5.25 -0.006\n",       // pandas, printed
      "K = [1.5 -2 3e5; 4 5.25 -0.006];",                                     // MATLAB
      "K = [1.5, -2, 3e5\n     4, 5.25, -0.006];\n",                          // MATLAB, rows by line
      "K = [1.5 -2 ...\n 3e5; 4 5.25 -0.006]",                                // MATLAB, continued
      "1.5 -2 3e5;\n4 5.25 -0.006;\n",                                        // MATLAB, no brackets
      "K =\n\n   1.0e+05 *\n\n   0.000015 -0.00002 3\n   0.00004 0.0000525 -0.00000006\n",  // MATLAB's display
      "[[1.5, -2, 3e5], [4, 5.25, -0.006]]",                                                // Python, JSON
      "array([[ 1.5e+00, -2.0e+00,\n         3.0e+05],\n       [ 4., 5.25, -6.e-03]], dtype=float64)\n",  // NumPy
      "[[1.5 -2. 3.e5]\n [4. 5.25\n  -6.e-3]]",  // NumPy, printed
      "K_mm = np.array([[1.5, -2, 3e5], [4, 5.25, -0.006]])",
  };
  for (const char* text : layouts) {
    SCOPED_TRACE(text);
    const MatrixX read = parse_matrix(text, "K.csv").values;
    ASSERT_EQ(read.rows(), 2);
    ASSERT_EQ(read.cols(), 3);
    EXPECT_LT((read - two_by_three).cwiseAbs().maxCoeff(), 1e-9) << read;
  }
}

TEST(MatrixFile, RoundingIsHalfOfTheLastDigitThatTheProgramPrints) {
  struct {
    const char* text;
    double first, second;
  } const cases[] = {
      {"1.234, 5.678\n", 5e-4, 5e-4},      // %.4g or %.3f
      {"1.234e6, 5.678e-3\n", 500, 5e-7},  // %.4g
      {"1.5e6, 5.678\n", 500, 5e-4},       // %.4g leaves out zeros at the end
      {"1234567.12, 0.05\n", 5e-3, 5e-3},  // %.2f
      {"1234567, 3\n", 0.5, 0.5},          // %.0f
      {"1.234, 0\n", 5e-4, 5e-4},          // a zero is known to the decimals
      {"1e5, 2e5\n", 500, 500},            // typed by hand: three digits
      {"1.23456789012345678, 1\n", 5e-18, 5e-18},
      {"1.0e+05 *\n 1.2345 0.0001\n", 5, 5},  // MATLAB's short format
      {"-12,50;3,25\n", 5e-3, 5e-3},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.text);
    const PrintedMatrix m = parse_matrix(c.text, "K.csv");
    EXPECT_NEAR(m.rounding(0, 0) / c.first, 1, 1e-9);
    EXPECT_NEAR(m.rounding(0, 1) / c.second, 1, 1e-9);
  }
}

TEST(MatrixFile, RoundingCoversWhatPrintingLost) {
  std::mt19937 random(7);
  for (int digits = 3; digits <= 15; ++digits) {
    const Matrix6 K = test::random_stiffness(random);
    const PrintedMatrix m = test::read_back(K, digits);
    EXPECT_TRUE(((m.values - K).array().abs() <= 1.0001 * m.rounding.array() + 1e-16 * K.array().abs()).all())
        << digits;
    EXPECT_LT((m.rounding.array() / K.array().abs()).maxCoeff(), 1.01 * 5 * std::pow(10, -digits));
  }
}

TEST(MatrixFile, AZeroMayHaveAnyExponent) {
  for (const char* zero : {"0.00e-2147483648", "0.00e2147483647", "0e-99999999999"}) {
    const PrintedMatrix K = parse_matrix(std::string(zero) + " 2.5\n", "K.txt");
    EXPECT_EQ(K.values, Eigen::RowVector2d(0, 2.5)) << zero;
    EXPECT_EQ(K.rounding(1), 0.005) << zero;
    EXPECT_TRUE(K.rounding.allFinite() && K.rounding(0) >= 0) << zero;
    EXPECT_TRUE(parse_matrix(zero, "K.txt").rounding.allFinite()) << zero;
  }
}

TEST(MatrixFile, TwistsAreColumnsHoweverTheyAreWritten) {
  const test::Folder folder;
  std::ofstream(folder / "rows.csv") << "1,2,3,4,5,6\n7,8,9,10,11,12\n";
  std::ofstream(folder / "columns.csv") << "1,7\n2,8\n3,9\n4,10\n5,11\n6,12\n";
  const MatrixX rows = read_twists(folder / "rows.csv", {}).values;
  EXPECT_EQ(rows, read_twists(folder / "columns.csv", {}).values);
  ASSERT_EQ(rows.cols(), 2);
  EXPECT_EQ(rows(2, 1), 9);
  EXPECT_EQ(read_twists(folder / "rows.csv", {1e-3, true}).values(0, 0), 4);
}

TEST(MatrixFile, AResultOfSolveKnowsItsUnitsAndOrder) {
  const test::Folder folder;
  std::mt19937 random(1);
  const Matrix6 K = test::random_stiffness(random);
  nlohmann::json json;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) json["msa"]["stiffness"][static_cast<std::size_t>(i)].push_back(K(i, j));
  std::ofstream(folder / "s.json") << json;
  const MatrixX mm = read_stiffness(folder / "s.json", {}, "msa.stiffness").values;
  const MatrixX m = read_stiffness(folder / "s.json", {1, true}, "msa.stiffness").values;
  EXPECT_EQ(mm, K);
  EXPECT_NEAR(m(0, 1) / K(0, 1), 1e3, 1e-9);
  EXPECT_NEAR(m(4, 5) / K(4, 5), 1e-3, 1e-15);
  EXPECT_EQ(m(0, 4), K(0, 4));
}

struct BadFile {
  const char* name;
  std::string text;
  const char* says;
  friend void PrintTo(const BadFile& b, std::ostream* out) { *out << b.text.substr(0, 60); }
};

const std::string row = "1.5,2,3,4,5,6\n", five = row + row + row + row + row;

class BadMatrix : public ::testing::TestWithParam<BadFile> {};

TEST_P(BadMatrix, IsRefusedWithPlaceValueAndRemedy) {
  const test::Folder folder;
  std::ofstream(folder / "K.csv", std::ios::binary) << GetParam().text;
  try {
    read_stiffness(folder / "K.csv", {}, "analytic.stiffness");
    FAIL() << "was read";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find(GetParam().says), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("K.csv"), std::string::npos) << e.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadMatrix,
    ::testing::Values(
        BadFile{"Empty", "", "no numbers"}, BadFile{"OnlyComments", "# K\n% of leg 1\n", "no numbers"},
        BadFile{"Nan", five + "1,2,3,NaN,5,6\n", "6: column 4: 'NaN' is not a finite number; it usually comes from"},
        BadFile{"Infinite", "1,2,-inf,4,5,6\n" + five, "1: column 3: '-inf'"},
        BadFile{"TooLarge", "1,2,3,4,5,1e999\n" + five, "1: column 6: '1e999' is not a finite number"},
        BadFile{"Enormous", "1,2,3,4,5,1e300\n" + five, "1: column 6: '1e300' is too large"},
        BadFile{"Word", row + "1,2,three,4,5,6\n" + five, "2: column 3: 'three' is not a finite number; write one"},
        BadFile{"WordInTheFirstRow", "1,2,3x,4,5,6\n" + five, "1: column 3: '3x'"},
        BadFile{"EmptyCell", row + "1,,3,4,5,6\n" + five, "2: column 2: the cell is empty"},
        BadFile{"Expression", "1,2,3,4,5,2*pi\n" + five, "'2*pi' is not a finite number"},
        BadFile{"EmptyQuotes", "\"\" 1,5 2,5\n", "the matrix is 1×2"},
        BadFile{"NumbersOfRowsAlone", ",a\n1\n2\n", "the matrix is 2×1"},
        BadFile{"Complex", "1+2i,2,3,4,5,6\n" + five, "'1+2i' is not a finite number"},
        BadFile{"FiveRows", five, "the matrix is 5×6, a stiffness is 6×6"},
        BadFile{"SevenRows", five + row + row, "the matrix is 7×6"},
        BadFile{"ShortRow", five + "1,2,3,4,5\n", "6: the row has 5 numbers where the first has 6"},
        BadFile{"Triangle", "1\n1 2\n1 2 3\n1 2 3 4\n1 2 3 4 5\n1 2 3 4 5 6\n", "only one triangle"},
        BadFile{"Translations", "1 2 3\n4 5 6\n7 8 9\n", "translations only"},
        BadFile{"OneRow", "1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6 1 2 3 4 5 6\n",
                "write six rows of six"},
        BadFile{"Zero", "0 0 0 0 0 0\n0 0 0 0 0 0\n0 0 0 0 0 0\n0 0 0 0 0 0\n0 0 0 0 0 0\n0 0 0 0 0 0\n",
                "all entries are zero"},
        BadFile{"MixedDecimals", "1,5;2.5;3;4;5;6\n" + five, "decimal points and decimal commas"},
        BadFile{"Utf16",
                "\xFF\xFE"
                "1",
                "UTF-16"},
        BadFile{"Binary", std::string("\x93NUMPY\0\1", 8), "binary"},
        BadFile{"OpenBracket", "K = [1 2 3; 4 5 6", "not closed"},
        BadFile{"TwoMatrices", "K = [1 2; 3 4]; J = [1 2];", "follows the matrix"},
        BadFile{"ThreeDeep", "[[[1, 2]]]", "three deep"},
        BadFile{"LargeFactor", "1e101 *\n1 2\n", "the factor 1e+101 is too large"},
        BadFile{"LargeProduct", "1e60 *\n1 1e50\n", "2: column 2: 1e+50 times the factor 1e+60 is too large"},
        BadFile{"BadFactor", "2x *\n1 2\n", "'2x ' is not a finite"},
        BadFile{"NotJson", "{\"K\": [NaN]}", "not valid JSON: JSON has no NaN"},
        BadFile{"OtherJson", "{\"displacement\": [1]}", "there is no 'analytic' on the way"},
        BadFile{"JsonOfNumber", "{\"analytic\": {\"stiffness\": 1}}", "is not a matrix"},
        BadFile{"JsonOfWords", "{\"analytic\": {\"stiffness\": [[\"a\"]]}}", "'\"a\"' is not a finite number"}),
    [](const auto& bad) { return std::string(bad.param.name); });

TEST(MatrixFile, BadTwistsAreRefused) {
  const test::Folder folder;
  const auto refusal = [&](const std::string& text) -> std::string {
    std::ofstream(folder / "J.csv") << text;
    try {
      read_twists(folder / "J.csv", {});
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("1 2 3\n").find("write one to five twists"), std::string::npos);
  EXPECT_NE(refusal(five + row).find("six passive joints"), std::string::npos);
  EXPECT_NE(refusal(row + "0,0,0,0,0,0\n").find("twist 2 is zero"), std::string::npos);
}

}  // namespace
}  // namespace deflect
