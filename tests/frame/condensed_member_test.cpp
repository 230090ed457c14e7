// A member of several elements and what stays of it from pose to pose.
#include "msa/frame/elements/condensed_member.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace deflect::frame {
namespace {

constexpr double none = std::numeric_limits<double>::infinity();
const BeamRigidity slender{6e6, 30, 20, 25, none, none};

double apart(const Matrix12& a, const Matrix12& b) { return (a - b).norm() / b.norm(); }

// A beam of two nodes is exact for loads at them.
TEST(CondensedMember, OfAnyElementsIsOneBeam) {
  const std::vector<std::vector<double>> divisions = {
      {0, 1}, {0, 0.25, 0.5, 0.75, 1}, {0, 0.6, 0.7, 1}, {0, 0.2, 0.4, 0.6, 0.8, 1}};
  for (const auto& at : divisions) {
    CondensedMember member(at);
    ASSERT_TRUE(member.set(slender, 0.3));
    EXPECT_LT(apart(member.stiffness(), local_stiffness(slender, 0.3)), 1e-12);
    double shortest = 1;
    for (std::size_t i = 1; i < at.size(); ++i) shortest = std::min(shortest, at[i] - at[i - 1]);
    EXPECT_DOUBLE_EQ(member.stiffest(), slender.EA / (shortest * 0.3));
  }
}

// Shear makes the inner nodes of a beam move otherwise, not less exactly.
TEST(CondensedMember, YieldsToShear) {
  const BeamRigidity thick{6e6, 30, 20, 25, 2e6, 3e6};
  CondensedMember member({0, 0.3, 0.6, 1});
  ASSERT_TRUE(member.set(thick, 0.02));
  EXPECT_LT(apart(member.stiffness(), local_stiffness(thick, 0.02)), 1e-12);
}

TEST(CondensedMember, IsRenewedWithLengthAndRigidity) {
  CondensedMember member({0, 0.5, 1});
  ASSERT_TRUE(member.set(slender, 0.3));
  const Matrix12 first = member.stiffness();
  const double stiffest = member.stiffest();
  EXPECT_DOUBLE_EQ(stiffest, slender.EA / 0.15);
  ASSERT_TRUE(member.set(slender, 0.3 * (1 + 4e-16)));
  EXPECT_EQ(member.stiffness(), first) << "the rounding of a length";
  ASSERT_TRUE(member.set(slender, 0.3 * (1 + 1e-9)));
  EXPECT_NE(member.stiffness(), first);
  BeamRigidity softer = slender;
  softer.EIz *= 0.5;
  ASSERT_TRUE(member.set(softer, 0.3));
  EXPECT_LT(apart(member.stiffness(), local_stiffness(softer, 0.3)), 1e-12);
  ASSERT_TRUE(member.set(slender, 0.3));
  EXPECT_EQ(member.stiffness(), first);
  EXPECT_EQ(member.stiffest(), stiffest);
}

TEST(CondensedMember, RefusesAnInnerNodeThatNothingHolds) {
  BeamRigidity loose = slender;
  loose.GJ = 0;
  CondensedMember member({0, 0.5, 1});
  EXPECT_FALSE(member.set(loose, 0.3));
  EXPECT_TRUE(member.set(slender, 0.3));
  EXPECT_FALSE(member.set(loose, 0.3));
  ASSERT_TRUE(member.set(slender, 0.3));
  EXPECT_LT(apart(member.stiffness(), local_stiffness(slender, 0.3)), 1e-12);
}

}  // namespace
}  // namespace deflect::frame
