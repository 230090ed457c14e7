// A frame under its load cases: displacements, reactions, member forces, energies, and checks on them. Linear: one
// factorisation serves all cases. Second order and finite: each case is a path of its own (geometric_solver.h).
#pragma once

#include <string>
#include <vector>

#include "msa/frame/file/frame_build.h"
#include "msa/frame/iterative/linear_solution.h"

namespace deflect::frame {

struct FrameOptions {
  FrameDivision division;     ///< empty: as the description divides; one element is exact at its nodes where linear
  EquationOptions equations;  ///< linear only; where the geometry is not linear the direct way is the only one
};

/// The bending moment with the largest magnitude along a member.
struct LargestMoment {
  double value = 0;  ///< Nm, with its sign
  double at = 0;     ///< m from the member's start
};

/// [N, Vy, Vz, T, My, Mz], N and Nm, in member axes on the face that looks along the member's x (member_loads.h): at
/// the start what the member does to the node, at the end what the node does to the member. Finite: in the axes of the
/// section there, which turn with the node. The largest moments are those at ends of elements unless linear.
struct MemberForces {
  Vector6 start, end;
  LargestMoment My, Mz;
  double energy = 0;  ///< J
};

/// Relative, 0 where all is exact. Terms that cancel are measured by 1e-7 of the unsigned sum of what cancels, so that
/// a case without reactions (free expansion) does not fail on its rounding.
struct FrameChecks {
  double residual = 0;  ///< Tᵀ(f − f_int): equilibrium of the free freedoms; not linear: what Newton would still move
  /// Loads + reactions: resultant force and moment of the whole, finite: in the deformed shape. Second order: force.
  double equilibrium = 0;
  /// Linear only: 2U = f·u + λ·v − Σ N ε L: the works of loads and of moved supports (displacements v, reactions λ)
  /// less that of the axial forces on the free expansion. From K d = f + K d0 + Cᵀλ, times d − d0; ½f·d where there is
  /// neither.
  double energy = 0;
};

/// How a case that is not linear was solved.
struct PathSummary {
  bool converged = true, stable = true;
  int steps = 0, iterations = 0;
  double load_factor = 1;  ///< of the load that the results are for
  std::string message;     ///< why not converged or not stable
};

/// Wrenches and displacements are in base axes; rotations are rotation vectors.
struct CaseResult {
  std::string name;
  PathSummary path;
  std::vector<Vector6> displacements;  ///< by node of the description: m, rad
  std::vector<Vector6> reactions;      ///< by support, [f; m] on the frame; 0 where free or where others imply it
  std::vector<Vector6> springs;        ///< by spring, [f; m] on its `node`
  std::vector<double> constraints;     ///< by general constraint, λ: the force on a freedom is factor · arm · λ
  std::vector<MemberForces> members;
  Named<double> energies;  ///< J by section and spring, largest first
  double energy = 0;       ///< J
  FrameChecks checks;
  VectorX u;                         ///< by freedom of FrameResult::structure
  std::vector<ElementLoad> loads;    ///< by beam of it
  std::vector<Vector12> end_forces;  ///< by beam of it, local axes; finite: those of the sections at the ends
};

struct FrameResult {
  std::string name;
  Geometry geometry = Geometry::linear;
  FrameModel structure;
  std::vector<CaseResult> cases;
  std::vector<std::string> notes;  ///< redundant constraints by name, idle spins that were held
  EquationSummary equations;       ///< which way they were solved, and why; linear only
  /// Betti: f_i·u_j + λ_i·v_j = f_j·u_i + λ_j·v_i between all cases, f with the forces that heat is equivalent to;
  /// largest difference, relative. Linear only.
  double reciprocity = 0;
};

inline constexpr double check_tolerance = 1e-6;

/// Throws ModelError for a frame that cannot stand and for constraints that contradict each other, InputError for a
/// name that does not resolve.
FrameResult analyse(const FrameDescription&, const FrameOptions& = {});

/// The first case without a stable equilibrium, or check above check_tolerance, with its value; empty when all hold.
std::string failed_check(const FrameResult&);

}  // namespace deflect::frame
