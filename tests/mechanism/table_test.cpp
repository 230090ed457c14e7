// Tables in device files: read, written, edited, refused; what their points say.
#include <gtest/gtest.h>

#include "msa/base/error.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/numbers.h"
#include "msa/mechanism/table.h"
#include "msa/mechanism/tolerances.h"
#include "tests/support/same_mechanism.h"

namespace deflect {
namespace {

Mechanism drive_with(const std::string& law, const std::string& more = "") {
  return parse_mechanism("name: drive\nkinematics: {family: chains}\n" + more + "leg:\n  drive: {joint: motor, rz: " +
                             law + "}\n  lever: {offset: [0 mm, 0 mm, 100 mm]}\n",
                         "drive.yaml");
}

const TableLaw& table_of(const Mechanism& m) {
  return std::get<TableLaw>(std::get<Joint>(*find(m.leg, "drive")).laws[5].at(0));
}

std::string refusal_of(const std::string& law, const std::string& more = "") {
  try {
    drive_with(law, more);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

const std::string hysteretic =
    "{law: table, points: [[0 Nm, 0 mrad], [10 Nm, 1 mrad], [30 Nm, 7 mrad]], "
    "unloading: [[30 Nm, 7 mrad], [10 Nm, 4 mrad], [0 Nm, 2 mrad]]}";

TEST(TableFile, IsWrittenAsItIsReadAndEdited) {
  Mechanism m = drive_with(hysteretic);
  EXPECT_EQ(table_of(m).points, (TablePoints{{0, 0}, {10, 1e-3}, {30, 7e-3}}));
  EXPECT_EQ(table_of(m).unloading, (TablePoints{{30, 7e-3}, {10, 4e-3}, {0, 2e-3}}));
  EXPECT_EQ(parse_mechanism(write_mechanism(m), "written"), m);
  m = edited(m, {"leg.drive.rz.points.1.1", "2 mrad", Edit::Action::set});
  EXPECT_EQ(table_of(m).points[1][1], 2e-3);
  m = edited(m, {"leg.drive.rz.points.1.0", "0.5", Edit::Action::multiply});
  EXPECT_EQ(table_of(m).points[1][0], 5);
  m = edited(m, {"leg.drive.rz", hysteretic, Edit::Action::append});
  EXPECT_EQ(std::get<Joint>(*find(m.leg, "drive")).laws[5].size(), 2u);
  m = drive_with("{law: table, points: [[-2 Nm, -1 mrad], [0 Nm, 0 mrad], [2 Nm, 3 mrad]]}");
  EXPECT_EQ(parse_mechanism(write_mechanism(m), "written"), m);
}

TEST(TableFile, MistakesAreToldWithTheWayOut) {
  const auto told = [](const std::string& law, const std::string& what) {
    const std::string found = refusal_of(law);
    EXPECT_NE(found.find("drive.yaml:"), found.npos) << law;
    EXPECT_NE(found.find(what), found.npos) << law << "\n" << found;
  };
  told("{law: table}", "'points' is missing");
  told("{law: table, points: 3}", "a list of pairs is wanted");
  told("{law: table, points: [[0 Nm, 0 mrad], [1 Nm]]}", "points.1: a pair is wanted");
  told("{law: table, points: [[0 Nm, 0 mrad], [1 N, 1 mrad]]}", "points.1.0");
  told("{law: table, points: [[0 Nm, 0 mrad]]}", "has 1 point: a curve needs at least two");
  told("{law: table, points: [[0 Nm, 0 rad], [2 Nm, 0.1 rad], [1 Nm, 0.2 rad]]}", "the load must rise");
  told("{law: table, points: [[0 Nm, 0 rad], [1 Nm, 0.2 rad], [2 Nm, 0.1 rad]]}", "the deflection must rise");
  told("{law: table, points: [[0 Nm, 0 rad], [1 Nm, 0.2 rad], [2 Nm, 0.2 rad]]}", "'law: clearance'");
  told("{law: table, points: [[1 Nm, 0.1 rad], [2 Nm, 0.2 rad]]}", "must pass through [0 Nmm, 0 deg]");
  told("{law: table, points: [[-1 Nm, -0.1 rad], [0 Nm, 0 rad]]}", "no load under pull");
  const std::string up = "{law: table, points: [[0 Nm, 0 rad], [2 Nm, 0.2 rad]], unloading: ";
  told(up + "[[2 Nm, 0.2 rad]]}", "unloading: has 1 point");
  told(up + "[[2 Nm, 0.3 rad], [0 Nm, 0.1 rad]]}", "must begin at the last of 'points'");
  told(up + "[[2 Nm, 0.2 rad], [1 Nm, 0.15 rad]]}", "must end at no load");
  told(up + "[[2 Nm, 0.2 rad], [1 Nm, 0.05 rad], [0 Nm, 0 rad]]}", "give back more work than it took");
  told(up + "[[2 Nm, 0.2 rad], [1 Nm, 0.25 rad], [0 Nm, 0 rad]]}", "the deflection must fall");
  told(
      "{law: table, points: [[-1 Nm, -1 rad], [0 Nm, 0 rad], [2 Nm, 0.2 rad]], unloading: [[2 Nm, 0.2 rad], [0 Nm, "
      "0.1 rad]]}",
      "must begin at [0 Nmm, 0 deg]");
}

TEST(TableFile, KeepsNoPreloadWhereItRemembers) {
  const std::string text =
      "name: drive\nkinematics: {family: chains}\nleg:\n  drive: {joint: motor, rz: " + hysteretic +
      ", preload: {rz: 1 Nm}}\n  lever: {offset: [0 mm, 0 mm, 100 mm]}\n";
  try {
    parse_mechanism(text, "drive.yaml");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("rz has a table with 'unloading'"), std::string::npos) << e.what();
  }
}

TEST(TableFile, ToleratesEachOfItsNumbersByItself) {
  const Mechanism m = resolved(drive_with("{law: table, points: [[0 Nm, 0 mrad], [10 Nm, 1 mrad], [30 Nm, 7 mrad]]}",
                                          "tolerances: {drive.points: 2 %}\n"));
  const std::vector<NumberMove> moves = number_moves(m);
  ASSERT_EQ(moves.size(), 4u);
  EXPECT_EQ(moves[0].name, "leg 1 drive rz points 2 load");
  EXPECT_EQ(moves[3].name, "leg 1 drive rz points 3 deflection");
  EXPECT_NEAR(moves[3].shifts.at(0).second, 0.02 * 7e-3, 1e-18);
}

// c is the slope of the stiffest piece of both branches, 0.1 mrad/Nm: A rises from 10 Nm by 0.2 mrad/Nm to 4 mrad; B
// falls from there by 0.05 to 3 mrad at 10 Nm and by 0.1 to 2 mrad at none; 2 mrad in 30 Nm are less steep than that.
TEST(TableCurves, AreTheBoundsOfWhatIsLeft) {
  const TableCurves c = curves_of(identified(table_of(drive_with(hysteretic))));
  const auto same = [](const TablePoints& found, const TablePoints& by_hand) {
    ASSERT_EQ(found.size(), by_hand.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      for (std::size_t k = 0; k < 2; ++k)
        EXPECT_NEAR(found[i][k], by_hand[i][k], 1e-14 * (k == 0 ? 30 : 7e-3)) << i << k;
  };
  same(c.elastic, {{-30, -3e-3}, {30, 3e-3}});
  same(c.loading, {{10, 0}, {30, 4e-3}});
  same(c.unloading, {{-20, 0}, {0, 2e-3}, {10, 3e-3}, {30, 4e-3}});
  EXPECT_NEAR(c.beyond, 0.2e-3, 1e-18);
  EXPECT_THROW(curves_of(table_of(drive_with(hysteretic))), std::logic_error);
}

TEST(TableCurves, LeaveNothingBehindAtTheOppositeEnd) {
  const TableLaw law = identified({{{0, 0}, {10, 2}, {20, 6}}, {{20, 6}, {0, 3}}});
  const TableCurves& c = curves_of(law);  // the last piece of unloading is the stiffest: B stays at 3 until none
  ASSERT_EQ(c.unloading.size(), 3u);
  EXPECT_NEAR(c.unloading[0][0], -20, 1e-12);
  EXPECT_NEAR(c.unloading[1][1], 3, 1e-12);
}

}  // namespace
}  // namespace deflect
