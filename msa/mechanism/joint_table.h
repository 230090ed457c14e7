// Joint types, one row each. Six letters give the kind of the freedoms tx ty tz rx ry rz in the joint's axes:
//   r rigid, f free, a actuated (held at its commanded value).
// A law given for a freedom makes it elastic, whatever its letter; an actuated freedom without a law is rigid.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace deflect {

enum class Freedom { rigid, free, actuated };

inline constexpr std::array<const char*, 6> freedom_names = {"tx", "ty", "tz", "rx", "ry", "rz"};

struct JointType {
  const char* name;
  const char* letters;
  const char* about;
};

inline constexpr JointType joint_table[] = {
    {"fixed", "rrrrrr", "no freedom; yields only where it is given a law"},
    {"prismatic", "rrarrr", "actuated slider along z"},
    {"slider", "rrfrrr", "passive slider along z"},
    {"motor", "rrrrra", "actuated revolute about z"},
    {"revolute", "rrrrrf", "passive revolute about z"},
    {"cylindrical", "rrfrrf", "slides along z and turns about it"},
    {"universal", "rrrffr", "turns about x and y, holds the spin about z"},
    {"ball", "rrrfff", "turns about all axes"},
    {"parallelogram", "frrrrr", "passive circular translation of a bar's end, x along its path"},
    {"custom", "rrrrrr", "as its field `freedoms` says: six letters; moves in the order tx ty tz rx ry rz"},
};

/// The row of a type, or nullptr.
const JointType* find_joint_type(std::string_view name);
std::vector<std::string> joint_type_names();
/// From six letters.
std::array<Freedom, 6> freedoms_of(std::string_view letters);

}  // namespace deflect
