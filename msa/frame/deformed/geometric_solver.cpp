#include "msa/frame/deformed/geometric_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/deformed/geometric_work.h"
#include "msa/frame/structure/relative.h"
#include "msa/frame/structure/stability.h"

namespace deflect::frame {
namespace {

constexpr double poor = 1e-12;  // reciprocal condition: to the rounding of a solution this adds as much

}  // namespace

/// Springs that jump begin where the linear theory has them under this part of the load, and the shape with them.
void GeometricSolver::begin_jumps(Work& work, double factor) const {
  const Model& m = linear_->model();
  VectorX loads = padded(factor * work.loads.head(model_.dofs()), m.dofs());
  for (std::size_t e = 0; e < m.beams.size(); ++e) {
    const Beam& beam = m.beams[e];
    const Vector3 push = beam.rigidity.EA * factor * work.strains[e] * beam.R_WM.col(0);
    if (beam.relative < 0) loads.segment<3>(6 * beam.a) -= push;
    loads.segment<3>(beam.relative < 0 ? 6 * beam.b : beam.relative) += push;
  }
  const Solution s = linear_->solve(loads, VectorX(factor * padded(work.values, std::ssize(m.constraints))));
  work.jumping.o.setZero();
  work.shape = Shape(model_);
  if (s.converged) {
    work.shape.move(s.u.head(model_.dofs()));
    for (std::size_t j = 0; j < work.jumping.springs.size(); ++j) {
      const std::size_t spring = work.jumping.springs[j];
      const auto i = as_index(j);
      work.jumping.o(i) =
          evaluate(m.springs[spring].elongation, s.fine) - s.spring_forces(as_index(spring)) / work.jumping.k(i);
    }
  }
  work.set_offsets();
}

/// The springs that jump with the slips of the linear model, at rest.
void GeometricSolver::take_jumps(Work& work) const {
  if (!work.jump) return;
  const double contact = contact_stiffness(model_);
  std::vector<double> k;
  for (std::size_t i = 0; i < model_.springs.size(); ++i) {
    const SpringLaw& law = linear_->model().springs[i].law;
    if (!jumps(law)) continue;
    work.jumping.springs.push_back(i);
    work.jumping.laws.push_back(scalar_law(law));
    // Where the law itself yields, so much: what is stiffer turns the rounding of elongations into forces.
    double least = contact * (law.rotation ? work.length * work.length : 1);
    for (const double force : {1.0, -1.0}) {
      const double own = std::visit([force](const auto& l) { return l.at_force(force); }, model_.springs[i].law);
      if (own > 0) least = std::min(least, own);
    }
    k.push_back(least);
  }
  const auto n = std::ssize(k);
  work.jumping.k = Eigen::Map<const VectorX>(k.data(), n);
  work.jumping.o = work.jumping.d = work.jumping.s = VectorX::Zero(n);
  work.jumping.end.assign(k.size(), 0);
  work.jumping.loose.assign(k.size(), 0);
  work.set_offsets();
}

/// Springs that jump by the stiffness that they have in the state, at its forces; rigid ones keep that of the steps.
void GeometricSolver::release_jumps(Work& work, GeometricState& state) const {
  state.jumping.clear();
  for (const Spring& spring : model_.springs) state.jumping.push_back(spring.law);
  for (std::size_t j = 0; j < work.jumping.springs.size(); ++j) {
    const std::size_t spring = work.jumping.springs[j];
    const auto i = as_index(j);
    const SpringLaw& law = linear_->model().springs[spring].law;
    const double d = work.jumping.d(i), s = work.jumping.s(i);
    const int end = work.jumping.end[j];
    const double k = tangent_at(law, d, s, end);
    state.jumping[spring] = law;
    know_force(state.jumping[spring], s);
    work.jumping.k(i) = std::isinf(k) ? work.jumping.k(i) : k;
    SpringLaw& linear = work.structure.springs[spring].law;
    linear = LinearSpring{work.jumping.k(i)};
    linear.preload = work.jumping.k(i) * d - s;
    keep_slips(law, d, s, end, state.slips);
    if (work.jumping.loose[j]) state.loose.push_back(model_.springs[spring].name);
  }
}

/// The nodes in a state, where nothing but what is held or rigid moves them: closed gaps are constraints.
Model GeometricSolver::held(const GeometricState& state) const {
  Model m = constrained(state.forms);
  for (std::size_t i = 0; i < state.jumping.size(); ++i)
    if (std::isinf(true_tangent(state.jumping[i], state.elongations(as_index(i)))))
      m.constraints.push_back({state.spring_forms[i], 0, model_.springs[i].name});
  return m;
}

GeometricSolver::GeometricSolver(Model given)
    : linear_(std::make_unique<Solver>(given)), model_(std::move(given)), notes_(linear_->notes()) {
  give_contacts_stiffness(model_);
  std::vector<char> redundant(model_.constraints.size(), 0);
  for (const Redundancy& r : linear_->elimination().redundant)
    if (const auto k = as_size(r.constraint); k < redundant.size()) redundant[k] = 1;
  const std::vector<Constraint>& solved = linear_->model().constraints;
  model_.constraints.insert(model_.constraints.end(), solved.end() - as_index(linear_->idle_motions()), solved.end());
  redundant.resize(model_.constraints.size(), 0);
  for (std::size_t k = 0; k < redundant.size(); ++k)
    if (!redundant[k]) active_.push_back(k);
}

/// The nodes with the constraints as they are in a shape, redundant ones left out.
Model GeometricSolver::constrained(const std::vector<LinearForm>& forms) const {
  Model m;
  m.nodes = model_.nodes;
  m.scalars = model_.scalars;
  for (const std::size_t k : active_) m.constraints.push_back({forms[k], 0, model_.constraints[k].name});
  return m;
}

/// The size of the forces that prescribed values bring, were nothing else to move.
double GeometricSolver::driving_force(const Linearisation& rest, const VectorX& values) const {
  const Elimination e = eliminate(constrained(rest.forms));
  VectorX active(std::ssize(active_)), ignored;
  for (std::size_t k = 0; k < active_.size(); ++k) active(as_index(k)) = values(as_index(active_[k]));
  return largest(internal_forces(model_, e.expand(VectorX::Zero(e.independent), active), ignored));
}

/// The forces of constraints under a part of the load, in work.lambda; returns what their values lack.
VectorX GeometricSolver::update_forces(Work& work, const Linearisation& at, const Elimination& e,
                                       const Model& constraints, double factor) const {
  const VectorX forces = Reactions(constraints, e).forces(at.forces - factor * work.loads);
  VectorX gaps(std::ssize(active_));
  for (std::size_t k = 0; k < active_.size(); ++k) {
    const auto c = as_index(active_[k]), i = as_index(k);
    work.lambda(c) = forces(i);
    gaps(i) = factor * work.values(c) - at.values(c);
  }
  return gaps;
}

/// What is known of the shape that was reached.
/// What second order leaves out, relative to the displacement: the square of the largest rotation, and the largest
/// strain of a member's axis.
double left_out_in_second_order(const Model& m, const GeometricState& state) {
  double rotation = 0, strain = 0;
  for (Eigen::Index node = 0; node < std::ssize(m.nodes); ++node)
    rotation = std::max(rotation, state.u.segment<3>(6 * node + 3).norm());
  for (std::size_t i = 0; i < m.beams.size(); ++i)
    strain = std::max(
        strain, std::abs(m.beams[i].R_WM.col(0).dot(state.beams[i].forces.segment<3>(6))) / m.beams[i].rigidity.EA);
  return rotation * rotation + strain;
}

void GeometricSolver::conclude(Work& work, GeometricState& state) const {
  const VectorX loads = state.load_factor * work.loads;
  work.strain(state.load_factor);
  work.with.least_tangents = work.least_tangents;
  Linearisation at = work.linearise(state.geometry);
  const Model constraints = constrained(at.forms);
  const Elimination e = eliminate(constraints);
  const VectorX gaps = update_forces(work, at, e, constraints, state.load_factor);
  state.K = tangent_stiffness(at, work.lambda, loads);
  const Tangent tangent(e, state.K);
  state.stable = tangent.stable();
  const VectorX lacking = e.reduce(loads - at.forces);
  for (Eigen::Index i = 0; i < lacking.size(); ++i)
    if (const int dof = nth(e.dof_of_q, i); dof < 6 * std::ssize(model_.nodes) && dof % 6 < 3)
      if (std::abs(lacking(i)) > state.unbalanced)
        state.unbalanced = std::abs(lacking(i)), state.unbalanced_node = dof / 6;
  if (const double size = size_of(work.shape.path, model_.nodes.size(), work.length);
      size > 0 && tangent.regular() && !balances(work, at, e, state.load_factor, loads - at.forces, gaps))
    state.residual = size_of(tangent.solve(loads - at.forces, gaps), model_.nodes.size(), work.length) / size;
  if (work.jump) release_jumps(work, state);
  if (work.jump || (at.spring_tangents.array() <= work.least_tangents.array()).any()) {  // without the floor
    work.with.least_tangents.setZero();
    at = work.linearise(state.geometry);
    state.K = tangent_stiffness(at, work.lambda, loads);
  }
  state.u = state.geometry == Geometry::finite ? work.shape.displacements() : work.shape.path;
  state.constraint_forces = work.lambda;
  state.elongations = at.elongations;
  state.spring_forces = at.spring_forces;
  state.spring_tangents = at.spring_tangents;
  for (std::size_t i = 0; i < at.beams.size() && state.geometry == Geometry::finite; ++i) {
    const LeftOut left = left_out(model_.beams[i], at.beams[i].forces, at.beams[i].A.col(0));
    state.left_out.relative = std::max(state.left_out.relative, left.relative);
    state.left_out.twist += left.twist;
  }
  state.beams = std::move(at.beams);
  if (state.geometry == Geometry::second_order) state.left_out.relative = left_out_in_second_order(model_, state);
  state.forms = std::move(at.forms);
  state.spring_forms = std::move(at.spring_forms);
  for (const auto& [part, energy] : energies(model_, state)) state.energy += energy;
  // A constraint that others implied in the undeformed shape may say more in this one.
  for (std::size_t k = 0, a = 0; state.converged && k < model_.constraints.size(); ++k) {
    if (a < active_.size() && active_[a] == k) {
      ++a;
      continue;
    }
    const auto c = as_index(k);
    if (std::abs(at.values(c) - state.load_factor * work.values(c)) > 1e-7 * work.length) {
      state.converged = false;
      state.message = fmt::format(
          "constraint '{}', which others implied in the undeformed shape, does not hold in the "
          "displaced one",
          model_.constraints[k].name);
    }
  }
}

/// Where nothing was found because stiffnesses are too far apart for doubles: a sentence to add that says so. At rest,
/// where the structure stands: what is not positive definite there is rounding.
std::string GeometricSolver::lost_digits(const Work& work, Geometry geometry) const {
  const Shape rest(model_);
  const VectorX none = VectorX::Zero(std::ssize(model_.constraints));
  const StructureConditions with{std::vector<double>(model_.beams.size(), 0), stiffness_at(model_, work.force),
                                 work.with.first_hold};
  const Linearisation at = geometry == Geometry::finite ? linearise_finite(work.structure, rest, with)
                                                        : linearise_second_order(work.structure, rest, none, with);
  const Tangent tangent(eliminate(constrained(at.forms)), tangent_stiffness(at, none, VectorX::Zero(model_.dofs())));
  const Tangent::Softest softest = tangent.softest();
  if (softest.condition > poor || softest.u.size() == 0) return "";
  return ". In the deformed shape " + explain_condition(model_, softest.u, softest.condition);
}

GeometricState GeometricSolver::solve(const GeometricLoad& load, const GeometricOptions& options) {
  const auto constraints = std::ssize(model_.constraints);
  const auto held = as_index(linear_->idle_motions());
  Work work(model_);
  work.loads = padded(load.forces, model_.dofs());
  work.values = load.values.size() ? padded(load.values, constraints) : constraint_values(model_);
  work.strains = load.strains;
  work.strains.resize(model_.beams.size(), 0);
  work.with.strains = work.strains;
  work.driving = driving(model_, work.loads, work.values);
  for (std::size_t e = 0; e < model_.beams.size(); ++e)
    work.driving.force = std::max(work.driving.force, model_.beams[e].rigidity.EA * std::abs(work.strains[e]));
  work.with.first_hold = as_size(constraints - held);
  linear_->check(work.loads, work.values.head(constraints - held));
  work.with.least_tangents = VectorX::Zero(std::ssize(model_.springs));
  GeometricState state;
  state.geometry = options.geometry;

  // The forces that springs will see set where their stiffness begins and how little of it a step takes (solver.cpp).
  linear_->begin_slips(options.slips);
  linear_->begin_limits(options.limits);
  take_jumps(work);
  const Linearisation rest = work.linearise(options.geometry);
  double force = std::max(largest(work.loads), largest(rest.forces));
  if (force == 0 && largest(work.values) > 0) force = driving_force(rest, work.values);
  if (force == 0)  // what earlier loads left
    for (const Spring& spring : linear_->model().springs)
      if (std::holds_alternative<FrictionSpring>(spring.law) || std::holds_alternative<TableSpring>(spring.law))
        force = std::max(force, std::abs(frame::force(spring.law, 0)));
  work.force = force;
  work.least_tangents = 1e-8 * stiffness_at(model_, force);
  for (const std::size_t i : work.jumping.springs) work.least_tangents(as_index(i)) = 0;

  const bool driven = force > 0 || largest(work.values) > 0;
  state.converged = true;
  if (driven)
    follow(work, options, state);
  else
    state.load_factor = 1;
  conclude(work, state);
  if (state.message.empty() && !state.stable)
    state.message = options.geometry == Geometry::finite
                        ? "the equilibrium is unstable"
                        : "the load is beyond the first buckling load: K_E + K_G is not positive definite";
  if (!state.converged || !state.stable) state.message += lost_digits(work, options.geometry);
  return state;
}

NodeStiffness GeometricSolver::stiffness(const GeometricState& state, int node) const {
  Model m = held(state);
  const auto first = std::ssize(m.constraints);
  m.fix(node, "held");
  const Elimination e = eliminate(m);
  const Tangent tangent(e, state.K);
  if (!tangent.regular())
    throw ModelError(fmt::format("with node '{}' held, the rest of the structure has no stiffness in this state",
                                 nth(model_.nodes, node).name));
  MatrixX values = MatrixX::Zero(first + 6, 6);
  values.bottomRows<6>().setIdentity();
  const MatrixX moved = tangent.solve(MatrixX::Zero(m.dofs(), 6), values);
  const MatrixX sizes = moved.cwiseAbs();
  const Eigen::SparseMatrix<double> K = state.K.cwiseAbs();
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  return {Reactions(m, e).forces(state.K * moved).bottomRows<6>(), epsilon * (sizes.transpose() * (K * sizes))};
}

MatrixX GeometricSolver::response(const GeometricState& state, const MatrixX& loads) const {
  const Model m = held(state);
  const Tangent tangent(eliminate(m), state.K);
  if (!tangent.regular()) throw ModelError("in this state the structure has no stiffness against some motion");
  MatrixX all = MatrixX::Zero(m.dofs(), loads.cols());
  all.topRows(loads.rows()) = loads;
  return tangent.solve(all, MatrixX::Zero(std::ssize(m.constraints), loads.cols()));
}

}  // namespace deflect::frame
