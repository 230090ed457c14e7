#include <algorithm>

#include "analytic/model.h"
#include "msa/base/index.h"

namespace deflect::analytic {

/// Under unit loads and one kelvin, each law held by its compliance alone.
AnalyticModel::Between AnalyticModel::between(const Imposed& imposed) const {
  ChainConditions under;
  for (Eigen::Index i = 0; i < imposed.c.size(); ++i) under.steps.push_back({0, imposed.c(i), false});
  Between out{MatrixX(imposed.c.size(), 7),
              Matrix67(),
              std::vector<Matrix67>(legs_.branches.size()),
              imposed,
              {stepped_, imposed}};
  for (Eigen::Index k = 0; k < 7; ++k) {
    const Vector6 F = k < 6 ? Vector6(Vector6::Unit(k)) : Vector6(Vector6::Zero());
    under.warmer = k < 6 ? 0 : 1;
    const AnalyticSolution s = equilibrium_under(F, under);
    VectorX forces = VectorX::Zero(imposed.c.size());
    for (std::size_t l = 0; l < s.leg_wrenches.size(); ++l) {
      legs_.branches[l].add_step_forces(s.leg_wrenches[l], under, forces);
      out.wrenches[l].col(k) = s.leg_wrenches[l];
    }
    through_.add_step_forces(F, under, forces);
    out.forces.col(k) = forces;
    out.displacement.col(k) = s.displacement;
  }
  return out;
}

/// Made on first use.
AnalyticModel::Between& AnalyticModel::linear_response() const {
  if (!imposed_) {
    ChainConditions under;
    imposed_ = std::make_shared<Imposed>(imposed_on(
        stepped_, [&](const std::vector<Step>& steps) { return under_steps(Vector6::Zero(), under, steps, 0); }));
  }
  if (!between_) between_ = std::make_shared<Between>(between(*imposed_));
  return *between_;
}

/// With no offsets on the laws.
SteppedForces AnalyticModel::held_under(const Between& b, const Vector6& F, const Conditions& conditions) const {
  const double length = legs_.length;
  const auto size = [length](const Vector6& w) { return std::max(w.head<3>().norm(), w.tail<3>().norm() / length); };
  Vector7 driving;
  driving << F, conditions.warmer;
  SteppedForces out{b.forces * driving, b.displacement * driving, std::max(size(F), held_without_load(conditions)),
                    length, true};
  for (const Matrix67& W : b.wrenches) out.largest = std::max(out.largest, size(W * driving));
  return out;
}

std::vector<Step> AnalyticModel::held_at(const VectorX& offsets) const {
  std::vector<Step> steps;
  for (Eigen::Index i = 0; i < offsets.size(); ++i) steps.push_back({offsets(i), between_->known.c(i), false});
  return steps;
}

/// Whether these are the forces with the laws at these offsets: that the rest of the mechanism is linear.
bool AnalyticModel::agrees(const Vector6& F, double warmer, const VectorX& offsets, const SteppedForces& told) const {
  ChainConditions under;
  under.warmer = warmer;
  const SteppedForces found = under_steps(F, under, held_at(offsets), told.largest);
  constexpr double alike = 1e-8;
  return found.converged &&
         (found.forces - told.forces).norm() <= alike * std::max(found.largest, told.forces.norm()) &&
         (found.displacement - told.displacement).norm() <= alike * found.displacement.norm();
}

/// The laws in balance under a load that includes the weight, by the linear response of the rest.
std::optional<AnalyticModel::Quick> AnalyticModel::quick(const Vector6& F, const Conditions& conditions) const {
  const bool straight = as_printed_.empty() && legs_.fits() && !stepped_.empty() && !lines_;
  if (!straight || (imposed_ && imposed_->S.size() == 0) ||
      (!conditions.slips.empty() && static_cast<int>(conditions.slips.size()) != frictions_))
    return std::nullopt;
  // A law that bends is found about the first load, by all its digits.
  const auto bends = [](const SteppedLaw& l) { return !is_linear(l.law) && row_of(l.law).curve != Curve::jumps; };
  if (!imposed_ && std::any_of(stepped_.begin(), stepped_.end(), bends)) return std::nullopt;
  refuse_motions(F);
  const bool first = !between_;
  Between& b = linear_response();
  SteppedForces at = held_under(b, F, conditions);
  const SteppedForces held = at;
  const Imposed& known = b.known;
  // Of loads in a sequence the next one finds most laws as the last one left them.
  std::optional<BalancedSteps> same;
  if (frictions_ > 0) same = b.same.after(held.forces, conditions.slips);
  BalancedSteps found = same ? *std::move(same) : [&] {
    BalancedSteps searched = balance(
        stepped_, conditions.slips,
        [&](const std::vector<Step>& steps) {
          VectorX offsets(std::ssize(steps));
          for (std::size_t i = 0; i < steps.size(); ++i) offsets(as_index(i)) = steps[i].offset;
          at.forces = held.forces - known.S * offsets;
          at.displacement = held.displacement + known.T * offsets;
          return at;
        },
        *imposed_, false);
    *imposed_ = known;
    if (frictions_ > 0) b.same.remember(held.forces, conditions.slips, searched);
    return searched;
  }();
  // Where nothing balances, any small offsets show whether the rest of the mechanism is linear.
  if (found.offsets.size() == 0) found.offsets = 1e-3 * known.c.cwiseProduct(held.forces);
  const Vector6 displacement = held.displacement + known.T * found.offsets;
  if (first) {
    SteppedForces told = held;
    told.forces -= known.S * found.offsets;
    told.displacement = displacement;
    if (!agrees(F, conditions.warmer, found.offsets, told)) {
      imposed_ = std::make_shared<Imposed>();  // what offsets do depends on the load
      between_.reset();
      return std::nullopt;
    }
  }
  return Quick{std::move(found), displacement};
}

AnalyticSolution AnalyticModel::displaced(const Vector6& F, const Conditions& conditions) const {
  const bool in_part = conditions.geometry != Geometry::linear;
  if (in_part && stepped_.empty()) return solve(F, conditions);
  const std::optional<Quick> found = quick(F + weight_, conditions);
  if (!found) return solve(F, conditions);
  AnalyticSolution s;
  s.converged = found->laws.converged;
  s.message = found->laws.reason;
  s.slips = found->laws.slips;
  s.load = F;
  s.displacement = found->displacement;
  if (!in_part || !s.converged) return s;
  ChainConditions under;
  under.warmer = conditions.warmer;
  under.steps = held_at(found->laws.offsets);
  s.leg_wrenches = equilibrium_under(F + weight_, under).leg_wrenches;
  return with_shape(std::move(s), conditions.geometry);
}

}  // namespace deflect::analytic
