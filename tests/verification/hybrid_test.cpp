// A hybrid machine: its stages stand one upon the other, so that their compliances at the tool add up.
#include <gtest/gtest.h>

#include "msa/frame/mechanism/msa.h"
#include "tests/support/chains.h"

namespace deflect {
namespace {

/// Everything rigid but the part of that index.
Configuration with_part_alone(Configuration c, std::size_t index) {
  std::vector<PlacedPart>& parts = c.legs[0].parts;
  parts = {parts[index]};
  return c;
}

// Redundant digits are lost in the head alone, whose legs are in parallel: 1e-12 of its compliance.
TEST(Hybrid, CompliancesOfTheStagesAddUp) {
  const Mechanism m = test::device("hybrid");
  for (const Pose& pose : test::workspace_poses(m, 20)) {
    const Configuration c = configure(m, pose);
    Matrix6 sum = Matrix6::Zero();
    for (std::size_t part = 0; part < c.legs[0].parts.size(); ++part)
      sum += test::compliance_by(frame::MsaModel(with_part_alone(c, part)));
    frame::MsaModel whole(c);
    EXPECT_LE(test::compliance_difference(test::compliance_by(whole), sum, c.size), 1e-11);
    const Matrix6 K = whole.stiffness(whole.solve(Vector6::Unit(0)).state).K;
    EXPECT_LE(test::compliance_difference(K.inverse(), sum, c.size), 1e-10);
  }
}

// The head by itself is a machine of three legs, here on the ground. Its file rounds to a nanometre, so that it takes
// the pose to that only.
TEST(Hybrid, HeadByItselfIsTheSameMachineAsTheBranch) {
  const Mechanism m = test::device("hybrid");
  const Configuration c = configure(m, home_pose(m));
  Mechanism head = m;
  const Parallel& group = std::get<Parallel>(*find(m.leg, "head"));
  head.kinematics = Chains();
  head.mounts = group.mounts;
  head.leg = group.leg;
  const Configuration alone = configure(head, {Vector3(0, 0, -0.69), Matrix3::Identity()});
  const auto& branch = std::get<PlacedParallel>(c.legs[0].parts.at(3));
  ASSERT_EQ(branch.part, "head");
  ASSERT_EQ(branch.branches.size(), alone.legs.size());
  for (std::size_t leg = 0; leg < alone.legs.size(); ++leg) {
    const auto& a = std::get<PlacedMember>(alone.legs[leg].parts.at(2));
    const auto& b = std::get<PlacedMember>(branch.branches[leg].parts.at(2));
    EXPECT_LE((b.p_W_start - a.p_W_start - Vector3(0, 0, -0.5)).norm(), 1e-9);
    EXPECT_LE((b.p_W_end - a.p_W_end - Vector3(0, 0, -0.5)).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace deflect
