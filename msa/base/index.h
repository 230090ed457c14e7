// Conversions between the signed indices of Eigen and the unsigned ones of the standard containers.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <type_traits>

namespace deflect {

/// An index or a count i ≥ 0 in the type of Eigen, or of the standard containers.
constexpr Eigen::Index as_index(std::integral auto i) { return static_cast<Eigen::Index>(i); }
constexpr std::size_t as_size(std::integral auto i) { return static_cast<std::size_t>(i); }

/// Element i, 0 ≤ i < size, of a standard container; i is an index of Eigen or an int.
template <class Container>
constexpr decltype(auto) nth(Container&& container, Eigen::Index i) {
  return container[static_cast<std::size_t>(i)];
}

/// The element of a table that is in the order of an enumeration.
template <class Container, class Enum>
requires std::is_enum_v<Enum>
constexpr decltype(auto) nth(Container&& table, Enum e) { return table[static_cast<std::size_t>(e)]; }

}  // namespace deflect
