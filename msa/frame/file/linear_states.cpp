// The states of a frame under its loads in linear geometry.
#include <tuple>
#include <utility>

#include "msa/base/index.h"
#include "msa/frame/file/frame_case.h"

namespace deflect::frame {
namespace {

/// All laws are linear: one factorisation, or one preconditioner, for all loads.
std::vector<LinearState> solve_equations(const std::vector<CaseLoad>& cases, const EquationOptions& options,
                                         FrameResult& out, Elimination& elimination) {
  Model& model = out.structure.model;
  const auto columns = std::ssize(cases);
  MatrixX loads(model.dofs(), columns), values(std::ssize(model.constraints), columns);
  for (Eigen::Index c = 0; c < columns; ++c) {
    loads.col(c) = nth(cases, c).forces;
    values.col(c) = nth(cases, c).values;
  }
  LinearSolution solution = solve_linear(std::move(model), loads, values, options);
  model = std::move(solution.model);  // with what the solver added to it
  out.notes = std::move(solution.notes);
  out.equations = std::move(solution.summary);
  elimination = std::move(solution.elimination);
  std::vector<LinearState> states(cases.size());
  for (std::size_t c = 0; c < cases.size(); ++c) states[c].fine = solution.fine.col(as_index(c));
  return states;
}

LinearState state_of(Solution s, const Model& model) {
  LinearState out;
  out.fine = std::move(s.fine);
  for (const Spring& spring : model.springs) out.laws.push_back(spring.law);
  out.slips = std::move(s.slips);
  out.loose = std::move(s.loose);
  out.path.converged = s.converged;
  out.path.iterations = s.iterations;
  out.path.steps = 1;
  if (!s.converged)
    out.path.message = s.message.empty() ? "no equilibrium with the laws of its springs, supports and ends was found"
                                         : std::move(s.message);
  return out;
}

/// One solver for all loads, which come in turn.
std::vector<LinearState> solve_laws(const std::vector<CaseLoad>& cases, bool assembly, const FrameOptions& options,
                                    FrameResult& out, Elimination& elimination) {
  Solver solver(std::move(out.structure.model));
  std::vector<LinearState> states;
  std::vector<double> slips;  // before the next load
  for (const CaseLoad& load : cases) {
    solver.begin_slips(slips);
    states.push_back(state_of(solver.solve(load.forces, load.values), solver.model()));
    const LinearState& state = states.back();
    const bool keeps = options.in_sequence || (assembly && states.size() == 1);
    if (keeps && state.path.converged) slips = state.slips;
  }
  out.notes = solver.notes();
  out.equations.solver = "direct";
  out.equations.why = "laws whose stiffness depends on their load";
  if (options.equations.solver == Equations::iterative) out.equations.why = "not iteratively: " + out.equations.why;
  out.equations.freedoms = solver.elimination().independent;
  std::tie(out.structure.model, elimination) = std::move(solver).structure();
  return states;
}

}  // namespace

std::vector<LinearState> solve_states(const std::vector<CaseLoad>& cases, bool assembly, const FrameOptions& options,
                                      FrameResult& out, Elimination& elimination) {
  return out.linear_laws ? solve_equations(cases, options.equations, out, elimination)
                         : solve_laws(cases, assembly, options, out, elimination);
}

}  // namespace deflect::frame
