// Every number of a description in a fixed order, to be read or replaced. Descriptions of the same make (the same
// keys, laws and lengths of lists) have the same numbers at the same index.
#pragma once

#include <functional>
#include <vector>

#include "msa/mechanism/description.h"

namespace deflect::effects {

/// Calls f(index, number) for each; f may change it. Legs that were resolved come last, one by one.
void for_each_number(Mechanism&, const std::function<void(std::size_t, double&)>& f);

std::vector<double> numbers_of(const Mechanism&);

}  // namespace deflect::effects
