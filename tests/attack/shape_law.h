// The laws of joints for the judge of deformed shapes: force and deflection as functions of one number s, along the
// curve of the law. Where the law jumps, s = δ + c f goes along the jump too.
#pragma once

#include "msa/mechanism/law.h"
#include "tests/attack/shape_rod.h"

namespace deflect::attack {

struct LawPoint {
  Long f, delta;        ///< N, m, or Nm, rad
  Long df, ddelta = 1;  ///< by s
};

/// `c`: m/N or rad/Nm, of the order of what yields there. Throws std::logic_error for a law that it does not know.
LawPoint along_law(const Law&, Long s, Long c);

}  // namespace deflect::attack
