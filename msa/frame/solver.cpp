#include "msa/frame/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "msa/base/error.h"
#include "msa/frame/relative.h"
#include "msa/frame/stability.h"

namespace deflect::frame {
namespace {

// Below this reciprocal condition of the scaled matrix a structure is looked at for motions that nothing holds.
constexpr double suspicious = 1e-12;

double largest(const VectorX& v) { return v.size() ? v.cwiseAbs().maxCoeff() : 0; }

MatrixX padded_rows(const MatrixX& m, std::size_t rows) {
  MatrixX out = MatrixX::Zero(static_cast<Eigen::Index>(rows), m.cols());
  out.topRows(m.rows()) = m;
  return out;
}

}  // namespace

Solver::Solver(Model m) : model_(std::make_unique<Model>(std::move(m))) {
  give_contacts_stiffness(*model_);
  use_relative_motion(*model_);
  prepare();
  if (held_idle_spins()) prepare();
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
}

/// Looks for motions that nothing resists, springs as at 1 N; throws unless all are idle spins, which it holds.
bool Solver::held_idle_spins() {
  if (elimination_->independent == 0) return false;
  const VectorX tangents = starting_tangents(1);
  const std::vector<double> values = assembly_->values(tangents);
  const double condition = cholesky_->factor(values);
  if (condition >= suspicious) {
    factored_tangents_ = tangents;
    factored_ = true;
    return false;
  }
  const std::vector<FreeMotion> motions = free_motions_of(*model_, *elimination_, assembly_->pattern(), values);
  if (motions.empty()) {
    notes_.push_back(explain_condition(*model_, *elimination_, assembly_->pattern(), values, condition));
    return false;
  }
  std::string list;
  std::vector<FreeMotion> refused;
  for (const FreeMotion& motion : motions)
    if (!motion.idle) {
      refused.push_back(motion);
      list += fmt::format("\n  {}: {}", refused.size(), describe(*model_, motion));
    }
  if (!refused.empty()) {
    const std::string what = fmt::format("the structure cannot stand: {} motion{} that nothing resists{}",
                                         refused.size(), refused.size() == 1 ? "" : "s", list);
    throw CannotStand(what, *model_, std::move(refused));
  }
  for (const FreeMotion& motion : motions) {
    hold(*model_, motion);
    idle_.emplace_back(motion.bodies.front().name, motion.u);
    notes_.push_back(fmt::format("{} spins idly about its own axis: harmless, held", motion.bodies.front().name));
  }
  return true;
}

/// An idle spin is harmless only as long as nothing drives it: the constraint that holds it must carry nothing.
void Solver::refuse_driven_spins(const VectorX& load) const {
  for (const auto& [name, motion] : idle_)  // normalised to 1: what else moves with it is rounding
    if (std::abs(load.dot(motion)) > 1e-7 * largest(load))
      throw ModelError(
          fmt::format("{} can spin about its own axis, and the load turns it: take the moment about that axis "
                      "away, or hold the spin at one end",
                      name));
}

void Solver::check(const VectorX& load, const VectorX& values) const {
  check_consistent(*model_, *elimination_, padded(values, static_cast<Eigen::Index>(model_->constraints.size())));
  refuse_driven_spins(padded(load, model_->dofs()));
}

void Solver::factor(const VectorX& tangents) {
  if (factored_ && factored_tangents_ == tangents) return;
  factored_ = false;
  if (elimination_->independent > 0) {
    const std::vector<double> values = assembly_->values(tangents);
    if (cholesky_->factor(values) == 0) {
      std::vector<FreeMotion> motions = free_motions_of(*model_, *elimination_, assembly_->pattern(), values);
      std::string list;
      for (const FreeMotion& motion : motions) list += "\n  " + describe(*model_, motion);
      throw CannotStand("in this state of its springs the structure cannot stand" + list, *model_, std::move(motions));
    }
  }
  factored_tangents_ = tangents;
  factored_ = true;
}

VectorX Solver::starting_tangents(double force) const {
  VectorX k(static_cast<Eigen::Index>(model_->springs.size()));
  for (std::size_t s = 0; s < model_->springs.size(); ++s)
    k(static_cast<Eigen::Index>(s)) = tangent_at_force(model_->springs[s].law, force);
  return k;
}

MatrixX Solver::linear(const VectorX& tangents, const MatrixX& given_loads, const MatrixX& given_values) {
  const MatrixX loads = padded_rows(given_loads, static_cast<std::size_t>(model_->dofs()));
  const MatrixX values = padded_rows(given_values, model_->constraints.size());
  for (Eigen::Index c = 0; c < values.cols(); ++c) check_consistent(*model_, *elimination_, values.col(c));
  for (Eigen::Index c = 0; c < loads.cols(); ++c) refuse_driven_spins(loads.col(c));
  factor(tangents);
  // One step of refinement: the first solution's residual is formed from the elements, not from the assembled matrix.
  MatrixX q = MatrixX::Zero(elimination_->independent, loads.cols());
  for (int pass = 0; pass < 2; ++pass) {
    MatrixX R(elimination_->independent, loads.cols());
    for (Eigen::Index c = 0; c < loads.cols(); ++c) {
      const VectorX u = elimination_->expand(q.col(c), values.col(c));
      R.col(c) = elimination_->reduce(loads.col(c) - tangent_forces(*model_, u, tangents));
    }
    q += cholesky_->solve(R);
  }
  MatrixX U(model_->dofs(), loads.cols());
  for (Eigen::Index c = 0; c < loads.cols(); ++c) U.col(c) = elimination_->expand(q.col(c), values.col(c));
  return U;
}

}  // namespace deflect::frame
