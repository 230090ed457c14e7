// Energies and stiffness in the deformed shape, on every built-in device: the energy stored is the work of the load,
// ∫ F · du = F · u(1) − ∫ u(λ) · F dλ along the loads λ F, and stiffness and compliance are each other's inverse and
// the slope of the displacement. In linear geometry: the energy of machines that are strained before the load.
#include <gtest/gtest.h>

#include <boost/math/quadrature/gauss.hpp>

#include "analytic/model.h"
#include "msa/frame/mechanism/msa.h"
#include "tests/support/devices.h"
#include "tests/support/effects.h"
#include "tests/support/mechanisms.h"
#include "validation/effects/with_effect.h"

namespace deflect {
namespace {

double total(const std::vector<std::pair<std::string, double>>& energies) {
  double sum = 0;
  for (const auto& [part, energy] : energies) sum += energy;
  return sum;
}

Vector6 mixed() { return (Vector6() << 30, -25, 31, 0.5, -1, 0.75).finished(); }

/// `at`: displacement under a load.
template <class At>
double work(const Vector6& F, const At& at) {
  // λ = s³: a ball's displacement, ∝ λ^⅔, is smooth over s.
  const auto along = [&](double s) { return 3 * s * s * at(s * s * s * F).dot(F); };
  return at(F).dot(F) - boost::math::quadrature::gauss<double, 20>::integrate(along, 0.0, 1.0);
}

/// By which share energy and work differ.
double off(const analytic::AnalyticModel& model, const Vector6& F) {
  const auto solved = [&](const Vector6& f) { return model.solve(f, Geometry::finite); };
  const double stored = total(model.energies(solved(F))) - total(model.energies(solved(Vector6::Zero())));
  return std::abs(stored / work(F, [&](const Vector6& f) { return Vector6(solved(f).displacement); }) - 1);
}

/// A member's law leaves out the third order of its bending, in force and energy differently: a share that falls with
/// the square of the load, sixteenfold from F to F/4. A contact whose force passes zero has a kink there, which the
/// quadrature knows to 1e-7.
void expect_work_of_the_load(const Mechanism& m) {
  const analytic::AnalyticModel model(configure(m, home_pose(m)));
  const double whole = off(model, mixed()), quarter = off(model, mixed() / 4);
  EXPECT_LE(whole, 1e-4);
  EXPECT_LE(quarter, whole / 12 + 1e-7);
}

class DeformedEnergy : public ::testing::TestWithParam<std::string> {
 protected:
  DeformedEnergy() : machine(test::device(GetParam())) {}

  Mechanism machine;
};

TEST_P(DeformedEnergy, IsTheWorkOfTheLoad) { expect_work_of_the_load(machine); }

/// With a base and a tool that are rigid, and with a tool that yields behind the platform.
TEST_P(DeformedEnergy, StiffnessIsTheInverseOfTheSlope) {
  for (const char* effect : {"", "tool_compliance"}) {
    Mechanism m = machine;
    if (*effect)
      m = effects::with_effect(m, {{&test::effect(effect), {}}, effects::start_values(test::effect(effect))});
    const Configuration placed = configure(m, home_pose(m));
    const analytic::AnalyticModel model(placed);
    const analytic::AnalyticSolution s = model.solve(mixed(), Geometry::finite);
    const Matrix6 K = model.stiffness(s), C = model.compliance(s);
    Vector6 lengths = Vector6::Ones();
    lengths.tail<3>().setConstant(placed.size);
    const Matrix6 CK = lengths.asDiagonal() * (C * K) * lengths.cwiseInverse().asDiagonal();
    const Vector6 eigen =
        Eigen::SelfAdjointEigenSolver<Matrix6>(lengths.asDiagonal() * C * lengths.asDiagonal()).eigenvalues();
    EXPECT_LE((CK - Matrix6::Identity()).norm(), 1e-12 * eigen(5) / eigen(0)) << effect;
  }
}

INSTANTIATE_TEST_SUITE_P(Devices, DeformedEnergy, ::testing::ValuesIn(test::device_names()), [](const auto& named) {
  std::string name = named.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

/// A joint that turns far about all its axes, held by a spring about each or by one stiffness of all six directions.
TEST(DeformedEnergyOf, AJointThatTurnsFarAboutAllAxesIsTheWorkOfTheLoad) {
  const auto spring = [](const char* k) { return std::string("{law: linear, stiffness: ") + k + "}"; };
  const Mechanism arm = test::device("arm"),
                  springs = test::with(test::with(test::with(arm, "leg.joint_1.rz", spring("200 Nm/rad")),
                                                  "leg.joint_1.rx", spring("150 Nm/rad")),
                                       "leg.joint_1.ry", spring("300 Nm/rad")),
                  coupled = test::with(arm, "leg.joint_1", R"({joint: motor, stiffness: {units: N-mm, rows: [
      [2e3, 0, 0, 0, 3e3, 0], [0, 2e3, 0, -2e3, 0, 0], [0, 0, 4e3, 0, 0, 0],
      [0, -2e3, 0, 1.5e5, 0, 0], [3e3, 0, 0, 0, 3e5, 2e4], [0, 0, 0, 0, 2e4, 2e5]]}})");
  for (const Mechanism& m : {springs, coupled}) {
    const analytic::AnalyticModel model(configure(m, home_pose(m)));
    EXPECT_GT(model.solve(mixed(), Geometry::finite).displacement.tail<3>().norm(), 0.05) << "the test shows nothing";
    expect_work_of_the_load(m);
  }
}

/// Of machines with preloaded contacts whose legs do not fit, both theories tell what the load adds to the strained
/// machine.
TEST(StrainedMachine, HasTheEnergyThatTheLoadAdds) {
  double strained = 0;  // how much of the energy is there before the load, at most
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Configuration c = test::random_mechanism(seed, true);
    std::mt19937 random(seed);
    for (PlacedLeg& leg : c.legs) leg.misfit << test::random_vector(random, 2e-5), test::random_vector(random, 1e-4);
    const Vector6 F = test::random_wrench(random);
    const analytic::AnalyticModel a(c);
    const double before = total(a.energies(a.assembled())), after = total(a.energies(a.solve(F)));
    strained = std::max(strained, std::abs(before / after));
    EXPECT_NEAR(total(frame::MsaModel(c).solve(F).energies), after - before, 1e-8 * std::max(before, after)) << seed;
  }
  EXPECT_GT(strained, 1e-3) << "the test shows nothing";
}

}  // namespace
}  // namespace deflect
