// Analysis of a frame under its load cases: displacements, reactions, member forces, energies, and checks of them.
// Linear geometry: one factorisation for all cases, one solver where laws are not linear (solver.h). Second order and
// finite: each case has its own load path (geometric_solver.h).
//
// A frame is assembled without load. Where members have misfits it is strained then: forces, reactions and energies of
// a case are those of the loaded frame, its displacements and rotations are relative to the frame as assembled. In
// linear geometry with linear laws a misfit changes no displacement. Frictions have slipped as the assembly made them
// slip.
#pragma once

#include <string>
#include <vector>

#include "msa/frame/elements/section_course.h"
#include "msa/frame/file/frame_build.h"
#include "msa/frame/iterative/linear_solution.h"

namespace deflect::frame {

struct FrameOptions {
  FrameDivision division;     ///< empty: as in the description; one element is exact at its nodes in linear geometry
  EquationOptions equations;  ///< linear only; nonlinear geometry and laws always use the direct solver
  bool in_sequence = false;   ///< cases follow one another, and frictions keep their slips from each to the next; else
                              ///< each case begins with the frame as assembled
};

/// The bending moment with the largest magnitude along a member.
struct LargestMoment {
  double value = 0;  ///< Nm, with its sign
  double at = 0;     ///< m from the member's start
};

/// [N, Vy, Vz, T, My, Mz], N and Nm, in member axes, on the face with outward normal +x (member_loads.h): at the start
/// the action of the member on the node, at the end that of the node on the member. Finite: in the axes of the section
/// there, which rotate with the node.
struct MemberForces {
  Vector6 start, end;
  LargestMoment My, Mz;
  double energy = 0;  ///< J
};

/// Relative errors, 0 where everything is exact. The reference is at least 1e-7 of the sum of the magnitudes of the
/// cancelling terms, so that a case without reactions (free expansion) does not fail by rounding, and 1e-8 of what the
/// motion of moved supports would be as a strain (all settle alike, which strains nothing); springs that jump count
/// there with what their forces would store in a contact stiffness (relative.h), for those that are rigid do no work.
struct FrameChecks {
  double residual = 0;  ///< Tᵀ(f − f_int): equilibrium of the free freedoms; nonlinear: size of the next Newton step
  /// Loads + reactions: resultant force and moment on the whole frame. Finite: in the deformed shape. Second order:
  /// only the force.
  double equilibrium = 0;
  /// Linear geometry only: 2U + Σ F δ = f·u + λ·v − Σ N ε L. U of the members, F and δ of springs, which follow any
  /// law: the work of loads and of moved supports (displacements v, reactions λ) minus that of the axial forces on the
  /// free expansion. From K d + E F = f + K d0 + Cᵀλ, times d − d0; ½f·d = U where there is neither.
  double energy = 0;
};

/// How a case in nonlinear geometry, or with laws that are not linear, was solved.
struct PathSummary {
  bool converged = true, stable = true;
  int steps = 0, iterations = 0;
  double load_factor = 1;  ///< share of the load that the results are for
  std::string message;     ///< why not converged or not stable
};

/// Wrenches and displacements are in base axes; rotations are rotation vectors.
struct CaseResult {
  std::string name;
  PathSummary path;
  std::vector<Vector6> displacements;  ///< by node of the description, from the frame as assembled: m, rad
  std::vector<Vector6> reactions;      ///< by support, [f; m] on the frame, rigid and elastic; 0 where free or
                                       ///< redundant
  std::vector<Vector6> springs;        ///< by spring, [f; m] on its `node`
  std::vector<double> constraints;     ///< by general constraint, λ: the force on a freedom is factor · arm · λ
  std::vector<MemberForces> members;
  Named<double> energies;  ///< J by section, and by spring, support ("support A") and end of a member ("beam start")
                           ///< that have laws; largest first
  double energy = 0;       ///< J
  FrameChecks checks;
  VectorX u;                         ///< by freedom of FrameResult::structure, from the frame as assembled
  std::vector<double> slips;         ///< of friction elements after the load, m or rad: of members' ends, supports and
                                     ///< springs in turn; empty without friction
  std::vector<ElementLoad> loads;    ///< by beam of it
  std::vector<Vector12> end_forces;  ///< by beam of it, local axes; finite: those of the sections at the ends
  std::vector<SectionCourse> courses;  ///< by beam of it; nonlinear geometry only
};

struct FrameResult {
  std::string name;
  Geometry geometry = Geometry::linear;
  FrameModel structure;
  std::vector<CaseResult> cases;
  std::vector<std::string> notes;  ///< redundant constraints by name, idle spins that were held
  EquationSummary equations;       ///< which solver was used, and why; linear only
  bool linear_laws = true;         ///< whether no law's stiffness depends on its load
  /// Betti: f_i·u_j + λ_i·v_j = f_j·u_i + λ_j·v_i between all cases, with the equivalent thermal forces included in f;
  /// largest difference, relative. Linear geometry and laws only.
  double reciprocity = 0;
};

inline constexpr double check_tolerance = 1e-6;

/// Throws ModelError for an unstable frame (a mechanism) and for contradicting constraints, InputError for a name that
/// does not resolve.
FrameResult analyse(const FrameDescription&, const FrameOptions& = {});

/// The first case without a stable equilibrium, or the first check above check_tolerance with its value; empty when all
/// hold.
std::string failed_check(const FrameResult&);

}  // namespace deflect::frame
