// Equilibrium of a structure whose springs are not linear: Solver::solve.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "msa/base/index.h"
#include "msa/frame/structure/solver.h"

namespace deflect::frame {
namespace {

/// Potential energy −fᵀu + stored; what equilibrium makes stationary.
double potential(const Model& m, const VectorX& u, const VectorX& load) {
  double sum = -load.dot(u);
  for (const Beam& beam : m.beams) {
    const Vector12 d = end_displacements(beam, u);
    sum += 0.5 * d.dot(pull(beam, d));
  }
  for (const Spring& s : m.springs) sum += energy(s.law, evaluate(s.elongation, u));
  return sum;
}

/// Whether Newton finds such a spring's force better from its force than from its elongation.
bool steep(const SpringLaw& law) {
  const auto* power = std::get_if<PowerSpring>(&law);
  return power && power->n > 1.6;
}

}  // namespace

struct Solver::Work {
  VectorX load, values, f;  // by freedom, by constraint; f the load on what is independent
  double force = 0;         // the largest that springs may see
  VectorX loaded, floor;    // tangents under it, and the least that the matrix of a step takes
  VectorX q, u, tangents;   // the state
  double residual = 0;
  double scale = 0;  // largest force of a spring once loads are shared, moments over length
  double length = 1;
  bool begun = false;  // the state is near the equilibrium
};

void Solver::begin_slips(const std::vector<double>& slips) {
  for (Spring& s : model_->springs) begin(s.law, slips);
}

void Solver::begin_limits(const std::vector<double>& limits) {
  for (Spring& s : model_->springs)
    if (auto* friction = std::get_if<FrictionSpring>(&s.law)) {
      const auto n = as_size(friction->number);
      friction->most = friction->number >= 0 && n < limits.size() ? limits[n] : friction->own;
    }
}

/// A first state. Each spring is linearised where the force that it got last stands on its law, which meets a steep law
/// at its load in two steps, however far away that is.
void Solver::begin_by_forces(Work& w) {
  const std::vector<Spring>& springs = model_->springs;
  const auto n = std::ssize(springs);
  VectorX at = VectorX::Zero(n), force(n), k = w.loaded;
  for (Eigen::Index i = 0; i < n; ++i) {
    force(i) = frame::force(nth(springs, i).law, 0);
  }
  for (int pass = 0; pass < 20; ++pass) {
    VectorX pulls(n), elongations(n);
    for (Eigen::Index i = 0; i < n; ++i)
      pulls(i) = force(i) + k(i) * (evaluate(nth(springs, i).elongation, w.u) - at(i));
    factor(k);
    w.q += cholesky_->solve(w.f - elimination_->reduce(forces_with(*model_, w.u, pulls)));
    w.u = elimination_->expand(w.q, w.values);
    for (Eigen::Index i = 0; i < n; ++i) {
      elongations(i) = evaluate(nth(springs, i).elongation, w.u);
      pulls(i) = force(i) + k(i) * (elongations(i) - at(i));
    }
    const auto per_length = [&](Eigen::Index i) { return nth(springs, i).law.rotation ? 1 / w.length : 1; };
    w.scale = 1e-3 * w.force;
    for (Eigen::Index i = 0; i < n; ++i) w.scale = std::max(w.scale, std::abs(pulls(i)) * per_length(i));
    double change = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      const SpringLaw& law = nth(springs, i).law;
      at(i) = elongation(law, pulls(i));
      k(i) = std::max(std::visit([&](const auto& l) { return l.at_force(pulls(i) + law.preload); }, law), w.floor(i));
      change = std::max(change, std::abs(pulls(i) - force(i)) * per_length(i) / w.scale);
      force(i) = pulls(i);
    }
    if (change < 1e-12) break;
  }
  if (!w.q.allFinite()) w.q.setZero();
  w.u = elimination_->expand(w.q, w.values);
}

/// How far to go along a step: backtrack until the potential falls; where what is to be gained drowns in its rounding,
/// the full step is right.
double Solver::line_search(const Work& w, const VectorX& step) const {
  VectorX ignored;
  const auto at = [&](double length) { return elimination_->expand(w.q + length * step, w.values); };
  const double before = potential(*model_, w.u, w.load);
  const double falls = -step.dot(w.f - elimination_->reduce(internal_forces(*model_, at(0), ignored)));
  const double rounding = 1e-13 * (std::abs(w.load.dot(w.u)) + std::abs(before));
  double length = 1;
  while (length > 1e-6 && std::abs(falls) > rounding) {
    const double after = potential(*model_, at(length), w.load);
    if (after <= before + 1e-4 * length * falls + rounding) break;
    length /= 2;
  }
  return length;
}

bool Solver::newton(Work& w, const NewtonOptions& options, Solution& s) {
  const bool linear = linear_springs();
  double previous_step = std::numeric_limits<double>::infinity();
  VectorX r = w.f - elimination_->reduce(internal_forces(*model_, w.u, w.tangents));
  int here = 0;
  while (here < options.max_iterations) {
    ++s.iterations;
    ++here;
    factor(s.iterations == 1 && !w.begun ? w.loaded : VectorX(w.tangents.cwiseMax(w.floor)));
    const VectorX step = cholesky_->solve(r);
    w.q += (linear ? 1 : line_search(w, step)) * step;
    w.u = elimination_->expand(w.q, w.values);
    const VectorX pulls = elimination_->reduce(internal_forces(*model_, w.u, w.tangents));
    r = w.f - pulls;
    const double size = std::max(largest(w.f) + largest(pulls), w.force);
    s.residual = size > 0 ? largest(r) / size : 0;
    const bool small_step = largest(step) <= options.tolerance * largest(w.q);
    const bool stalled = s.residual < 1e-9 && largest(step) > 0.5 * previous_step;  // rounding is all that is left
    previous_step = largest(step);
    if (small_step || stalled || s.residual == 0 || (linear && here == 3)) return true;
  }
  return false;
}

void Solver::conclude(const Work& w, Solution& s) const {
  s.u = w.u;
  s.fine = w.u.cast<Extended>();
  const std::vector<Spring>& springs = model_->springs;
  s.spring_tangents.resize(std::ssize(springs));
  s.spring_forces = s.spring_tangents;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const SpringLaw& law = springs[i].law;
    const auto k = as_index(i);
    const double d = evaluate(springs[i].elongation, w.u);
    s.spring_forces(k) = force(law, d);
    s.spring_tangents(k) = tangent(law, d);
  }
}

Solution Solver::solve(const VectorX& load, const NewtonOptions& options) {
  return solve(load, constraint_values(*model_), options);
}

Solution Solver::solve(const VectorX& given_load, const VectorX& given_values, const NewtonOptions& options) {
  Work w;
  w.load = padded(given_load, model_->dofs());
  w.values = padded(given_values, std::ssize(model_->constraints));
  if (linear_springs()) return solve_linear(w.load, w.values);
  check(w.load, w.values);
  w.length = characteristic_length(*model_);
  w.f = elimination_->reduce(w.load);
  w.q = VectorX::Zero(elimination_->independent);
  w.u = elimination_->expand(w.q, w.values);
  const std::vector<Spring>& springs = model_->springs;
  if (std::any_of(springs.begin(), springs.end(), [](const Spring& s) { return jumps(s.law); }))
    return solve_condensed(w.load, w.values, options.watched);
  const VectorX first = internal_forces(*model_, w.u, w.tangents);
  w.force = w.scale = std::max(largest(w.load), largest(first));
  Solution s;
  if (w.force == 0) {  // nothing drives it: every spring is at rest
    s.converged = true;
    conclude(w, s);
    return s;
  }
  // A spring at rest may have no stiffness (Hertz). The matrix of a step never takes less than a small part of the
  // stiffness at full load, which slows nothing that carries load and keeps an idle spring from blocking the step.
  w.loaded = starting_tangents(w.force);
  w.floor = 1e-8 * w.loaded;
  if (std::any_of(springs.begin(), springs.end(), [](const Spring& spring) { return steep(spring.law); })) {
    begin_by_forces(w);
    w.begun = true;
  }
  s.converged = newton(w, options, s);
  s.converged = s.converged && std::isfinite(s.residual) && s.residual < 1e-7;
  if (!s.converged && !linear_springs()) return solve_condensed(w.load, w.values, options.watched);
  conclude(w, s);
  return s;
}

}  // namespace deflect::frame
