// Solves the equations of a linear structure by one of two solvers.
//
// Direct: Cholesky factorisation (solver.h). Exact except for rounding, recognises every mechanism, and solves many
// load cases at little more than the cost of one. Iterative: preconditioned conjugate gradients
// (conjugate_gradients.h), with a residual computed from the elements and, where needed, one correction. It takes a
// fraction of the time and a tenth of the memory for large, wide and well-conditioned structures.
//
// The iterative solver is used only for structures that are proved to stand (standing.h), that have no parts so stiff
// that they need relative coordinates (relative.h), and whose preconditioned condition could be estimated. Its error
// bound must be within the requested error (within a hundred times that where rounding, which affects both solvers, is
// added). Otherwise the direct solver is used, and the summary says why. `automatic` chooses the iterative solver from
// 20 000 free freedoms, with a level of more than 50 nodes (narrow structures are cheap to factorise) and at most four
// load cases.
#pragma once

#include <functional>
#include <optional>

#include "msa/frame/structure/solver.h"

namespace deflect::frame {

enum class Equations { automatic, direct, iterative };
inline constexpr const char* equations_names[] = {"auto", "direct", "iterative"};

struct EquationOptions {
  Equations solver = Equations::automatic;
  double error = 1e-10;  ///< iterative: requested value of error_bound (below), without rounding
  int threads = 0;       ///< 0: as many as the machine has. Results are bit-identical for any number
  /// Progress callback of the iterative solver, 0 … 1.
  std::function<void(double)> progress = {};
};

struct EquationSummary {
  std::string solver, why;  ///< "direct" or "iterative", and the reason as a clause
  int freedoms = 0;         ///< number of free ones
  int iterations = 0;
  /// Iterative: ‖u − u_exact‖_K / ‖u‖_K over free freedoms, largest of the load cases: 2 (‖r‖ + ‖ρ‖)_{M⁻¹} / √θ /
  /// ‖u‖_K, r the residual of u from the elements, ρ its rounding. After a correction c with residual r_c by recursion:
  /// 2 (‖r_c‖ + ‖ρ‖)_{M⁻¹} / √θ / ‖u‖_K plus the rounding of u itself. The bound is exact where θ/4 is below the
  /// smallest eigenvalue (conjugate_gradients.h); ρ and the rounding of u are estimates that assume random signs.
  std::optional<double> error_bound;
};

/// The structure, its elimination, and the displacements (one column per load, by freedom of `model`).
struct LinearSolution {
  Model model;
  Elimination elimination;
  MatrixX u;
  ExtendedMatrix fine;  ///< the same in extended precision, for differences
  std::vector<std::string> notes;
  EquationSummary summary;
};

/// `loads`: columns by freedom; `values`: columns by constraint. Springs must be linear. Throws as Solver does.
LinearSolution solve_linear(Model, const MatrixX& loads, const MatrixX& values, const EquationOptions& = {});

}  // namespace deflect::frame
