// Equilibrium of a structure whose springs are not linear: Solver::solve.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "msa/frame/solver.h"

namespace deflect::frame {
namespace {

// Of the largest force: a gap that carries less is not loaded.
constexpr double unloaded = 1e-9;

double largest(const VectorX& v) { return v.size() ? v.cwiseAbs().maxCoeff() : 0; }

/// Potential energy −fᵀu + stored; what equilibrium makes stationary. A friction's has what sliding costs.
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
  return jumps(law) || (power && power->n > 1.6);
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
  for (Spring& s : model_->springs)
    if (auto* friction = std::get_if<FrictionSpring>(&s.law)) {
      const auto n = static_cast<std::size_t>(friction->number);
      friction->before = friction->number >= 0 && n < slips.size() ? slips[n] : 0;
    }
}

/// A first state. Each spring is linearised where the force that it got last stands on its law, which meets a gap on
/// the side that closes and a steep law at its load in two steps, however far away that is. Frictions, which have no
/// elongation of their own at the force that they slip at, are linearised where they are.
void Solver::begin_by_forces(Work& w) {
  std::vector<Spring>& springs = model_->springs;
  const auto n = static_cast<Eigen::Index>(springs.size());
  VectorX at = VectorX::Zero(n), force(n), k = w.loaded;
  for (Eigen::Index i = 0; i < n; ++i) {
    SpringLaw& law = springs[static_cast<std::size_t>(i)].law;
    know_force(law, 0);
    if (auto* gap = std::get_if<GapSpring>(&law)) gap->idle = false;
    force(i) = frame::force(law, 0);
  }
  for (int pass = 0; pass < 20; ++pass) {
    VectorX pulls(n), elongations(n);
    for (Eigen::Index i = 0; i < n; ++i)
      pulls(i) = force(i) + k(i) * (evaluate(springs[static_cast<std::size_t>(i)].elongation, w.u) - at(i));
    factor(k);
    w.q += cholesky_->solve(w.f - elimination_->reduce(forces_with(*model_, w.u, pulls)));
    w.u = elimination_->expand(w.q, w.values);
    for (Eigen::Index i = 0; i < n; ++i) {
      elongations(i) = evaluate(springs[static_cast<std::size_t>(i)].elongation, w.u);
      pulls(i) = force(i) + k(i) * (elongations(i) - at(i));
    }
    const auto per_length = [&](Eigen::Index i) {
      return springs[static_cast<std::size_t>(i)].law.rotation ? 1 / w.length : 1;
    };
    w.scale = 1e-3 * w.force;
    for (Eigen::Index i = 0; i < n; ++i) w.scale = std::max(w.scale, std::abs(pulls(i)) * per_length(i));
    double change = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      SpringLaw& law = springs[static_cast<std::size_t>(i)].law;
      if (auto* gap = std::get_if<GapSpring>(&law)) {
        const bool little = std::abs(pulls(i) + law.preload) * per_length(i) <= unloaded * w.scale;
        if (pass == 0 || !little) gap->idle = little;
      }
      double next = pulls(i);
      if (std::holds_alternative<FrictionSpring>(law)) {
        at(i) = elongations(i);
        next = frame::force(law, at(i));
        k(i) = std::max(tangent(law, at(i)), w.floor(i));
      } else {
        at(i) = elongation(law, next);
        k(i) = std::max(std::visit([&](const auto& l) { return l.at_force(next + law.preload); }, law), w.floor(i));
      }
      change = std::max(change, std::abs(next - force(i)) * per_length(i) / w.scale);
      force(i) = next;
      know_force(law, next);
    }
    if (change < 1e-12) break;
  }
  if (!w.q.allFinite()) w.q.setZero();
  w.u = elimination_->expand(w.q, w.values);
}

/// How far to go along a step. Smooth springs: backtrack until the potential falls; where what is to be gained drowns
/// in its rounding, the full step is right. Springs that jump: to where the potential, which is convex, has its
/// minimum.
double Solver::line_search(const Work& w, const VectorX& step) const {
  VectorX ignored;
  const auto at = [&](double length) { return elimination_->expand(w.q + length * step, w.values); };
  const auto slope = [&](double length) {
    return -step.dot(w.f - elimination_->reduce(internal_forces(*model_, at(length), ignored)));
  };
  const double before = potential(*model_, w.u, w.load), falls = slope(0);
  const double rounding = 1e-13 * (std::abs(w.load.dot(w.u)) + std::abs(before));
  double length = 1;
  const bool jump =
      std::any_of(model_->springs.begin(), model_->springs.end(), [](const Spring& s) { return jumps(s.law); });
  if (!jump) {
    while (length > 1e-6 && std::abs(falls) > rounding) {
      const double after = potential(*model_, at(length), w.load);
      if (after <= before + 1e-4 * length * falls + rounding) break;
      length /= 2;
    }
    return length;
  }
  if (std::abs(falls) <= rounding) return 1;
  double low = 0, high = 1, at_low = falls, at_high = slope(1);
  const double enough = 1e-3 * std::abs(falls);
  if (at_high <= enough) return 1;
  for (int i = 0; i < 100; ++i) {
    // Regula falsi (Illinois) once the minimum is known to within a factor.
    length = low == 0 ? high / 16 : (low * at_high - high * at_low) / (at_high - at_low);
    const double here = slope(length);
    if (std::abs(here) <= enough) break;
    if (here > 0) {
      if (high > length && low > 0) at_low /= 2;
      high = length;
      at_high = here;
    } else {
      if (low > 0) at_high /= 2;
      low = length;
      at_low = here;
    }
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

/// λ = f for springs that jump; false where that was so already.
bool Solver::update_known_forces(const Work& w) {
  double lacking = 0;
  for (Spring& s : model_->springs) {
    if (!jumps(s.law)) continue;
    const double d = evaluate(s.elongation, w.u), per_length = s.law.rotation ? 1 / w.length : 1;
    lacking = std::max(lacking, std::abs(unknown_force(s.law, d)) * per_length);
    const double f = force(s.law, d);
    if (auto* gap = std::get_if<GapSpring>(&s.law); gap && gap->idle) {
      if (std::abs(f + s.law.preload) * per_length <= unloaded * w.scale) continue;
      gap->idle = false;
      lacking = w.scale;
    }
    know_force(s.law, f);
  }
  return lacking > 1e-12 * w.scale;  // over the contact stiffness, of no account
}

void Solver::conclude(const Work& w, Solution& s) const {
  s.u = w.u;
  s.fine = w.u.cast<Extended>();
  const std::vector<Spring>& springs = model_->springs;
  s.spring_tangents.resize(static_cast<Eigen::Index>(springs.size()));
  s.spring_forces = s.spring_tangents;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    const SpringLaw& law = springs[i].law;
    const auto k = static_cast<Eigen::Index>(i);
    const double d = evaluate(springs[i].elongation, w.u), t = true_tangent(law, d);
    s.spring_forces(k) = force(law, d);
    s.spring_tangents(k) = t;
    if (const auto* friction = std::get_if<FrictionSpring>(&law); friction && friction->number >= 0) {
      const auto n = static_cast<std::size_t>(friction->number);
      s.slips.resize(std::max(s.slips.size(), n + 1));
      s.slips[n] = friction->slip(d);
      if (!s.converged && friction->slides(d))
        s.message = fmt::format("{} slips at {:.6g} {} and nothing else holds what it lets go", springs[i].name,
                                friction->most, law.rotation ? "Nm" : "N");
    }
  }
}

Solution Solver::solve(const VectorX& load, const NewtonOptions& options) {
  return solve(load, constraint_values(*model_), options);
}

Solution Solver::solve(const VectorX& given_load, const VectorX& given_values, const NewtonOptions& options) {
  Work w;
  w.load = padded(given_load, model_->dofs());
  w.values = padded(given_values, static_cast<Eigen::Index>(model_->constraints.size()));
  if (linear_springs()) return solve_linear(w.load, w.values);
  check(w.load, w.values);
  w.length = characteristic_length(*model_);
  w.f = elimination_->reduce(w.load);
  w.q = VectorX::Zero(elimination_->independent);
  w.u = elimination_->expand(w.q, w.values);
  for (Spring& s : model_->springs) {
    know_force(s.law, 0);
    if (auto* gap = std::get_if<GapSpring>(&s.law)) gap->idle = false;
  }
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
  bool any_steep = false, any_jump = false;
  for (std::size_t i = 0; i < model_->springs.size(); ++i) {
    const SpringLaw& law = model_->springs[i].law;
    any_steep = any_steep || steep(law);
    if (!jumps(law)) continue;
    any_jump = true;
    w.floor(static_cast<Eigen::Index>(i)) *= 1e-4;
  }
  if (any_steep) begin_by_forces(w);
  w.begun = any_steep;
  s.converged = newton(w, options, s);
  for (int round = 0; any_jump && s.converged && round < 60 && update_known_forces(w); ++round)
    s.converged = newton(w, options, s);
  s.converged = s.converged && std::isfinite(s.residual) && s.residual < 1e-7;
  conclude(w, s);
  return s;
}

}  // namespace deflect::frame
