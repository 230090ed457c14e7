// Every number of a description in a fixed order, to be read or replaced. Two descriptions with the same keys, laws and
// lengths of lists have the same numbers at the same index.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "msa/fields/number_walk.h"
#include "msa/mechanism/description.h"

namespace deflect {

/// Calls f(index, number) for each; f may change it. The legs of a resolved mechanism (device_file.h) come last, one by
/// one. InputError "KEY: …" where a number lies outside its range afterwards, or numbers contradict each other.
void for_each_number(Mechanism&, const std::function<void(std::size_t, double&)>& f);

std::vector<double> numbers_of(const Mechanism&);

/// In the order of for_each_number: element i describes number i.
std::vector<DescribedNumber> described_numbers(const Mechanism&);

}  // namespace deflect
