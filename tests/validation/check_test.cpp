// Every usual mistake in a stiffness is found, in any device, alone and beside a reference, in full and in few digits;
// a right stiffness passes.
#include "validation/matrix/check_matrix.h"

#include <gtest/gtest.h>

#include <set>

#include "analytic/model.h"
#include "msa/base/error.h"
#include "tests/support/stiffnesses.h"
#include "validation/matrix/mistakes.h"

namespace deflect {
namespace {

using namespace matrix;

constexpr int full = 17, few = 4;

/// The closed form's stiffness of the built-in device, N, mm.
Matrix6 device_stiffness(const Pose& pose) {
  const Mechanism m = test::device("haptic-6psu-ideal-joints");
  const analytic::AnalyticModel model(configure(m, pose));
  return stiffness_in_mm(model.stiffness(model.solve(Vector6::Zero())));
}

/// Random springs, and the built-in device at tilted poses.
std::vector<Matrix6> right_matrices() {
  std::vector<Matrix6> list;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    list.push_back(test::random_stiffness(random));
  }
  for (const Pose& pose : test::random_poses(test::device("haptic-6psu-ideal-joints"), 10))
    list.push_back(device_stiffness(pose));
  return list;
}

MatrixCheckOptions options(const Matrix6& K, int digits, const Matrix6* R = nullptr) {
  MatrixCheckOptions o;
  o.K = test::read_back(K, digits);
  if (R) o.reference = test::read_back(*R, digits);
  return o;
}

std::set<std::string> ids(const std::vector<MatrixDiagnosis>& list) {
  std::set<std::string> set;
  for (const MatrixDiagnosis& d : list) set.insert(d.id);
  return set;
}

/// One mistake of the table in many matrices.
class EveryMistake : public ::testing::TestWithParam<std::string> {
 protected:
  Matrix6 spoil(const Matrix6& K) const {
    std::mt19937 random(11);
    return test::spoilt().at(GetParam())(K, random);
  }
};

TEST_P(EveryMistake, IsNamedBesideAReference) {
  for (const int digits : {full, few})
    for (const Matrix6& K : right_matrices()) {
      const MatrixCheck m = check_matrix(options(spoil(K), digits, &K));
      EXPECT_FALSE(m.passes());
      EXPECT_EQ(ids(m.explanations), std::set{GetParam()}) << digits << " digits of\n" << K;
    }
}

/// What K alone tells. Mistakes that leave the stiffness of another possible device pass. In units of millimetres,
/// metres taken for millimetres and an exchanged order leave the same: a device too small. A block that was scaled
/// breaks K ⪰ 0 as its coupling does when it was scaled.
TEST_P(EveryMistake, IsNamedAloneWhereItLeavesATrace) {
  static const std::map<std::string, std::set<std::string>> found = {
      {"coupling_sign", {}},
      {"moved", {}},
      {"turned", {}},
      {"scaled", {}},
      {"stiffer", {}},
      {"softer", {}},
      {"metres", {"metres", "rotation_first"}},
      {"rotation_first", {"rotation_first", "metres"}},
      {"translation_block", {"translation_block", "coupling_block"}},
      {"rotation_block", {"rotation_block", "coupling_block"}},
  };
  if (GetParam() == "moved_as_compliance") return;  // any size of device, but for the digits: see below
  const auto expected = found.find(GetParam());
  for (const int digits : {full, few})
    for (const Matrix6& K : right_matrices()) {
      const MatrixCheck m = check_matrix(options(spoil(K), digits));
      EXPECT_EQ(ids(m.explanations), expected == found.end() ? std::set{GetParam()} : expected->second)
          << digits << " digits of\n"
          << K;
      EXPECT_EQ(m.passes(), expected != found.end() && expected->second.empty());
    }
}

std::vector<std::string> all_ids() {
  std::vector<std::string> list;
  for (const Mistake& m : mistakes()) list.emplace_back(m.id);
  return list;
}

INSTANTIATE_TEST_SUITE_P(Table, EveryMistake, ::testing::ValuesIn(all_ids()), [](const auto& p) { return p.param; });

TEST(CheckMatrix, RightMatricesPassInAnyUnitAndToAnyDigits) {
  std::mt19937 random;
  for (const Matrix6& K : right_matrices())
    for (const int digits : {full, 6, few}) {
      EXPECT_TRUE(check_matrix(options(K, digits)).passes());
      EXPECT_TRUE(check_matrix(options(K, digits, &K)).passes());
      MatrixCheckOptions metres = options(test::spoilt().at("metres")(K, random), digits);
      metres.unit_m = 1;
      EXPECT_TRUE(check_matrix(metres).passes());
    }
}

TEST(CheckMatrix, TwoMistakesAreNamedInTheirOrder) {
  std::mt19937 random(3);
  const Matrix6 K = test::random_stiffness(random);
  const auto spoilt = test::spoilt();
  const auto diagnosis = [&](const std::string& first, const std::string& second) {
    const MatrixCheck m = check_matrix(options(spoilt.at(second)(spoilt.at(first)(K, random), random), full, &K));
    return m.explanations.size() == 1 ? m.explanations.front().id : "";
  };
  EXPECT_EQ(diagnosis("metres", "negated"), "negated+metres");
  EXPECT_EQ(diagnosis("moved", "rotation_first"), "rotation_first+moved");
  EXPECT_EQ(diagnosis("moved", "turned"), "turned+moved");
  EXPECT_EQ(diagnosis("scaled", "compliance"), "compliance+scaled");
}

TEST(CheckMatrix, SaysWhereTheOtherPointLies) {
  std::mt19937 random(5);
  const Matrix6 K = test::random_stiffness(random), X = shift_twist(-Vector3(10, -20, 30));
  const MatrixCheck m = check_matrix(options(X.transpose() * K * X, full, &K));
  ASSERT_EQ(m.explanations.size(), 1u);
  EXPECT_EQ(m.explanations[0].sentence, "it is given at another point: T + (10, -20, 30) mm");
}

TEST(CheckMatrix, TheSizeOfTheDeviceDecidesBetweenMetresAndOrder) {
  std::mt19937 random(5);
  const Matrix6 K = test::random_stiffness(random);
  for (const char* id : {"metres", "rotation_first"}) {
    MatrixCheckOptions o = options(test::spoilt().at(id)(K, random), full);
    EXPECT_TRUE(check_matrix(o).guessed);
    o.plausible = {0.02, 1};
    EXPECT_EQ(ids(check_matrix(o).explanations), std::set<std::string>{id});
  }
}

/// Ties that are no fault of the search: matrices that both mistakes make, entry by entry.
TEST(CheckMatrix, MistakesThatMakeTheSameMatrixAreAllNamed) {
  // At the home pose the device is symmetric about z, so turning it over and shifting it past its centre, of stiffness
  // or of compliance, change the sign of the coupling and nothing else.
  const Matrix6 K = device_stiffness(test::home(test::device("haptic-6psu-ideal-joints")));
  std::mt19937 random(1);
  const MatrixCheck m = check_matrix(options(test::spoilt().at("coupling_sign")(K, random), full, &K));
  EXPECT_EQ(ids(m.explanations), (std::set<std::string>{"coupling_sign", "moved", "moved_as_compliance", "turned"}));
  // Its coupling is a lever only, A [r]×: one that is missing or too large on one side is also a move on that side.
  const auto alone = [&](const char* id) {
    return ids(check_matrix(options(test::spoilt().at(id)(K, random), full)).explanations);
  };
  EXPECT_EQ(alone("triangle"), (std::set<std::string>{"triangle", "moved_on_one_side"}));
  EXPECT_EQ(alone("degrees"), (std::set<std::string>{"degrees", "moved_on_one_side"}));
}

TEST(CheckMatrix, TheStructureDoesNotDependOnThePoint) {
  std::mt19937 random(9);
  const Matrix6 K = test::random_stiffness(random);
  const Vector3 r(15, -40, 25);
  const Matrix6 X = shift_twist(-r);
  const ElasticStructure a = elastic_structure(K), b = elastic_structure(X.transpose() * K * X);
  EXPECT_LT((a.centre_of_stiffness - r - b.centre_of_stiffness).norm(), 1e-9);
  EXPECT_LT((*a.centre_of_compliance - r - *b.centre_of_compliance).norm(), 1e-9);
  EXPECT_LT((a.translational - b.translational).norm(), 1e-9 * a.translational.norm());
  EXPECT_LT((a.rotational - b.rotational).norm(), 1e-9 * a.rotational.norm());
  EXPECT_NEAR(a.length, b.length, 1e-9 * a.length);
  const Matrix6 Y = shift_twist(-a.centre_of_stiffness);
  const Matrix3 coupling = (Y.transpose() * K * Y).topRightCorner<3, 3>();
  EXPECT_LT((coupling - coupling.transpose()).norm(), 1e-9 * coupling.norm());
}

TEST(CheckMatrix, ABeamsCentresLieInItsMiddle) {
  // A clamped beam of length L along x at its tip: all centres at half length (Lončarić).
  const double EA = 2e5, GJ = 3e6, EI = 5e6, L = 200;
  Matrix6 K = Matrix6::Zero();
  K.diagonal() << EA / L, 12 * EI / (L * L * L), 12 * EI / (L * L * L), GJ / L, 4 * EI / L, 4 * EI / L;
  K(1, 5) = K(5, 1) = -6 * EI / (L * L);
  K(2, 4) = K(4, 2) = 6 * EI / (L * L);
  const ElasticStructure s = elastic_structure(K);
  EXPECT_LT((s.centre_of_stiffness - Vector3(-L / 2, 0, 0)).norm(), 1e-9);
  EXPECT_LT((*s.centre_of_compliance - Vector3(-L / 2, 0, 0)).norm(), 1e-9);
  EXPECT_NEAR(s.rotational(0), GJ / L, 1e-6);
  EXPECT_NEAR(s.rotational(2), EI / L, 1e-6);
}

/// A leg: two passive joints released in a random stiffness.
struct Leg {
  Matrix6 locked, free;
  MatrixX J = MatrixX(6, 2);

  explicit Leg(unsigned seed) {
    std::mt19937 random(seed);
    locked = test::random_stiffness(random);
    J << 0, 0, 0, 0, 0, 10, 1, 0, 0, 1, 0, 0;  // about x through T; about y through T + (10, 0, 0) mm, advancing
    const MatrixX KJ = locked * J;
    free = locked - KJ * (J.transpose() * KJ).inverse() * KJ.transpose();
  }
};

TEST(CheckMatrix, PassiveJointsAreFreeOrNamed) {
  const Leg leg(2);
  for (const int digits : {full, 6}) {
    MatrixCheckOptions o = options(leg.free, digits);
    o.passive_twists = test::read_back(leg.J, full);
    EXPECT_TRUE(check_matrix(o).passes());
    o.K = test::read_back(leg.locked, digits);
    const MatrixCheck m = check_matrix(o);
    EXPECT_EQ(ids(m.findings), std::set<std::string>{"passive_joint_resists"});
    EXPECT_EQ(m.findings.size(), 2u);
    EXPECT_NE(m.findings[0].sentence.find("rotation about (1, 0, 0) through T"), std::string::npos);
  }
  const MatrixCheck locked = check_matrix(options(leg.locked, full, &leg.free));
  ASSERT_EQ(ids(locked.explanations), std::set<std::string>{"stiffer"});
  EXPECT_NE(locked.explanations[0].sentence.find("in 2 directions"), std::string::npos);
}

TEST(CheckMatrix, FreeDirectionsAreScrewsInWords) {
  std::mt19937 random(4);
  Matrix6 K = test::random_stiffness(random);
  const auto released = [&](const Vector6& t) { return Matrix6(K - K * t * (t.transpose() * K) / t.dot(K * t)); };
  Vector6 t;
  t << 0, 0, 1, 0, 0, 0;
  MatrixCheck m = check_matrix(options(released(t), full));
  ASSERT_EQ(ids(m.findings), std::set<std::string>{"free_direction"});
  EXPECT_NE(m.findings[0].sentence.find("translation along (0, 0, 1)"), std::string::npos) << m.findings[0].sentence;
  t << Vector3(30, 0, 0).cross(Vector3::UnitZ()) + 5 * Vector3::UnitZ(), Vector3::UnitZ();
  m = check_matrix(options(released(t), full));
  ASSERT_EQ(m.findings.size(), 1u);
  EXPECT_NE(m.findings[0].sentence.find("(0, 0, 1) through T + (30, 0, 0) mm, advancing 5 mm per rad"),
            std::string::npos)
      << m.findings[0].sentence;
  K.row(5).setZero(), K.col(5).setZero();
  EXPECT_EQ(ids(check_matrix(options(K, few)).findings), std::set<std::string>{"free_direction"});
}

TEST(CheckMatrix, WhatNoMistakeExplainsIsSaidInNumbers) {
  std::mt19937 random(6);
  const Matrix6 K = test::random_stiffness(random);
  Matrix6 bad = K;
  bad(0, 4) *= 1.1, bad(1, 3) *= 0.9, bad(2, 5) *= 1.2;
  EXPECT_EQ(ids(check_matrix(options(bad, full)).findings), std::set<std::string>{"asymmetric"});
  const MatrixCheck beside = check_matrix(options((bad + bad.transpose()) / 2, full, &K));
  EXPECT_EQ(ids(beside.findings), std::set<std::string>{"differs"});
  ASSERT_TRUE(beside.ratio);
  EXPECT_LT((*beside.ratio)(0), 1);
  EXPECT_GT((*beside.ratio)(1), 1);
  bad = K;
  bad(2, 2) *= -1;
  EXPECT_EQ(ids(check_matrix(options(bad, full)).findings), std::set<std::string>{"indefinite"});
  EXPECT_THROW(check_matrix(options(K, full, &bad)), InputError);
}

TEST(CheckMatrix, ToleranceTakesThePlaceOfTheDigits) {
  std::mt19937 random(8);
  const Matrix6 K = test::random_stiffness(random);
  Matrix6 rough = K;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) rough(i, j) *= 1 + 1e-7 * test::uniform(random, -1, 1);
  MatrixCheckOptions o = options(rough, full);
  const MatrixCheck strict = check_matrix(o);
  ASSERT_EQ(ids(strict.findings), std::set<std::string>{"asymmetric"});
  EXPECT_NE(strict.findings[0].remedy.find("--tolerance"), std::string::npos);
  o.tolerance = 1e-6;
  EXPECT_TRUE(check_matrix(o).passes());
}

}  // namespace
}  // namespace deflect
