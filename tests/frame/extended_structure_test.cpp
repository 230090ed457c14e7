// Stiffnesses so far apart that doubles keep no digit of the stiff part's strain, against closed forms.
#include "msa/frame/structure/extended_structure.h"

#include <gtest/gtest.h>

#include "msa/frame/structure/solver.h"

namespace deflect::frame {
namespace {

constexpr double length = 0.7, EI = 3e3, GA = 2e5;
const Vector3 away(41.3, -17.9, 8.1);  // no coordinate is a round number

Matrix3 some_axes() { return rotation_from_rpy(0.3, -0.4, 0.5); }

/// A beam along its local x on a hinge about its local z, with the stiffness k.
Model beam_on_hinge(double k) {
  Model m;
  const Matrix3 R = some_axes();
  const int ground = m.add_node("ground", away), root = m.add_node("root", away);
  const int tip = m.add_node("tip", away + length * R.col(0));
  m.fix(ground, "ground");
  std::array<ConnectionFreedom, 6> hinge;
  hinge[5] = {false, {LinearSpring{k}}};
  m.connect(ground, root, away, R, hinge, "hinge", "hinge");
  m.beams.push_back({root, tip, R, length, {1e9, EI, EI, EI, GA, GA}, "beam", "beam", -1, 0});
  return m;
}

VectorX tip_force(const Model& m, const Vector3& f) {
  VectorX load = VectorX::Zero(m.dofs());
  load.segment<3>(12) = f;
  return load;
}

// The tip goes by F L²/k with the hinge and by F L³/3EI + F L/GA with the beam, however small that is beside the first.
TEST(ExtendedStructure, KeepsTheStrainOfAStiffPartOnASoftOne) {
  for (const double k : {1e3, 1e-6, 1e-12}) {
    Model m = beam_on_hinge(k);
    const Elimination e = eliminate(m);
    const VectorX none = constraint_values(m);
    const double F = 2;
    const auto u = ExtendedStructure(m, e, VectorX::Constant(1, k)).solve(tip_force(m, F * some_axes().col(1)), none);
    ASSERT_TRUE(u);
    const Vector12 ends = turned(some_axes().transpose(), end_displacements(m.beams[0], *u));
    EXPECT_NEAR(ends(7), F * length * length * length / (3 * EI) + F * length / GA, 1e-13 * ends(7)) << k;
    const double turn = some_axes().col(2).dot(Vector3(u->segment<3>(9).cast<double>()));
    EXPECT_NEAR(turn, F * length / k, 1e-13 * turn) << k;
  }
}

// A hinge without stiffness: along the beam a force finds equilibrium, and the free motion stays where it is; across it
// there is none.
TEST(ExtendedStructure, HoldsWhatNothingResistsUnlessTheLoadDrivesIt) {
  const Model m = beam_on_hinge(1);
  const Elimination e = eliminate(m);
  const ExtendedStructure free(m, e, VectorX::Zero(1));
  const auto u = free.solve(tip_force(m, 5 * some_axes().col(0)), constraint_values(m));
  ASSERT_TRUE(u);
  const Vector12 ends = turned(some_axes().transpose(), end_displacements(m.beams[0], *u));
  EXPECT_NEAR(ends(6), 5 * length / 1e9, 1e-12 * ends(6));
  EXPECT_FALSE(free.solve(tip_force(m, some_axes().col(1)), constraint_values(m)));
}

}  // namespace
}  // namespace deflect::frame
