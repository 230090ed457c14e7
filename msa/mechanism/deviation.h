// What a standard deviation of a number in a file can be, as tolerances of machines and of frames give it.
#pragma once

#include <fmt/format.h>

#include <string>

#include "msa/base/error.h"
#include "msa/base/units.h"

namespace deflect {

/// InputError where the standard deviation `sigma` (SI; a share where `value` is relative, "5 %"), written as `value`,
/// cannot be one of a number of this dimension: it is negative, more than the number itself, or larger than the number
/// may be.
inline void require_deviation(double sigma, const std::string& value, Dimension d) {
  if (sigma < 0) throw InputError(fmt::format("'{}' is a standard deviation: it must be at least 0", value));
  if (!value.ends_with('%')) return require_usable_size(sigma, d, value);
  if (sigma > 1)
    throw InputError(fmt::format("'{}' is a standard deviation larger than the number itself: at most 100 %", value));
}

}  // namespace deflect
