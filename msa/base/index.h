// Eigen counts in signed numbers, the standard containers in unsigned ones: the conversions between them.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <cstddef>
#include <type_traits>

namespace deflect {

/// A place or a number as Eigen counts it, and as the standard containers do: i ≥ 0.
constexpr Eigen::Index as_index(std::integral auto i) { return static_cast<Eigen::Index>(i); }
constexpr std::size_t as_size(std::integral auto i) { return static_cast<std::size_t>(i); }

/// Element i, 0 ≤ i < size, of a standard container; i is an index of Eigen or an int.
template <class Container>
constexpr decltype(auto) nth(Container&& container, Eigen::Index i) {
  return container[static_cast<std::size_t>(i)];
}

/// The element of a table in the order of an enumeration.
template <class Container, class Enum>
requires std::is_enum_v<Enum>
constexpr decltype(auto) nth(Container&& table, Enum e) { return table[static_cast<std::size_t>(e)]; }

}  // namespace deflect
