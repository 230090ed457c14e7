// The Gough-Stewart platform: its struts carry forces along themselves only, so that its stiffness is known in closed
// form, K = Jᵀ diag(k) J with rows [nᵀ, ((C − T) × n)ᵀ].
#include <gtest/gtest.h>

#include "analytic/model.h"
#include "msa/frame/mechanism/msa.h"
#include "tests/support/chains.h"

namespace deflect {
namespace {

/// Without its flexible members: the drive yields alone.
Mechanism ideal_struts() {
  Mechanism m = test::device("stewart-6ups");
  Offset cylinder;
  cylinder.shift = *std::get<Member>(*find(m.leg, "cylinder")).along;
  for (auto& [name, part] : m.leg)
    if (name == "cylinder") part = cylinder;
  std::erase_if(m.leg, [](const auto& part) { return part.first == "rod"; });
  return m;
}

/// k of a strut: drive, tube and the rod as far as it stands out, in series.
double strut(const Mechanism& m, double extension) {
  double c = 1 / std::get<LinearLaw>(std::get<Joint>(*find(m.leg, "slide")).laws[2].at(0)).stiffness;
  const double E = find(m.materials, "steel")->E;
  for (const auto& [name, part] : m.leg)
    if (const auto* member = std::get_if<Member>(&part))
      c += (member->along ? member->along->norm() : extension) /
           (E * properties(*find(m.sections, member->section), 0.3).A);
  return 1 / c;
}

Matrix6 closed_form(const Mechanism& m, const Configuration& c) {
  Matrix6 K = Matrix6::Zero();
  for (std::size_t leg = 0; leg < 6; ++leg) {
    const Vector3 arm = c.pose.R_WT * m.mounts[leg].platform.shift;
    const Vector3 n = (c.pose.p_WT + arm - m.mounts[leg].base.shift).normalized();
    Vector6 row;
    row << n, arm.cross(n);
    K += row * strut(m, c.actuators[leg].value) * row.transpose();
  }
  return K;
}

TEST(Stewart, HasTheClosedFormStiffnessByBothTheories) {
  for (const Mechanism& m : {ideal_struts(), test::device("stewart-6ups")})
    for (const Pose& pose : test::workspace_poses(m, 20, 0.2)) {
      const Configuration c = configure(m, pose);
      const Matrix6 K = closed_form(m, c);
      const analytic::AnalyticModel analytic(c);
      frame::MsaModel msa(c);
      const Vector6 F = Vector6::Unit(0);
      EXPECT_LE(test::stiffness_difference(analytic.stiffness(analytic.solve(F)), K, c.size), 1e-12);
      EXPECT_LE(test::stiffness_difference(msa.stiffness(msa.solve(F).state).K, K, c.size), 1e-12);
      EXPECT_LE(test::compliance_difference(test::compliance_by(analytic), K.inverse(), c.size), 1e-11);
      EXPECT_LE(test::compliance_difference(test::compliance_by(msa), K.inverse(), c.size), 1e-11);
    }
}

/// Joints exactly on their circles; the file rounds them.
Mechanism exact() {
  Mechanism m = test::device("stewart-6ups");
  for (Mount& mount : m.mounts)
    for (const auto& [shift, radius] : {std::pair{&mount.base.shift, 3.0}, {&mount.platform.shift, 1.0}}) {
      const double tenths = std::round(std::atan2(shift->y(), shift->x()) * 1800 / pi);
      *shift = radius * Vector3(std::cos(tenths * pi / 1800), std::sin(tenths * pi / 1800), 0);
    }
  return m;
}

// A platform whose joints lie on circles with 120° symmetry, parallel to its base and turned by 90°, is singular
// wherever it stands (E. F. Fichter, A Stewart platform-based manipulator, IJRR 5, 1986): a screw about z is free.
TEST(Stewart, TurnedByNinetyDegreesIsRefusedWithTheScrewThatIsFree) {
  for (const Vector3& p : {Vector3(0, 0, 2), Vector3(0.1, -0.05, 1.8)}) {
    const Configuration c = configure(exact(), {p, rotation_from_rpy(0, 0, pi / 2)});
    for (const Eigen::Index load : {0, 5}) {  // whether it drives the motion or not
      for (const auto& solve :
           std::vector<std::function<void()>>{[&] { analytic::AnalyticModel(c).solve(Vector6::Unit(load)); },
                                              [&] { frame::MsaModel(c).solve(Vector6::Unit(load)); }}) {
        std::string message;
        try {
          solve();
        } catch (const ModelError& e) {
          message = e.what();
        }
        EXPECT_NE(message.find("cannot stand"), message.npos) << message;
        EXPECT_NE(message.find("platform"), message.npos) << message;
        EXPECT_NE(message.find("per rad"), message.npos) << message;
      }
    }
  }
}

}  // namespace
}  // namespace deflect
