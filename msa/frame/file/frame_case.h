// The parts of a frame's analysis: what its linear and its other load cases share.
#pragma once

#include "msa/frame/file/frame_analysis.h"

namespace deflect::frame {

/// The load cases in second order or at finite displacement, with the notes of their solver; the structure is that of
/// `out`, which gets the constraints that hold idle spins.
void analyse_geometric(const FrameDescription&, FrameResult& out);

/// Energies by group and in all, from those of the members and the elongations of the springs.
void find_energies(CaseResult&, const FrameDescription&, const FrameModel&, const VectorX& elongations);

/// The one with the larger magnitude stays; rounding does not move it.
void keep_larger(LargestMoment& largest_so_far, double value, double x);

inline double ratio(double part, double whole) { return part == 0 ? 0 : part / whole; }

}  // namespace deflect::frame
