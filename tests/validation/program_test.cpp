// The program as a user meets it: the contract's commands, results, files and exit codes.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/program.h"

namespace deflect {
namespace {

using nlohmann::json;
using test::contents;
using test::deflect;
using test::Folder;

TEST(Program, ValidateWritesTheContractsJsonAndTheFigure) {
  const Folder folder;
  const auto run = deflect("validate haptic-6psu --json '" + (folder / "v.json").string() + "' --out '" +
                           (folder / "out").string() + "'");
  ASSERT_EQ(run.code, 0) << run.out;
  const json v = json::parse(contents(folder / "v.json"));
  ASSERT_EQ(v["points"].size(), 27u);
  const char* axes[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < 27; ++i) {
    const json& p = v["points"][i];
    EXPECT_EQ(p["point"], i / 3);
    EXPECT_EQ(p["load_axis"], axes[i % 3]);
    EXPECT_EQ(p["load_N"], 50);
    EXPECT_EQ(p["pose"].size(), 6u);
    EXPECT_EQ(p["analytic"].size(), 6u);
    EXPECT_EQ(p["msa"].size(), 6u);
  }
  EXPECT_NEAR(v["points"][0]["pose"][2].get<double>(), 173.898547, 1e-6);
  EXPECT_LT(v["max_relative_difference"].get<double>(), 1e-7);
  EXPECT_LE(v["rms_relative_difference"].get<double>(), v["max_relative_difference"].get<double>());
  for (const char* name : {"fig10.svg", "fig10.pdf", "fig10.png", "validation.csv"})
    EXPECT_GT(contents(folder / "out" / name).size(), 1000u) << name;
}

TEST(Program, SolveSaysThatItLeavesTheRigOut) {
  const Folder folder;
  const std::string at = "solve " + (folder / "m.yaml").string() + " --load 0,0,10", note = "not part of this";
  ASSERT_EQ(deflect("new --like scara -o " + (folder / "m.yaml").string()).code, 0);
  EXPECT_EQ(deflect(at + " --joints 0.1,0.2,100,0.3").out.find(note), std::string::npos);
  std::ofstream(folder / "m.yaml", std::ios::app) << "\nrig: {load_cell: {point: [20 mm, 0 mm, 0 mm]}}\n";
  const auto run = deflect(at + " --joints 0.1,0.2,100,0.3");
  EXPECT_EQ(run.code, 0);
  EXPECT_NE(run.out.find(note), std::string::npos) << run.out;
}

TEST(Program, SolveWritesTheContractsJsonAndTheDeflectedStructure) {
  const Folder folder;
  const auto run = deflect("solve haptic-6psu-ideal-joints --pose 25,25,198.898547,0,0,0 --load 50,0,0,0,0,0 --json '" +
                           (folder / "s.json").string() + "' --out '" + (folder / "out").string() + "'");
  ASSERT_EQ(run.code, 0) << run.out;
  const json s = json::parse(contents(folder / "s.json"));
  EXPECT_NEAR(s["analytic"]["displacement"][0].get<double>(), 0.703127, 0.51e-6);
  EXPECT_NEAR(s["msa"]["displacement"][0].get<double>(), 0.703127, 0.51e-6);
  for (const char* theory : {"analytic", "msa"}) {
    ASSERT_EQ(s[theory]["stiffness"].size(), 6u);
    for (const json& row : s[theory]["stiffness"]) EXPECT_EQ(row.size(), 6u);
  }
  EXPECT_LT(s["relative_difference"].get<double>(), 1e-9);
  for (const char* check : {"symmetric", "positive", "passive_joints_free"}) EXPECT_EQ(s["checks"][check], true);
  double sum = 0;
  for (const json& share : s["shares"]) sum += share["share"].get<double>();
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_EQ(s["shares"][0]["part"], "guideway");
  EXPECT_NE(contents(folder / "out" / "deflected.msh").find("displacement_mm"), std::string::npos);
  EXPECT_NE(contents(folder / "out" / "deflected.vtu").find("displacement_mm"), std::string::npos);
}

TEST(Program, SolveDrawsNoStructureThatNoTheoryHas) {
  const Folder folder;
  const auto run = deflect("solve haptic-6psu --theories analytic --pose 25,25,198.9,0,0,0 --load 50,0,0 --out '" +
                           (folder / "out").string() + "'");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.out.find("put msa among --theories"), std::string::npos) << run.out;
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(Program, SolveFindsEquilibriumInTheDeformedShape) {
  const Folder folder;
  const std::string call = "solve haptic-6psu --pose 25,25,198.9 --load 50,0,0 --json '" + (folder / "s.json").string();
  ASSERT_EQ(deflect(call + "'").code, 0);
  const json linear = json::parse(contents(folder / "s.json"));
  EXPECT_FALSE(linear.contains("geometry"));
  for (const std::string geometry : {"second-order", "finite"}) {
    const auto run = deflect(call + "' --geometry " + geometry);
    ASSERT_EQ(run.code, 0) << run.out;
    EXPECT_NE(run.out.find("in the deformed shape (" + geometry + "); from the linear one the displacement differs by"),
              std::string::npos);
    EXPECT_EQ(run.out.find("passive joints free"), std::string::npos);
    const json s = json::parse(contents(folder / "s.json"));
    EXPECT_EQ(s["geometry"], geometry);
    EXPECT_FALSE(s["checks"].contains("passive_joints_free"));
    // The tool is pushed sideways by 0.7 mm of 100 mm: geometry changes the displacement by some such share, and the
    // theories differ by the square of it.
    for (const char* theory : {"analytic", "msa"}) {
      EXPECT_GT(s[theory]["from_linear"].get<double>(), 1e-4);
      EXPECT_LT(s[theory]["from_linear"].get<double>(), 2e-2);
      EXPECT_NE(s[theory]["displacement"][0], linear[theory]["displacement"][0]);
    }
    EXPECT_LT(s["relative_difference"].get<double>(), 1e-4);
  }
}

TEST(Program, SolveRefusesALoadBeyondBucklingAndAnUnknownGeometry) {
  const auto buckled = deflect("solve haptic-6psu --pose 0,0,198.9 --load 0,0,-50000 --geometry finite");
  EXPECT_EQ(buckled.code, 4);
  EXPECT_NE(buckled.out.find("of the load, a buckling or limit load"), std::string::npos) << buckled.out;
  const auto unknown = deflect("solve haptic-6psu --pose 0,0,198.9 --load 0,0,5 --geometry deformed");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_NE(unknown.out.find("linear, second-order, finite"), std::string::npos) << unknown.out;
}

TEST(Program, SameCallSameBytes) {
  const Folder folder;
  for (const char* name : {"a", "b"})
    ASSERT_EQ(deflect("solve haptic-6psu --pose 10,-5,180,3,-2,4 --load 5,6,7,100,200,300 --json '" +
                      (folder / name).string() + "'")
                  .code,
              0);
  EXPECT_EQ(contents(folder / "a"), contents(folder / "b"));
}

TEST(Program, JointsReachTheSamePoseAsThePoseItself) {
  const Folder folder;
  ASSERT_EQ(
      deflect("solve haptic-6psu --joints 80,80,80,80,80,80 --load 50,0,0 --json '" + (folder / "q").string() + "'")
          .code,
      0);
  const json s = json::parse(contents(folder / "q"));
  EXPECT_NEAR(s["pose"][2].get<double>(), 173.898547, 1e-6);
  EXPECT_NEAR(s["pose"][0].get<double>(), 0, 1e-9);
}

TEST(Program, DevicesListsAndPrintsAFileToStartFrom) {
  const auto list = deflect("devices");
  EXPECT_EQ(list.code, 0);
  EXPECT_NE(list.out.find("haptic-6psu-ideal-joints"), std::string::npos);
  const Folder folder;
  const std::string mine = (folder / "my.yaml").string();
  ASSERT_EQ(deflect("devices haptic-6psu > '" + mine + "'").code, 0);
  EXPECT_EQ(deflect("solve '" + mine + "' --pose 0,0,174 --load 50,0,0").code, 0);
}

TEST(Program, PointsComeFromAFile) {
  const Folder folder;
  std::ofstream(folder / "p.csv") << "pose,x_mm,y_mm,z_mm,yaw_deg,note\nnear,0,0,170,5,one\nfar,10,0,180,0,two\n";
  const auto run = deflect("validate haptic-6psu --points '" + (folder / "p.csv").string() + "' --json '" +
                           (folder / "v.json").string() + "'");
  ASSERT_EQ(run.code, 0) << run.out;
  const json v = json::parse(contents(folder / "v.json"));
  ASSERT_EQ(v["points"].size(), 6u);
  EXPECT_EQ(v["points"][3]["point"], "far");
}

struct Refusal {
  const char* name;
  const char* arguments;
  int code;
  const char* says;
  friend void PrintTo(const Refusal& r, std::ostream* out) { *out << r.arguments; }
};

class Refused : public ::testing::TestWithParam<Refusal> {};

TEST_P(Refused, WithCodeAndReasonAndNoFile) {
  const Folder folder;
  const auto run = deflect(std::string(GetParam().arguments) + " --json '" + (folder / "r.json").string() + "'");
  EXPECT_EQ(run.code, GetParam().code) << run.out;
  EXPECT_NE(run.out.find(GetParam().says), std::string::npos) << run.out;
  EXPECT_FALSE(std::filesystem::exists(folder / "r.json"));
}

INSTANTIATE_TEST_SUITE_P(
    Inputs, Refused,
    ::testing::Values(
        Refusal{"UnknownDevice", "validate haptic-6pus", 2, "did you mean 'haptic-6psu'?"},
        Refusal{"MissingFile", "validate ./none.yaml", 2, "none.yaml"},
        Refusal{"UnknownOption", "validate haptic-6psu --frobnicate", 2, "frobnicate"},
        Refusal{"NoPose", "solve haptic-6psu", 2, "--pose"},
        Refusal{"PoseAndJoints", "solve haptic-6psu --pose 0,0,170 --joints 1,2,3,4,5,6", 2, "either --pose"},
        Refusal{"ShortPose", "solve haptic-6psu --pose 0,0", 2, "2 numbers"},
        Refusal{"WordInPose", "solve haptic-6psu --pose 0,zero,170", 2, "number 2: 'zero' is not a finite number"},
        Refusal{"NanLoad", "solve haptic-6psu --pose 0,0,170 --load nan,0,0", 2, "not a finite number"},
        Refusal{"OutOfReach", "solve haptic-6psu --pose 300,0,170 --load 1,0,0", 3, "the link does not reach"},
        Refusal{"SliderRange", "solve haptic-6psu --pose 0,0,400 --load 1,0,0", 3, "outside its range"},
        Refusal{"NoAssembly", "solve haptic-6psu --joints 20,500,20,500,20,500 --load 1,0,0", 3, "no assembly"},
        Refusal{"UnknownErratum", "validate haptic-6psu --as-printed pasive-joints", 2,
                "did you mean 'passive-joints'?"},
        Refusal{"ElementWithoutUnit", "validate haptic-6psu --element-size 25", 2, "--element-size: '25' has no unit"},
        Refusal{"ElementNegative", "validate haptic-6psu --element-size '-1 mm'", 2, "greater than zero"},
        Refusal{"ZeroForce", "validate haptic-6psu --force 0", 2, "other than zero"},
        Refusal{"UnwritableFolder", "validate haptic-6psu --out /proc/none", 2, "/proc/none"}),
    [](const auto& refusal) { return std::string(refusal.param.name); });

TEST(Program, AMechanismThatCannotStandIsRefusedAndDrawn) {
  const Folder folder;
  const std::string loose = (folder / "loose.yaml").string();
  ASSERT_EQ(deflect("devices haptic-6psu-ideal-joints | sed 's/mount: {joint: fixed/mount: {joint: slider/' > '" +
                    loose + "'")
                .code,
            0);
  const auto run =
      deflect("solve '" + loose + "' --pose 0,0,174 --load 1,0,0 --out '" + (folder / "out").string() + "'");
  EXPECT_EQ(run.code, 3) << run.out;
  EXPECT_NE(run.out.find("node 'platform' slides along (0, 0, 1). To hold it, lock or spring one of: leg 1 mount tz"),
            std::string::npos)
      << run.out;
  EXPECT_NE(contents(folder / "out" / "motion-1.vtu").find("displacement_mm"), std::string::npos);
  EXPECT_GT(contents(folder / "out" / "motion-1.msh").size(), 1000u);
}

TEST(Program, HelpOfEveryCommandSaysWhatItDoesWithAnExample) {
  for (const char* command : {"solve", "validate", "frame", "map", "export", "devices"}) {
    const auto run = deflect(std::string(command) + " --help");
    EXPECT_EQ(run.code, 0);
    EXPECT_NE(run.out.find("Example:\n  deflect " + std::string(command)), std::string::npos) << run.out;
  }
  EXPECT_EQ(deflect("--help").code, 0);
  EXPECT_EQ(deflect("").code, 2);
}

TEST(Program, AsPrintedShowsThePriceBesideTheCorrectedTheory) {
  const auto run = deflect("validate haptic-6psu --as-printed passive-joints --errata");
  ASSERT_EQ(run.code, 0) << run.out;
  EXPECT_NE(run.out.find("as printed"), std::string::npos);
  EXPECT_NE(run.out.find("passive-joints"), std::string::npos);
  EXPECT_NE(run.out.find("K_c J_q = 0 fails"), std::string::npos);
}

TEST(Program, PriceOfTheErrataIsDrawnSigned) {
  const test::Folder folder;
  const std::string out = (folder / "out").string();
  const auto run = deflect("validate haptic-6psu --errata --out '" + out + "'");
  ASSERT_EQ(run.code, 0) << run.out;
  const std::string svg = test::contents(folder / "out" / "errata.svg"),
                    caption = test::contents(folder / "out" / "errata.txt");
  for (const char* text : {"scalar-direction", "too stiff", "too soft", "load along z", "÷2", "×10", "+1 %"})
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  for (const char* text : {"haptic-6psu", "50 N", "base axes", "9 points", "as printed over corrected"})
    EXPECT_NE(caption.find(text), std::string::npos) << text << "\n" << caption;
}

}  // namespace
}  // namespace deflect
