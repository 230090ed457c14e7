// A chain of joints and members between two bodies, for the judge of deformed shapes: given how both bodies stand, the
// wrench that passes through the chain and the coordinates of its joints, what is left of its equations.
//
// A joint stands with its axes on the part before it and moves tx ty tz, then Rx Ry Rz about the place where it then
// is. The wrench does work on each of these motions; a law carries that force at its own deflection, a free motion
// carries none. All of it holds for motions of any size.
#pragma once

#include <variant>
#include <vector>

#include "tests/attack/shape_law.h"

namespace deflect::attack {

/// By which numbers are scaled: what moves is of the order 1 in them. `steps`: along each rod.
struct ShapeScale {
  Long length = 1, move = 1, force = 1;  ///< m; the displacement over the length; N
  int steps = 4;
};

struct JointL {
  /// One number of the state: a free motion, or along the curve of a law, or a motion of a stiffness of all six.
  struct Number {
    std::size_t freedom;
    const Law* law;  ///< null: none
  };
  const PlacedJoint* joint;
  std::vector<Number> numbers;
};

/// Where a leg's end stands beside its seat, as the last motion of the leg.
struct SeatL {
  Vector6L beside;
};

using VectorL = Eigen::Matrix<Long, Eigen::Dynamic, 1>;
using MatrixL = Eigen::Matrix<Long, Eigen::Dynamic, Eigen::Dynamic>;

struct ChainL {
  static constexpr int ground = -1;
  int start = ground, end = ground;
  std::vector<std::variant<JointL, RodL, SeatL>> parts;
  Eigen::Index numbers = 0;

  void add(const PlacedPart&, const Vector3L& p_T, Shear);
};

/// What is left of a chain's equations, scaled: six of its end, then one for each number. `gap`: of the body `end`
/// behind where the chain ends. `slopes`: by number, of the law alone.
struct ChainLeft {
  VectorL left, slopes;
};
ChainLeft left_of(const ChainL&, const MotionL& start, const MotionL& end, const WrenchL&, const VectorL& numbers,
                  Long misfit, const ShapeScale&);

}  // namespace deflect::attack
