#include "msa/frame/structure/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/structure/extended_structure.h"
#include "msa/frame/structure/relative.h"
#include "msa/frame/structure/stability.h"
#include "msa/frame/structure/standing.h"

namespace deflect::frame {
namespace {

// A smallest eigenvalue of the scaled matrix above this is no rounding of 0, of any matrix that fits into memory.
constexpr double sound = 1e-8;
constexpr double poor = 1e-12;        // of which a user is told
constexpr double nearly_free = 1e-6;  // strain of a motion, see mobility.h

constexpr int most_corrections = 20;
constexpr double extended_rounding = 1e-19, no_digits = 1e-9;
constexpr double strains_nothing = 1e-24, is_no_strain = 1e-26;  // of the energy that nothing would cancel
constexpr double few_digits_lost = 1e-13;                        // of a plain solution, in energy

MatrixX padded_rows(const MatrixX& m, std::size_t rows) {
  MatrixX out = MatrixX::Zero(as_index(rows), m.cols());
  out.topRows(m.rows()) = m;
  return out;
}

/// Whether Tᵀf is what rounding leaves where every force is taken by constraints.
bool is_rounding(const VectorX& reduced, const Elimination& e, const VectorX& f) {
  VectorX unsigned_sum = VectorX::Zero(e.independent);
  for (std::size_t dof = 0; dof < e.T.size(); ++dof)
    for (const Term& t : e.T[dof]) unsigned_sum(t.dof) += std::abs(t.coefficient * f(as_index(dof)));
  return (reduced.array().abs() <= 1e-14 * unsigned_sum.array()).all();
}

/// u K u, by elements.
double twice_energy(const Model& m, const ExtendedVector& u, const VectorX& tangents) {
  double sum = 0;
  for (const Beam& beam : m.beams) {
    const Vector12 d = end_displacements(beam, u);
    sum += d.dot(pull(beam, d));
  }
  for (std::size_t s = 0; s < m.springs.size(); ++s) {
    const double elongation = evaluate(m.springs[s].elongation, u);
    sum += tangents(as_index(s)) * elongation * elongation;
  }
  return sum;
}

/// What u K u would be, were nothing to cancel: an answer that strains the structure by less than the rounding of this
/// strains nothing.
double unsigned_energy(const Model& m, const ExtendedVector& u, const VectorX& tangents) {
  const VectorX size = u.cast<double>().cwiseAbs();
  double sum = 0;
  for (const Beam& beam : m.beams) sum += stiffness(beam).diagonal().dot(end_displacements(beam, size).cwiseAbs2());
  for (std::size_t s = 0; s < m.springs.size(); ++s) {
    double elongation = 0;
    for (const Term& t : m.springs[s].elongation) elongation += std::abs(t.coefficient) * size(t.dof);
    sum += tangents(as_index(s)) * elongation * elongation;
  }
  return sum;
}

}  // namespace

Solver::Solver(Model m) : model_(std::make_unique<Model>(std::move(m))) {
  give_contacts_stiffness(*model_);
  use_relative_motion(*model_);
  hold(loose_pieces(*model_, resisting(starting_tangents(1))));
  prepare();
  if (hold_idle_motions()) prepare();
  note_condition();
  for (std::string& note : idle_notes(*model_, idle_)) notes_.push_back(std::move(note));
  for (std::string& note : redundancies(*model_, *elimination_)) notes_.push_back(std::move(note));
}

std::pair<Model, Elimination> Solver::structure() && { return {std::move(*model_), std::move(*elimination_)}; }

bool Solver::linear_springs() const {
  return std::all_of(model_->springs.begin(), model_->springs.end(), [](const Spring& s) { return is_linear(s.law); });
}

void Solver::prepare() {
  elimination_ = std::make_unique<Elimination>(eliminate(*model_));
  check_consistent(*model_, *elimination_, constraint_values(*model_));
  assembly_ = std::make_unique<Assembly>(*model_, *elimination_);
  cholesky_ = std::make_unique<SparseCholesky>(assembly_->pattern());
  factored_ = false;
  extended_.reset();
}

std::vector<char> Solver::resisting(const VectorX& tangents) const {
  std::vector<char> out;
  for (const double k : tangents) out.push_back(k > 0);
  return out;
}

void Solver::hold(std::vector<IdleMotion> motions) {
  for (IdleMotion& motion : motions) {
    model_->constraints.push_back({motion.hold, 0, "idle motion"});
    idle_.push_back(std::move(motion));
  }
}

/// Looks for motions that nothing resists, springs as at 1 N; throws unless all are idle, which it holds: then the
/// structure has changed. A structure that its connections prove to stand has none. The stiffness matrix is not asked:
/// what resists a free motion in it is rounding, of whatever size.
bool Solver::hold_idle_motions() {
  if (elimination_->independent == 0 || not_proved_standing(*model_).empty()) return false;
  Mobility mobility = mobility_of(*model_, resisting(starting_tangents(1)));
  if (const auto n = mobility.free.cols(); n > 0)
    throw CannotStand(fmt::format("the structure cannot stand: {} motion{} that nothing resists", n, n == 1 ? "" : "s"),
                      *model_, mobility.free);
  if (mobility.smallest_held < nearly_free && mobility.softest.size() > 0)
    notes_.push_back(fmt::format("the structure is nearly a mechanism: {} with a strain of {:.0e} of its size",
                                 describe(*model_, free_motions_of(*model_, mobility.softest).front()),
                                 mobility.smallest_held));
  const bool held = !mobility.idle.empty();
  hold(std::move(mobility.idle));
  return held;
}

/// What a user should know of stiffnesses that leave few digits.
void Solver::note_condition() {
  if (elimination_->independent == 0) return;
  factored_tangents_ = starting_tangents(1);
  std::vector<double> values = assembly_->values(factored_tangents_);
  const double condition = cholesky_->factor(values);
  factored_ = condition > 0;
  if (condition > poor) return;
  if (!factored_) {  // what is softest shows beside a little of the diagonal
    const SparsePattern& p = assembly_->pattern();
    for (int j = 0; j < p.n; ++j) nth(values, nth(p.column_start, j)) *= 1 + 1e-13;
    if (cholesky_->factor(values) == 0) return;
  }
  const SparseCholesky::Softest softest = cholesky_->softest();
  notes_.push_back(explain_condition(
      *model_, elimination_->expand(softest.motion, VectorX::Zero(std::ssize(model_->constraints))), condition));
}

/// An idle motion is harmless only as long as nothing drives it: the constraint that holds it must carry nothing.
void Solver::refuse_driven_motions(const VectorX& load) const {
  const double most = largest(load);
  for (const IdleMotion& motion : idle_) {
    double work = 0, size = 0;
    for (const Term& t : motion.u) {
      work += t.coefficient * load(t.dof);
      size = std::max(size, std::abs(t.coefficient));
    }
    if (std::abs(work) > 1e-7 * most * size)
      throw ModelError(
          fmt::format("{}, and the load drives this motion, which nothing resists: take that part of the load away, "
                      "or hold the motion",
                      name_of(*model_, motion)));
  }
}

void Solver::check(const VectorX& load, const VectorX& values) const {
  check_consistent(*model_, *elimination_, padded(values, std::ssize(model_->constraints)));
  refuse_driven_motions(padded(load, model_->dofs()));
}

/// For linear(), which can do without: factored_ says whether the sparse factor exists.
void Solver::try_to_factor(const VectorX& tangents) {
  if (factored_ && factored_tangents_ == tangents) return;
  factored_tangents_ = tangents;
  factored_ = elimination_->independent == 0 || cholesky_->factor(assembly_->values(tangents)) > 0;
  if (factored_) return;
  const Mobility mobility = mobility_of(*model_, resisting(tangents));
  if (mobility.free.cols() > 0)
    throw CannotStand("in this state of its springs the structure cannot stand", *model_, mobility.free);
}

void Solver::factor(const VectorX& tangents) {
  try_to_factor(tangents);
  if (!factored_)
    throw NumericalError(
        "the stiffness matrix cannot be factored: the stiffnesses of its parts, or its geometry, leave no digits");
}

VectorX Solver::starting_tangents(double force) const {
  VectorX k(std::ssize(model_->springs));
  for (std::size_t s = 0; s < model_->springs.size(); ++s)
    k(as_index(s)) = tangent_at_force(model_->springs[s].law, force);
  return k;
}

ExtendedMatrix Solver::linear(const VectorX& tangents, const MatrixX& given_loads, const MatrixX& given_values) {
  const MatrixX loads = padded_rows(given_loads, as_size(model_->dofs()));
  const MatrixX values = padded_rows(given_values, model_->constraints.size());
  for (Eigen::Index c = 0; c < values.cols(); ++c) check_consistent(*model_, *elimination_, values.col(c));
  for (Eigen::Index c = 0; c < loads.cols(); ++c) refuse_driven_motions(loads.col(c));
  try_to_factor(tangents);
  ExtendedMatrix U(model_->dofs(), loads.cols());
  for (Eigen::Index c = 0; c < loads.cols(); ++c) U.col(c) = refined(tangents, loads.col(c), values.col(c));
  return U;
}

/// By the sparse factor and corrections where that loses few digits, else with extended digits throughout.
ExtendedVector Solver::refined(const VectorX& tangents, const VectorX& load, const VectorX& values) {
  ExtendedVector u;
  double lost = 1, left = 1;
  const bool found = factored_ && corrected(tangents, load, values, u, lost, left);
  if (found && lost < few_digits_lost) return u;
  if (elimination_->independent <= ExtendedStructure::most_freedoms) {
    if (!extended_ || extended_tangents_ != tangents) {
      extended_ = std::make_shared<const ExtendedStructure>(*model_, *elimination_, tangents);
      extended_tangents_ = tangents;
    }
    if (std::optional<ExtendedVector> fine = extended_->solve(load, values)) return *fine;
  }
  if (found) return u;
  if (factored_ && (tangents.array() == 0).any()) {
    // Springs that let go leave motions that nothing resists. They take no part: what the first step and its correction
    // say of them is as good as anything.
    VectorX q = VectorX::Zero(elimination_->independent);
    for (int pass = 0; pass < 2; ++pass)
      q += cholesky_->solve(
          elimination_->reduce(load - tangent_forces(*model_, elimination_->expand(q, values), tangents)));
    return elimination_->expand(q, values).cast<Extended>();
  }
  throw NumericalError(fmt::format(
      "no digits are left: corrections to the solution stay at {:.1e} of it. Stiffnesses differ by too much, or the "
      "structure is nearly a mechanism",
      left));
}

/// Corrections are measured in energy, |dq|² = dq·r for the residual r, against that of the answer: `lost` is the first
/// of them, `left` the last; false where that says that u is worth nothing.
bool Solver::corrected(const VectorX& tangents, const VectorX& load, const VectorX& values, ExtendedVector& u,
                       double& lost, double& left) {
  ExtendedVector q = ExtendedVector::Zero(elimination_->independent);
  u = elimination_->expand_fine(q, values);
  double before = 1;
  for (int pass = 0; pass < most_corrections; ++pass) {
    const VectorX unbalanced = load - tangent_forces(*model_, u, tangents);
    const VectorX residual = elimination_->reduce(unbalanced);
    if (pass == 0 && is_rounding(residual, *elimination_, unbalanced)) {
      lost = 0;
      return true;
    }
    const VectorX correction = cholesky_->solve(residual);
    q += correction.cast<Extended>();
    u = elimination_->expand_fine(q, values);
    if (pass == 0) continue;
    const double energy = twice_energy(*model_, u, tangents), corrects = std::abs(correction.dot(residual));
    const double change = energy > 0 ? std::sqrt(corrects / energy) : 0;
    if (pass == 1) {
      lost = energy > is_no_strain * unsigned_energy(*model_, u, tangents) ? std::min(change, 1.0) : 0;
      rounding_ = std::max(rounding_, lost);
    }
    const double shrinks = change / before;
    left = before = change;
    if (change * shrinks < extended_rounding) return true;
    if (pass == 1 || shrinks < 0.5) continue;
    // The residual's own rounding is left, or the factor is worth nothing.
    return left < no_digits || corrects < strains_nothing * unsigned_energy(*model_, u, tangents);
  }
  return left < no_digits;
}

/// Where no spring's stiffness depends on its load.
Solution Solver::solve_linear(const VectorX& load, const VectorX& values) {
  const VectorX tangents = starting_tangents(1);
  Solution s;
  s.fine = linear(tangents, load, values);
  s.u = s.fine.cast<double>();
  s.iterations = 1;
  s.converged = true;
  s.spring_tangents = tangents;
  s.spring_forces.resize(tangents.size());
  for (std::size_t i = 0; i < model_->springs.size(); ++i) {
    const auto k = as_index(i);
    s.spring_forces(k) = tangents(k) * evaluate(model_->springs[i].elongation, s.fine);
  }
  return s;
}

}  // namespace deflect::frame
