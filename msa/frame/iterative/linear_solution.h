// The equations of a linear structure, by one of two ways.
//
// Direct: Cholesky factorisation (solver.h): exact but for rounding, recognises whatever cannot stand, many load cases
// at little more than the price of one. Iterative: preconditioned conjugate gradients (conjugate_gradients.h), with a
// residual formed from the elements and where that asks for it one correction; a fraction of the time and a tenth of
// the memory where a structure is large, wide and benign.
//
// The iterative way answers only for structures that are proved to stand (standing.h), without parts so stiff that they
// need relative coordinates (relative.h), whose preconditioned condition it could estimate, and with an error bound
// within what was asked (with what rounding adds, which meets both ways alike, within a hundred times that); else the
// direct one does, and the summary says why. `automatic` takes it from 20 000 free freedoms, a level of more than 50
// nodes (narrow structures are factorised at little cost) and up to four load cases.
#pragma once

#include <functional>
#include <optional>

#include "msa/frame/structure/solver.h"

namespace deflect::frame {

enum class Equations { automatic, direct, iterative };
inline constexpr const char* equations_names[] = {"auto", "direct", "iterative"};

struct EquationOptions {
  Equations solver = Equations::automatic;
  double error = 1e-10;  ///< of the iterative way: what the bound below must reach, rounding aside
  int threads = 0;       ///< 0: as many as the machine has. Results are the same bits for any number
  /// Told how far the iterative way has come, 0 … 1.
  std::function<void(double)> progress = {};
};

struct EquationSummary {
  std::string solver, why;  ///< "direct" or "iterative", and a clause
  int freedoms = 0;         ///< that are free
  int iterations = 0;
  /// Iterative: ‖u − u_exact‖_K / ‖u‖_K over free freedoms, largest of the load cases: 2 (‖r‖ + ‖ρ‖)_{M⁻¹} / √θ /
  /// ‖u‖_K, r the residual of u from the elements, ρ its rounding. After a correction c, whose own residual is carried
  /// along: 2 (‖r_c‖ + ‖ρ‖)_{M⁻¹} / √θ / ‖u‖_K and what the last places of u are worth. The inequality is exact where
  /// θ/4 lies below the smallest eigenvalue (conjugate_gradients.h); ρ and the last places are estimates, with signs by
  /// chance.
  std::optional<double> error_bound;
};

/// The structure, what solved it and the displacements (columns of loads, by freedom of `model`).
struct LinearSolution {
  Model model;
  Elimination elimination;
  MatrixX u;
  ExtendedMatrix fine;  ///< the same, for differences
  std::vector<std::string> notes;
  EquationSummary summary;
};

/// Columns of loads by freedom and of values by constraint; springs are linear. Throws as Solver does.
LinearSolution solve_linear(Model, const MatrixX& loads, const MatrixX& values, const EquationOptions& = {});

}  // namespace deflect::frame
