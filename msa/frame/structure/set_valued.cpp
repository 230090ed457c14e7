// Equilibrium with springs that jump, Solver::solve: the structure condensed to the elongations of the springs that are
// not linear, whose laws are a convex minimisation of few variables (set_valued_laws.h). With K the stiffness of the
// rest, E the elongations' forms and f the load, K u + E s = f. Any stiffness k beside each of these springs makes
// A = K + E k Eᵀ regular, and with o = δ − s/k
//   u = A⁻¹(f + E k o),   δ = Eᵀu = Eᵀ A⁻¹f + (EᵀA⁻¹E) k o.
// k is no error of the result: what it adds is taken away again in o.
#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "msa/base/index.h"
#include "msa/base/settle.h"
#include "msa/frame/elements/jumping_springs.h"
#include "msa/frame/structure/driving.h"
#include "msa/frame/structure/relative.h"
#include "msa/frame/structure/solver.h"

namespace deflect::frame {
namespace {

constexpr double no_force = 1e-11;        // of the load
constexpr double out_of_balance = 1e-11;  // of the forces: what is worth a correction

/// By spring its force at u; the springs `jumping` carry the forces `known`.
VectorX spring_pulls(const std::vector<Spring>& springs, const ExtendedVector& u,
                     const std::vector<std::size_t>& jumping, const VectorX& known) {
  VectorX pulls(std::ssize(springs));
  for (std::size_t i = 0; i < springs.size(); ++i)
    pulls(as_index(i)) = force(springs[i].law, evaluate(springs[i].elongation, u));
  for (Eigen::Index i = 0; i < known.size(); ++i) pulls(as_index(nth(jumping, i))) = known(i);
  return pulls;
}

/// What the springs' `pulls` and the rest of the structure leave of the load, relative; `jumping`: the pulls of the
/// springs that are not linear.
double relative_residual(const Model& m, const Elimination& e, const VectorX& load, const ExtendedVector& u,
                         const VectorX& pulls, const VectorX& jumping) {
  const VectorX f = e.reduce(load);
  const VectorX held = e.reduce(forces_with(m, u, pulls));
  // Stiffness times the rounding of displacements is all that can be asked of forces.
  const double rounding = 1e-15 * contact_stiffness(m) * largest(u.cast<double>());
  const double size = std::max({largest(f) + largest(held), largest(jumping), rounding * 1e8});
  return size > 0 ? largest(VectorX(f - held)) / size : 0;
}

/// Takes the state of law i, that of spring number `at`, into the solution and the force into the spring.
void add_state(const SetValuedSolution& found, Eigen::Index i, std::size_t at, Spring& spring, Solution& s) {
  const int end = nth(found.end, i);
  know_force(spring.law, found.s(i));
  s.spring_tangents(as_index(at)) = tangent_at(spring.law, found.d(i), found.s(i), end);
  if (found.loose.cols() > 0 && found.loose.row(i).cwiseAbs().maxCoeff() > 0) s.loose.push_back(spring.name);
  keep_slips(spring.law, found.d(i), found.s(i), end, s.slips);
}

}  // namespace

struct Solver::Condensed {
  std::vector<std::size_t> springs;  // that are not linear
  VectorX tangents;                  // of all springs; of those, k
  VectorX k;
  ExtendedMatrix u;     // under unit forces in those: A⁻¹E
  MatrixX elongations;  // EᵀA⁻¹E
};

const Solver::Condensed& Solver::condensed() {
  if (condensed_) return *condensed_;
  auto c = std::make_shared<Condensed>();
  const std::vector<Spring>& springs = model_->springs;
  c->tangents = starting_tangents(1);
  for (std::size_t i = 0; i < springs.size(); ++i)
    if (!is_linear(springs[i].law)) c->springs.push_back(i);
  const auto n = std::ssize(c->springs);
  const double length = characteristic_length(*model_), contact = contact_stiffness(*model_);
  MatrixX forces = MatrixX::Zero(model_->dofs(), n);
  c->k.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Spring& spring = springs[nth(c->springs, i)];
    for (const Term& t : spring.elongation) forces(t.dof, i) += t.coefficient;
    c->k(i) = spring.law.rotation ? contact * length * length : contact;
  }
  // First with a k that is stiffer than all else, then with as much as the structure itself resists each elongation.
  const MatrixX values = MatrixX::Zero(std::ssize(model_->constraints), n);
  for (int pass = 0; pass < 2; ++pass) {
    for (Eigen::Index i = 0; i < n; ++i) c->tangents(as_index(nth(c->springs, i))) = c->k(i);
    c->u = linear(c->tangents, forces, values);
    c->elongations.resize(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
      for (Eigen::Index j = 0; j < n; ++j)
        c->elongations(i, j) = evaluate(springs[nth(c->springs, i)].elongation, ExtendedVector(c->u.col(j)));
    if (pass == 1) break;
    for (Eigen::Index i = 0; i < n; ++i)
      if (const double sum = 1 / c->elongations(i, i); sum < 1e12 * c->k(i)) {
        // A friction that slips has no stiffness of its own: digits are kept by one of the structure's size.
        const SpringLaw& law = springs[nth(c->springs, i)].law;
        const bool soft = frictions_soft_ && std::holds_alternative<FrictionSpring>(law);
        c->k(i) = soft ? std::max(sum - c->k(i), 1e-8 * c->k(i)) : sum;
      }
  }
  condensed_ = std::move(c);
  return *condensed_;
}

/// The laws in equilibrium, with limits of frictions that are those of the loads beside them. u0 without offsets.
SetValuedSolution Solver::settled(const LinearRelation& relation, std::vector<ScalarLaw>& laws, const MatrixX& watched,
                                  const ExtendedVector& u0) {
  const Condensed& c = condensed();
  std::vector<std::size_t> growing;  // among the laws
  const auto friction = [&](std::size_t law) {
    return std::get_if<FrictionSpring>(&model_->springs[c.springs[law]].law);
  };
  for (std::size_t i = 0; i < laws.size(); ++i)
    if (friction(i) && friction(i)->share > 0 && friction(i)->beside >= 0) growing.push_back(i);
  if (growing.empty()) return deflect::solve(relation, laws, watched);
  SetValuedSolution found;
  const auto of_loads = [&](const VectorX& tried) -> std::optional<VectorX> {
    for (std::size_t i = 0; i < growing.size(); ++i) {
      friction(growing[i])->most = tried(as_index(i));
      laws[growing[i]] = scalar_law(model_->springs[c.springs[growing[i]]].law);
    }
    found = deflect::solve(relation, laws, watched);
    if (found.outcome != SetValuedSolution::Outcome::solved) return std::nullopt;
    const ExtendedVector u = u0 + c.u * VectorX(c.k.cwiseProduct(found.o)).cast<Extended>();
    const VectorX pulls = spring_pulls(model_->springs, u, c.springs, found.s);
    VectorX out = tried;
    for (std::size_t i = 0; i < growing.size(); ++i) {
      const FrictionSpring& f = *friction(growing[i]);
      out(as_index(i)) = f.own + f.share * std::abs(pulls(f.beside));
    }
    return out;
  };
  VectorX limits(std::ssize(growing));
  double rounding = 0;
  for (std::size_t i = 0; i < growing.size(); ++i) {
    const FrictionSpring& f = *friction(growing[i]);
    limits(as_index(i)) = f.own;
    rounding = std::max(rounding, 1e-14 * f.k * std::abs(f.before));
  }
  if (!settle(limits, of_loads, rounding)) found.outcome = SetValuedSolution::Outcome::undecided;
  return found;
}

/// The offsets with the digits that laws of great stiffness need: Newton on the structure's own displacements in
/// Extended numbers, ends staying as they are. u0 without offsets; forces and elongations follow in `found`.
ExtendedVector Solver::refined(const std::vector<ScalarLaw>& laws, SetValuedSolution& found,
                               const LinearRelation& relation, const ExtendedVector& u0) {
  const Condensed& c = condensed();
  const auto n = std::ssize(laws);
  const VectorX root = c.k.cwiseSqrt();  // units in which k is 1
  const MatrixX P = root.asDiagonal() * relation.P * root.cwiseInverse().asDiagonal();
  ExtendedVector o = found.o.cast<Extended>(), best = o;
  double before = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < 10; ++pass) {
    const ExtendedVector u = u0 + c.u * c.k.cast<Extended>().cwiseProduct(o);
    VectorX lacking(n), d(n), s(n);
    MatrixX J(n, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto at = as_size(i);
      const ScalarLaw& law = laws[at];
      Extended fine = 0;
      for (const Term& t : model_->springs[c.springs[at]].elongation) fine += t.coefficient * u(t.dof);
      const bool bounded = std::isfinite(law.low) || std::isfinite(law.high);
      const bool held = bounded && found.end[at] != 0;
      const double end = found.end[at] > 0 ? law.high : law.low;
      d(i) = held ? end : std::clamp(static_cast<double>(fine), law.low, law.high);
      s(i) = c.k(i) * static_cast<double>(fine - o(i));
      const double t = held ? 0 : law.tangent(d(i)) / c.k(i), weight = 1 / (1 + t);
      lacking(i) =
          held ? root(i) * static_cast<double>(Extended(end) - fine) : weight * (s(i) - law.force(d(i))) / root(i);
      J.row(i) = held ? VectorX(P.row(i)) : VectorX(weight * (t - 1) * P.row(i));
      if (!held) J(i, i) += weight;
    }
    const double now = lacking.norm();
    if (!(now < 0.5 * before)) break;
    before = now;
    best = o;
    found.d = d, found.s = s;
    if (now == 0) break;
    Eigen::CompleteOrthogonalDecomposition<MatrixX> solver;
    solver.setThreshold(1e-11);
    o += VectorX(solver.compute(J).solve(lacking).cwiseQuotient(root)).cast<Extended>();
  }
  return best;
}

/// The offsets of refined(), and u with them. A⁻¹E is known to the rounding of doubles. Where offsets are large, so
/// that k o is far more than any force, that leaves some of the load: A⁻¹ of what is left belongs to u0, as far as it
/// brings the forces nearer to balance.
ExtendedVector Solver::balanced(const std::vector<ScalarLaw>& laws, SetValuedSolution& found,
                                const LinearRelation& relation, ExtendedVector u0, const VectorX& load) {
  const Condensed& c = condensed();
  const VectorX still = VectorX::Zero(std::ssize(model_->constraints));
  ExtendedVector best;
  SetValuedSolution of_best = found;
  double least = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < 3; ++pass) {
    const ExtendedVector offsets = refined(laws, found, relation, u0);
    const ExtendedVector u = u0 + c.u * c.k.cast<Extended>().cwiseProduct(offsets);
    const VectorX pulls = spring_pulls(model_->springs, u, c.springs, found.s);
    const double left = relative_residual(*model_, *elimination_, load, u, pulls, found.s);
    if (pass > 0 && !(left < 0.5 * least)) break;
    best = u, of_best = found, least = left;
    if (left < out_of_balance || !factored_) break;
    const VectorX missing = elimination_->reduce(load - forces_with(*model_, u, pulls));
    u0 += elimination_->expand(cholesky_->solve(missing), still).cast<Extended>();
  }
  found = std::move(of_best);
  return best;
}

Solution Solver::solve_condensed(const VectorX& load, const VectorX& values, const std::vector<int>& watched) {
  const Condensed& c = condensed();
  const std::vector<Spring>& springs = model_->springs;
  const auto n = std::ssize(c.springs);
  ExtendedVector u = linear(c.tangents, load, values);
  const double length = characteristic_length(*model_);
  const Driving by = driving(*model_, load, values);
  LinearRelation relation{c.k.cwiseInverse(), VectorX(n), c.elongations * c.k.asDiagonal(), VectorX(n)};
  std::vector<ScalarLaw> laws;
  MatrixX by_elongation = MatrixX::Zero(std::ssize(watched), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Spring& spring = springs[nth(c.springs, i)];
    relation.d0(i) = evaluate(spring.elongation, u);
    relation.size(i) = by.size(c.k(i), spring.law.rotation ? length : 1);
    laws.push_back(scalar_law(spring.law));
    for (std::size_t w = 0; w < watched.size(); ++w)
      by_elongation(as_index(w), i) = c.k(i) * static_cast<double>(c.u(watched[w], i));
  }
  SetValuedSolution found = settled(relation, laws, by_elongation, u);
  Solution s;
  s.iterations = 1;
  s.converged = found.outcome == SetValuedSolution::Outcome::solved;
  if (found.outcome == SetValuedSolution::Outcome::undecided && frictions_soft_) {
    frictions_soft_ = false;
    condensed_.reset();
    return solve_condensed(load, values, watched);
  }
  if (!s.converged) {
    s.fine = u;
    s.u = u.cast<double>();
    s.spring_tangents = s.spring_forces = VectorX::Zero(std::ssize(springs));
    s.message = reason(found);
    return s;
  }
  u = balanced(laws, found, relation, u, load);
  // A law at its kink has forces whose signs are rounding: it takes the stiffness of a pull, as in the closed form.
  for (Eigen::Index i = 0; i < n; ++i) {
    const double rest = -springs[nth(c.springs, i)].law.preload;
    if (std::abs(found.s(i) - rest) <= no_force * relation.size(i)) found.s(i) = rest;
  }
  const VectorX pulls = spring_pulls(springs, u, c.springs, found.s);
  s.residual = relative_residual(*model_, *elimination_, load, u, pulls, found.s);
  s.converged = std::isfinite(s.residual) && s.residual < 1e-7;
  s.fine = u;
  s.u = u.cast<double>();
  s.spring_forces = pulls;
  s.spring_tangents = c.tangents;
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t spring = nth(c.springs, i);
    add_state(found, i, spring, model_->springs[spring], s);
  }
  s.free = c.u.cast<double>() * c.k.asDiagonal() * found.loose;
  s.least = found.least, s.most = found.most;
  return s;
}

std::string Solver::reason(const SetValuedSolution& found) const {
  const Condensed& c = *condensed_;
  if (found.outcome == SetValuedSolution::Outcome::no_fit)
    return "the parts cannot be assembled: their misfits are larger than the play, and nothing yields";
  for (std::size_t i = 0; i < c.springs.size() && found.outcome == SetValuedSolution::Outcome::overcome; ++i) {
    const Spring& spring = model_->springs[c.springs[i]];
    const auto* friction = std::get_if<FrictionSpring>(&spring.law);
    if (friction && std::abs(found.along(as_index(i))) > 1e-3 * largest(found.along))
      return fmt::format("{} slips at {:.6g} {} and nothing else holds what it lets go", spring.name, friction->most,
                         spring.law.rotation ? "Nm" : "N");
  }
  return "";
}

}  // namespace deflect::frame
