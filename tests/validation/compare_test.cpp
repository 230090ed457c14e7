// What `compare` says of residuals whose origin is known: put into readings by hand, through statics alone.
#include "validation/compare/comparison.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <set>

#include "tests/support/devices.h"
#include "validation/compare/residual_study.h"
#include "validation/measurement/configure_all.h"
#include "validation/measurement/random.h"
#include "validation/prediction/campaign.h"
#include "validation/prediction/prediction.h"
#include "validation/prediction/simulate.h"
#include "validation/report/compare_results.h"
#include "validation/subject/machine_sites.h"

namespace deflect {
namespace {

using namespace compare;
using namespace measurement;
using namespace prediction;
using namespace report;
using namespace subject;

testing::AssertionResult says(const std::string& text, const std::string& part) {
  if (text.find(part) != text.npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "'" << part << "' is not in: " << text;
}

constexpr double sigma = 2e-6;

/// Lengths and directions of the legs of the 6-PSU by its drawing, and the forces that statics put on them.
struct Leg {
  Vector3 n;
  Vector6 s;
  double slider;
};

std::array<Leg, 6> legs_at(const Mechanism& m, const Pose& pose) {
  std::array<Leg, 6> out;
  for (int i = 0; i < 6; ++i) {
    const SixPsuLeg g = leg_at(test::six_psu(m), i + 1, pose);
    Leg& leg = out[static_cast<std::size_t>(i)];
    leg.n = (g.p_WC - g.p_WB).normalized();
    leg.s << leg.n, (g.p_WC - pose.p_WT).cross(leg.n);
    leg.slider = g.slider;
  }
  return out;
}

/// Readings of the drawing with legs that are longer by e(leg number, force, leg), and noise.
template <class Elongation>
Measurements made(const Mechanism& m, const std::string& plan, const Elongation& e, std::uint64_t seed = 1) {
  Measurements data = campaign(plan, m, 50, seed);
  PredictionOptions o;
  o.geometry = Geometry::finite;
  const std::vector<Configuration> machines = configure_all(m, data);
  const std::vector<VectorX> d = predict(m, machines, data, o);
  Random random(seed + 100);
  for (std::size_t i = 0; i < data.readings.size(); ++i) {
    Reading& r = data.readings[i];
    const std::array<Leg, 6> legs = legs_at(m, machines[r.pose].pose);
    Matrix6 S;  // Σ s_i f_i = F, and Sᵀt = e
    for (int k = 0; k < 6; ++k) S.col(k) = legs[static_cast<std::size_t>(k)].s;
    const Vector6 f = S.inverse() * r.load;
    Vector6 elongation;
    for (int k = 0; k < 6; ++k) elongation(k) = e(k + 1, f(k), legs[static_cast<std::size_t>(k)]);
    const Vector6 moved = d[i] + S.transpose().inverse() * elongation;
    for (std::size_t k = 0; k < 3; ++k)
      r.displacement[k] = moved(static_cast<Eigen::Index>(k)) + sigma * random.normal();
    r.sigma_u = sigma;
  }
  return data;
}

/// Readings of the machine itself, and noise.
Measurements made_by(const Mechanism& m) {
  SimulationOptions o;
  o.sigma_u = sigma;
  o.tolerances = 0;
  return simulate(m, campaign("rich", m, 50, 1), o);
}

Mechanism ideal() { return test::device("haptic-6psu-ideal-joints"); }

const auto nothing = [](int, double, const Leg&) { return 0.0; };

Comparison compared(const Measurements& data) {
  static const Mechanism m = ideal();
  return compare::compare(m, data);
}

TEST(Sites, LegForcesAreThoseOfStatics) {
  const Mechanism m = ideal();
  for (const Pose& pose : test::random_poses(m, 10)) {
    const std::vector<Site> sites = sites_of(configure(m, pose));
    const std::array<Leg, 6> legs = legs_at(m, pose);
    ASSERT_EQ(sites.size(), 6u);
    Matrix6 S;
    for (int k = 0; k < 6; ++k) S.col(k) = legs[static_cast<std::size_t>(k)].s;
    for (std::size_t k = 0; k < 6; ++k) {
      const Vector6 g = S.inverse().row(static_cast<Eigen::Index>(k)).transpose();
      EXPECT_LT((sites[k].g - g).norm(), 1e-9 * g.norm());
      EXPECT_LT((sites[k].s - legs[k].s).norm(), 1e-12);
      EXPECT_NEAR(sites[k].extension, legs[k].slider, 1e-15);
      EXPECT_NEAR(sites[k].along, legs[k].n.z() * legs[k].n.z(), 1e-12);
    }
  }
}

TEST(Sites, OfAnArmAreItsDrivenJoints) {
  const Mechanism m = test::device("fanuc-r2000ic");
  const Configuration c = configure_joints(m, VectorX::Constant(6, 0.3));
  const std::vector<Site> sites = sites_of(c);
  ASSERT_EQ(sites.size(), 6u);
  EXPECT_EQ(sites[1].name, "joint_2 rz");
  EXPECT_TRUE(sites[1].rotation);
  // Axis 1 is vertical through the base: a force turns it by its arm.
  const Vector3 p = c.pose.p_WT, f(1, 2, 3);
  Vector6 F;
  F << f, 0, 0, 0;
  EXPECT_NEAR(sites[0].g.dot(F), p.cross(f).z(), 1e-9);
}

TEST(Compare, FindsNothingWhereNothingIsMissing) {
  int alarms = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    alarms += compared(made(ideal(), "random", nothing, seed)).findings.empty() ? 0 : 1;
  EXPECT_LE(alarms, 1);  // chance: below one in 10⁴ each
}

TEST(Compare, TellsHowFarItHasCome) {
  const Measurements data = made(ideal(), "paper", nothing);
  double last = 0;
  const auto told = [&](double share) {
    EXPECT_GE(share, last);
    EXPECT_LE(share, 1);
    last = share;
  };
  compare::compare(ideal(), data, {}, {1, nullptr, told});
  EXPECT_GE(last, 0.9);
}

TEST(Compare, SaysWhatTheDeformedShapeExplains) {
  const Comparison c = compared(made(ideal(), "rich", nothing));
  ASSERT_TRUE(c.deformed_shape_fit.has_value());
  EXPECT_NEAR(c.deformed_shape_fit->amplitude(0), 1, 4 * std::sqrt(c.deformed_shape_fit->covariance(0, 0)));
  EXPECT_NEAR(c.chi2_per_dof, 1, 0.2);
}

TEST(Compare, ASpringAlongTheSlidesIsElasticThereAndAlike) {
  const Comparison c =
      compared(made(ideal(), "rich", [](int, double f, const Leg& l) { return 2e-6 * f * l.n.z() * l.n.z(); }));
  ASSERT_EQ(c.findings.size(), 1u);
  EXPECT_EQ(c.findings[0].pattern, "elastic along slides");
  EXPECT_NEAR(c.findings[0].amplitude(0), 2e-6, 4 * c.findings[0].deviation(0));
  EXPECT_TRUE(says(c.findings[0].sentence, "an elastic compliance is missing"));
  EXPECT_TRUE(says(c.findings[0].sentence, "proportional"));
  EXPECT_TRUE(says(c.findings[0].sentence, "the same at all 6 sites"));
}

TEST(Compare, AYieldingRootGrowsAsTheSquareOfTheLength) {
  const Comparison c = compared(made(ideal(), "rich", [](int, double f, const Leg& l) {
    return f * (1 - l.n.z() * l.n.z()) * l.slider * l.slider / 5e3;
  }));
  ASSERT_FALSE(c.findings.empty());
  EXPECT_EQ(c.findings[0].pattern, "elastic across slides");
  EXPECT_TRUE(says(c.findings[0].sentence, "grows as their length to the 2.0"));
}

TEST(Compare, PlayDoesNotGrowWithTheLoad) {
  const Comparison c =
      compared(made(ideal(), "rich", [](int, double f, const Leg&) { return f == 0 ? 0 : std::copysign(10e-6, f); }));
  ASSERT_EQ(c.findings.size(), 1u);
  EXPECT_EQ(c.findings[0].pattern, "step");
  EXPECT_NEAR(c.findings[0].amplitude(0), 10e-6, 4 * c.findings[0].deviation(0));
  EXPECT_TRUE(says(c.findings[0].sentence, "free travel"));
  const auto proportionality =
      std::find_if(c.contrasts.begin(), c.contrasts.end(), [](const auto& t) { return t.id == "proportionality"; });
  EXPECT_LT(proportionality->p_value, 1e-10);
}

// Play about an axis that no force at T turns: without a moment nothing tells where the tool is in it. Its readings are
// those of the model, and only where a moment closes it has the model a stiffness there.
TEST(Compare, AModelWithPlayThatNoForceClosesIsCompared) {
  for (const char* axis : {"tool.rz", "tool.rx"}) {
    const Mechanism play = edited(ideal(), {axis, "{law: clearance, gap: 0.5 mrad}", Edit::Action::set});
    const Subject subject(play);
    const Measurements data = made_by(play);
    const std::shared_ptr<const Standing> standing = subject.stand(data);
    const Matrix6 compliance = standing->compliance(0);
    EXPECT_TRUE(compliance.allFinite()) << axis;
    EXPECT_GT(compliance.trace(), 0) << axis;
    EXPECT_LT(compare::compare(play, data).chi2_per_dof, 1.3) << axis;
  }
}

TEST(Compare, ContactStiffensAsThePowerOfTwoThirds) {
  const Comparison c = compared(made(ideal(), "rich", [](int, double f, const Leg&) {
    return std::copysign(2e-6 * std::pow(std::abs(f), 2.0 / 3), f);
  }));
  ASSERT_FALSE(c.findings.empty());
  EXPECT_EQ(c.findings[0].pattern, "power");
  EXPECT_TRUE(says(c.findings[0].sentence, "as the force to the 0.6"));
}

TEST(Compare, OneLegIsNamed) {
  const Comparison c = compared(made(ideal(), "random", [](int leg, double f, const Leg& l) {
    return leg == 4 ? 0.5 * f * (1 - l.n.z() * l.n.z()) * std::pow(l.slider / 0.08, 3) * 1e-5 : 0;
  }));
  ASSERT_FALSE(c.findings.empty());
  EXPECT_EQ(c.findings[0].pattern, "elastic at leg 4");
  EXPECT_TRUE(says(c.findings[0].sentence, "at leg 4 alone"));
}

TEST(Compare, WhatGivesInOneSenseIsEven) {
  const Comparison c = compared(made(ideal(), "rich", [](int, double f, const Leg&) { return f > 0 ? 1e-6 * f : 0; }));
  ASSERT_FALSE(c.findings.empty());
  std::vector<std::string> found;
  for (const Finding& f : c.findings) found.push_back(f.pattern);
  EXPECT_NE(std::find(found.begin(), found.end(), "one-sided"), found.end());
}

TEST(Compare, FrictionDependsOnTheWay) {
  // A stop operator beside each leg, by hand: leg by leg through the cycle.
  Mechanism m = ideal();
  Measurements data = made(m, "cycle", nothing);
  const std::vector<Configuration> machines = configure_all(m, data);
  for (const PoseGroup& group : data.poses) {
    const std::array<Leg, 6> legs = legs_at(m, machines[data.readings[group.readings[0]].pose].pose);
    Matrix6 S;
    for (int k = 0; k < 6; ++k) S.col(k) = legs[static_cast<std::size_t>(k)].s;
    Vector6 held = Vector6::Zero(), before = Vector6::Zero();
    for (const std::size_t i : group.readings) {
      const Vector6 f = S.inverse() * data.readings[i].load;
      held = (held + f - before).cwiseMax(-1.5).cwiseMin(1.5);
      before = f;
      const Vector6 moved = S.transpose().inverse() * (-4e-6 * held);
      for (std::size_t k = 0; k < 3; ++k) *data.readings[i].displacement[k] += moved(static_cast<Eigen::Index>(k));
    }
  }
  const Comparison c = compared(data);
  ASSERT_FALSE(c.findings.empty());
  EXPECT_EQ(c.findings[0].pattern, "hysteresis");
  const auto hysteresis =
      std::find_if(c.contrasts.begin(), c.contrasts.end(), [](const auto& t) { return t.id == "hysteresis"; });
  EXPECT_LT(hysteresis->p_value, 1e-6);
}

TEST(Compare, TurnedSensorAxesAreNotReciprocal) {
  Measurements data = made(ideal(), "rich", nothing);
  const Matrix3 R = rotation_from_vector({0, 0.02, 0});
  for (Reading& r : data.readings) {
    const Vector3 d = R * Vector3(*r.displacement[0], *r.displacement[1], *r.displacement[2]);
    for (std::size_t k = 0; k < 3; ++k) r.displacement[k] = d(static_cast<Eigen::Index>(k));
  }
  const Comparison c = compared(data);
  ASSERT_FALSE(c.findings.empty());
  EXPECT_EQ(c.findings[0].pattern, "sensor axes");
  EXPECT_NEAR(c.findings[0].amplitude(1), 0.02, 4 * c.findings[0].deviation(1) + 4e-4);  // second order of the turn
  const auto reciprocity =
      std::find_if(c.contrasts.begin(), c.contrasts.end(), [](const auto& t) { return t.id == "reciprocity"; });
  EXPECT_LT(reciprocity->p_value, 1e-6);
}

TEST(Compare, GrossOutliersAreSetAsideByLine) {
  Measurements data = made(ideal(), "rich", nothing);
  for (std::size_t i = 0; i < data.readings.size(); ++i) data.readings[i].line = i + 2;
  *data.readings[100].displacement[1] += 40 * sigma;
  *data.readings[333].displacement[0] -= 25 * sigma;
  const Comparison c = compared(data);
  EXPECT_EQ(c.set_aside, (std::vector<std::size_t>{102, 335}));
  EXPECT_TRUE(c.findings.empty());
}

TEST(Compare, WithoutSigmaScatterComesFromTheResiduals) {
  Measurements data = made(ideal(), "random", nothing);
  for (Reading& r : data.readings) r.sigma_u.reset();
  const Comparison c = compared(data);
  EXPECT_TRUE(c.sigma_from_residuals);
  EXPECT_NEAR(c.sigma_u, sigma, 0.25 * sigma);  // tolerances do not act here; patterns take 5 % of the freedoms
}

TEST(Compare, ResultsDoNotDependOnThreads) {
  const Mechanism m = ideal();
  const Measurements data = made(m, "random", nothing);
  const Comparison a = compare::compare(m, data, {}, {1}), b = compare::compare(m, data, {}, {4});
  EXPECT_EQ(a.residual, b.residual);
  EXPECT_EQ(compare_json(a), compare_json(b));
}

/// The tool point of the arm lies on the axis of its last joint: forces there do not turn it, and moments do.
TEST(Compare, AJointThatNoLoadTurnsHasNoCurve) {
  const Mechanism arm = test::device("arm");
  Measurements data = prediction::simulate(arm, prediction::campaign("random", arm, 50, 1), {});
  const auto sites_of_curves = [&] {
    std::set<std::string> out;
    for (const ElongationCurve& curve : compare::compare(arm, data).curves) out.insert(curve.site);
    return out;
  };
  EXPECT_EQ(sites_of_curves(),
            (std::set<std::string>{"joint_1 rz", "joint_2 rz", "joint_3 rz", "joint_4 rz", "joint_5 rz"}));
  for (const VectorX& f : residual_study(arm, data).force) EXPECT_EQ(f(5), 0);
  for (Reading& r : data.readings) r.load(5) = 1;
  EXPECT_EQ(sites_of_curves().count("joint_6 rz"), 1u);
}

TEST(Compare, TheDeformedShapeUnderOtherLoadsGoesWithTheirSquare) {
  const Mechanism m = ideal();
  Measurements data = made(m, "random", nothing), half = data;
  for (Reading& r : half.readings) r.load /= 2;
  ResidualStudy whole = residual_study(m, data), less = residual_study(m, half);
  EXPECT_EQ(deformed_shape_under(whole, 0, half.readings[0].load), Vector6::Zero());
  whole.deformed_shape = deformed_shape_of(whole);
  less.deformed_shape = deformed_shape_of(less);
  double apart = 0, size = 0;
  for (std::size_t i = 0; i < half.readings.size(); ++i) {
    const Vector6 wanted = less.deformed_shape[i];
    apart += (deformed_shape_under(whole, i, half.readings[i].load) - wanted).head<3>().squaredNorm();
    size += wanted.head<3>().squaredNorm();
  }
  EXPECT_GT(size, 0);
  EXPECT_LT(apart, 0.01 * size);  // what is odd in the load: the next order, of the rotations
}

// Data that are not what they say.

std::vector<std::string> sentences(const Comparison& c) {
  std::vector<std::string> out;
  for (const RecordingMistake& mistake : c.mistakes) out.push_back(mistake.sentence);
  return out;
}

template <class Change>
std::vector<std::string> looks_like(const Change& change, const std::string& plan = "rich") {
  Measurements data = made(ideal(), plan, nothing);
  for (Reading& r : data.readings) {
    Vector3 u(*r.displacement[0], *r.displacement[1], *r.displacement[2]);
    change(r.load, u);
    for (std::size_t k = 0; k < 3; ++k) r.displacement[k] = u(static_cast<Eigen::Index>(k));
    r.sigma_u = 2e-6;
  }
  return sentences(compared(data));
}

TEST(Plausibility, GoodDataLookLikeNothing) {
  EXPECT_TRUE(looks_like([](Vector6&, Vector3&) {}).empty());
}

TEST(Plausibility, MistakesOfRecordingAreNamed) {
  const auto first = [](const std::vector<std::string>& all) {
    return all.empty() ? std::string("nothing") : all.front();
  };
  EXPECT_TRUE(says(first(looks_like([](Vector6&, Vector3& u) { u = -u; })), "opposite sign"));
  EXPECT_TRUE(
      says(first(looks_like([](Vector6&, Vector3& u) { std::swap(u.x(), u.y()); })), "recorded x = y, y = x, z = z"));
  EXPECT_TRUE(says(first(looks_like([](Vector6& F, Vector3&) { F /= 9.80665; })), "kgf"));
  EXPECT_TRUE(says(first(looks_like([](Vector6&, Vector3& u) { u /= 1e3; })), "displacements in m"));
  EXPECT_TRUE(says(first(looks_like([](Vector6&, Vector3& u) { u *= 1e3; })), "µm"));
  const auto elsewhere = [](Vector6& F, Vector3&) {
    F.tail<3>() += Vector3(-0.02, 0.01, -0.08).cross(Vector3(F.head<3>()));
  };
  EXPECT_TRUE(says(first(looks_like(elsewhere)), "T + (20, -10, "));
}

TEST(Plausibility, ReplicatesThatContradictEachOtherAreNamedByLine) {
  Measurements data = made(ideal(), "rich", nothing);
  for (std::size_t i = 0; i < data.readings.size(); ++i) data.readings[i].line = i + 2;
  *data.readings[5].displacement[0] += 1e-4;
  const std::vector<std::string> all = sentences(compared(data));
  ASSERT_FALSE(all.empty());
  EXPECT_TRUE(says(all.front(), "lines 7 and 367 contradict each other"));
  EXPECT_TRUE(says(all.front(), "ux_mm"));
}

// The third reading and its repetition differ by 4 % of what it reads, which is 14 standard deviations of the noise and
// 1.4 of what two loads do that are known to 2 %.
TEST(Plausibility, ErrorsOfLoadsAreNoContradiction) {
  Mechanism m = ideal();
  Measurements data = made(m, "rich", nothing);
  Reading &first = data.readings[2], &again = data.readings[362];
  again.displacement = first.displacement;
  *again.displacement[0] *= 1.04;
  first.sigma_u = again.sigma_u = 0.04 * std::abs(*first.displacement[0]) / (14 * std::sqrt(2));
  const auto contradict = [&] {
    const std::vector<std::string> all = sentences(compare::compare(m, data));
    return !all.empty() && says(all.front(), "contradict each other");
  };
  m.tolerances.load = 0;
  EXPECT_TRUE(contradict());
  m.tolerances.load = 0.02;
  EXPECT_FALSE(contradict());
}

}  // namespace
}  // namespace deflect
