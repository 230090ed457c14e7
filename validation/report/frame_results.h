// A solved frame as JSON, as CSV tables and as a report for a person. Units in names: mm, rad, N, Nmm; forces in
// member axes as in msa/frame/frame_analysis.h.
#pragma once

#include <string>
#include <vector>

#include "msa/frame/file/frame_analysis.h"

namespace deflect::report {

/// {"frame", "geometry", "cases": {name: {"displacements": [{"node", "ux_mm", …, "rz_rad"}], "reactions": [{"node",
/// "fx_N", …} held freedoms only], "springs": [{"spring", "fx_N", …}], "constraints": [{"constraint", "force_N" or
/// "moment_Nmm"}], "members": [{"member", "start": {"N_N", …}, "end": {the same}, "largest_My_Nmm", "at_mm", …,
/// "energy_Nmm"}], "energy_Nmm", "shares": [{"part", "share"}], "checks": {…}}}, "reciprocity", "solver": {"name",
/// "why", "freedoms", and where it is iterative "iterations", "error_bound"}, "notes"}; where the geometry is not
/// linear, cases have a "path" {"converged", "stable", "load_factor", "steps", "iterations", "message"} and there is
/// neither reciprocity nor a check of energy nor a solver. Throws NumericalError naming a number that is not finite.
std::string frame_json(const frame::FrameDescription&, const frame::FrameResult&);

/// The result's notes, and of each case whether its displacements are small enough for the geometry.
std::vector<std::string> notes_of(const frame::FrameDescription&, const frame::FrameResult&);

/// One row per case and node, support or spring, member, energy group. Cells of free freedoms are empty.
struct FrameTables {
  std::string displacements, reactions, members, shares;
};
FrameTables frame_tables(const frame::FrameDescription&, const frame::FrameResult&);

/// Case by case; of a list with more than `most` rows only those with the largest entries.
std::string frame_report(const frame::FrameDescription&, const frame::FrameResult&, std::size_t most = 24);

}  // namespace deflect::report
