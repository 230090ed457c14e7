// The scale of a map's stiffness: its range, round values in it, tics.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "validation/figures/sheet.h"
#include "validation/studies/map.h"

namespace deflect::figures {

/// Stiffness along x, y, z at the grid's poses; NaN out of reach. All are positive or the map would have no stiffness.
struct StiffnessRange {
  double low = std::numeric_limits<double>::infinity(), high = 0;
};

StiffnessRange range_of_stiffness(const studies::StiffnessMap&);

/// Preferred numbers within the range: the coarsest series that has at least `wanted` of them, or the finest.
std::vector<double> levels_in(const StiffnessRange&, std::size_t wanted);

/// Four levels or more as tics, with their numbers or without.
std::string tics_in(const StiffnessRange&, bool named = true);

/// Tics of an axis of so many mm: whole steps, none of them so near to an end that its label would touch the next
/// panel's; where there is no room for all, the first and the last.
std::string inner_tics(const Sheet&, double low, double high, double room_mm);

}  // namespace deflect::figures
