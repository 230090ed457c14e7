// The closed-form theory against itself by second routes: inverses, eliminations, derivatives.
#include <gtest/gtest.h>

#include <random>

#include "analytic/member.h"
#include "analytic/model.h"
#include "msa/base/stiffness_checks.h"
#include "tests/support/devices.h"
#include "tests/support/laws.h"

namespace deflect::analytic {
namespace {

using test::device;

PlacedMember member() {
  PlacedMember m;
  m.p_W_start = Vector3(0.1, 0, 0);
  m.p_W_end = Vector3(0.1, 0.02, 0.07);
  m.R_WM = axes_along_x(m.p_W_end - m.p_W_start, Vector3::UnitX());
  m.section = properties({RectangleSection{0.006, 0.009}}, 0.3);
  m.E = 210e9;
  m.G = 80e9;
  return m;
}

TEST(Member, ComplianceIsTheInverseOfTheTipStiffnessThatThePaperMeans) {
  const PlacedMember m = member();
  const double L = m.length(), EIy = m.E * m.section.Iy, EIz = m.E * m.section.Iz;
  Matrix6 K = Matrix6::Zero();  // (35) with L² in (2,6) and 4EI/L in (5,5)
  K.diagonal() << m.E * m.section.A / L, 12 * EIz / pow(L, 3), 12 * EIy / pow(L, 3), m.G * m.section.J / L, 4 * EIy / L,
      4 * EIz / L;
  K(1, 5) = K(5, 1) = -6 * EIz / (L * L);
  K(2, 4) = K(4, 2) = 6 * EIy / (L * L);
  EXPECT_LE((tip_compliance(m) * K - Matrix6::Identity()).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Member, AsPrintedDiffersWhereThePaperErrs) {
  const PlacedMember m = member();
  const Matrix6 K = tip_compliance_guideway_as_printed(m).inverse();
  const double L = m.length();
  EXPECT_NEAR(K(1, 5) / (-6e-3 * m.E * m.section.Iz / pow(L, 3)), 1, 1e-12);  // N/mm read as N
  EXPECT_NEAR(K(4, 4) / (6 * m.E * m.section.Iy / L), 1, 1e-12);
  EXPECT_GT(std::abs(K(1, 5) - K(5, 1)), 0.1 * std::abs(K(1, 5)));
  // What the paper prints without error is left: (35), and (41) with the link along z.
  const double E = m.E, EIy = E * m.section.Iy, EIz = E * m.section.Iz;
  EXPECT_NEAR(K(5, 1) / (-6 * EIz / (L * L)), 1, 1e-12);
  EXPECT_NEAR(K(2, 4) / (6 * EIy / (L * L)), 1, 1e-12);
  EXPECT_NEAR(K(4, 2) / (6 * EIy / (L * L)), 1, 1e-12);
  EXPECT_NEAR(K(2, 2) / (12 * EIy / pow(L, 3)), 1, 1e-12);
  // Inverted twice; its entries are of very different size (condition 1e6).
  const Matrix6 link = tip_compliance_link_as_printed(m).inverse();
  EXPECT_NEAR(link(0, 4) / (-6 * EIy / (L * L)), 1, 1e-9);
  EXPECT_NEAR(link(4, 0) / (-6 * EIy / (L * L)), 1, 1e-9);
  EXPECT_NEAR(link(1, 3) / (6 * EIy / (L * L)), 1, 1e-9);
  EXPECT_NEAR(link(3, 1) / (6 * EIy / (L * L)), 1, 1e-9);
  EXPECT_NEAR(link(2, 2) / (1e6 * m.section.A / L), 1, 1e-9);   // A/L of (41) in mm, read as N/mm
  EXPECT_NEAR(link(3, 3) / (4e6 * m.section.Iy / L), 1, 1e-9);  // 4 I/L of (41) in mm, read as Nmm
  EXPECT_NEAR(link(4, 4) / (4 * EIy / L), 1, 1e-9);
  PlacedMember vertical = m;
  vertical.p_W_end = vertical.p_W_start + Vector3(0, 0, 0.1);
  EXPECT_THROW(link_axes_as_printed(vertical), ModelError);
}

/// A pulley of radius r feels k r² of the belt.
TEST(Belt, TurnsAPulley) {
  EXPECT_DOUBLE_EQ(belt_stiffness(BeltLaw{2e6, 0.01, 0.1, 0.3, 0.02}),
                   0.02 * 0.02 * belt_stiffness(BeltLaw{2e6, 0.01, 0.1, 0.3}));
}

class EveryLaw : public ::testing::TestWithParam<test::LawSite> {};

TEST_P(EveryLaw, ComplianceIsTheDerivativeAndEnergyTheWorkStored) {
  const Law law = test::resolved_law(GetParam());
  if (jumps(law)) GTEST_SKIP() << "takes its phases from steps.h";
  EXPECT_EQ(deflection(law, 0), 0);
  for (const double f : {-200.0, -3.0, 0.02, 7.0, 50.0}) {
    const double h = 1e-5 * std::abs(f);
    EXPECT_NEAR((deflection(law, f + h) - deflection(law, f - h)) / (2 * h), compliance(law, f),
                1e-8 * compliance(law, f));
    // dU = f dδ
    EXPECT_NEAR((stored_energy(law, f + h) - stored_energy(law, f - h)) / (2 * h), f * compliance(law, f),
                1e-8 * std::abs(f) * compliance(law, f));
    EXPECT_DOUBLE_EQ(deflection(law, -f), -deflection(law, f));
  }
}

// The search for balance asks for it. Beside a preload P a force is known to the rounding of f + P.
TEST_P(EveryLaw, AsAScalarLawIsItsInverse) {
  const Law law = test::resolved_law(GetParam());
  if (jumps(law) || is_linear(law)) GTEST_SKIP() << "has no inverse, or a plain one";
  for (const double P : {0.0, 5.0}) {
    const ScalarLaw inverse = scalar_law(law, P, 0, 0);
    for (const double f : {-200.0, -3.0, 0.02, 7.0, 50.0}) {
      const double d = deflection(law, f + P) - at_rest(law, P);
      EXPECT_NEAR(inverse.force(d), f, 1e-12 * (std::abs(f) + P)) << P;
      EXPECT_NEAR(inverse.tangent(d) * compliance(law, f + P), 1, 1e-11) << f << " " << P;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Table, EveryLaw, ::testing::ValuesIn(test::law_sites()),
                         [](const auto& site) { return test::name_of(site.param); });

TEST(Laws, UniversalJointOfTheDeviceIs39kNPerMmInSeriesAnd1850AsPrinted) {
  const Material steel{210e9, 0.3, {}};
  const std::vector<Law> joint = {HertzLineLaw{"", 0.0015, 0.01, steel}, PinBendingLaw{"", 0.003, 0.01, steel}};
  EXPECT_NEAR(1e-6 / compliance(joint, 1), 39.2, 0.05);
  EXPECT_NEAR(1e-6 / compliance(joint, 1, {Erratum::ujoint_parallel}), 1852, 1);
}

TEST(Laws, PowerOfTwoThirdsIsHertz) {
  const Law hertz = HertzPointLaw{"", 0.004, {210e9, 0.3, {}}};
  const Law power = PowerLaw{deflection(hertz, 5), 5, 2.0 / 3};
  for (const double f : {-40.0, 1e-3, 2.0, 300.0}) {
    EXPECT_NEAR(deflection(power, f) / deflection(hertz, f), 1, 1e-14);
    EXPECT_NEAR(compliance(power, f) / compliance(hertz, f), 1, 1e-14);
    EXPECT_NEAR(stored_energy(power, f) / stored_energy(hertz, f), 1, 1e-14);
  }
  EXPECT_TRUE(is_linear(PowerLaw{1e-6, 1, 1}));
  EXPECT_NEAR(deflection(Law(PowerLaw{1e-6, 2, 1}), 10), 5e-6, 1e-20);
}

TEST(Laws, HardeningKeepsItsCubicAtAnySize) {
  const HardeningLaw law{5e5, 1e-4};
  for (const double f : {1e-9, 1e-3, 1.0, 50.0, 1e4, 1e9}) {
    const double d = hardening_deflection(law, f), x = d / law.reference;
    EXPECT_NEAR(law.stiffness * d * (1 + x * x) / f, 1, 1e-14) << f;
  }
}

TEST(Laws, CableHasTheEAOfItsMaterialOrItsOwn) {
  const Law by_material = CableLaw{"", 1e-6, 0.08, {150e9, 0.3, {}}}, own = CableLaw{"", 0, 0.08, {}, 150e3};
  EXPECT_DOUBLE_EQ(compliance(own, 1), compliance(by_material, 1));
}

TEST(Laws, ContactAsPrintedIsHalfAsStiff) {
  const Material steel{210e9, 0.3, {}};
  EXPECT_DOUBLE_EQ(effective_modulus(steel, {Erratum::contact_modulus}), effective_modulus(steel) / 2);
  EXPECT_NEAR(effective_modulus(steel), 210e9 / 0.91, 1e-3);
}

class EveryPose : public ::testing::Test {
 protected:
  Mechanism m = device("haptic-6psu-ideal-joints");
};

// K_c = C⁻¹ − C⁻¹ J_q (J_qᵀ C⁻¹ J_q)⁻¹ J_qᵀ C⁻¹, the other way to release passive joints.
TEST_F(EveryPose, ReleaseOfPassiveJointsAgreesWithTheFormulaInStiffness) {
  for (const Pose& pose : test::random_poses(m, 20)) {
    const AnalyticModel model(configure(m, pose));
    const AnalyticSolution s = model.solve(Vector6::Unit(0) * 50);
    for (std::size_t leg = 0; leg < 6; ++leg) {
      const Chain& c = model.chains()[leg];
      ASSERT_EQ(c.J_q.cols(), 5);
      const Matrix6 K = c.C.inverse();
      const Matrix6 released = K - K * c.J_q * (c.J_q.transpose() * K * c.J_q).inverse() * c.J_q.transpose() * K;
      const Matrix6 K_c = model.leg_stiffness(leg, s);
      // The formula subtracts nearly equal matrices: it loses what K is larger than K_c by.
      EXPECT_LE((K_c - released).cwiseAbs().maxCoeff(), 1e-11 * K.cwiseAbs().maxCoeff());
    }
  }
}

// The leg of this device is a two-force member: statics alone gives its stiffness.
TEST_F(EveryPose, LegIsATwoForceMember) {
  for (const Pose& pose : test::random_poses(m, 20)) {
    const AnalyticModel model(configure(m, pose));
    const AnalyticSolution s = model.solve(Vector6::Unit(1) * 50);
    Matrix6 K = Matrix6::Zero();
    for (int leg = 1; leg <= 6; ++leg) {
      const SixPsuLeg g = leg_at(test::six_psu(m), leg, pose);
      const Vector3 n = (g.p_WC - g.p_WB).normalized();
      const double I = pi * std::pow(0.008, 4) / 64, A = pi * 16e-6, E = 210e9, L = g.slider;
      const double bending = (1 - n.z() * n.z()) * L * L * L / (3 * E * I), axial = n.z() * n.z() * L / (E * A);
      Vector6 line;
      line << n, (g.p_WC - pose.p_WT).cross(n);
      K += line * line.transpose() / (bending + axial + 0.1255 / (E * pi * 9e-6));
    }
    EXPECT_LE((model.stiffness(s) - K).norm(), 1e-12 * K.norm());
    EXPECT_LE((s.displacement - K.inverse() * Vector6::Unit(1) * 50).norm(), 1e-12 * s.displacement.norm());
  }
}

TEST_F(EveryPose, LegWrenchesBalanceTheLoad) {
  std::mt19937 random(3);
  const Mechanism contact = device("haptic-6psu");
  for (const Pose& pose : test::random_poses(m, 20)) {
    const Vector6 F = test::random_wrench(random);
    const AnalyticSolution s = AnalyticModel(configure(contact, pose)).solve(F);
    ASSERT_TRUE(s.converged);
    Vector6 sum = Vector6::Zero();
    for (const Vector6& w : s.leg_wrenches) sum += w;
    EXPECT_LE((sum - F).norm(), 1e-12 * F.norm());
  }
}

TEST_F(EveryPose, EnergyIsHalfTheWorkOfALinearDeviceAndLessOfOneWithContacts) {
  const Vector6 F = Vector6::Unit(0) * 50;
  const auto stored_over_work = [&](const Mechanism& device) {
    const AnalyticModel model(configure(device, test::home(device)));
    const AnalyticSolution s = model.solve(F);
    double sum = 0;
    for (const auto& [part, energy] : model.energies(s)) sum += energy;
    return sum / F.dot(s.displacement);
  };
  EXPECT_NEAR(stored_over_work(m), 0.5, 1e-13);
  const double contact = stored_over_work(device("haptic-6psu"));
  EXPECT_LT(contact, 0.5);  // between 0.4, all Hertz, and 0.5
  EXPECT_GT(contact, 0.49);
}

TEST_F(EveryPose, TangentStiffnessIsTheDerivativeOfTheLoad) {
  const Mechanism contact = device("haptic-6psu");
  const AnalyticModel model(configure(contact, test::random_poses(m, 1).front()));
  std::mt19937 random(5);
  const Vector6 F = test::random_wrench(random);
  const Matrix6 C = model.stiffness(model.solve(F)).inverse();
  for (int i = 0; i < 6; ++i) {
    const double h = i < 3 ? 1e-3 : 1e-5;
    const Vector6 dF = Vector6::Unit(i) * h;
    const Vector6 slope = (model.solve(F + dF).displacement - model.solve(F - dF).displacement) / (2 * h);
    EXPECT_LE((slope - C.col(i)).norm(), 1e-6 * C.col(i).norm()) << i;
  }
}

// A published script eliminates the passive joints as K_c = C⁻¹ − C⁻¹J_q(J_qᵀC⁻¹J_q)⁻¹J_qᵀ and another as
// (C + J_qJ_qᵀ)⁻¹: both must be caught.
TEST_F(EveryPose, WrongEliminationsAreRejectedByTheChecks) {
  const AnalyticModel model(configure(m, test::random_poses(m, 1).front()));
  const Chain& c = model.chains()[2];
  const Matrix6 K = c.C.inverse();
  const Matrix6 forgotten = K - K * c.J_q * (c.J_q.transpose() * K * c.J_q).inverse() * c.J_q.transpose();
  EXPECT_FALSE(check_stiffness(forgotten, {{"leg 3", forgotten, c.J_q}}).all());
  const Matrix6 mixed = (c.C + c.J_q * c.J_q.transpose()).inverse();
  const StiffnessChecks checks = check_stiffness(mixed, {{"leg 3", mixed, c.J_q}});
  EXPECT_TRUE(checks.symmetric && checks.positive);
  EXPECT_FALSE(checks.passive_joints_free);
  const Matrix6 locked = K;
  EXPECT_FALSE(check_stiffness(locked, {{"leg 3", locked, c.J_q}}).passive_joints_free);
}

TEST(Refusal, ARigidChainIsNamed) {
  Mechanism m = device("haptic-6psu-ideal-joints");
  std::erase_if(m.leg, [](const auto& part) { return std::holds_alternative<Member>(part.second); });
  try {
    const AnalyticModel model(configure(m, test::home(m)));
    model.stiffness(model.solve(Vector6::Unit(0)));
    FAIL();
  } catch (const ModelError& e) {
    EXPECT_NE(std::string(e.what()).find("leg 1: infinite stiffness"), std::string::npos) << e.what();
  }
}

TEST(Errata, NamesAreReadAndMisreadOnesExplained) {
  EXPECT_TRUE(parse_errata("").empty());
  EXPECT_TRUE(parse_errata("none").empty());
  EXPECT_EQ(parse_errata("all").size(), errata().size());
  EXPECT_EQ(parse_errata("tcp-transfer,link-frame,passive-joints"),
            (std::set<Erratum>{Erratum::tcp_transfer, Erratum::link_frame, Erratum::passive_joints}));
  EXPECT_EQ(parse_errata("passive-joints,ujoint-parallel"),
            (std::set<Erratum>{Erratum::passive_joints, Erratum::ujoint_parallel}));
  try {
    parse_errata("passive-joint");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean 'passive-joints'?"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace deflect::analytic
