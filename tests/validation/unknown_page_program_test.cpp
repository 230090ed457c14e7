// The page of a diagnosis that ends in something unknown shows where it acts.
#include <gtest/gtest.h>
#include <fstream>

#include "tests/support/page.h"
#include "validation/page/page.h"

namespace deflect {
namespace {

// The elbow of a scara follows a curve with knees. Sideways play of screw and wrist could move the tool as it does.
TEST(UnknownPage, MarksThePartsWhereItMayAct) {
  if (!page::pages_are_built()) GTEST_SKIP() << "built without pages";
  const std::string elbow = "rz: {law: linear, stiffness: !ours 2e4 Nm/rad}";
  std::string file = test::contents(test::source_dir() + "/validation/devices/scara.yaml");
  ASSERT_NE(file.find(elbow), file.npos);
  file.replace(file.find(elbow), elbow.size(),
               "rz: {law: table, points: [[0 Nm, 0 mrad], [2 Nm, 0.05 mrad], [3 Nm, 0.3 mrad], [6 Nm, 0.5 mrad], "
               "[20 Nm, 1 mrad]]}");
  const test::Folder folder;
  std::ofstream(folder / "true.yaml") << file;
  const auto path = [&](const char* name) { return " '" + (folder / name).string() + "'"; };
  const test::Run made =
      test::deflect("simulate" + path("true.yaml") + " --campaign random --noise 0.004 --seed 3 -o" + path("data.csv"));
  ASSERT_EQ(made.code, 0) << made.out;
  const test::Run found =
      test::deflect("diagnose scara" + path("data.csv") + " --bootstrap 99 --report" + path("page.html"));
  ASSERT_EQ(found.code, 0) << found.out;
  const auto seen = test::used_page(folder / "page.html", folder);
  ASSERT_TRUE(seen) << "the browser said nothing";
  EXPECT_EQ(seen->at("failures"), nlohmann::json::array());
  const auto legend = seen->at("legend").get<std::string>();
  // A spring that stiffens is named at the elbow, which is red for it; something unknown may act there too.
  const std::string words = "Something unknown acts at one of these: ";
  const std::size_t at = legend.find(words);
  ASSERT_NE(at, legend.npos) << legend;
  const std::string parts = legend.substr(at + words.size(), std::string("screw, wrist, elbow").size());
  for (const char* part : {"screw", "wrist", "elbow"}) EXPECT_NE(parts.find(part), parts.npos) << legend;
}

// Something rubs at a node of a truss at which no part is drawn but its members (a set of foreign make).
TEST(UnknownPage, MarksTheNodeWhereSomethingRubs) {
  if (!page::pages_are_built()) GTEST_SKIP() << "built without pages";
  const test::Folder folder;
  const std::string data =
      test::source_dir() + "/tests/verification/foreign_frames/truss-45_friction-node-P1d-uy_32.csv";
  const test::Run found = test::deflect("diagnose truss-45 '" + data + "' --bootstrap 99 --report '" +
                                        (folder / "page.html").string() + "'");
  ASSERT_EQ(found.code, 0) << found.out;
  EXPECT_NE(found.out.find("'node P1d uy, where something rubs'"), found.out.npos) << found.out;
  const auto seen = test::used_page(folder / "page.html", folder);
  ASSERT_TRUE(seen) << "the browser said nothing";
  EXPECT_EQ(seen->at("failures"), nlohmann::json::array());
  const auto legend = seen->at("legend").get<std::string>();
  EXPECT_NE(legend.find("Something unknown acts here: node P1d"), legend.npos) << legend;
}

}  // namespace
}  // namespace deflect
