// Iso-curves of a field and the numbers that stand on them.
#include "validation/figures/contours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

namespace deflect {
namespace {

using namespace figures;

/// x² + y² between −1 and 1.
GridField bowl(int n) {
  GridField f;
  for (int i = 0; i < n; ++i) f.x.push_back(-1 + 2.0 * i / (n - 1));
  f.y = f.x;
  for (const double y : f.y)
    for (const double x : f.x) f.values.push_back(x * x + y * y);
  return f;
}

TEST(Contours, ACircleIsOneClosedCurve) {
  const std::vector<Polyline> curves = iso_curves(bowl(61), 0.5);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_NEAR(curves[0].front().x, curves[0].back().x, 1e-12);
  EXPECT_NEAR(curves[0].front().y, curves[0].back().y, 1e-12);
  double length = 0;
  for (std::size_t i = 0; i < curves[0].size(); ++i) {
    const PlanePoint& p = curves[0][i];
    // Linear between points 1/30 apart: off by at most h²/4 in the value.
    EXPECT_NEAR(p.x * p.x + p.y * p.y, 0.5, 1.0 / 900 / 4 + 1e-12);
    if (i > 0) length += std::hypot(p.x - curves[0][i - 1].x, p.y - curves[0][i - 1].y);
  }
  EXPECT_NEAR(length, 2 * M_PI * std::sqrt(0.5), 0.01);
}

TEST(Contours, CurvesEndAtTheEdgeAndWhereThereIsNoValue) {
  EXPECT_EQ(iso_curves(bowl(61), 1.5).size(), 4u) << "one in each corner";
  GridField f = bowl(61);
  f.values[30 * 61 + 51] = std::numeric_limits<double>::quiet_NaN();  // on the circle of level 0.5, right
  const std::vector<Polyline> open = iso_curves(f, 0.5);
  ASSERT_EQ(open.size(), 1u);
  EXPECT_GT(std::hypot(open[0].front().x - open[0].back().x, open[0].front().y - open[0].back().y), 0.03);
  EXPECT_TRUE(iso_curves(bowl(61), 5).empty());
}

TEST(Contours, ASaddleHasTwoCurves) {
  GridField f{{0, 1}, {0, 1}, {1, 0, 0, 1}};
  EXPECT_EQ(iso_curves(f, 0.4).size(), 2u);
  EXPECT_EQ(iso_curves(f, 0.6).size(), 2u);
}

TEST(Contours, LabelsLieWithinThePanelApartFromEachOtherAndOnFreeGround) {
  const GridField f = bowl(61);
  LabelledCurves curves(f, 22, 22, 1, 2.5);  // a panel of a figure 88 mm wide
  const std::vector<double> levels = {0.1, 0.2, 0.5, 1, 1.8};
  for (const double level : levels) curves.add(level);
  for (const double level : levels) curves.label(level);
  ASSERT_GE(curves.labels().size(), 3u);
  for (const CurveLabel& a : curves.labels()) {
    EXPECT_LT(std::abs(a.at.x) + a.half_width, 1);
    EXPECT_LT(std::abs(a.at.y) + a.half_height, 1);
    for (const CurveLabel& b : curves.labels())
      EXPECT_TRUE(&a == &b || std::abs(a.at.x - b.at.x) >= a.half_width + b.half_width ||
                  std::abs(a.at.y - b.at.y) >= a.half_height + b.half_height);
    for (const double level : levels)
      for (const Polyline& line : curves.visible(level))
        for (const PlanePoint& p : line) EXPECT_FALSE(a.covers(p));
  }
}

TEST(Contours, WhereNoHeavyCurvePassesAnotherCarriesItsNumber) {
  const GridField f = bowl(61);
  const LabelledCurves curves(f, 22, 22, 1, 2.5);
  EXPECT_EQ(curve_rows(curves, {0.3, 0.6}, {7}, 0.5).values.empty(), false);
  const CurveRows rows = curve_rows(curves, {0.3, 0.6}, {0.6}, 0.5);
  EXPECT_FALSE(rows.thin.empty());
  EXPECT_FALSE(rows.heavy.empty());
  std::istringstream value(rows.values);
  double x = 0, y = 0, level = 0;
  int colour = -1;
  value >> x >> y >> level >> colour;
  EXPECT_EQ(level, 0.6);
  EXPECT_EQ(colour, 0) << "black on what is light";
}

}  // namespace
}  // namespace deflect
