// Visits every number of a description in a fixed order, to read or replace it. Descriptions with the same structure
// (keys, kinds of laws, lengths of lists) have corresponding numbers at the same index.
#pragma once

#include <functional>
#include <vector>

#include "msa/mechanism/description.h"

namespace deflect {

/// Calls f(index, number) for each; f may change it. Resolved legs (device_file.h) come last, one after the other.
void for_each_number(Mechanism&, const std::function<void(std::size_t, double&)>& f);

std::vector<double> numbers_of(const Mechanism&);

}  // namespace deflect
