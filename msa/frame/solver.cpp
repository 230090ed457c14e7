#include "msa/frame/solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "msa/base/error.h"
#include "msa/frame/stability.h"

namespace deflect::frame {
namespace {

// Below this reciprocal condition of the scaled matrix a structure is looked at for motions that nothing holds.
constexpr double suspicious = 1e-12;

double largest(const VectorX& v) { return v.size() ? v.cwiseAbs().maxCoeff() : 0; }

/// Potential energy −fᵀu + stored; what equilibrium makes stationary.
double potential(const Model& m, const VectorX& u, const VectorX& load) {
  double sum = -load.dot(u);
  for (const auto& [part, energy] : energies(m, u)) sum += energy;
  return sum;
}

bool all_linear(const Model& m) {
  return std::all_of(m.springs.begin(), m.springs.end(), [](const Spring& s) { return is_linear(s.law); });
}

}  // namespace

Solver::Solver(const Model& m)
    : model_(m), elimination_(eliminate(m)), assembly_(m, elimination_), cholesky_(assembly_.pattern()) {
  check_consistent(m, elimination_, constraint_values(m));
}

void Solver::factor(const VectorX& tangents) {
  if (factored_ && factored_tangents_ == tangents) return;
  factored_ = false;
  const std::vector<double> values = assembly_.values(tangents);
  if (elimination_.independent > 0) {
    const double condition = cholesky_.factor(values);
    if (condition < suspicious) refuse_mechanism(model_, elimination_, assembly_.pattern(), values);
    if (condition == 0) throw ModelError("the structure's stiffness is not positive definite");
  }
  factored_tangents_ = tangents;
  factored_ = true;
}

VectorX Solver::starting_tangents(double force) const {
  VectorX k(static_cast<Eigen::Index>(model_.springs.size()));
  for (std::size_t s = 0; s < model_.springs.size(); ++s)
    k(static_cast<Eigen::Index>(s)) = tangent_at_force(model_.springs[s].law, force);
  return k;
}

Solution Solver::solve(const VectorX& load, const NewtonOptions& options) {
  return solve(load, constraint_values(model_), options);
}

Solution Solver::solve(const VectorX& load, const VectorX& values, const NewtonOptions& options) {
  check_consistent(model_, elimination_, values);
  Solution s;
  VectorX q = VectorX::Zero(elimination_.independent);
  s.u = elimination_.expand(q, values);
  const VectorX f = elimination_.reduce(load);
  const VectorX first = internal_forces(model_, s.u, s.spring_tangents);
  const double force = std::max(largest(load), largest(first));
  if (force == 0) {  // nothing drives it: every spring is at rest
    s.converged = true;
    return s;
  }
  // A spring at rest may have no stiffness (Hertz). The matrix of a step never takes less than a small part of the
  // stiffness at full load, which slows nothing that carries load and keeps an idle spring from blocking the step.
  const VectorX loaded = starting_tangents(force);
  const VectorX floor = 1e-8 * loaded;
  const bool linear = all_linear(model_);
  VectorX r = f - elimination_.reduce(first);
  double previous_step = std::numeric_limits<double>::infinity();
  for (s.iterations = 1; s.iterations <= options.max_iterations; ++s.iterations) {
    factor(s.iterations == 1 ? loaded : VectorX(s.spring_tangents.cwiseMax(floor)));
    const VectorX step = cholesky_.solve(r);
    // Backtrack until the potential falls; where what is to be gained drowns in its rounding, the full step is right.
    double length = 1;
    if (!linear) {
      const double before = potential(model_, s.u, load), slope = -r.dot(step);
      const double rounding = 1e-13 * (std::abs(load.dot(s.u)) + std::abs(before));
      while (length > 1e-6 && std::abs(slope) > rounding) {
        const double after = potential(model_, elimination_.expand(q + length * step, values), load);
        if (after <= before + 1e-4 * length * slope + rounding) break;
        length /= 2;
      }
    }
    q += length * step;
    s.u = elimination_.expand(q, values);
    const VectorX pulls = elimination_.reduce(internal_forces(model_, s.u, s.spring_tangents));
    r = f - pulls;
    const double scale = largest(f) + largest(pulls);
    s.residual = scale > 0 ? largest(r) / scale : 0;
    const bool small_step = largest(step) <= options.tolerance * largest(q);
    const bool stalled = s.residual < 1e-9 && largest(step) > 0.5 * previous_step;  // rounding is all that is left
    previous_step = largest(step);
    s.converged = small_step || stalled || s.residual == 0 || (linear && s.iterations == 3);
    if (s.converged) break;
  }
  s.converged = s.converged && std::isfinite(s.residual) && s.residual < 1e-7;
  return s;
}

MatrixX Solver::linear(const VectorX& tangents, const MatrixX& loads, const MatrixX& values) {
  for (Eigen::Index c = 0; c < values.cols(); ++c) check_consistent(model_, elimination_, values.col(c));
  factor(tangents);
  // One step of refinement: the first solution's residual is formed from the elements, not from the assembled matrix.
  MatrixX q = MatrixX::Zero(elimination_.independent, loads.cols());
  for (int pass = 0; pass < 2; ++pass) {
    MatrixX R(elimination_.independent, loads.cols());
    for (Eigen::Index c = 0; c < loads.cols(); ++c) {
      const VectorX u = elimination_.expand(q.col(c), values.col(c));
      R.col(c) = elimination_.reduce(loads.col(c) - tangent_forces(model_, u, tangents));
    }
    q += cholesky_.solve(R);
  }
  MatrixX U(model_.dofs(), loads.cols());
  for (Eigen::Index c = 0; c < loads.cols(); ++c) U.col(c) = elimination_.expand(q.col(c), values.col(c));
  return U;
}

}  // namespace deflect::frame
