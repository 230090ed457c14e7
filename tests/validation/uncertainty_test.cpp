// Residuals weighed by noise and tolerances.
#include "validation/statistics/uncertainty.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "msa/frame/file/frame_file.h"
#include "tests/support/devices.h"
#include "validation/compare/held_out.h"
#include "validation/measurement/configure_all.h"
#include "validation/measurement/measurements.h"
#include "validation/measurement/random.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/prediction.h"

namespace deflect {
namespace {

using namespace compare;
using namespace measurement;
using namespace prediction;
using namespace statistics;
using namespace subject;

/// Twelve readings of three components each, displacement d, σ each.
struct Small {
  std::vector<MeasuredValue> values;
  std::vector<double> sigma;
  std::vector<VectorX> d;
  MatrixX A;
  Random random{3};

  Small() {
    for (std::size_t reading = 0; reading < 12; ++reading) {
      Vector6 x = Vector6::Zero();
      x.head<3>() = 1e-4 * random.normal3();
      d.push_back(x);
      for (std::size_t k = 0; k < 3; ++k) {
        values.push_back(tool_point_value(reading, k, x(static_cast<Eigen::Index>(k)), {}));
        sigma.push_back(1e-6 * random.uniform(1, 3));
      }
    }
    A = matrix(5) * 3e-6;
  }
  MatrixX matrix(Eigen::Index columns) {
    MatrixX out(36, columns);
    for (double& x : out.reshaped()) x = random.normal();
    return out;
  }
  MatrixX dense(double load) const {
    MatrixX S = A * A.transpose();
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t j = 0; j < values.size(); ++j) {
        const auto r = static_cast<Eigen::Index>(i), c = static_cast<Eigen::Index>(j);
        if (i == j) S(r, c) += sigma[i] * sigma[i];
        if (values[i].reading == values[j].reading) S(r, c) += load * load * values[i].value * values[j].value;
      }
    return S;
  }
};

TEST(Uncertainty, WeighsByTheInverseOfTheWholeCovariance) {
  Small s;
  const Uncertainty u(s.A, s.values, s.sigma, LoadErrors(0.01, s.d));
  const MatrixX X = s.matrix(2), Y = s.matrix(3), inverse = s.dense(0.01).inverse();
  const MatrixX wanted = X.transpose() * inverse * Y;
  EXPECT_LT((u.inner(X, Y) - wanted).norm(), 1e-10 * wanted.norm());
  EXPECT_EQ(u.count(), 36u);
}

// The tolerances' share of a pose is its expectation given the residuals at the others: A_p Aᵀ_o Σ_oo⁻¹ r_o.
TEST(HeldOut, LearnsTolerancesAtTheOtherPoses) {
  Small s;
  Measurements data;
  data.poses.resize(4);
  for (std::size_t i = 0; i < 12; ++i) {
    data.readings.emplace_back();
    data.readings.back().pose = i / 3;
  }
  ResidualStudy study;
  study.data = &data;
  study.values = s.values;
  std::vector<bool> aside(12, false);
  aside[7] = true;
  const Uncertainty u(s.A, s.values, s.sigma, LoadErrors(0.01, s.d), aside);
  const VectorX r = s.A * s.matrix(1).topRows(5) + 1e-6 * s.matrix(1);
  const MatrixX all = s.dense(0.01);
  double squares = 0, n = 0;
  for (std::size_t pose = 0; pose < 4; ++pose) {
    std::vector<Eigen::Index> own, others;
    for (std::size_t i = 0; i < 36; ++i)
      if (i / 3 != 7) (i / 9 == pose ? own : others).push_back(static_cast<Eigen::Index>(i));
    const MatrixX A = s.A(own, Eigen::all) * s.A(others, Eigen::all).transpose();
    const VectorX left = r(own) - A * MatrixX(all(others, others)).llt().solve(VectorX(r(others)));
    squares += left.squaredNorm();
    n += static_cast<double>(own.size());
    const double here = HeldOut(study, u, aside).squares(r)(static_cast<Eigen::Index>(pose));
    EXPECT_NEAR(here, left.squaredNorm(), 1e-9 * here) << "of a fold, here a pose";
  }
  const double wanted = std::sqrt(squares / n);
  EXPECT_NEAR(HeldOut(study, u, aside).rmse(r), wanted, 1e-9 * wanted);
}

TEST(Uncertainty, CovarianceOfContrastsIsThatOfTheirReadings) {
  Small s;
  const Uncertainty u(s.A, s.values, s.sigma, LoadErrors(0.01, s.d));
  Eigen::SparseMatrix<double, Eigen::RowMajor> T(2, 36);
  T.insert(0, 0) = 1;
  T.insert(0, 7) = -1;
  T.insert(1, 3) = 0.5;
  const MatrixX dense(T), wanted = dense * s.dense(0.01) * dense.transpose();
  EXPECT_LT((u.covariance(T) - wanted).norm(), 1e-12 * wanted.norm());
}

TEST(Uncertainty, ReadingsSetAsideWeighNothing) {
  Small s;
  std::vector<bool> aside(12, false);
  aside[4] = true;
  const Uncertainty u(s.A, s.values, s.sigma, LoadErrors(0.01, s.d), aside);
  VectorX r = VectorX::Zero(36);
  r.segment<3>(12).setConstant(1);  // of reading 4
  EXPECT_EQ(u.inner(r, r)(0, 0), 0);
  EXPECT_EQ(u.count(), 33u);
}

TEST(Regression, FindsAmplitudesAndTheirScatter) {
  Small s;
  const Uncertainty u(s.A, s.values, s.sigma, LoadErrors(0.01, s.d));
  const MatrixX G = s.matrix(3);
  const VectorX truth = Vector3(2e-6, -1e-6, 5e-7), r = G * truth;
  const Regression fit = regress(u, r, G);
  EXPECT_LT((fit.amplitude - truth).norm(), 1e-10 * truth.norm());
  EXPECT_EQ(fit.freedoms, 3);
  const MatrixX wanted = (G.transpose() * s.dense(0.01).inverse() * G).inverse();
  EXPECT_LT((fit.covariance - wanted).norm(), 1e-8 * wanted.norm());
  EXPECT_NEAR(fit.gain, u.inner(r, r)(0, 0), 1e-9 * fit.gain);  // all of it
}

TEST(Regression, LeavesOpenWhatTheDataDoNotDetermine) {
  Small s;
  const Uncertainty u(s.A, s.values, s.sigma, LoadErrors(0.01, s.d));
  MatrixX G(36, 2);
  G.col(0) = s.matrix(1);
  G.col(1) = -2 * G.col(0);
  const Regression fit = regress(u, 1e-6 * G.col(0), G);
  EXPECT_EQ(fit.freedoms, 1);
  EXPECT_LT((G * fit.amplitude - 1e-6 * G.col(0)).norm(), 1e-12);
  EXPECT_EQ(regress(u, s.matrix(1), G.col(0), G).freedoms, 0);  // beside itself nothing is left of it
}

TEST(ToleranceModel, AMachineOfSofterSteelMovesInProportion) {
  Mechanism m = test::device("haptic-6psu-ideal-joints");
  const Measurements data = campaign("paper", m, 50, 1);
  std::vector<MeasuredValue> values;
  for (std::size_t i = 0; i < data.readings.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) values.push_back(tool_point_value(i, k, 0, {}));
  const std::shared_ptr<const Standing> standing = Subject(m).stand(data);
  const ToleranceModel t = tolerance_model(*standing, data, values);
  // One modulus; per leg a diameter, two joints, a link; per pose six sliders.
  EXPECT_EQ(t.nuisances.size(), 1u + 6 * (1 + 6 + 1) + 9 * 6);
  EXPECT_EQ(t.nuisances[0].name, "modulus");
  const VectorX d = rows_of(values, standing->predict(data));
  // d ∝ 1/E: a step of 1 % changes it by 1/1.01 − 1.
  EXPECT_LT((t.A.shared.col(0) - d * (1 / 1.01 - 1)).norm(), 1e-9 * d.norm());
  // A pose's sliders move its own readings only.
  const Eigen::Index slider = 49;
  EXPECT_EQ(t.nuisances[49].name, "pose 0 leg 1 slider");
  const MatrixX A = t.A.dense();
  EXPECT_EQ(A.cols(), std::ssize(t.nuisances));
  EXPECT_GT(A.col(slider).head(9).norm(), 0);
  EXPECT_EQ(A.col(slider).tail(72).norm(), 0);
  // By its σ over some 100 mm of guideway: deflections as its cube, so that they change by far less than a percent.
  EXPECT_LT(A.col(slider).head(9).norm(), 1e-2 * d.head(9).norm());
}

// d ∝ 1/E and d ∝ 1/k: the derivative says σ_d = t d, a difference over a deviation t d/(1 + t), of a fifth 17 % less.
TEST(ToleranceModel, LargeOnesAreDerivatives) {
  Mechanism m = test::device("haptic-6psu-ideal-joints");
  m.tolerances.modulus = 0.2;
  const Measurements data = campaign("paper", m, 50, 1);
  std::vector<MeasuredValue> values;
  for (std::size_t i = 0; i < data.readings.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) values.push_back(tool_point_value(i, k, 0, {}));
  const std::shared_ptr<const Standing> standing = Subject(m).stand(data);
  const ToleranceModel of_steel = tolerance_model(*standing, data, values);
  const VectorX d = rows_of(values, standing->predict(data));
  EXPECT_LT((of_steel.A.shared.col(0) + 0.2 * d).norm(), 0.0101 * 0.2 * d.norm());

  const char* post = R"(
name: post
plane: xz
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {bar: {shape: rectangle, width_y: 20 mm, height_z: 20 mm}}
nodes: {A: [0 m, 0 m, 0 m], B: [1 m, 0 m, 0 m]}
members: {bar: {from: A, to: B, section: bar, material: steel, y_axis: [0, 1, 0]}}
supports: {A: {holds: [uz, ry]}}
springs: {ground: {node: A, ux: 2000 N/mm}}
loads: {pull: {nodes: {B: {fx: 1 kN}}}}
sensors: {a: {node: A, direction: ux, sigma: 1 um}}
tolerances: {spring.ux.stiffness: 50 %}
)";
  const Subject s = frame::parse_frame(post, "frame.yaml");
  const Measurements read = s.placed(parse_measurements("load.pull,a_mm\n1,0\n2,0\n", "data.csv", s.instruments()));
  const auto stands = s.stand(read);
  const std::vector<MeasuredValue> seen = measured_values(read, stands->sensor_forms(read));
  const ToleranceModel of_spring = tolerance_model(*stands, read, seen);
  ASSERT_EQ(of_spring.A.shared.cols(), 1);
  for (const Eigen::Index i : {0, 1})  // 0.5 and 1 mm; steps of a twentieth of the half change k by a fortieth
    EXPECT_NEAR(of_spring.A.shared(i, 0), -0.5 * 0.5e-3 * static_cast<double>(i + 1), 0.025 * 0.25e-3 * 2);
}

// Readings of a pose are predicted alone there: their rank among them says nothing of a drift over all.
TEST(ToleranceModel, ADriftingSensorChangesNothing) {
  Mechanism m = test::device("haptic-6psu-ideal-joints");
  const Measurements data = campaign("paper", m, 50, 1);
  std::vector<MeasuredValue> values;
  for (std::size_t i = 0; i < data.readings.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) values.push_back(tool_point_value(i, k, 0, {}));
  const MatrixX still = tolerance_model(*Subject(m).stand(data), data, values).A.dense();
  m.sensor.drift = Vector3(1e-3, -2e-3, 1e-3);
  EXPECT_EQ((tolerance_model(*Subject(m).stand(data), data, values).A.dense() - still).norm(), 0);
}

}  // namespace
}  // namespace deflect
