// The joint "parallelogram" against a true one: two rigid bars on hinges, side by side.
#include <gtest/gtest.h>

#include "msa/frame/mechanism/msa.h"
#include "msa/mechanism/place.h"
#include "tests/support/chains.h"

namespace deflect {
namespace {

/// A motor, an arm, bars whose far end may swing against a spring, and a member behind them.
std::string arm(const std::string& bars) {
  return R"(name: arm
kinematics: {family: chains}
materials: {steel: {E: 210 GPa, nu: 0.3}}
sections: {rod: {shape: round, diameter: 20 mm}}
leg:
  motor: {joint: motor, axis: [0, 1, 0.2], rz: {law: linear, stiffness: 1e8 Nmm/rad}}
  upper: {member: rod, material: steel, along: [300 mm, 50 mm, 0 mm]}
)" + bars +
         R"(
  lower: {member: rod, material: steel, along: [0 mm, 100 mm, 250 mm]}
)";
}

// A spring k along the path s = r φ of the bars' ends stores what k r² about one hinge does.
TEST(Parallelogram, IsTwoBarsOnHinges) {
  const double r = std::hypot(0.2, 0.05), k = 4e5;
  for (const double phi : {0.0, 0.4, -1.2, 2.5}) {
    const Mechanism joint = parse_mechanism(
        arm(fmt::format(
            "  bars: {{joint: parallelogram, axis: [0.3, 0, 1], bar: [200 mm, 50 mm, 20 mm], home: {{tx: {} "
            "m}}, tx: {{law: linear, stiffness: {} N/m}}}}",
            r * phi, k)),
        "joint");
    // The hinges turn about the same axis; offsets are in the axes of the chain, which the hinge's are turned from.
    const Matrix3 axes = axes_along_z(Vector3(0.3, 0, 1), Vector3::UnitX());
    const Vector3 bar = 1e3 * (axes * Vector3(0.2, 0.05, 0.02));
    const std::string hinge = "joint: revolute, axis: [0.3, 0, 1]";
    const Mechanism bars = parse_mechanism(arm(fmt::format(R"(  bars:
    mounts:
      - leg:
          first: {{{0}, home: {{rz: {1} rad}}, rz: {{law: linear, stiffness: {2} Nm/rad}}}}
          bar: {{offset: [{3} mm, {4} mm, {5} mm]}}
          second: {{{0}, home: {{rz: {6} rad}}}}
      - base: {{shift: [10 mm, 80 mm, 5 mm]}}
        platform: {{shift: [10 mm, 80 mm, 5 mm]}}
        leg:
          first: {{{0}, home: {{rz: {1} rad}}}}
          bar: {{offset: [{3} mm, {4} mm, {5} mm]}}
          second: {{{0}, home: {{rz: {6} rad}}}})",
                                                           hinge, phi, k * r * r, bar.x(), bar.y(), bar.z(), -phi)),
                                           "bars");
    for (const double q : {0.0, 0.7}) {
      const VectorX angle = VectorX::Constant(1, q);
      const Configuration a = configure_joints(joint, angle), b = configure_joints(bars, angle);
      EXPECT_LE(test::distance(a.pose, b.pose), 1e-12) << phi;
      frame::MsaModel one(a), two(b);
      EXPECT_LE(test::compliance_difference(test::compliance_by(two), test::compliance_by(one), a.size), 1e-11) << phi;
    }
  }
}

}  // namespace
}  // namespace deflect
