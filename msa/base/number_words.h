// Numbers in sentences, with only the digits that they need.
#pragma once

#include <string>
#include <string_view>

namespace deflect {

/// "200000", "0.00312", "1.2e+09": with `significant` digits, without an exponent from 1e-4 to 1e7.
std::string digits_of(double value, int significant);

/// "123.456 ± 0.012": the deviation has two digits, and the value the same last digit, but at least three digits.
std::string plus_minus_words(double value, double deviation);

/// "200000 (199800 … 200200)": with two digits of the distance of the bounds; "0.612 (at least 0.605)" without an upper
/// bound.
std::string interval_words(double value, double low, double high);

/// The number rounded to the decimals that a sentence prints, so that the sentence is true for the printed number.
double as_printed(double value, int decimals);

/// What the eye does not see in a text that should be a number: "; it holds U+2212, a minus sign that is no '-'". Empty
/// where all characters are ASCII.
std::string odd_character_words(std::string_view utf8);

/// "5.2 to 1.1": with two digits, or more (six at most) where the two would otherwise look equal.
std::string fall_words(double from, double to);

}  // namespace deflect
