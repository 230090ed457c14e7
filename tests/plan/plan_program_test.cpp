// deflect plan as a user runs it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/support/paths.h"
#include "tests/support/program.h"
#include "validation/measurement/measurements.h"

namespace deflect {
namespace {

const std::string device = "haptic-6psu-ideal-joints";

/// A tie that the paper's plan leaves: data and diagnosis in a folder.
class PlanProgram : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = std::make_unique<test::Folder>();
    const test::Run made =
        test::deflect("simulate " + device +
                      " --with actuator_compliance,stiffness_N_per_mm=3000 --campaign paper --seed 3 --machine 3 -o " +
                      path("paper.csv"));
    ASSERT_EQ(made.code, 0) << made.out;
    const test::Run diagnosed = test::deflect("diagnose " + device + " " + path("paper.csv") +
                                              " --bootstrap 99 --json " + path("diagnosis.json"));
    ASSERT_EQ(diagnosed.code, 0) << diagnosed.out;
  }
  static void TearDownTestSuite() { folder.reset(); }
  /// Readings of a healthy arm in a file.
  static std::string scara(const std::string& seed) {
    const std::string file = path("scara_" + seed + ".csv");
    EXPECT_EQ(test::deflect("simulate scara --campaign paper --machine 3 --seed " + seed + " -o " + file).code, 0);
    return file;
  }
  static std::string path(const std::string& name) { return (*folder / name).string(); }
  static inline std::unique_ptr<test::Folder> folder;
};

TEST_F(PlanProgram, TheLoopFromATieToItsEnd) {
  const auto first = nlohmann::json::parse(test::contents(path("diagnosis.json")));
  ASSERT_EQ(first.at("verdict"), "ambiguous");
  ASSERT_FALSE(first.at("ties").empty());
  const test::Run planned = test::deflect("plan " + device + " " + path("diagnosis.json") + " -o " + path("next.csv") +
                                          " --json " + path("plan.json") + " --out " + path("figures"));
  ASSERT_EQ(planned.code, 0) << planned.out;
  const auto plan = nlohmann::json::parse(test::contents(path("plan.json")));
  EXPECT_EQ(plan.at("kind"), "plan");
  EXPECT_TRUE(std::filesystem::exists(path("figures/plan.csv")));
  // Four times finer than planned: of readings as planned one set in fifteen would name the other, by their noise.
  const test::Run filled =
      test::deflect("simulate " + device + " --with actuator_compliance,stiffness_N_per_mm=3000 --campaign " +
                    path("next.csv") + " --noise 0.0005 --seed 4 --machine 3 -o " + path("filled.csv"));
  ASSERT_EQ(filled.code, 0) << filled.out;
  const test::Run again = test::deflect("diagnose " + device + " " + path("paper.csv") + " " + path("filled.csv") +
                                        " --bootstrap 99 --json " + path("again.json"));
  ASSERT_EQ(again.code, 0) << again.out;
  const auto second = nlohmann::json::parse(test::contents(path("again.json")));
  ASSERT_FALSE(second.at("missing").empty());
  EXPECT_EQ(second.at("missing").front(), "actuator_compliance");
  EXPECT_EQ(second.at("data"), path("paper.csv") + " + " + path("filled.csv"));
}

// The instrument that a plan proposes, in the device: its readings name the effect.
TEST_F(PlanProgram, AProposedInstrumentTells) {
  const test::Run planned = test::deflect("plan " + device + " " + path("diagnosis.json") + " -o " + path("many.csv") +
                                          " --json " + path("instruments.json"));
  ASSERT_EQ(planned.code, 0) << planned.out;
  const auto plan = nlohmann::json::parse(test::contents(path("instruments.json")));
  ASSERT_FALSE(plan.at("new_sensors").empty());
  const auto& gauge = plan.at("new_sensors").front();
  EXPECT_NE(gauge.at("name").get<std::string>().find("_in_leg_"), std::string::npos) << "beside the actuator";
  ASSERT_FALSE(gauge.at("enough").empty());
  EXPECT_LT(gauge.at("enough").size(), plan.at("readings").size() / 4);
  std::ofstream(path("gauged.yaml")) << test::contents(test::source_dir() + "/validation/devices/" + device + ".yaml")
                                     << "sensors: {gauge: " << gauge.at("entry").get<std::string>() << "}\n";
  const std::string with = " --with actuator_compliance,stiffness_N_per_mm=3000 --machine 3 ";
  const test::Run read = test::deflect("simulate " + path("gauged.yaml") + with + "--campaign " + path("many.csv") +
                                       " --seed 4 -o " + path("gauged.csv"));
  ASSERT_EQ(read.code, 0) << read.out;
  const test::Run again = test::deflect("diagnose " + path("gauged.yaml") + " " + path("paper.csv") + " " +
                                        path("gauged.csv") + " --bootstrap 99 --json " + path("told.json"));
  ASSERT_EQ(again.code, 0) << again.out;
  const auto told = nlohmann::json::parse(test::contents(path("told.json")));
  ASSERT_FALSE(told.at("missing").empty()) << again.out;
  EXPECT_EQ(told.at("missing").front(), "actuator_compliance");
}

// One reading of a gauge on a carriage, 5 standard deviations from what the machine as drawn would read, and 2.5 from
// what it reads with the effect. It counts for all candidates or for none: the probabilities are those of the verdict.
TEST_F(PlanProgram, AReadingThatIsAnOutlierToNothingAloneCountsForAllCandidates) {
  std::ofstream(path("carriage.yaml")) << test::contents(test::source_dir() + "/validation/devices/" + device + ".yaml")
                                       << "sensors: {gauge: {body: leg.3.guideway, direction: uz, sigma: 2 um}}\n";
  std::ofstream(path("gauge.csv"))
      << "pose,x_mm,y_mm,z_mm,roll_deg,pitch_deg,yaw_deg,fx_N,fy_N,fz_N,mx_Nmm,gauge_mm\n"
         "A,-20.771166,-24.969602,155.606814,-4.034387,6.168938,1.146458,0,50,0,1051,-0.01073\n";
  const test::Run run = test::deflect("diagnose " + path("carriage.yaml") + " " + path("paper.csv") + " " +
                                      path("gauge.csv") + " --bootstrap 99 --json " + path("gauge.json"));
  ASSERT_EQ(run.code, 0) << run.out;
  const auto j = nlohmann::json::parse(test::contents(path("gauge.json")));
  ASSERT_EQ(j.at("verdict"), "effect") << run.out;
  EXPECT_EQ(j.at("missing").front(), "actuator_compliance");
  for (const auto& c : j.at("candidates")) {
    if (c.at("effect") != "platform_flexibility") continue;
    EXPECT_LT(c.at("probability").get<double>(), 0.01) << run.out;
  }
}

// A diagnosis of several sessions names all of them: a plan and a page find them again.
TEST_F(PlanProgram, SeveralSessionsAreFoundAgain) {
  auto diagnosis = nlohmann::json::parse(test::contents(path("diagnosis.json")));
  std::filesystem::create_directory(path("elsewhere"));
  const test::Run second =
      test::deflect("simulate " + device + " --campaign paper --seed 9 -o " + path("elsewhere/second.csv"));
  ASSERT_EQ(second.code, 0) << second.out;
  diagnosis["data"] = path("paper.csv") + " + gone/second.csv";
  std::ofstream(path("elsewhere/two.json")) << diagnosis.dump(2);
  const std::string planned = "plan " + device + " " + path("elsewhere/two.json") + " --readings 1 ";
  const test::Run found = test::deflect(planned + "-o " + path("more.csv") + " --json " + path("more.json"));
  ASSERT_EQ(found.code, 0) << found.out;
  EXPECT_EQ(nlohmann::json::parse(test::contents(path("more.json"))).at("taken"), 54);
  EXPECT_NE(found.out.find("deflect diagnose " + device + " " + path("paper.csv") + " " + path("elsewhere/second.csv") +
                           " " + path("more.csv")),
            std::string::npos)
      << found.out;
  std::filesystem::remove(path("elsewhere/second.csv"));
  const test::Run lost = test::deflect(planned);
  EXPECT_EQ(lost.code, 2) << lost.out;
  EXPECT_NE(lost.out.find("'gone/second.csv', are not there"), std::string::npos) << lost.out;
  const test::Run page = test::deflect("report " + path("more.json") + " -o " + path("plan.html"));
  if (page.code == 2 && page.out.find("built without pages") != std::string::npos) GTEST_SKIP() << page.out;
  EXPECT_EQ(page.code, 0) << page.out;
  const test::Run sessions = test::deflect("diagnose scara " + scara("1") + " " + scara("2") +
                                           " --bootstrap 99 --report " + path("sessions.html"));
  EXPECT_EQ(sessions.code, 0) << sessions.out;
}

// Readings may be added to a diagnosis, but a slip in a file's name must not pass unseen.
TEST_F(PlanProgram, DataOtherThanTheDiagnosedAreRemarked) {
  const std::string plan = "plan " + device + " " + path("diagnosis.json") + " ", few = " --readings 1";
  const std::string remark = path("diagnosis.json") + " was not made from ";
  const test::Run diagnosed = test::deflect(plan + path("paper.csv") + few);
  EXPECT_EQ(diagnosed.code, 0) << diagnosed.out;
  EXPECT_EQ(diagnosed.out.find(remark), std::string::npos) << diagnosed.out;
  const test::Run other = test::deflect("simulate " + device + " --campaign paper --seed 5 -o " + path("other.csv"));
  ASSERT_EQ(other.code, 0) << other.out;
  const test::Run planned = test::deflect(plan + path("other.csv") + few);
  EXPECT_EQ(planned.code, 0) << planned.out;
  EXPECT_NE(planned.out.find(remark + path("other.csv")), std::string::npos) << planned.out;
}

TEST_F(PlanProgram, AnEmptyPlanIsRefusedUntilItIsFilledIn) {
  const test::Run planned =
      test::deflect("plan " + device + " " + path("diagnosis.json") + " --readings 4 -o " + path("empty.csv"));
  ASSERT_EQ(planned.code, 0) << planned.out;
  const test::Run compared = test::deflect("compare " + device + " " + path("empty.csv"));
  EXPECT_EQ(compared.code, 2) << compared.out;
}

TEST_F(PlanProgram, BeforeAnyMeasurement) {
  const test::Run run = test::deflect("plan " + device + " --before paper --aim precision -o " + path("better.csv") +
                                      " --json " + path("foresight.json") + " --out " + path("before"));
  ASSERT_EQ(run.code, 0) << run.out;
  const auto j = nlohmann::json::parse(test::contents(path("foresight.json")));
  EXPECT_EQ(j.at("kind"), "foresight");
  EXPECT_EQ(j.at("given").at("readings"), 27);
  EXPECT_EQ(j.at("better").at("readings"), 27);
  EXPECT_LT(j.at("better").at("error_after_um"), j.at("given").at("error_after_um"));
  const std::size_t effects = j.at("given").at("detectable").size();
  ASSERT_EQ(j.at("given").at("cosines").size(), effects);
  EXPECT_NEAR(j.at("given").at("cosines")[2][2], 1, 1e-9);
  EXPECT_TRUE(std::filesystem::exists(path("before/foresight.svg")));
  EXPECT_EQ(j.at("better_found"), true);
  EXPECT_EQ(j.at("better").at("gain").size(), 27u);
  EXPECT_NEAR(j.at("better").at("gain").back().at("value").get<double>(),
              j.at("better").at("error_after_um").get<double>(),
              0.02 * j.at("better").at("error_after_um").get<double>());
  const test::Run page = test::deflect("report " + path("foresight.json") + " -o " + path("foresight.html"));
  const bool without_pages = page.code == 2 && page.out.find("built without pages") != std::string::npos;
  EXPECT_TRUE(page.code == 0 || without_pages) << page.out;
  // The better campaign is itself a campaign.
  const test::Run used =
      test::deflect("simulate " + device + " --campaign " + path("better.csv") + " -o " + path("x.csv"));
  EXPECT_EQ(used.code, 0) << used.out;
}

// A jack at a node: the planned file names the node, is read again, and the diagnosis takes what was read there.
TEST_F(PlanProgram, PlansForcesAtNodes) {
  const std::string hidden = " --with factor@cross0,factor=0.05 --machine 3";
  const auto run = [&](const std::string& words) {
    const test::Run r = test::deflect(words);
    EXPECT_EQ(r.code, 0) << words << "\n" << r.out;
    return r.out;
  };
  run("simulate lattice-girder --campaign paper --seed 5" + hidden + " -o " + path("girder.csv"));
  run("diagnose lattice-girder " + path("girder.csv") + " --json " + path("girder.json"));
  const auto found = nlohmann::json::parse(test::contents(path("girder.json")));
  const std::string told = run("plan lattice-girder " + path("girder.json") + " --nodes all -o " + path("next.csv"));
  EXPECT_TRUE(std::regex_search(told, std::regex("node\\.[a-z0-9]+\\.f[xyz] = -?20000 N"))) << told;
  EXPECT_EQ(told.find("pose"), std::string::npos) << "a frame has none: " << told;
  EXPECT_NE(test::contents(path("next.csv")).find("node."), std::string::npos);
  run("simulate lattice-girder --campaign " + path("next.csv") + " --seed 6" + hidden + " -o " + path("filled.csv"));
  run("diagnose lattice-girder " + path("girder.csv") + " " + path("filled.csv"));
  const test::Run machine = test::deflect("plan " + device + " --before paper --nodes all");
  EXPECT_EQ(machine.code, 2);
  EXPECT_NE(machine.out.find("no nodes to load"), std::string::npos) << machine.out;
}

// The page of a plan: of a machine with its poses, of a frame under its loads.
TEST_F(PlanProgram, WritesAPage) {
  const test::Run machine = test::deflect("plan " + device + " --before paper --report " + path("machine.html"));
  if (machine.out.find("built without pages") != std::string::npos) GTEST_SKIP() << machine.out;
  ASSERT_EQ(machine.code, 0) << machine.out;
  const std::string page = test::contents(path("machine.html"));
  for (const char* held : {"\"kind\":\"foresight\"", "\"better_found\"", "\"stands\"", "\"pose_mm_deg\""})
    EXPECT_NE(page.find(held), std::string::npos) << held;
  const test::Run frame = test::deflect("plan portal-semi-rigid --before paper --report " + path("frame.html"));
  EXPECT_EQ(frame.code, 0) << frame.out;
  EXPECT_TRUE(std::filesystem::exists(path("frame.html")));
}

// The columns of the file say what is read, filled in or not, and a campaign beyond the limits is not written.
TEST_F(PlanProgram, ReadsTheChannelsOfTheFileWithinTheLimits) {
  const std::string cells =
      "p,0,0.5,0,30,0,0,,,0.01,1e-5\nq,0.6,0.9,30,0,0,0,,,0.01,1e-5\nq,0.6,0.9,0,30,0,0,,,0.01,1e-5\n";
  std::ofstream(path("campaign.csv"))
      << ("pose,q1_rad,q2_rad,fx_N,fy_N,fz_N,mz_Nmm,ux_mm,thz_rad,sigma_u_mm,sigma_th_rad\n" + cells);
  std::ofstream(path("lever.yaml"))
      << "name: lever\nkinematics: {family: chains}\nleg:\n"
         "  pivot: {joint: motor, rz: {law: linear, stiffness: 2 kNm/rad}}\n  lever: {offset: [300 mm, 0 mm, 0 mm]}\n"
         "  elbow: {joint: motor, rz: {law: linear, stiffness: 1 kNm/rad}}\n  fore: {offset: [200 mm, 0 mm, 0 mm]}\n"
         "tolerances: {load: 1 %, leg.pivot.rz.stiffness: 5 %, leg.elbow.rz.stiffness: 5 %}\n";
  const std::string plan = "plan " + path("lever.yaml") + " --before " + path("campaign.csv") + " -o " +
                           path("better.csv") + " --json " + path("f.json");
  ASSERT_EQ(test::deflect(plan).code, 0);
  const auto header = [&] {
    return test::contents(path("better.csv")).substr(0, test::contents(path("better.csv")).find('\n'));
  };
  EXPECT_NE(header().find("ux_mm,thz_rad"), std::string::npos) << header();
  for (const char* not_read : {"uy_mm", "uz_mm"}) EXPECT_EQ(header().find(not_read), std::string::npos) << header();
  EXPECT_EQ(test::contents(path("better.csv")).find(",0,0,0.01"), std::string::npos) << "cells are empty";

  const test::Run limited = test::deflect(plan + " --max-force 10 --max-moment 500");
  ASSERT_EQ(limited.code, 0) << limited.out;
  EXPECT_NE(limited.out.find("goes beyond the limits"), std::string::npos) << limited.out;
  EXPECT_EQ(nlohmann::json::parse(test::contents(path("f.json"))).at("given_within_limits"), false);
  const measurement::Measurements within = measurement::read_plan(path("better.csv"));
  ASSERT_EQ(within.readings.size(), 3u);
  for (const measurement::Reading& r : within.readings) {
    EXPECT_LE(r.load.head<3>().cwiseAbs().maxCoeff(), 10);
    EXPECT_LE(r.load.tail<3>().cwiseAbs().maxCoeff(), 0.5);
  }
}

TEST_F(PlanProgram, WhatIsWrongIsSaid) {
  EXPECT_EQ(test::deflect("plan " + device).code, 2);
  EXPECT_EQ(test::deflect("plan " + device + " " + path("diagnosis.json") + " --before paper").code, 2);
  EXPECT_EQ(test::deflect("plan " + device + " " + path("diagnosis.json") + " --group 9").code, 2);
  EXPECT_EQ(test::deflect("plan " + device + " " + path("diagnosis.json") + " --max-force 0 --forces-only").code, 2);
  EXPECT_EQ(test::deflect("plan " + device + " --before papre").code, 2);
  EXPECT_EQ(test::deflect("plan " + device + " --before paper --aim speed").code, 2);
  for (const char* ignored : {"--group 2", "--readings 4", "--probability 0.9"}) {
    const test::Run run = test::deflect("plan " + device + " --before paper " + ignored);
    EXPECT_EQ(run.code, 2) << ignored;
    EXPECT_NE(run.out.find("leave out --"), std::string::npos) << run.out;
  }
  EXPECT_EQ(test::deflect("plan " + device + " " + path("diagnosis.json") + " --use x.csv").code, 2);
  const test::Run other =
      test::deflect("plan haptic-6psu " + path("diagnosis.json") + " " + path("paper.csv") + " --readings 1");
  EXPECT_NE(other.out.find("is of 'haptic-6psu-ideal-joints', and this is 'haptic-6psu'"), std::string::npos)
      << other.out;
}

}  // namespace
}  // namespace deflect
