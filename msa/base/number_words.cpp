#include "msa/base/number_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace deflect {
namespace {

/// The decimal place of the first digit: 0 of 1 … 9, 2 of 314, −3 of 0.004.
int place_of(double value) { return value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value)))); }

}  // namespace

std::string digits_of(double value, int significant) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  // Rounding may carry into another place: 9.996 is 10.0.
  const double rounded = std::stod(fmt::format("{:.{}e}", value, std::max(1, significant) - 1));
  const int place = place_of(rounded);
  if (rounded != 0 && (place < -4 || place > 6)) return fmt::format("{:.{}g}", value, significant);
  return fmt::format("{:.{}f}", rounded, std::max(0, significant - 1 - place));
}

std::string plus_minus_words(double value, double deviation) {
  if (!(deviation > 0) || !std::isfinite(deviation)) return digits_of(value, 3) + " ± " + digits_of(deviation, 2);
  const int more = place_of(value) - place_of(deviation);
  return digits_of(value, std::clamp(more + 2, 3, 9)) + " ± " + digits_of(deviation, 2);
}

std::string interval_words(double value, double low, double high) {
  const double width = high - low;
  const double largest = std::max({std::abs(value), std::abs(low), std::abs(high)});
  int digits = 4;
  if (std::isinf(high) && std::isfinite(low))
    return fmt::format("{} (at least {})", digits_of(value, digits), digits_of(low, digits));
  if (width > 0 && std::isfinite(width) && largest > 0)
    digits = std::clamp(place_of(largest) - place_of(width) + 2, 4, 12);
  return fmt::format("{} ({} … {})", digits_of(value, digits), digits_of(low, digits), digits_of(high, digits));
}

double as_printed(double value, int decimals) {
  return std::isfinite(value) ? std::stod(fmt::format("{:.{}f}", value, decimals)) : value;
}

std::string fall_words(double from, double to) {
  int digits = 2;
  while (digits < 6 && digits_of(from, digits) == digits_of(to, digits)) ++digits;
  return digits_of(from, digits) + " to " + digits_of(to, digits);
}

std::string odd_character_words(std::string_view utf8) {
  const auto at = std::find_if(utf8.begin(), utf8.end(), [](unsigned char c) { return c >= 0xC0; });
  if (at == utf8.end()) return "";
  const auto first = static_cast<unsigned char>(*at);
  const int more = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : 1;
  if (std::distance(at, utf8.end()) <= more) return "";
  std::uint32_t code = first & (0x3FU >> more);
  for (int i = 1; i <= more; ++i) code = (code << 6U) | (static_cast<unsigned char>(at[i]) & 0x3FU);
  const bool minus = code == 0x2212 || (code >= 0x2010 && code <= 0x2015);
  const bool space = code == 0xA0 || code == 0x202F || (code >= 0x2000 && code <= 0x200B) || code == 0xFEFF;
  return fmt::format("; it holds U+{:04X}{}", code,
                     minus   ? ", a minus sign that is no '-'"
                     : space ? ", a space that is no ' '"
                             : "");
}

}  // namespace deflect
