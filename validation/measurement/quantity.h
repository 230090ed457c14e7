// What a channel reads: physical quantities, and the units in which files, tables and results give them.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace deflect::measurement {

enum class Quantity { length, angle, force, moment, strain };

/// Units of a quantity; each number is how many of that unit make one SI unit (m, rad, N, Nm, 1).
struct QuantityRow {
  const char* what;  ///< "displacement"
  const char* unit;  ///< of columns in measurement files
  double per_SI;
  const char* fine;  ///< of errors in tables
  double fine_per_SI;
  const char* fine_column;  ///< the same in names of columns
  const char* coarse;       ///< of errors in JSON
  double coarse_per_SI;
};
inline constexpr std::array quantity_rows = {
    QuantityRow{"displacement", "mm", 1e3, "µm", 1e6, "um", "mm", 1e3},
    QuantityRow{"rotation", "rad", 1, "µrad", 1e6, "urad", "mrad", 1e3},
    QuantityRow{"force", "N", 1, "N", 1, "N", "N", 1},
    QuantityRow{"moment", "Nmm", 1e3, "Nmm", 1e3, "Nmm", "Nmm", 1e3},
    QuantityRow{"strain", "um_per_m", 1e6, "µm/m", 1e6, "um_per_m", "µm/m", 1e6},
};
constexpr std::size_t number_of(Quantity q) { return static_cast<std::size_t>(q); }
static_assert(quantity_rows.size() == number_of(Quantity::strain) + 1);

constexpr const QuantityRow& row_of(Quantity q) { return quantity_rows[number_of(q)]; }

/// Of a component of [δ; θ].
constexpr Quantity displacement_quantity(std::size_t component) {
  return component < 3 ? Quantity::length : Quantity::angle;
}

}  // namespace deflect::measurement
