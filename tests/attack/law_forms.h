// Random frames with linear laws at supports and ends of members, and coupled springs. The oracles know springs only:
// they get the same frame with a spring for each law, and a node of its own for each elastic end.
#pragma once

#include "tests/attack/random_frame.h"

namespace deflect::attack {

/// random_frame() of the seed, with elastic ends; `written` has them, and some of the springs, as laws.
RandomFrame random_law_frame(unsigned seed);

}  // namespace deflect::attack
