// Parts of a frame's analysis that linear and nonlinear load cases share.
#pragma once

#include "msa/frame/file/frame_analysis.h"

namespace deflect::frame {

struct GeometricState;

/// Solves the load cases in second-order or finite geometry and adds the solver's notes. `out` contains the structure,
/// to which the constraints that hold idle spins are added.
void analyse_geometric(const FrameDescription&, const FrameOptions&, FrameResult& out);

/// Resultant of loads, constraints and springs, relative; its moment about the first node, in the deformed shape, where
/// the geometry is finite: in second order moments balance to the accuracy of that theory only. The reference is at
/// least 1e-7 of |K||u|, the terms that cancel in the forces of members and springs: to check_tolerance, rounding of
/// 450 machine epsilons of each.
double resultant(const FrameModel&, const GeometricState&, const VectorX& loads);

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

/// A note for each spring within whose play the structure floats.
void note_floating(const std::string& load, const std::vector<std::string>& loose, std::vector<std::string>& notes);

/// Keeps the moment with the larger magnitude; a difference by rounding does not replace it.
void keep_larger(LargestMoment& largest_so_far, double value, double x);

inline constexpr double cancelling = 1e-7;  ///< of the terms that cancel, see FrameChecks

inline double ratio(double part, double whole) { return part == 0 ? 0 : part / whole; }

}  // namespace deflect::frame
