// Parts of a frame's analysis that linear and nonlinear load cases share.
#pragma once

#include "msa/frame/file/frame_analysis.h"

namespace deflect::frame {

/// Solves the load cases in second-order or finite geometry and adds the solver's notes. `out` contains the structure,
/// to which the constraints that hold idle spins are added.
void analyse_geometric(const FrameDescription&, FrameResult& out);

/// Computes energies by group and in total, from those of the members and the elongations of the springs.
void find_energies(CaseResult&, const FrameDescription&, const FrameModel&, const VectorX& elongations);

/// Keeps the moment with the larger magnitude; a difference by rounding does not replace it.
void keep_larger(LargestMoment& largest_so_far, double value, double x);

inline double ratio(double part, double whole) { return part == 0 ? 0 : part / whole; }

}  // namespace deflect::frame
