// Many poses at once against one at a time.
#include "validation/studies/sweep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "msa/base/error.h"
#include "msa/mechanism/device_file.h"
#include "msa/mechanism/stand.h"
#include "tests/support/paths.h"
#include "validation/studies/solve.h"

namespace deflect::studies {
namespace {

Mechanism haptic() { return read_mechanism(test::source_dir() + "/validation/devices/haptic-6psu.yaml"); }

struct Arrays {
  std::vector<double> poses, loads, displacements[2], stiffnesses[2];

  std::size_t size() const { return poses.size() / 6; }
  void solve(const Mechanism& m, bool keep_unreachable = false, int threads = 1) {
    std::vector<ManyAnswers> out;
    for (int t = 0; t < 2; ++t) {
      displacements[t].assign(6 * size(), -1);
      stiffnesses[t].assign(36 * size(), -1);
      out.push_back({displacements[t], stiffnesses[t]});
    }
    solve_many(m, {poses, loads, keep_unreachable}, theories::all_theories(), out, {threads});
  }
};

Arrays five() {
  Arrays a;
  for (int i = 0; i < 5; ++i) {
    for (const double x : {5.0 * i, -3.0 * i, 170.0 + i, 1.0 * i, -0.5 * i, 2.0}) a.poses.push_back(x);
    for (const double f : {50.0 - 9 * i, 2.0 * i, -5.0, 10.0 * i, 0.0, 3.0}) a.loads.push_back(f);
  }
  return a;
}

// The sweep sums in another order than a single solution; contacts are solved to 1e-12 of their forces.
TEST(ManyPoses, AreThoseOfOneAtATime) {
  const Mechanism m = haptic();
  Arrays a = five();
  a.solve(m);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector6 pose = Eigen::Map<const Vector6>(a.poses.data() + 6 * i),
                  load = Eigen::Map<const Vector6>(a.loads.data() + 6 * i);
    const SolveResult one = solve(m, stand(m, pose), load, {});
    for (std::size_t t = 0; t < 2; ++t) {
      const Vector6 d = Eigen::Map<const Vector6>(a.displacements[t].data() + 6 * i);
      const Matrix6 K =
          Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(a.stiffnesses[t].data() + 36 * i);
      EXPECT_LT((d - one.solutions[t].displacement_mm_rad).norm(), 1e-9 * d.norm());
      EXPECT_LT((K - one.solutions[t].stiffness_mm).norm(), 1e-9 * K.norm());
    }
  }
}

TEST(ManyPoses, OneLoadIsThatOfAll) {
  const Mechanism m = haptic();
  Arrays one = five(), all = five();
  one.loads = {50, 0, 0, 0, 0, 0};
  for (std::size_t i = 0; i < all.loads.size(); ++i) all.loads[i] = one.loads[i % 6];
  one.solve(m);
  all.solve(m, false, 2);
  EXPECT_EQ(one.displacements[0], all.displacements[0]);
  EXPECT_EQ(one.stiffnesses[1], all.stiffnesses[1]);
}

TEST(ManyPoses, OutOfReachIsAnErrorOrNotANumber) {
  const Mechanism m = haptic();
  Arrays a = five();
  a.poses[12] = 1000;
  try {
    a.solve(m);
    FAIL();
  } catch (const ModelError& e) {
    EXPECT_EQ(std::string(e.what()).substr(0, 8), "pose 2: ");
  }
  a.solve(m, true);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(std::isnan(a.displacements[1][6 * i]), i == 2) << i;
}

TEST(ManyPoses, RowsThatDoNotFitAreRefused) {
  const Mechanism m = haptic();
  Arrays a = five();
  a.loads.resize(12);
  EXPECT_THROW(a.solve(m), InputError);
  a = five();
  a.loads[7] = std::nan("");
  EXPECT_THROW(a.solve(m), InputError);
}

}  // namespace
}  // namespace deflect::studies
