// A leg that is assembled beside its drawing moves the unloaded platform, to first order, as a mount drawn there would.
#include <gtest/gtest.h>

#include "msa/frame/mechanism/msa.h"
#include "tests/support/chains.h"

namespace deflect {
namespace {

/// A frame moved by a small placement: by its shift and turn in its parent's axes (`about_parent`) or its own.
Placement moved(const Placement& seat, const Placement& by) {
  return {seat.shift + by.shift, rpy_from_rotation(rotation_from_vector(by.turn) *
                                                   rotation_from_rpy(seat.turn.x(), seat.turn.y(), seat.turn.z()))};
}

// What is neglected is of second order: e² / m with e = 1 µm, against e.
TEST(Misfit, MovesThePlatformAsAMountDrawnThereWould) {
  const double e = 1e-6;
  std::mt19937 random(13);
  for (const char* name : {"stewart-6ups", "delta"}) {
    const Mechanism m = test::device(name);
    for (const Pose& pose : test::workspace_poses(m, 5)) {
      const Configuration c = configure(m, pose);
      const int leg = 1 + static_cast<int>(random() % m.mounts.size());
      const bool base = random() % 2;
      const Placement by{test::random_vector(random, e), test::random_vector(random, e)};
      Mechanism drawn = m, misfit = m;
      if (c.actuators.size() < 6)  // a Delta out of true does not take a pose without tilt
        std::get<Chains>(drawn.kinematics).home.reset();
      Mount& mount = drawn.mounts[static_cast<std::size_t>(leg - 1)];
      Placement& seat = base ? mount.base : mount.platform;
      seat = moved(seat, by);
      misfit.misfits = {base ? Misfit{leg, by, {}} : Misfit{leg, {}, by}};

      const Pose there = configure_joints(drawn, test::coordinates(c)).pose;
      Vector6 expected;
      const Eigen::AngleAxisd turn(there.R_WT * pose.R_WT.transpose());
      expected << there.p_WT - pose.p_WT, turn.angle() * turn.axis();
      frame::MsaModel model(configure(misfit, pose));
      const Vector6 found = model.assembled().u.segment<6>(6 * model.mechanism().tool);
      EXPECT_LE((found - expected).norm(), 1e-4 * e + 1e-5 * expected.norm())
          << name << " leg " << leg << " base " << base;
      EXPECT_GT(expected.norm(), 0.01 * e);
    }
  }
}

}  // namespace
}  // namespace deflect
