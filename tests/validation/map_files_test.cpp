// What a map writes, and the command.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/devices.h"
#include "tests/support/maps.h"
#include "tests/support/program.h"
#include "tests/support/theories.h"
#include "validation/report/map_results.h"

namespace deflect {
namespace {

using namespace report;
using namespace studies;

using nlohmann::json;
using test::contents;
using test::cube;
using test::device;
using test::Folder;
using test::too_wide;

/// Cells of a CSV line; commas in quotes do not part.
std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> list(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') quoted = !quoted;
    if (c == ',' && !quoted)
      list.emplace_back();
    else
      list.back() += c;
  }
  return list;
}

TEST(MapCsv, NamesUnitsAndHasARowForEveryPose) {
  const Mechanism m = device("haptic-6psu");
  const StiffnessMap map = map_stiffness(m, too_wide(m));
  std::istringstream lines(map_csv(map));
  std::string line;
  std::getline(lines, line);
  const std::vector<std::string> header = cells(line);
  for (const char* name :
       {"x_mm", "yaw_deg", "force_N", "compliance_kind", "length_mm", "reached", "note_out_of_reach", "guide_mean_mm",
        "analytic_cxx_mm_per_N", "analytic_czy_mm_per_N", "msa_stiffness_z_N_per_mm", "msa_smallest_N_per_mm",
        "msa_largest_N_per_mm", "msa_isotropy", "msa_kxx_N_per_mm", "msa_kthz_Nmm_per_rad", "relative_difference"})
    EXPECT_EQ(std::count(header.begin(), header.end(), name), 1) << name;
  const auto column = [&](const char* name) { return std::find(header.begin(), header.end(), name) - header.begin(); };
  for (const MapPose& p : map.poses) {
    ASSERT_TRUE(std::getline(lines, line));
    const std::vector<std::string> row = cells(line);
    ASSERT_EQ(row.size(), header.size()) << line;
    const auto cell = [&](const char* name) { return row[static_cast<std::size_t>(column(name))]; };
    EXPECT_EQ(cell("length_mm"), "55");
    EXPECT_EQ(cell("reached"), p.reached() ? "1" : "0");
    EXPECT_EQ(cell("analytic_cxx_mm_per_N").empty(), !p.reached());
    if (p.reached()) {
      EXPECT_EQ(std::stod(cell("msa_czz_mm_per_N")), test::msa(p).compliance_mm_N(2, 2));
    }
  }
  EXPECT_FALSE(std::getline(lines, line));
}

TEST(MapJson, HasSummaryAndArraysInTheGridsOrder) {
  const Mechanism m = device("haptic-6psu");
  const StiffnessMap map = map_stiffness(m, too_wide(m));
  const json j = json::parse(map_json(map));
  EXPECT_EQ(j["device"], "haptic-6psu");
  EXPECT_EQ(j["compliance_kind"], "secant");
  EXPECT_EQ(j["force_N"], 50);
  EXPECT_EQ(j["length_mm"], 55);
  EXPECT_EQ(j["grid"]["z_mm"].size(), 5u);
  EXPECT_LT(j["max_relative_difference"].get<double>(), 1e-7);
  const json& array = j["arrays"]["msa"]["stiffness_x_N_per_mm"];
  ASSERT_EQ(array.size(), map.poses.size());
  double smallest = 1e300;
  for (std::size_t i = 0; i < array.size(); ++i) {
    ASSERT_EQ(array[i].is_null(), !map.poses[i].reached());
    if (map.poses[i].reached()) {
      EXPECT_EQ(array[i], test::msa(map.poses[i]).stiffness_N_mm(0));
      smallest = std::min(smallest, test::msa(map.poses[i]).stiffness_N_mm(0));
    }
  }
  EXPECT_EQ(j["ranges"]["msa"]["stiffness_x_N_per_mm"]["smallest"], smallest);
  EXPECT_LT(j["correlation_with_guide_mean"]["x"]["spearman"].get<double>(), 0);
}

TEST(MapVtu, CellsHaveTheGridsDimensionAndOnlyPosesReached) {
  const Mechanism m = device("haptic-6psu-ideal-joints");
  const auto piece = [&](const MapOptions& o) {
    const std::string text = map_vtu(map_stiffness(m, o));
    const std::size_t at = text.find("<Piece ");
    return text.substr(at, text.find('>', at) - at);
  };
  EXPECT_EQ(piece(cube(m, 3, 3, 2)), "<Piece NumberOfPoints=\"18\" NumberOfCells=\"4\"");
  EXPECT_EQ(piece(cube(m, 3, 1, 3)), "<Piece NumberOfPoints=\"9\" NumberOfCells=\"4\"");
  EXPECT_EQ(piece(cube(m, 1, 1, 3)), "<Piece NumberOfPoints=\"3\" NumberOfCells=\"2\"");
  EXPECT_EQ(piece(cube(m, 1, 1, 1)), "<Piece NumberOfPoints=\"1\" NumberOfCells=\"1\"");
  const StiffnessMap wide = map_stiffness(m, too_wide(m));
  const auto n = std::count_if(wide.poses.begin(), wide.poses.end(), [](const MapPose& p) { return p.reached(); });
  EXPECT_NE(map_vtu(wide).find(fmt::format("NumberOfPoints=\"{}\"", n)), std::string::npos);
}

TEST(MapProgram, WritesFiguresAndTablesAndNoBarIntoAPipe) {
  const Folder folder;
  const auto run = test::deflect("map haptic-6psu --n 5 --x -45,45 --y -45,45 --out '" + (folder / "out").string() +
                                 "' --json '" + (folder / "m.json").string() + "'");
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_EQ(run.out.find('\r'), std::string::npos);
  for (const char* says : {"secant", "tangent", "characteristic length 55 mm", "the link does not reach", "Spearman",
                           "analytic against MSA"})
    EXPECT_NE(run.out.find(says), std::string::npos) << says;
  for (const char* stem : {"fig11", "stiffness-vs-length"})
    for (const char* suffix : {".svg", ".pdf", ".png"})
      EXPECT_GT(contents(folder / "out" / (std::string(stem) + suffix)).size(), 1000u) << stem << suffix;
  EXPECT_GT(contents(folder / "out" / "map.csv").size(), 1000u);
  EXPECT_GT(contents(folder / "out" / "map.vtu").size(), 1000u);
  const json j = json::parse(contents(folder / "m.json"));
  EXPECT_EQ(j["poses"], 125);
  EXPECT_LT(j["reached"].get<int>(), 125);
}

TEST(MapProgram, DrawsSlicesThatAreOutOfReachAsAWhole) {
  const Folder folder;
  const auto run = test::deflect("map haptic-6psu --n 9,8,9 --z 120,300 --out '" + (folder / "out").string() + "'");
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_NE(contents(folder / "out" / "fig11.svg").find("z = 300 mm: out of reach"), std::string::npos);
}

TEST(MapProgram, LoadTiltLengthAndTheoryAreTaken) {
  const Folder folder;
  const auto run = test::deflect(
      "map haptic-6psu --n 2,1,1 --y 3 --tilt 2,0,1 --load 1,2,3,40,50,60 --length '100 mm' --theory msa --threads 1 "
      "--json '" +
      (folder / "m.json").string() + "'");
  ASSERT_EQ(run.code, 0) << run.out;
  const json j = json::parse(contents(folder / "m.json"));
  EXPECT_EQ(j["length_mm"], 100);
  EXPECT_EQ(j["compliance_kind"], "tangent");
  EXPECT_EQ(j["load"][5], 60);
  EXPECT_EQ(j["grid"]["y_mm"], json::array({3.0}));
  EXPECT_EQ(j["grid"]["roll_pitch_yaw_deg"], json::array({2.0, 0.0, 1.0}));
  EXPECT_FALSE(j["arrays"].contains("analytic"));
}

TEST(MapProgram, HelpSaysWhatIsSecantAndWhatIsTangent) {
  const auto run = test::deflect("map --help");
  EXPECT_EQ(run.code, 0);
  for (const char* says : {"secant", "tangent", "Example:\n  deflect map"})
    EXPECT_NE(run.out.find(says), std::string::npos) << run.out;
}

struct Refusal {
  const char* name;
  const char* arguments;
  const char* says;
};

class MapRefused : public ::testing::TestWithParam<Refusal> {};

TEST_P(MapRefused, WithCodeTwoAndReasonAndNoFile) {
  const Folder folder;
  const auto run = test::deflect(std::string("map haptic-6psu ") + GetParam().arguments + " --json '" +
                                 (folder / "r.json").string() + "'");
  EXPECT_EQ(run.code, 2) << run.out;
  EXPECT_NE(run.out.find(GetParam().says), std::string::npos) << run.out;
  EXPECT_FALSE(std::filesystem::exists(folder / "r.json"));
}

INSTANTIATE_TEST_SUITE_P(Inputs, MapRefused,
                         ::testing::Values(Refusal{"NoPoses", "--n 0", "--n 0: give a whole number from 1"},
                                           Refusal{"HalfAPose", "--n 2.5,3,3", "--n 2.5: give a whole number"},
                                           Refusal{"TwoCounts", "--n 2,3", "2 numbers; write nx,ny,nz"},
                                           Refusal{"TooMany", "--n 1000", "at most 10 million"},
                                           Refusal{"Reversed", "--x 20,-20", "--x 20,-20: the range is reversed"},
                                           Refusal{"NotFinite", "--z 100,inf", "--z '100,inf'"},
                                           Refusal{"Word", "--y a,b", "--y 'a,b': number 1"},
                                           Refusal{"NoForce", "--force 0", "--force 0"},
                                           Refusal{"NoLoad", "--load 0,0,0", "without load a contact has no stiffness"},
                                           Refusal{"ShortLoad", "--load 1,2", "--load '1,2'"},
                                           Refusal{"Tilt", "--tilt 1", "--tilt '1'"},
                                           Refusal{"Theory", "--theory fem", "analytic, msa or both"},
                                           Refusal{"LengthWithoutUnit", "--length 100", "--length: '100' has no unit"},
                                           Refusal{"LengthNegative", "--length '-1 mm'", "greater than zero"},
                                           Refusal{"Threads", "--threads -1", "--threads -1"},
                                           Refusal{"Unwritable", "--n 2 --out /proc/none", "/proc/none"}),
                         [](const auto& refusal) { return std::string(refusal.param.name); });

}  // namespace
}  // namespace deflect
