// Frames by the dice, of every kind that a user may write, a third of them mechanisms.
//
// The ideal frame has nodes on a grid of small whole numbers (metres), so that what is collinear, coplanar or
// concurrent there is so exactly, and the oracles (standing_oracle.h, dense_oracle.h) judge it without rounding. The
// program gets the same frame in another size: all lengths times `unit`, forces times unit², stiffnesses of springs to
// match. Then displacements are `unit` times those of the ideal frame, rotations the same.
#pragma once

#include <optional>

#include "msa/frame/file/frame_description.h"

namespace deflect::attack {

enum class FrameKind { chain, tree, ring, grid, truss, portal, plane, web, nearly_singular };
inline constexpr const char* frame_kind_names[] = {"chain",  "tree",  "ring", "grid",           "truss",
                                                   "portal", "plane", "web",  "nearly singular"};

struct RandomFrame {
  unsigned seed = 0;
  FrameKind kind = FrameKind::chain;
  frame::FrameDescription ideal;
  double unit = 1;
  /// The ideal frame in other words, which the program gets (law_forms.h); its nodes are the first of the ideal one's.
  std::optional<frame::FrameDescription> written = {};

  const frame::FrameDescription& words() const { return written ? *written : ideal; }
};

/// The same seed gives the same frame on every machine.
RandomFrame random_frame(unsigned seed);

/// Numbers by the dice that do not depend on the standard library's distributions.
class Dice {
 public:
  explicit Dice(unsigned long long seed) : state_(seed * 0x9E3779B97F4A7C15ull + 0xD1B54A32D192ED03ull) {}
  unsigned long long bits();
  int whole(int low, int high) { return low + static_cast<int>(bits() % static_cast<unsigned>(high - low + 1)); }
  double real(double low, double high) { return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53; }
  bool chance(double p) { return real(0, 1) < p; }
  double power_of_ten(double low, double high);
  /// Components from z to x: the arguments of a call would be drawn in an order of the compiler's own.
  Vector3 wholes(int low, int high) {
    return from_the_last([&] { return whole(low, high); });
  }
  Vector3 reals(double low, double high) {
    return from_the_last([&] { return real(low, high); });
  }

 private:
  template <class Draw>
  static Vector3 from_the_last(const Draw& draw) {
    Vector3 out;
    for (Eigen::Index i = 2; i >= 0; --i) out(i) = draw();
    return out;
  }
  unsigned long long state_;
};

}  // namespace deflect::attack
