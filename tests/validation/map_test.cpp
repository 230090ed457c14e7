// Maps on small grids: values against single solutions, symmetry, threads, reach.
#include "validation/studies/map.h"

#include <gtest/gtest.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/support/devices.h"
#include "tests/support/maps.h"
#include "tests/support/theories.h"
#include "validation/figures/fig11.h"
#include "validation/figures/stiffness_length.h"
#include "validation/report/map_correlation.h"
#include "validation/report/map_results.h"
#include "validation/studies/solve.h"

namespace deflect {
namespace {

using namespace figures;
using namespace report;
using namespace studies;
using namespace theories;

using nlohmann::json;
using test::cube;
using test::device;
using test::too_wide;

MapOptions one_pose(const Mechanism& m, const Vector3& p_mm, const Vector3& tilt_deg = Vector3::Zero()) {
  MapOptions o = cube(m, 1, 1, 1);
  o.grid.low_mm = o.grid.high_mm = p_mm;
  o.grid.tilt_deg = tilt_deg;
  return o;
}

double difference(const Matrix3& a, const Matrix3& b) { return (a - b).norm() / b.norm(); }

TEST(MapGrid, RunsFromEndToEndWithXFastest) {
  const MapGrid g{{-1, 2, 10}, {1, 6, 20}, {3, 2, 1}, {0, 0, 7}};
  ASSERT_EQ(g.size(), 6u);
  EXPECT_EQ(g.pose_mm_deg(0), (Vector6() << -1, 2, 15, 0, 0, 7).finished()) << "one value stands in the middle";
  EXPECT_EQ(g.pose_mm_deg(1)(0), 0);
  EXPECT_EQ(g.pose_mm_deg(5), (Vector6() << 1, 6, 15, 0, 0, 7).finished());
  EXPECT_EQ(g.index(2, 1, 0), 5u);
}

TEST(Map, SaysWhatSolveSaysAtEveryCornerByBothTheories) {
  for (const char* name : {"haptic-6psu-ideal-joints", "haptic-6psu"}) {
    const Mechanism m = device(name);
    const StiffnessMap map = map_stiffness(m, cube(m, 2, 2, 2));
    ASSERT_EQ(map.poses.size(), 8u);
    for (const MapPose& p : map.poses) {
      ASSERT_TRUE(p.reached());
      EXPECT_LT(p.relative_difference, 1e-9);
      for (int axis = 0; axis < 3; ++axis) {
        const SolveResult s = solve(m, stand(m, p.pose_mm_deg), 50 * Vector6::Unit(axis), {});
        for (const auto& [v, theory] :
             {std::pair{test::analytic(p), test::analytic(s)}, std::pair{test::msa(p), test::msa(s)}}) {
          EXPECT_NEAR(v.compliance_mm_N.col(axis).norm() / (theory.displacement_mm_rad.head<3>().norm() / 50), 1, 1e-9);
          EXPECT_NEAR(v.stiffness_N_mm(axis) * theory.displacement_mm_rad(axis), 50, 50 * 1e-9);
          for (const int i : {axis, axis + 3}) EXPECT_NEAR(v.K_ii(i) / theory.stiffness_mm(i, i), 1, 1e-7);
        }
      }
    }
  }
}

TEST(Map, CentreOfTheIdealDeviceIsTheClosedForm) {
  const Mechanism m = device("haptic-6psu-ideal-joints");
  const MapPose p = map_stiffness(m, cube(m, 1, 1, 1)).poses.front();
  for (const MapValues* v : {&test::analytic(p), &test::msa(p)}) {
    EXPECT_NEAR(50 * v->compliance_mm_N(0, 0), 0.084092, 0.51e-6);
    EXPECT_NEAR(50 * v->compliance_mm_N(2, 2), 0.026865, 0.51e-6);
    EXPECT_NEAR(v->smallest_N_mm, 50 / 0.084092, 0.01) << "x and y couple with rotations only";
    EXPECT_NEAR(v->largest_N_mm, 50 / 0.026865, 0.1);
  }
  for (const double q : {p.slide_min_mm, p.slide_mean_mm, p.slide_max_mm}) EXPECT_NEAR(q, 80, 1e-9);
}

TEST(Map, DirectionsLieBetweenTheExtremes) {
  const Mechanism m = device("haptic-6psu-ideal-joints");
  const StiffnessMap map = map_stiffness(m, cube(m, 3, 3, 3));
  for (const MapPose& p : map.poses) {
    const MapValues& v = test::msa(p);
    EXPECT_GE(v.stiffness_N_mm.minCoeff(), v.smallest_N_mm * (1 - 1e-9));
    EXPECT_LE(v.stiffness_N_mm.maxCoeff(), v.largest_N_mm * (1 + 1e-9));
    EXPECT_GE(v.K_ii(0), v.stiffness_N_mm(0) * (1 - 1e-9)) << "holding the other displacements stiffens";
    EXPECT_GT(v.isotropy, 0);
    EXPECT_LT(v.isotropy, 1);
  }
}

TEST(Map, WithoutContactsSecantIsTangentAndTheLoadDoesNotMatter) {
  const Mechanism m = device("haptic-6psu-ideal-joints");
  MapOptions o = one_pose(m, {12, -7, 180}, {3, -2, 5});
  const MapValues secant = map_stiffness(m, o).poses.front().values.at(1);
  o.force_N = -3;
  const MapValues pulled = map_stiffness(m, o).poses.front().values.at(1);
  o.load_N_Nmm = (Vector6() << 1, 2, 3, 40, 50, 60).finished();
  const MapValues tangent = map_stiffness(m, o).poses.front().values.at(1);
  EXPECT_LT(difference(pulled.compliance_mm_N, secant.compliance_mm_N), 1e-9);
  EXPECT_LT(difference(tangent.compliance_mm_N, secant.compliance_mm_N), 1e-9);
  EXPECT_NEAR(tangent.isotropy / secant.isotropy, 1, 1e-9);
}

TEST(Map, ContactsStiffenUnderLoadSoThatTheTangentIsAboveTheSecant) {
  const Mechanism m = device("haptic-6psu");
  MapOptions o = one_pose(m, {12, -7, 180});
  const double at_50 = map_stiffness(m, o).poses.front().values.at(1).stiffness_N_mm(2);
  o.force_N = 500;
  EXPECT_GT(map_stiffness(m, o).poses.front().values.at(1).stiffness_N_mm(2), at_50);
  o.load_N_Nmm = 50 * Vector6::Unit(2);
  EXPECT_GT(map_stiffness(m, o).poses.front().values.at(1).stiffness_N_mm(2), at_50);
}

TEST(Map, TurnsWithTheDeviceByAThirdOfATurn) {
  const Matrix3 R = rotation_from_rpy(0, 0, 2 * pi / 3);
  for (const char* name : {"haptic-6psu-ideal-joints", "haptic-6psu"}) {
    const Mechanism m = device(name);
    for (const Vector3& p : {Vector3(20, 5, 150), Vector3(-13, 22, 195)}) {
      const MapPose a = map_stiffness(m, one_pose(m, p)).poses.front();
      const MapPose b = map_stiffness(m, one_pose(m, R * p)).poses.front();
      EXPECT_NEAR(b.slide_mean_mm, a.slide_mean_mm, 1e-9);
      for (const auto& [u, v] :
           {std::pair{test::analytic(a), test::analytic(b)}, std::pair{test::msa(a), test::msa(b)}}) {
        EXPECT_NEAR(v.stiffness_N_mm(2) / u.stiffness_N_mm(2), 1, 1e-9);
        if (std::string(name) == "haptic-6psu") continue;  // there the forces along x and y load other legs
        EXPECT_LT(difference(v.compliance_mm_N, R * u.compliance_mm_N * R.transpose()), 1e-9);
        EXPECT_NEAR(v.smallest_N_mm / u.smallest_N_mm, 1, 1e-9);
        EXPECT_NEAR(v.largest_N_mm / u.largest_N_mm, 1, 1e-9);
        EXPECT_NEAR(v.isotropy / u.isotropy, 1, 1e-7);
      }
    }
  }
}

TEST(Map, StiffWhereTheGuidewaysAreShortInEveryDirection) {
  for (const char* name : {"haptic-6psu-ideal-joints", "haptic-6psu"}) {
    const Mechanism m = device(name);
    const StiffnessMap map = map_stiffness(m, cube(m, 5, 5, 5));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LT(with_slides(map, axis).spearman, -0.8) << name << axis;
      for (int j = 0; j < 5; ++j)
        for (int i = 0; i < 5; ++i)
          for (int k = 1; k < 5; ++k)  // the guideways lengthen with the height
            EXPECT_LT(test::analytic(map.poses[map.options.grid.index(i, j, k)]).stiffness_N_mm(axis),
                      test::analytic(map.poses[map.options.grid.index(i, j, k - 1)]).stiffness_N_mm(axis));
    }
  }
}

TEST(Map, HasTheSameBitsForAnyNumberOfThreads) {
  const Mechanism m = device("haptic-6psu");
  MapOptions o = too_wide(m);
  std::set<std::string> results;
  for (const int threads : {1, 2, 5}) {
    const StiffnessMap map = map_stiffness(m, o, {threads});
    results.insert(map_csv(map) + map_json(map) + map_vtu(map));
  }
  EXPECT_EQ(results.size(), 1u);
}

TEST(Map, CountsPosesOutOfReachByReason) {
  const Mechanism m = device("haptic-6psu-ideal-joints");
  const StiffnessMap map = map_stiffness(m, too_wide(m));
  std::size_t refused = 0, expected = 0;
  for (const MapPose& p : map.poses) {
    bool reached = true;
    try {
      configure(m, pose_from(p.pose_mm_deg));
    } catch (const ModelError& e) {
      reached = false;
      EXPECT_EQ(p.out_of_reach, e.what());
    }
    expected += reached ? 0 : 1;
    EXPECT_EQ(p.reached(), reached);
    EXPECT_EQ(p.values.size(), reached ? 2u : 0u);
  }
  const std::vector<OutOfReach> reasons = out_of_reach(map);
  ASSERT_EQ(reasons.size(), 2u);
  for (const OutOfReach& r : reasons) {
    refused += r.poses;
    EXPECT_TRUE(r.reason == "the link does not reach" ||
                r.reason == "the slider would stand at … mm, outside its range of … to … mm")
        << r.reason;
  }
  EXPECT_EQ(refused, expected);
  EXPECT_GT(refused, 0u);
  EXPECT_LT(refused, map.poses.size());
  const std::string report = map_report(map);
  EXPECT_NE(report.find(fmt::format("reached: {} of 125 poses", 125 - refused)), std::string::npos) << report;
}

TEST(Map, EveryPanelHasAContourWithItsNumberInAJournalsColumn) {
  const Mechanism m = device("haptic-6psu");
  const StiffnessMap map = map_stiffness(m, cube(m, 5, 5, 5));
  for (const double width : {88.0, 170.0}) {
    const std::string body = fig11(map, {width, "DejaVu Sans", 8}).front().body;
    for (int row = 0; row < 4; ++row)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_NE(body.find(fmt::format("$values{}{} << EOD", row, axis)), body.npos) << width << " " << row << axis;
    EXPECT_NE(body.find("font 'DejaVu Sans,6.4'"), body.npos) << "of numbers on contours";
  }
}

TEST(Map, NothingReachedIsAResultWithoutFigures) {
  const Mechanism m = device("haptic-6psu");
  MapOptions o = cube(m, 2, 2, 2);
  o.grid.low_mm.x() = 300;
  o.grid.high_mm.x() = 400;
  const StiffnessMap map = map_stiffness(m, o);
  EXPECT_TRUE(fig11(map).empty());
  EXPECT_TRUE(stiffness_against_length(map).empty());
  EXPECT_NE(map_report(map).find("reached: 0 of 8"), std::string::npos);
  EXPECT_EQ(json::parse(map_json(map))["reached"], 0);
  EXPECT_NE(map_vtu(map).find("NumberOfPoints=\"0\" NumberOfCells=\"0\""), std::string::npos);
}

TEST(Map, OtherErrorsEndItWithTheFirstPoseInOrderWhateverTheThreads) {
  const Mechanism m = test::with(device("haptic-6psu-ideal-joints"), "leg.actuator.joint", "slider");
  MapOptions o = cube(m, 4, 4, 4);
  std::set<std::string> messages;
  for (const int threads : {1, 2, 4}) {
    try {
      map_stiffness(m, o, {threads});
      ADD_FAILURE() << "a machine on passive sliders stood";
    } catch (const ModelError& e) {
      messages.insert(e.what());
    }
  }
  EXPECT_EQ(messages.size(), 1u);
}

TEST(Map, TellsItsProgressToTheEnd) {
  const Mechanism m = device("haptic-6psu-ideal-joints");
  std::atomic<double> most = 0;
  std::atomic<std::size_t> calls = 0;
  const auto told = [&](double share) {
    ++calls;
    for (double seen = most; share > seen && !most.compare_exchange_weak(seen, share);) {
    }
  };
  map_stiffness(m, cube(m, 3, 3, 3), {0, nullptr, told});
  EXPECT_EQ(most, 1.0);
  EXPECT_GT(calls, 1u);
}

TEST(Map, OneTheoryAlone) {
  const Mechanism m = device("haptic-6psu");
  MapOptions o = cube(m, 2, 1, 2);
  o.theories = theories_named("analytic");
  const StiffnessMap map = map_stiffness(m, o);
  EXPECT_EQ(map.poses[0].values.size(), 1u);
  EXPECT_EQ(map_csv(map).find("msa_"), std::string::npos);
  EXPECT_EQ(map_csv(map).find("relative_difference"), std::string::npos);
  EXPECT_FALSE(json::parse(map_json(map)).contains("max_relative_difference"));
}

TEST(Correlation, RanksShareTies) {
  const Correlation c = correlation({1, 2, 3, 4}, {10, 100, 1000, 10000});
  EXPECT_NEAR(c.spearman, 1, 1e-15);
  EXPECT_NEAR(c.pearson, 0.824, 5e-4);
  EXPECT_NEAR(correlation({1, 2, 2, 3}, {4, 3, 3, 1}).spearman, -1, 1e-15);
  EXPECT_NEAR(correlation({1, 1, 2}, {1, 2, 3}).spearman, std::sqrt(3) / 2, 1e-15);
  EXPECT_EQ(correlation({1, 2}, {5, 5}).pearson, 0);
}

}  // namespace
}  // namespace deflect
