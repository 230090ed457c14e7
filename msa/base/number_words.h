// Numbers in sentences: with the digits that they need, and no others.
#pragma once

#include <string>

namespace deflect {

/// "200000", "0.00312", "1.2e+09": as many significant digits, without an exponent from 1e-4 to 1e7.
std::string digits_of(double value, int significant);

/// "123.456 ± 0.012": the value to the last digit of the deviation, which has two; at least three digits of the value.
std::string plus_minus_words(double value, double deviation);

/// "200000 (199800 … 200200)": so many digits that the bounds can be told from each other, two of their distance.
std::string interval_words(double value, double low, double high);

/// The number as it is read in a sentence that prints it with so many decimals: what the sentence says of it must be
/// true of this.
double as_printed(double value, int decimals);

/// "5.2 to 1.1": from the two digits on, as many as show that the second is not the first, six at most.
std::string fall_words(double from, double to);

}  // namespace deflect
