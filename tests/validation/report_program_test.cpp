// `--report` and `deflect report` as a user meets them: the page is opened and used in a browser.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "msa/base/files.h"
#include "tests/support/page.h"
#include "validation/page/page.h"

namespace deflect {
namespace {

using namespace page;

using nlohmann::json;
using test::contents;
using test::page_data;

class ReportProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!pages_are_built()) GTEST_SKIP() << "built without pages";
  }
  std::string path(const std::string& name) { return "'" + (folder / name).string() + "'"; }
  void run(const std::string& arguments) {
    const test::Run run = test::deflect(arguments);
    ASSERT_EQ(run.code, 0) << run.out;
  }
  void simulate(const std::string& more = "") {
    run("simulate haptic-6psu-ideal-joints --campaign paper --with guide_root_compliance,stiffness_Nmm_per_rad=1e6 "
        "--seed 5 -o " +
        path("data.csv") + more);
  }
  /// A result without what it was made from, which pages do not hold.
  json result_in(const std::string& name) {
    json result = json::parse(contents(folder / name));
    result.erase("provenance");
    return result;
  }
  /// What the browser saw, after what holds for every page.
  json used(const std::string& page, const std::string& window = "1200,900", bool dark = false, bool webgl = true) {
    const auto seen = test::used_page(folder / page, folder, window, dark, webgl);
    EXPECT_TRUE(seen) << "the browser said nothing";
    if (!seen) return {};
    EXPECT_EQ(seen->at("failures"), json::array()) << seen->at("failures").dump(1);
    for (const json& chart : seen->at("charts")) {
      EXPECT_GT(chart.at("drawn"), 0) << chart;
      EXPECT_GT(chart.at("colours"), 3) << chart;
    }
    for (const json& colours : seen->at("views")) EXPECT_GT(colours, 20);
    for (const json& notes : seen->at("notes")) EXPECT_FALSE(notes.empty()) << "nothing to read under the pointer";
    if (seen->contains("still")) {
      EXPECT_FALSE(seen->at("still"));
      EXPECT_TRUE(seen->at("dragged"));
      EXPECT_TRUE(seen->at("turned"));
    }
    EXPECT_FALSE(seen->at("wide")) << "wider than the window";
    EXPECT_EQ(seen->at("cut"), json::array()) << "words that are cut or stand beyond the window";
    EXPECT_EQ(seen->at("scripts"), 3);  // data, program, the check
    EXPECT_LT(std::filesystem::file_size(folder / page), 5'000'000u);
    return *seen;
  }

  test::Folder folder;
};

#define NEEDS_BROWSER() \
  if (test::browser().empty()) GTEST_SKIP() << "no Chromium here"

/// Cells of a CSV without quotes in the row that begins so.
std::vector<std::string> row_of(const std::string& csv, const std::string& begin) {
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(begin)) continue;
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    return cells;
  }
  return {};
}

TEST_F(ReportProgram, APageOfADiagnosisIsUsedInABrowserAndHoldsTheNumbersOfItsJson) {
  NEEDS_BROWSER();
  simulate();
  run("diagnose haptic-6psu-ideal-joints " + path("data.csv") + " --json " + path("d.json") + " --report " +
      path("page.html"));
  const json d = result_in("d.json"), data = page_data(contents(folder / "page.html"));
  EXPECT_EQ(data.at("results").at(0).at("result"), d);
  EXPECT_EQ(data.at("data").at("text"), contents(folder / "data.csv"));

  const json seen = used("page.html");
  for (const char* each : {"posed", "readout", "deflected"}) EXPECT_TRUE(seen.at(each)) << each;
  const auto headline = seen.at("verdict").get<std::string>(), ids = seen.at("ids").get<std::string>();
  EXPECT_TRUE(headline.starts_with("The clamp of every guideway yields and lets it tilt. ")) << headline;
  EXPECT_EQ(headline.find("guide_root_compliance"), std::string::npos) << headline;
  EXPECT_TRUE(ids.starts_with("guide_root_compliance (all legs): stiffness_Nmm_per_rad = ")) << ids;
  EXPECT_GE(seen.at("charts").size(), 10u);  // candidates, waterfall, residuals twice, six legs

  const json& best = d.at("candidates").at(0);
  const auto row = row_of(seen.at("saved").at("candidates.csv"), best.at("effect").get<std::string>() + " (");
  ASSERT_GE(row.size(), 5u);
  EXPECT_EQ(std::stod(row[1]), best.at("probability"));
  EXPECT_EQ(std::stod(row[2]), best.at("rmse_mm"));
  EXPECT_EQ(std::stod(row[3]), best.at("held_out_rmse_mm"));
  EXPECT_EQ(json::parse(seen.at("saved").at("diagnosis.json").get<std::string>()), d);

  const json& versions = data.at("versions");
  ASSERT_EQ(versions.size(), 2u);
  EXPECT_LT(versions[1].at("result").at("baseline").at("rmse_mm"),
            versions[0].at("result").at("baseline").at("rmse_mm"));
  EXPECT_EQ(data.at("scene").at("guilty").size(), 6u);

  run("report " + path("d.json") + " -o " + path("alone.html"));
  EXPECT_EQ(used("alone.html").at("charts").size(), 2u);  // candidates, waterfall
  run("report " + path("d.json") + " --device haptic-6psu-ideal-joints --data " + path("data.csv") + " -o " +
      path("again.html"));
  const json again = page_data(contents(folder / "again.html"));
  for (const char* each : {"versions", "scene", "device", "data"}) EXPECT_EQ(again.at(each), data.at(each)) << each;
}

TEST_F(ReportProgram, ResidualsOfAPageAreMeasuredMinusPredicted) {
  simulate();
  run("compare haptic-6psu-ideal-joints " + path("data.csv") + " --json " + path("c.json") + " --report " +
      path("page.html"));
  const json data = page_data(contents(folder / "page.html")), c = result_in("c.json");
  const json& version = data.at("versions").at(0);
  EXPECT_EQ(version.at("result"), c);
  double squares = 0;
  std::size_t n = 0;
  for (const json& r : version.at("readings"))
    for (std::size_t i = 0; i < 3; ++i) {
      const double residual = r.at("residual").at(i);
      EXPECT_NEAR(residual, r.at("measured").at(i).get<double>() - r.at("predicted").at(i).get<double>(), 1e-12);
      squares += residual * residual;
      ++n;
    }
  const double rmse = c.at("baseline").at("rmse_mm"), floor = c.at("noise_floor_mm");
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(n)), rmse, 1e-3 * rmse);
  for (const json& p : version.at("poses"))
    for (const json& draw : p.at("with_nothing_missing")) {
      EXPECT_GT(draw, 0.1 * floor);
      EXPECT_LT(draw, 4 * floor);
    }
}

TEST_F(ReportProgram, TheShapeInThePictureIsTheAnswerOfSolve) {
  run("solve haptic-6psu --pose 25,25,198.9 --load 50,0,0 --json " + path("s.json") + " --report " + path("page.html"));
  const json s = json::parse(contents(folder / "s.json")),
             scene = page_data(contents(folder / "page.html")).at("scene");
  const json& u =
      scene.at("poses").at(0).at("shapes").at(0).at("displacement_mm").at(scene.at("tool").get<std::size_t>());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(u.at(i), s.at("msa").at("displacement").at(i).get<double>(), 1e-5);
}

TEST_F(ReportProgram, TextOfUsersStaysText) {
  NEEDS_BROWSER();
  simulate();
  std::string device = test::deflect("devices haptic-6psu-ideal-joints").out;
  const std::string evil = "</script><script>window.broken = document.write('x')</script><img src=x onerror=alert(1)>";
  device.replace(device.find("name: haptic-6psu-ideal-joints"), 30, "name: \"" + evil + "\"");
  write_text(folder / "evil.yaml", device);
  std::istringstream lines(contents(folder / "data.csv"));
  std::string text, line;
  for (bool head = true; std::getline(lines, line); head = false)
    text += line + (head ? ",note_<b>who</b>" : ",\"" + evil + "\"") + "\n";
  write_text(folder / "noted.csv", text);
  run("compare " + path("evil.yaml") + " " + path("noted.csv") + " --report " + path("page.html"));
  const json seen = used("page.html");
  EXPECT_NE(seen.at("saved").at("readings-0.csv").get<std::string>().find("onerror=alert(1)"), std::string::npos);
  EXPECT_EQ(page_data(contents(folder / "page.html")).at("versions").at(0).at("device"), evil);
}

TEST_F(ReportProgram, APageFitsATelephoneInLightAndInDark) {
  NEEDS_BROWSER();
  simulate();
  run("compare haptic-6psu-ideal-joints " + path("data.csv") + " --report " + path("page.html"));
  const json light = used("page.html", "390,844"), dark = used("page.html", "390,844", true);
  EXPECT_NE(light.at("background"), dark.at("background"));
}

TEST_F(ReportProgram, PagesWithLongNamesFitATelephone) {
  NEEDS_BROWSER();
  simulate();
  std::string device = test::deflect("devices haptic-6psu-ideal-joints").out;
  device.replace(device.find("name: haptic-6psu-ideal-joints"), 30,
                 "name: haptic_device_of_the_second_laboratory_with_another_carriage_and_ball_joints");
  write_text(folder / "haptic-device-of-the-second-laboratory-with-another-carriage.yaml", device);
  const std::string named = path("haptic-device-of-the-second-laboratory-with-another-carriage.yaml");
  for (const std::string& command :
       {"diagnose " + named + " " + path("data.csv"), "solve " + named + " --pose 25,25,198.9 --load 0,0,10",
        "map " + named + " --n 3", std::string("validate tripteron"), std::string("frame ansys-vm217"),
        std::string("show gantry")}) {
    SCOPED_TRACE(command);
    run(command + " --report " + path("page.html"));
    used("page.html", "390,844");
  }
}

TEST_F(ReportProgram, WithoutWebGLThePageSaysSoAndShowsTheRest) {
  NEEDS_BROWSER();
  simulate();
  run("compare haptic-6psu-ideal-joints " + path("data.csv") + " --report " + path("page.html"));
  const json seen = used("page.html", "1200,900", false, false);
  const json missing = seen.at("missing");
  ASSERT_EQ(missing.size(), 2u) << missing;  // the machine, the map of the residual
  EXPECT_NE(missing[0].get<std::string>().find("The machine could not be drawn: this browser does not draw in 3D"),
            std::string::npos)
      << missing;
  EXPECT_TRUE(seen.at("verdict").get<std::string>().starts_with("Something is missing")) << seen.at("verdict");
  EXPECT_EQ(seen.at("charts").size(), used("page.html").at("charts").size());
  EXPECT_TRUE(seen.at("saved").contains("tool-displacement.csv"));
  EXPECT_EQ(used("page.html").at("missing"), json::array());
}

TEST_F(ReportProgram, AFigureThatFailsIsLeftOutAndTheOthersStand) {
  NEEDS_BROWSER();
  simulate();
  run("compare haptic-6psu-ideal-joints " + path("data.csv") + " --report " + path("page.html"));
  std::string html = contents(folder / "page.html");
  const json whole = page_data(html);
  const std::string mark = "id=\"data\">";
  const std::size_t from = html.find(mark) + mark.size(), to = html.find("</script>", from);
  json data = whole;
  data["scene"]["poses"][0].erase("points_mm");
  data["versions"][0]["curves"][1].erase("force");
  data["versions"][0]["result"].erase("errors");
  write_text(folder / "broken.html", html.substr(0, from) + data.dump() + html.substr(to));
  const json seen = used("broken.html"), good = used("page.html");
  const json missing = seen.at("missing");
  ASSERT_EQ(missing.size(), 3u) << missing.dump(1);
  EXPECT_TRUE(missing[0].get<std::string>().starts_with("The machine could not be drawn: ")) << missing[0];
  EXPECT_TRUE(missing[1].get<std::string>().find("Force–elongation of ") != std::string::npos) << missing[1];
  EXPECT_TRUE(missing[2].get<std::string>().starts_with("Errors by group could not be drawn: ")) << missing[2];
  EXPECT_EQ(seen.at("verdict"), good.at("verdict"));
  EXPECT_EQ(seen.at("charts").size() + 1, good.at("charts").size());
}

TEST_F(ReportProgram, TheSceneHasSectionsLoadsAndGround) {
  run("solve scara --pose 380,50,160 --load 0,0,-20,0,500,0 --report " + path("page.html"));
  const json scene = page_data(contents(folder / "page.html")).at("scene");
  EXPECT_EQ(scene.at("kind"), "machine");
  const json& pose = scene.at("poses").at(0);
  bool box = false;
  for (std::size_t i = 0; i < scene.at("bodies").size(); ++i) {
    const json& body = scene.at("bodies")[i];
    if (body.at("part") != "upper_link") continue;
    box = true;
    EXPECT_EQ(body.at("size_mm"), json({100.0, 70.0}));
    EXPECT_EQ(body.at("round"), false);
    EXPECT_NEAR(pose.at("axes")[i].at(2).get<double>(), 0, 1e-6) << "its local y lies level";
  }
  EXPECT_TRUE(box);
  const json& arrows = pose.at("shapes").at(0).at("arrows");
  ASSERT_EQ(arrows.size(), 2u);
  EXPECT_EQ(arrows[0].at("words"), "20 N");
  EXPECT_EQ(arrows[0].at("vector"), json({0.0, 0.0, -20.0}));
  EXPECT_EQ(arrows[1].at("kind"), "moment");
  EXPECT_EQ(arrows[1].at("words"), "500 Nmm");
  ASSERT_EQ(scene.at("ground").size(), 1u);
  EXPECT_EQ(scene.at("ground")[0].at("at_mm"), json({0.0, 0.0, 0.0}));
  if (test::browser().empty()) return;
  const json seen = used("page.html");
  EXPECT_TRUE(seen.at("scale").get<std::string>().ends_with(" mm")) << seen.at("scale");
  EXPECT_TRUE(seen.at("factor").get<std::string>().starts_with("deflection × ")) << seen.at("factor");
}

TEST_F(ReportProgram, AFrameUnderItsLoadsIsAPage) {
  run("frame portal --json " + path("f.json") + " --report " + path("page.html"));
  const json data = page_data(contents(folder / "page.html")), f = result_in("f.json");
  EXPECT_EQ(data.at("results").at(0).at("kind"), "frame");
  EXPECT_EQ(data.at("results").at(0).at("result"), f);
  const json& scene = data.at("scene");
  EXPECT_EQ(scene.at("kind"), "frame");
  EXPECT_EQ(scene.at("poses").at(0).at("shapes").size(), f.at("cases").size());
  // Nodes of the description come first, and move as the result says.
  for (const json& drawn : scene.at("poses").at(0).at("shapes")) {
    const auto name = drawn.at("name").get<std::string>();
    const json& of_case = f.at("cases").at(name);
    EXPECT_EQ(drawn.at("arrows").empty(), name == "summer") << name;
    EXPECT_EQ(drawn.at("other_loads"), name == "summer" ? "1 member warmer or colder" : "");
    for (std::size_t i = 0; i < of_case.at("displacements").size(); ++i)
      EXPECT_NEAR(drawn.at("displacement_mm").at(i).at(0), of_case.at("displacements")[i].at("ux_mm"), 1e-6);
  }
  if (test::browser().empty()) return;
  const json seen = used("page.html");
  EXPECT_TRUE(seen.at("verdict").get<std::string>().starts_with("The frame moves by ")) << seen.at("verdict");
  EXPECT_TRUE(seen.at("deflected"));
}

// Members C2b and C1b are in one line: what is missing may be in either, and both are marked.
TEST_F(ReportProgram, ADiagnosedFrameShowsWhereItActs) {
  const std::string data = "'" + test::source_dir() + "/validation/measurements/frames/truss-45.csv'";
  run("diagnose truss-45 " + data + " --bootstrap 99 --report " + path("page.html"));
  const json scene = page_data(contents(folder / "page.html")).at("scene");
  const auto first = scene.at("guilty").at(0).get<std::string>();
  EXPECT_EQ(scene.at("guilty").size(), 1u);
  EXPECT_TRUE(first == "member C1b" || first == "member C2b") << first;
  if (test::browser().empty()) return;
  const std::string legend = used("page.html").at("legend").get<std::string>();
  EXPECT_NE(legend.find("acts here: " + first), std::string::npos) << legend;
  EXPECT_NE(legend.find(first == "member C1b" ? "As likely here: member C2b" : "As likely here: member C1b"),
            std::string::npos)
      << legend;
}

// Of a member that differs at its start only the start is marked; springs stand where their nodes are.
TEST_F(ReportProgram, EndsAndSpringsOfAFrameAreMarked) {
  const auto marked = [&](const std::string& frame, const std::string& effect) {
    run("add " + frame + " " + effect + " --force -o " + path("after.yaml"));
    run("simulate " + frame + " --campaign cycle -o " + path("data.csv"));
    run("history " + path("data.csv") + " " + frame + " " + path("after.yaml") + " --report " + path("page.html"));
    return page_data(contents(folder / "page.html")).at("scene");
  };
  EXPECT_EQ(marked("portal-semi-rigid", "factor@beam_1.start.ry --set factor=0.4").at("guilty"),
            json({"start of beam_1"}));
  const json scene = marked("beam-on-springs", "clearance@spring.pad3.uz --set gap_mm=0.05");
  EXPECT_EQ(scene.at("guilty"), json({"spring pad3"}));
  const auto spring = std::find_if(scene.at("ground").begin(), scene.at("ground").end(),
                                   [](const json& foot) { return foot.at("name") == "spring pad3"; });
  ASSERT_NE(spring, scene.at("ground").end());
  EXPECT_TRUE(spring->at("guilty"));
  EXPECT_EQ(spring->at("words"), "N6: uz on a spring");
}

TEST_F(ReportProgram, AMatrixThatFailsItsChecksIsAPageToo) {
  write_text(folder / "K.csv",
             "100,5,0,0,0,0\n0,100,0,0,0,0\n0,0,200,0,0,0\n0,0,0,90000,0,0\n0,0,0,0,90000,0\n0,0,0,0,0,90000\n");
  EXPECT_EQ(
      test::deflect("check " + path("K.csv") + " --json " + path("k.json") + " --report " + path("page.html")).code, 4);
  const json data = page_data(contents(folder / "page.html"));
  EXPECT_EQ(data.at("results").at(0).at("result"), result_in("k.json"));
  EXPECT_EQ(data.at("results").at(0).at("result").at("matrix").at(0).at(1), 5);
  run("frame truss --json " + path("f.json"));
  run("report " + path("k.json") + " " + path("f.json") + " -o " + path("both.html"));
  if (test::browser().empty()) return;
  const json seen = used("page.html");
  EXPECT_TRUE(seen.at("verdict").get<std::string>().starts_with("The stiffness fails: ")) << seen.at("verdict");
  const json both = used("both.html");
  for (const char* id : {"checks", "stiffness", "displacements", "members"})
    EXPECT_TRUE(std::any_of(both.at("tables").begin(), both.at("tables").end(), [&](const json& t) {
      return t.at("id") == id && t.at("rows") > 0;
    })) << id;
}

TEST_F(ReportProgram, SeveralResultsAreOnePage) {
  NEEDS_BROWSER();
  simulate();
  run("compare haptic-6psu-ideal-joints " + path("data.csv") + " --json " + path("c.json"));
  run("history " + path("data.csv") + " haptic-6psu-ideal-joints haptic-6psu --json " + path("h.json"));
  run("solve delta --pose 0,0,-900 --load 0,0,10 --json " + path("s.json"));
  run("validate tripteron --json " + path("v.json"));
  run("map haptic-6psu-ideal-joints --n 3 --json " + path("m.json"));
  run("map tripteron --n 2 --json " + path("m2.json"));
  std::string files;
  for (const char* each : {"c.json", "h.json", "s.json", "v.json", "m.json", "m2.json"}) files += " " + path(each);
  run("report" + files + " -o " + path("page.html"));
  const json seen = used("page.html");
  EXPECT_EQ(seen.at("from"), json({"From m.json:", "From m2.json:"}));
  for (const char* id : {"tests", "fall", "displacement", "stiffness", "validation", "map"})
    EXPECT_TRUE(std::any_of(seen.at("tables").begin(), seen.at("tables").end(), [&](const json& t) {
      return t.at("id") == id && t.at("rows") > 0;
    })) << id;
}

TEST_F(ReportProgram, EveryCommandThatHasSomethingToShowMakesAPage) {
  NEEDS_BROWSER();
  simulate();
  for (const std::string& command :
       {"history " + path("data.csv") + " haptic-6psu-ideal-joints haptic-6psu", std::string("validate hybrid"),
        std::string("map delta --n 2"),
        std::string("solve fanuc-r2000ic --joints 0.1,0.2,-0.3,0.1,0.4,0 --load 0,0,-500")}) {
    run(command + " --report " + path("page.html"));
    const json seen = used("page.html");
    EXPECT_TRUE(seen.contains("turned")) << command;
  }
}

TEST_F(ReportProgram, WhatIsNoResultIsRefused) {
  write_text(folder / "x.json", "{\"a\": 1}");
  write_text(folder / "y.json", "{");
  write_text(folder / "z.json", R"({"kind": "simulation"})");
  const std::string those =
      "; pages are made of results of diagnose, compare, history, solve, validate, map, frame, "
      "check, show, fit, predict, plan: give files that their --json wrote";
  for (const auto& [file, message] :
       {std::pair{"x.json", "x.json: not a result of a command that has a page" + those},
        std::pair{"z.json", "z.json: a result of the kind 'simulation' has no page" + those},
        std::pair{"y.json", std::string("y.json:1: not valid JSON")}}) {
    const test::Run run = test::deflect("report " + path(file) + " -o " + path("page.html"));
    EXPECT_EQ(run.code, 2) << run.out;
    EXPECT_NE(run.out.find(message), std::string::npos) << run.out;
    EXPECT_FALSE(std::filesystem::exists(folder / "page.html"));
  }
}

}  // namespace
}  // namespace deflect
