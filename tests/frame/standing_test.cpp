// The proof from connections alone that a structure can stand.
#include "msa/frame/structure/standing.h"

#include <gtest/gtest.h>

#include <limits>

namespace deflect::frame {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();
constexpr BeamRigidity rod{1e6, 100, 100, 80, none, none};

/// Three nodes at right angles, joined by two beams.
Model corner() {
  Model m;
  m.add_node("a", {1, 0, 0});
  m.add_node("b", {0, 0, 0});
  m.add_node("c", {0, 1, 0});
  m.add_beam(0, 1, Matrix3::Identity(), rod, "", "");
  m.add_beam(1, 2, Matrix3::Identity(), rod, "", "");
  return m;
}

void hold(Model& m, int node, std::initializer_list<int> freedoms) {
  for (const int i : freedoms) m.constraints.push_back({{{6 * node + i, 1}}, 0, ""});
}

TEST(Standing, OneClampHoldsABody) {
  Model m = corner();
  EXPECT_EQ(not_proved_standing(m), "the body of node 'a' is not held by supports of its own");
  m.fix(2, "wall");
  EXPECT_EQ(not_proved_standing(m), "");
}

TEST(Standing, SixSimpleSupportsHoldItWhereTheyAreIndependent) {
  Model m = corner();
  hold(m, 0, {1, 2}), hold(m, 1, {0, 1, 2}), hold(m, 2, {2});
  EXPECT_EQ(not_proved_standing(m), "");
  m = corner();  // z at a and b only: it turns about the x axis
  hold(m, 0, {1, 2}), hold(m, 1, {0, 1, 2}), hold(m, 2, {0, 0, 1});
  EXPECT_NE(not_proved_standing(m), "");
}

// A body that turns about b, where its displacements are held, moves a across by its rotation times 1 m, whatever
// turns: to couple these two holds nothing, to couple them the other way round holds the rotation.
TEST(Standing, ALeverThatFollowsTheBodyDoesNotHoldIt) {
  for (const double sign : {1.0, -1.0}) {
    Model m = corner();
    hold(m, 1, {0, 1, 2, 3, 4});
    m.constraints.push_back({{{1, 1}, {6 + 5, -sign}}, 0, "lever"});
    EXPECT_EQ(not_proved_standing(m).empty(), sign < 0) << sign;
  }
}

TEST(Standing, EveryBodyNeedsItsOwn) {
  Model m = corner();
  m.fix(0, "wall");
  m.add_node("d", {0, 0, 1});
  EXPECT_EQ(not_proved_standing(m), "the body of node 'd' is not held by supports of its own");
  Model joined = m;
  joined.join(1, 3, "weld");
  EXPECT_EQ(not_proved_standing(joined), "");
  std::array<ConnectionFreedom, 6> hinge;
  hinge[4].rigid = false;
  m.connect(1, 3, m.nodes[3].position, Matrix3::Identity(), hinge, "hinge", "");
  EXPECT_NE(not_proved_standing(m), "");
}

TEST(Standing, ABeamWithoutTorsionalStiffnessJoinsNothing) {
  Model m = corner();
  m.fix(0, "wall");
  m.beams[1].rigidity.GJ = 0;
  EXPECT_NE(not_proved_standing(m), "");
}

}  // namespace
}  // namespace deflect::frame
