// What may happen at each of a subject's places, whether or not a law describes it.
#pragma once

#include <map>
#include <optional>

#include "validation/diagnosis/whatever_the_law.h"

namespace deflect::diagnosis {

/// Of the subject's own places, those that are one part: of every leg, and of each of several.
template <class Does>
void for_each_place(const subject::Subject& subject, const Does& does) {
  for (const subject::Place& p : subject.places()) {
    if (!p.others.empty()) continue;
    does(p, std::nullopt);
    for (int leg = 1; p.in_legs() && subject.legs() > 1 && leg <= subject.legs(); ++leg) does(p, std::optional(leg));
  }
}

/// Columns over the measured numbers: of sensors channel_shapes(), of all else Changes::by_whatever().
std::map<Spot, MatrixX> whatever_columns(const Observations&, const Changes&);

}  // namespace deflect::diagnosis
