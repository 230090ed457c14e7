// Parts of a frame's analysis that linear and nonlinear load cases share.
#pragma once

#include "msa/frame/file/frame_analysis.h"

namespace deflect::frame {

/// Solves the load cases in second-order or finite geometry and adds the solver's notes. `out` contains the structure,
/// to which the constraints that hold idle spins are added.
void analyse_geometric(const FrameDescription&, const FrameOptions&, FrameResult& out);

/// A state of the structure in linear geometry.
struct LinearState {
  ExtendedVector fine;             ///< by freedom
  std::vector<SpringLaw> laws;     ///< by spring, in this state; empty where all are linear
  std::vector<double> slips;       ///< of friction elements
  std::vector<std::string> loose;  ///< springs within whose play the structure floats
  PathSummary path;
};

/// Of each load. `assembly`: the first is that of the frame as assembled. `out` contains the structure, to which the
/// solver adds, and gets its notes and its summary.
std::vector<LinearState> solve_states(const std::vector<CaseLoad>&, bool assembly, const FrameOptions&,
                                      FrameResult& out, Elimination&);

/// Computes energies by group and in total, from those of the members and of the springs (by spring of the structure).
void find_energies(CaseResult&, const FrameDescription&, const FrameModel&, const VectorX& of_springs);

/// Keeps the moment with the larger magnitude; a difference by rounding does not replace it.
void keep_larger(LargestMoment& largest_so_far, double value, double x);

inline double ratio(double part, double whole) { return part == 0 ? 0 : part / whole; }

}  // namespace deflect::frame
