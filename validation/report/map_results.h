// A stiffness map as text, CSV, JSON and as a grid for ParaView.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "validation/studies/map.h"

namespace deflect::report {

/// A reason for which poses are out of reach: without the leg and the numbers.
struct OutOfReach {
  std::string reason;
  std::size_t poses = 0;
  std::size_t example = 0;  ///< index of the first of them
};
std::vector<OutOfReach> out_of_reach(const studies::StiffnessMap&);

/// What the figures show: the first of the theories; null at a pose out of reach.
const studies::MapValues* shown(const studies::MapPose&);
const theories::Theory& shown_theory(const studies::StiffnessMap&);

/// "50 N along x, y, z in turn" or the wrench; and what is secant and what is tangent under it.
std::string map_load_text(const studies::StiffnessMap&);
std::string map_kind_text(const studies::StiffnessMap&);

/// Counts, ranges with the poses where they occur, correlations, the difference of the theories.
std::string map_report(const studies::StiffnessMap&);

/// A row for every pose; cells of what a pose out of reach does not have are empty. Throws InputError like
/// write_text().
std::string map_csv(const studies::StiffnessMap&);

/// Summary, the grid, and arrays in its order with null at poses out of reach.
std::string map_json(const studies::StiffnessMap&);

/// Poses reached as points (mm), cells between neighbours that are all reached (hexahedra, quadrilaterals or lines by
/// the grid's dimension), a lone pose as a vertex; the columns of the CSV as point data. ASCII VTU.
std::string map_vtu(const studies::StiffnessMap&);

}  // namespace deflect::report
