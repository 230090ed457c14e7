// Matrices as sets of columns.
#include "validation/statistics/columns.h"

#include <gtest/gtest.h>

namespace deflect {
namespace {

// Lines that bend at 0.1, 0.2, … and a line with two of these bends: they are found out of nine, though each column
// alone is nearly parallel to its neighbours, and nothing is left.
TEST(ChosenInTurn, ABrokenLineIsTheBendsThatItHas) {
  constexpr Eigen::Index n = 400, bends = 9;
  const VectorX x = VectorX::LinSpaced(n, 0, 1);
  MatrixX columns(n, bends);
  for (Eigen::Index i = 0; i < bends; ++i)
    columns.col(i) = (x.array() - 0.1 * static_cast<double>(i + 1)).cwiseMax(0).matrix().normalized();
  const VectorX line = 3 * columns.col(1) - 2 * columns.col(5);
  const MatrixX chosen = statistics::chosen_in_turn(columns, line, 1e-12, 1e-6);
  EXPECT_LE(chosen.cols(), 4);
  EXPECT_LT((line - chosen * (chosen.transpose() * line)).norm(), 1e-9);
  EXPECT_TRUE((chosen.transpose() * chosen).isIdentity(1e-9));
}

TEST(ChosenInTurn, StopsWhereTheBestOfTheRestTakesTooLittle) {
  const MatrixX columns = MatrixX::Identity(5, 4);
  const VectorX v = (VectorX(5) << 1, 4, 2, 3, 9).finished();
  EXPECT_EQ(statistics::chosen_in_turn(columns, v, 8.9, 1e-6).cols(), 2);  // 16 and 9
  EXPECT_EQ(statistics::chosen_in_turn(columns, v, 16.1, 1e-6).cols(), 0);
  EXPECT_EQ(statistics::chosen_in_turn(columns, v, 0.5, 1e-6).cols(), 4);
}

// A column that is within the span of those chosen is not chosen for what rounding leaves of it.
TEST(ChosenInTurn, PassesOverWhatIsWithinTheSpan) {
  MatrixX columns(3, 3);
  columns << 1, 0, 1, 0, 1, 1, 0, 0, 0;
  const VectorX v = (VectorX(3) << 5, 3, 1).finished();
  EXPECT_EQ(statistics::chosen_in_turn(columns, v, 1e-30, 1e-6).cols(), 2);
}

}  // namespace
}  // namespace deflect
