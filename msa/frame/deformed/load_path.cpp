// The way of a structure under a growing load (geometric_solver.h).
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "msa/base/index.h"
#include "msa/frame/deformed/geometric_work.h"
#include "msa/frame/structure/reactions.h"

namespace deflect::frame {
namespace {

constexpr double follows = 0.1;   // Newton's steps, each beside the one before: nothing else can be near
constexpr double balance = 0.25;  // of work and energy in a step
constexpr double of_sums = 100 * std::numeric_limits<double>::epsilon();  // rounding of a sum of up to 100 terms
constexpr int most_iterations = 5000;  // of all steps: a path of ever smaller ones leads nowhere in reasonable time

/// Of forces on the independent freedoms, N; moments over the length.
double size_of_reduced(const VectorX& forces, const Elimination& e, double length) {
  double size = 0;
  for (Eigen::Index i = 0; i < forces.size(); ++i)
    size = std::max(size, std::abs(forces(i)) / (nth(e.dof_of_q, i) % 6 > 2 ? length : 1));
  return size;
}

/// By freedom, the sum of the magnitudes of loads and of the forces of members and springs, which balance there.
VectorX unsigned_forces(const Model& m, const Linearisation& at, const VectorX& loads) {
  VectorX sum = loads.cwiseAbs();
  for (std::size_t i = 0; i < m.beams.size(); ++i) {
    const VectorX forces = at.beams[i].forces.cwiseAbs();
    sum.segment<6>(6 * m.beams[i].a) += forces.head<6>();
    sum.segment<6>(6 * m.beams[i].b) += forces.tail<6>();
  }
  for (std::size_t i = 0; i < at.spring_forms.size(); ++i)
    for (const Term& t : at.spring_forms[i]) sum(t.dof) += std::abs(t.coefficient * at.spring_forces(as_index(i)));
  return sum;
}

double largest_spin(const VectorX& u, std::size_t nodes) {
  double spin = 0;
  for (std::size_t i = 0; i < nodes; ++i) spin = std::max(spin, u.segment<3>(as_index(6 * i + 3)).norm());
  return spin;
}

/// M of a damped fall, by freedom: 1, of rotations length².
VectorX weights_of(const Model& m, double length) {
  VectorX weights = VectorX::Ones(m.dofs());
  for (std::size_t i = 0; i < m.nodes.size(); ++i) weights.segment<3>(as_index(6 * i + 3)).setConstant(length * length);
  return weights;
}

Eigen::SparseMatrix<double> damped(const Model& m, double damping, double length) {
  const VectorX weights = damping * weights_of(m, length);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < m.dofs(); ++i) entries.emplace_back(i, i, weights(i));
  Eigen::SparseMatrix<double> out(m.dofs(), m.dofs());
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace

bool GeometricSolver::balances(const Work& work, const Linearisation& at, const Elimination& e, double factor,
                               const VectorX& unbalanced, const VectorX& gaps) const {
  const VectorX forces = e.reduce(unbalanced), sizes = unsigned_forces(model_, at, factor * work.loads);
  VectorX size = VectorX::Zero(e.independent);
  for (std::size_t dof = 0; dof < e.T.size(); ++dof)
    for (const Term& t : e.T[dof]) size(t.dof) += std::abs(t.coefficient) * sizes(as_index(dof));
  if ((forces.array().abs() > of_sums * size.array()).any()) return false;
  for (std::size_t k = 0; k < active_.size(); ++k) {
    double motion = factor * std::abs(work.values(as_index(active_[k])));
    for (const Term& t : at.forms[active_[k]]) motion += std::abs(t.coefficient * work.shape.path(t.dof));
    if (std::abs(gaps(as_index(k))) > of_sums * motion) return false;
  }
  return true;
}

GeometricSolver::Step GeometricSolver::newton(Work& work, double factor, Geometry geometry) const {
  const VectorX loads = factor * work.loads;
  const Linearisation at = work.linearise(geometry);
  const Model constraints = constrained(at.forms);
  const Elimination e = eliminate(constraints);
  const VectorX gaps = update_forces(work, at, e, constraints, factor);
  Eigen::SparseMatrix<double> K = tangent_stiffness(at, work.lambda, loads);
  if (work.damping > 0) K += damped(model_, work.damping, work.length);
  Step step{std::make_unique<Tangent>(e, K), {}};
  if (work.jump)
    step.unbalanced = size_of_reduced(e.reduce(loads - at.forces), e, work.length) / (factor * work.driving.force);
  if (!step.tangent->regular()) return step;
  VectorX unbalanced = loads - at.forces;
  step.u = step.tangent->solve(unbalanced, gaps);
  if (work.jump) keep_laws(work, at, factor, step, unbalanced);
  step.balanced = balances(work, at, e, factor, unbalanced, gaps);
  return step;
}

/// Springs that jump keep their laws at the end of the step: with the offsets o as unknowns its elongations are
/// δ = δ0 + P o, P = Eᵀ K⁻¹ E k, E the forms of these springs and k their stiffness in K. Their new offsets push too.
void GeometricSolver::keep_laws(Work& work, const Linearisation& at, double factor, Step& step,
                                VectorX& unbalanced) const {
  Work::Jumping& j = work.jumping;
  const auto n = std::ssize(j.springs);
  MatrixX pushes = MatrixX::Zero(model_.dofs(), n);
  const auto elongation = [&](Eigen::Index i, const VectorX& u) {
    return evaluate(at.spring_forms[nth(j.springs, i)], u);
  };
  for (Eigen::Index i = 0; i < n; ++i)
    for (const Term& t : at.spring_forms[nth(j.springs, i)]) pushes(t.dof, i) += t.coefficient * j.k(i);
  const MatrixX moved = step.tangent->solve(pushes, MatrixX::Zero(std::ssize(active_), n));
  LinearRelation relation{j.k.cwiseInverse(), VectorX(n), MatrixX(n, n), VectorX(n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t spring = nth(j.springs, i);
    for (Eigen::Index other = 0; other < n; ++other) relation.P(i, other) = elongation(i, moved.col(other));
    relation.d0(i) = at.elongations(as_index(spring)) + elongation(i, step.u);
    const double arm = model_.springs[spring].law.rotation ? work.length : 1;
    relation.size(i) = factor * work.driving.size(j.k(i), arm);
  }
  relation.d0 -= relation.P * j.o;
  const SetValuedSolution found = deflect::solve(monotone(std::move(relation), j.o, j.laws), j.laws, MatrixX(0, n));
  if (found.outcome != SetValuedSolution::Outcome::solved) {
    step.u.resize(0);
    return;
  }
  step.u += moved * (found.o - j.o);
  unbalanced += pushes * (found.o - j.o);
  j.o = found.o, j.d = found.d, j.s = found.s, j.end = found.end;
  for (Eigen::Index i = 0; i < n; ++i) nth(j.loose, i) = found.loose.cols() > 0 && !found.loose.row(i).isZero(0);
  work.set_offsets();
}

/// An equilibrium was found: whether the path led there, which its energy tells where Newton's method does not. Beyond
/// a buckling load there is one on each side, with nearly the same energy: the path does not lead back on its
/// `tangent`.
bool GeometricSolver::arrived(Work& work, const VectorX& before, const VectorX& tangent, double factor,
                              const GeometricState& state, bool doubtful) const {
  const VectorX moved = work.shape.path - before;
  if (doubtful && !work.jump && !work.falling && tangent.dot(weights_of(model_, work.length).cwiseProduct(moved)) < 0) {
    work.why = "a buckling load is there";
    return false;
  }
  // A law that is not linear shares work otherwise than in halves.
  const bool linear = std::all_of(model_.springs.begin(), model_.springs.end(),
                                  [](const Spring& spring) { return is_linear(spring.law); });
  if (work.jump || work.falling || !linear || !work.by_loads_alone()) return true;
  const double energy = work.stored(work.linearise(Geometry::finite));
  const double done = (state.load_factor + factor) / 2 * work.loads.dot(moved);
  const double gained = energy - work.energy;
  if (doubtful && std::abs(gained - done) > balance * std::max(std::abs(gained), std::abs(done))) {
    work.why = "a limit load is there";
    return false;
  }
  work.energy = energy;
  return true;
}

/// Newton at a part of the load; false leaves the reason in work.why.
bool GeometricSolver::iterate(Work& work, double factor, const GeometricOptions& options, GeometricState& state) const {
  const bool finite = options.geometry == Geometry::finite;
  work.strain(factor);
  if (work.jump && state.load_factor == 0) begin_jumps(work, factor);
  double previous = std::numeric_limits<double>::infinity(), least = previous, halved = previous, slowest = 0;
  int stalls = 0;    // steps in turn, each longer than half of the one before; second order: than the shortest before
  int trembles = 0;  // small steps in turn, none shorter than half of the shortest before
  int balanced = 0;  // states in turn in which rounding is all that the forces lack: the next step is noise
  const VectorX before = work.shape.path;
  VectorX tangent;
  int last = options.max_iterations;
  for (int i = 1; i <= last; ++i) {
    ++state.iterations;
    // At rest a spring has the stiffness that it will have under the load, later no less than a small part of it.
    const bool at_rest = i == 1 && state.load_factor == 0 && !work.jump;
    work.with.least_tangents = at_rest ? stiffness_at(model_, factor * work.force) : work.least_tangents;
    const Step step = newton(work, factor, options.geometry);
    if (step.u.size() == 0) {
      work.why = work.jump ? "the laws that jump have no state there" : "the tangent stiffness is singular";
      return false;
    }
    if (!step.u.allFinite() || (finite && largest_spin(step.u, model_.nodes.size()) > pi / 2)) {
      work.why = "a node would turn by more than a right angle at once";
      return false;
    }
    balanced = step.balanced ? balanced + 1 : 0;
    if (balanced < 2) work.shape.move(step.u);
    if (i == 1) tangent = step.u;
    const double change = size_of(step.u, model_.nodes.size(), work.length);
    const double size = size_of(work.shape.path, model_.nodes.size(), work.length);
    // Rounding is all that is left; of play that floats against hardly any stiffness, that of positions. What hangs in
    // play by forces of second order goes on to tremble: stiffnesses round the forces that move it, the more the less
    // the load. Where all forces balance, it may tremble further.
    // In large steps of stiff members Newton's method gains digits in every other iteration only.
    // Second order takes the K_G of the shape before: its steps shrink by a constant factor, but for one or two where
    // constraints take over forces. Five that are no shorter than the shortest before are rounding.
    stalls = change > (finite ? 0.5 * previous : 0.999 * least) ? stalls + 1 : 0;
    const bool stalled =
        change < 1e-6 * (work.jump ? std::max(size, 1e-5 * work.length) : size) && stalls >= (finite ? 2 : 5);
    const double small = step.unbalanced < 1e-8 ? 1e-4 : 1e-5;
    trembles = work.jump && change < small * size && change > 0.5 * least ? trembles + 1 : 0;
    if (const double larger = std::max(change, previous); !finite && larger < halved / 2) {
      halved = larger;
      last = i + options.max_iterations;
    }
    least = std::min(least, change);
    // Second order takes the forces of constraints from the shape before: that too has to have settled.
    const bool settled = finite || previous <= options.tolerance * size;
    if ((change <= options.tolerance * size && settled) || stalled || trembles >= 5 || balanced >= 2) {
      // Across a buckling or limit load Newton finds equilibria that nothing would stay in.
      const bool stable = !finite || step.tangent->stable();
      if (!stable) work.why = "the equilibrium is unstable there, a buckling or limit load was passed";
      return stable && (!finite || arrived(work, before, tangent, factor, state, slowest > follows));
    }
    if (i > 1 && change > 1e-6 * size && !step.balanced) slowest = std::max(slowest, change / previous);
    previous = change;
  }
  work.why = fmt::format("Newton did not converge in {} iterations", last);
  return false;
}

/// Whether the load drives the softest motion of the state at `factor`, as at a limit load: it is much of the step that
/// the state takes under more load.
bool GeometricSolver::drives(Work& work, double factor, const VectorX& towards) const {
  const Step here = newton(work, factor, Geometry::finite);
  if (here.u.size() == 0) return false;
  const VectorX mass = weights_of(model_, work.length);
  const VectorX none = VectorX::Zero(std::ssize(active_));
  VectorX soft(mass.size());
  for (Eigen::Index i = 0; i < soft.size(); ++i) soft(i) = std::sin(1.0 + static_cast<double>(i));  // of all motions
  for (int i = 0; i < 20; ++i) {
    soft = here.tangent->solve(mass.cwiseProduct(soft), none);
    soft /= std::sqrt(soft.dot(mass.cwiseProduct(soft)));
  }
  return std::abs(soft.dot(mass.cwiseProduct(towards))) > 1e-3 * std::sqrt(towards.dot(mass.cwiseProduct(towards)));
}

/// From the last stable state, at work.shape, to one under the whole load.
bool GeometricSolver::fall(Work& work, const GeometricOptions& options, GeometricState& state) const {
  work.strain(1);
  work.with.least_tangents = work.least_tangents;
  double farthest = size_of(work.shape.path, model_.nodes.size(), work.length) / 4;
  double damping = 0;
  for (int i = 0; i < 1000; ++i) {
    ++state.iterations;
    const VectorX lambda = work.lambda;
    work.damping = damping;
    const Step step = newton(work, 1, Geometry::finite);
    work.damping = 0;
    const bool down = step.u.size() > 0 && step.u.allFinite() && step.tangent->stable();
    const double size = down ? size_of(step.u, model_.nodes.size(), work.length) : 0;
    if (!down || size > farthest) {
      damping = damping > 0 ? 4 * damping : 1e-6 * step.tangent->largest_entry();
      work.lambda = lambda;
      continue;
    }
    work.shape.move(step.u);
    if (damping == 0 && size < farthest / 10) {
      const Shape here = work.shape;
      work.falling = true;
      if (iterate(work, 1, options, state)) return true;
      work.falling = false;
      work.shape = here;
    }
    farthest = std::min(1.2 * farthest, 0.1 * work.length);
    damping = damping < 1e-12 * step.tangent->largest_entry() ? 0 : damping / 3;
  }
  return false;
}

/// From rest to the whole load, or to where that leads.
void GeometricSolver::follow(Work& work, const GeometricOptions& options, GeometricState& state) const {
  const bool finite = options.geometry == Geometry::finite;
  const double largest_step = finite ? 1.0 / std::max(1, options.load_steps) : 1;
  double step = largest_step;
  for (int halved = 0; state.load_factor < 1;) {
    const Shape before = work.shape;
    const VectorX lambda = work.lambda, offsets = work.jumping.o;
    const double factor = state.load_factor + step > 1 - 1e-9 ? 1 : state.load_factor + step;
    if (iterate(work, factor, options, state)) {
      state.load_factor = factor;
      ++state.steps;
      step = std::min(2 * step, largest_step);
      halved = std::max(0, halved - 1);
      continue;
    }
    work.shape = before;
    work.lambda = lambda;
    work.jumping.o = offsets;
    work.set_offsets();
    step /= 2;
    if (state.iterations > most_iterations)
      work.why = fmt::format("in {} iterations it came no further, by ever smaller steps", state.iterations);
    else if (finite && ++halved <= options.halvings)
      continue;
    const double reached = state.load_factor;
    if (finite && !work.jump && reached > 0) {
      work.strain(1);
      const Step on = newton(work, 1, Geometry::finite);
      work.strain(reached);
      if (on.u.size() > 0 && drives(work, reached, on.u)) {
        if (fall(work, options, state)) {
          state.load_factor = 1;
          state.snaps_at = reached;
          state.message =
              fmt::format("the structure snaps through at {:.4g} of the load: this state is behind the jump", reached);
          return;
        }
        work.why = "it gives way there, and no state was found that it comes to rest in";
        work.shape = before;
        work.lambda = lambda;
      }
    }
    state.converged = false;
    state.message = fmt::format("no equilibrium was found beyond {:.4g} of the load: {}", reached, work.why);
    return;
  }
}

}  // namespace deflect::frame
