// The paper's device written as chains: the frame that walks along its legs must find the joints, and the theories the
// stiffness, of the family "6-psu".
#include <gtest/gtest.h>

#include "analytic/model.h"
#include "msa/frame/mechanism/msa.h"
#include "msa/mechanism/six_psu.h"
#include "tests/support/chains.h"

namespace deflect {
namespace {

/// The parts of a 6-psu leg where the walk takes them: laws of the ball joint act along the link, behind its motion;
/// those of the universal joint before its motion.
Mechanism as_chains(const Mechanism& m) {
  const SixPsu& k = test::six_psu(m);
  Mechanism out = m;
  const Pose home = test::home(m);
  out.kinematics = Chains{Placement{home.p_WT, Vector3::Zero()}, {}};
  for (int leg = 1; leg <= 6; ++leg) {
    const SixPsuLeg g = leg_at(k, leg, home);
    Mount mount;
    mount.base = {g.p_WA, {0, 0, std::atan2(g.radial.y(), g.radial.x())}};
    mount.platform.shift = g.p_WC - home.p_WT;
    out.mounts.push_back(mount);
  }
  for (auto& [name, part] : out.leg)
    if (auto* joint = std::get_if<Joint>(&part)) {
      joint->at.clear();
      joint->axes = name == "ball_joint" ? "after" : "before";
      if (name == "actuator") joint->home[2] = m.workspace.nominal_slider;
    } else {
      Member& member = std::get<Member>(part);
      if (name == "link") member.along = k.link_length * Vector3::UnitZ();
      member.from = name == "guideway" ? "actuator" : "";
      member.to.clear();
    }
  return parse_mechanism(write_mechanism(out), "6-psu as chains");
}

class SixPsuAsChains : public ::testing::TestWithParam<const char*> {};

TEST_P(SixPsuAsChains, HasTheSameJointsAndStiffness) {
  const Mechanism m = test::device(GetParam()), chains = as_chains(m);
  std::mt19937 random(7);
  for (const Pose& pose : test::random_poses(m, 50)) {
    const Configuration a = configure(m, pose), b = configure(chains, pose);
    EXPECT_LE((test::coordinates(a) - test::coordinates(b)).cwiseAbs().maxCoeff(), 1e-12);
    for (std::size_t leg = 0; leg < 6; ++leg) {
      const auto& guide = std::get<PlacedMember>(b.legs[leg].parts.at(1));
      const SixPsuLeg g = leg_at(test::six_psu(m), static_cast<int>(leg) + 1, pose);
      EXPECT_LE((guide.p_W_start - g.p_WA).norm() + (guide.p_W_end - g.p_WB).norm(), 1e-12);
    }
    EXPECT_LE(test::distance(configure_joints(chains, test::coordinates(a)).pose, pose), 1e-11);

    const Vector6 F = test::random_wrench(random);
    const analytic::AnalyticModel A(a), B(b);
    const analytic::AnalyticSolution s = A.solve(F), t = B.solve(F);
    EXPECT_LE(test::stiffness_difference(B.stiffness(t), A.stiffness(s), a.size), 1e-9);
    frame::MsaModel f(a), g(b);
    const frame::MsaSolution u = f.solve(F), v = g.solve(F);
    EXPECT_LE((v.displacement - u.displacement).norm(), 1e-9 * u.displacement.norm());
    EXPECT_LE(test::stiffness_difference(g.stiffness(v.state).K, f.stiffness(u.state).K, a.size), 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, SixPsuAsChains, ::testing::Values("haptic-6psu", "haptic-6psu-ideal-joints"),
                         [](const auto& p) {
                           return std::string(p.param) == "haptic-6psu" ? "Contacts" : "IdealJoints";
                         });

}  // namespace
}  // namespace deflect
