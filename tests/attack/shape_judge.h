// What both theories say of a device in its deformed shape, judged by its equilibrium (shape_oracle.h).
#pragma once

#include "tests/attack/device_judge.h"
#include "tests/attack/shaped_device.h"

namespace deflect::attack {

/// By what a device can be judged.
enum class ShapeClass {
  cannot_stand,  ///< or nothing yields: a matter of linear geometry
  equilibrium,   ///< the judge followed the growing load to its end
  singular,      ///< the same, but something idles, is held twice or has hardly digits: it may also be refused
  gives_way,     ///< it met a loss of stability on the way
  agreement      ///< it found no equilibrium: only by each other
};
inline constexpr const char* shape_class_names[] = {"cannot stand", "equilibrium found", "the same, singular at rest",
                                                    "gives way", "by agreement"};

struct ShapeJudgement {
  Outcome outcome = Outcome::answered;
  ShapeClass kind = ShapeClass::cannot_stand;
  double closed_form = 0, msa = 0;       ///< errors of displacements, relative
  double between = 0, second_order = 0;  ///< of the theories: finite, second order
  double of_allowed = 0;                 ///< the largest error over what is allowed
  double compliance = 0;                 ///< error of the stiffness over what is allowed, the worse theory
  double of_strain = 0;                  ///< what small strains leave open, where that was asked
  std::string words = {};
};

ShapeJudgement judge_in_shape(const std::optional<ShapedDevice>&);
/// In a process of its own.
ShapeJudgement judge_in_shape_apart(unsigned seed, bool laws);

std::string reproduction_in_shape(unsigned seed, bool laws, const ShapeJudgement&);

}  // namespace deflect::attack
