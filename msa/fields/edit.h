// A change of a description, addressed by the path of a field.
#pragma once

#include <string>

namespace deflect {

/// One change of a description.
///   path   field names joined by dots as they nest in the file: "materials.steel.E", "leg.ball_joint.tz";
///          "*" stands for every entry ("materials.*.E"); "leg[4]…" for leg 4 alone, which is kept as a variation.
///   value  YAML as it would stand in the file: "200 GPa", "{law: linear, stiffness: 500 N/mm}".
struct Edit {
  enum class Action {
    set,       ///< the field takes the value
    append,    ///< the value joins a list (laws in series)
    multiply,  ///< the number is multiplied by the plain number `value`
    add,       ///< the value is added to the number
  };
  std::string path, value;
  Action action = Action::set;
};

/// "edit 'materials.steel.E *= 0.9'": the start of messages about it.
std::string origin_of(const Edit&);

}  // namespace deflect
