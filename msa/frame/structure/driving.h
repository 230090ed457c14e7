// What drives a structure: loads, and supports that move. A play whose force is rounding beside both carries none.
#pragma once

#include "msa/frame/structure/model.h"

namespace deflect::frame {

struct Driving {
  double force = 0;  ///< the largest of a load, N; moments over the length of the structure
  double moved = 0;  ///< the largest of prescribed values, m; rotations times the length

  /// LinearRelation::size of a law with the stiffness k in the relation. `arm`: the length for a rotation, else 1.
  /// Moved supports cause no force where the structure yields freely; their motion is known to its rounding only, and
  /// k times a few roundings, 1e-9 of this, is no force.
  double size(double k, double arm) const;
};

Driving driving(const Model&, const VectorX& loads, const VectorX& values);

}  // namespace deflect::frame
