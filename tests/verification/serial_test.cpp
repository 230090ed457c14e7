// Serial arms of rigid links on elastic joints: C = Σ J_i J_iᵀ / k_i.
#include <gtest/gtest.h>

#include "analytic/model.h"
#include "msa/frame/mechanism/msa.h"
#include "tests/support/chains.h"

namespace deflect {
namespace {

/// Σ J_i J_iᵀ / k_i with J_i = [z × (T − p); z] of the joint's axis through p.
Matrix6 closed_form(const Configuration& c) {
  Matrix6 C = Matrix6::Zero();
  for (const PlacedPart& part : c.legs[0].parts) {
    const auto& joint = std::get<PlacedJoint>(part);
    const Vector3 z = joint.R_WJ.col(2);
    Vector6 J;
    J << z.cross(c.pose.p_WT - joint.p_W), z;
    C += J * J.transpose() / std::get<LinearLaw>(joint.laws[5].at(0)).stiffness;
  }
  return C;
}

/// Largest over smallest singular value, rotations weighed by the arm's size.
double condition(const Matrix6& C, double length) {
  Vector6 w = Vector6::Ones();
  w.tail<3>().setConstant(length);
  const Vector6 s = Eigen::JacobiSVD<Matrix6>(w.asDiagonal() * C * w.asDiagonal()).singularValues();
  return s(0) / s(5);
}

// The closed form of a leg goes by way of its stiffness, C⁻¹, whose rounding is that of the condition of C.
TEST(Serial, ComplianceIsTheSumOverTheJoints) {
  const Mechanism m = test::device("fanuc-r2000ic");
  std::mt19937 random(8);
  for (int i = 0; i < 100; ++i) {
    Vector6 q;
    q << test::random_vector(random, 3), test::random_vector(random, 3);
    const Configuration c = configure_joints(m, q);
    const Matrix6 C = closed_form(c), analytic = test::compliance_by(analytic::AnalyticModel(c)),
                  msa = test::compliance_by(frame::MsaModel(c));
    EXPECT_LE(test::compliance_difference(analytic, C, c.size), 1e-12 + 1e-15 * condition(C, c.size));
    EXPECT_LE(test::compliance_difference(msa, C, c.size), 1e-12);
  }
}

// Axes 4 and 6 in line, or the arm stretched: no load is too much in one direction, every displacement exists.
TEST(Serial, SingularArmHasADisplacement) {
  const Mechanism m = test::device("fanuc-r2000ic");
  const double stretched = std::atan2(0.225, 1.280);
  for (const Vector6& q :
       {(Vector6() << 0.3, 0.2, -0.1, 0.4, 0, 0.2).finished(),
        (Vector6() << 0.3, 0.4, pi / 2 - 0.4 - stretched, 0.4, 0.7, 0.2).finished(), Vector6(Vector6::Zero())}) {
    const Configuration c = configure_joints(m, q);
    const Matrix6 C = closed_form(c);
    EXPECT_LE(test::compliance_difference(test::compliance_by(frame::MsaModel(c)), C, c.size), 1e-12);
  }
}

}  // namespace
}  // namespace deflect
