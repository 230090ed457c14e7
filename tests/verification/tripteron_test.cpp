// The Tripteron of D. Kirsanov, O. Sevostianov, O. Rodionov, M. Ostanin (IEEE 2020, document 9290208): deflections
// under 1000 N, and wrong ways to release passive joints that are in public use.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "analytic/member.h"
#include "analytic/model.h"
#include "msa/base/stiffness_checks.h"
#include "msa/frame/mechanism/msa.h"
#include "tests/support/chains.h"

namespace deflect {
namespace {

struct Point {
  Vector3 p;           // m
  Vector3 deflection;  // mm: |translation| for 1000 N along x, y, z; ten decimals are given
};

const Point points[] = {{{0.1, 0.1, 0.1}, {1.2559788138, 1.2608437900, 1.1137608798}},
                        {{0.5, 0.5, 0.5}, {1.2028065749, 1.2096077576, 1.2096097222}},
                        {{1, 1, 1}, {1.2905625748, 1.2895667505, 1.4089404443}},
                        {{1, 0.1, 0.1}, {1.2606276317, 1.3921035569, 1.2898850652}},
                        {{0.1, 1, 0.1}, {1.1080946580, 1.2628789609, 1.2986732887}},
                        {{0.1, 0.1, 1}, {1.3982662813, 1.1092904676, 1.1081527651}},
                        {{0.9, 0.2, 0.6}, {1.2896252672, 1.2860801801, 1.2652015760}}};

Configuration at(const Vector3& p) { return configure(test::device("tripteron"), {p, Matrix3::Identity()}); }

double deflection_mm(const Matrix6& C, int axis) { return 1e3 * 1000 * C.col(axis).head<3>().norm(); }

TEST(Tripteron, DeflectsAsPublishedByBothTheories) {
  for (const Point& point : points) {
    const Configuration c = at(point.p);
    const Matrix6 analytic = test::compliance_by(analytic::AnalyticModel(c)),
                  msa = test::compliance_by(frame::MsaModel(c));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(deflection_mm(analytic, axis), point.deflection(axis), 0.51e-10)
          << point.p.transpose() << " " << axis;
      EXPECT_NEAR(deflection_mm(msa, axis), point.deflection(axis), 0.51e-10) << point.p.transpose() << " " << axis;
    }
  }
}

/// A leg's compliance C without its passive joints, the sum of the stiffnesses of its springs, which is no stiffness of
/// springs in series, and the twists J_q of the passive joints. All at T, base axes.
struct Leg {
  Matrix6 C = Matrix6::Zero(), summed_stiffness = Matrix6::Zero();
  Matrix6X J_q{6, 0};
};

Leg leg_of(const PlacedLeg& placed, const Vector3& p_WT) {
  Leg leg;
  for (const PlacedPart& part : placed.parts)
    if (const auto* member = std::get_if<PlacedMember>(&part)) {
      const Matrix6 C = analytic::moved_to(p_WT, *member, member->R_WM, analytic::tip_compliance(*member));
      leg.C += C;
      leg.summed_stiffness += C.inverse();
    } else {
      const auto& joint = std::get<PlacedJoint>(part);
      const Vector3 z = joint.R_WJ.col(2);
      Vector6 twist = Vector6::Zero();
      if (joint.elastic(2)) {  // the slide
        const double k = std::get<LinearLaw>(joint.laws[2].at(0)).stiffness;
        twist.head<3>() = z;
        leg.C += twist * twist.transpose() / k;
        leg.summed_stiffness += twist * k * twist.transpose();
      } else {
        twist << z.cross(p_WT - joint.p_W), z;
        leg.J_q.conservativeResize(6, leg.J_q.cols() + 1);
        leg.J_q.rightCols<1>() = twist;
      }
    }
  return leg;
}

/// K − K J (Jᵀ B J)⁻¹ Jᵀ K, which releases the joints where B = K.
Matrix6 released(const Matrix6& K, const Matrix6& B, const Matrix6X& J) {
  return K - K * J * (J.transpose() * B * J).inverse() * J.transpose() * K;
}

/// A way from C and J_q to the stiffness of a leg whose passive joints are free. The wrong ones are in public code for
/// this and like machines and make it five times too stiff at least.
struct Elimination {
  const char* name;
  Matrix6 (*K_c)(const Leg&);
  bool right;
  friend void PrintTo(const Elimination& e, std::ostream* out) { *out << e.name; }
};

const Elimination eliminations[] = {
    {"Condensed", [](const Leg& l) { return released(l.C.inverse(), l.C.inverse(), l.J_q); }, true},
    {"Locked", [](const Leg& l) -> Matrix6 { return l.C.inverse(); }, false},
    {"OneJointOfThree", [](const Leg& l) { return released(l.C.inverse(), l.C.inverse(), l.J_q.leftCols(1)); }, false},
    {"ComplianceForStiffness", [](const Leg& l) { return released(l.C.inverse(), l.C, l.J_q); }, false},
    {"SeriesAddedAsStiffness", [](const Leg& l) -> Matrix6 { return l.summed_stiffness; }, false},
    {"SeriesAddedInTheBrackets",
     [](const Leg& l) { return released(l.C.inverse(), l.summed_stiffness.inverse(), l.J_q); }, false},
};

class Release : public ::testing::TestWithParam<Elimination> {};

TEST_P(Release, PassesTheChecksWhereItIsRight) {
  for (const Point& point : points) {
    const Configuration c = at(point.p);
    Matrix6 K = Matrix6::Zero();
    std::vector<LegStiffness> legs;
    for (const PlacedLeg& placed : c.legs) {
      const Leg leg = leg_of(placed, c.pose.p_WT);
      legs.push_back({placed.name, GetParam().K_c(leg), leg.J_q});
      K += legs.back().K;
    }
    const StiffnessChecks checks = check_stiffness(K, legs);
    EXPECT_EQ(checks.all(), GetParam().right) << checks.failure;
    const Matrix6 C = K.inverse();
    for (int axis = 0; axis < 3; ++axis) {
      const double ratio = deflection_mm(C, axis) / point.deflection(axis);
      if (GetParam().right) {
        EXPECT_NEAR(ratio, 1, 1e-9);
      } else {
        EXPECT_LT(ratio, 0.2);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(PassiveJoints, Release, ::testing::ValuesIn(eliminations),
                         [](const auto& e) { return std::string(e.param.name); });

}  // namespace
}  // namespace deflect
