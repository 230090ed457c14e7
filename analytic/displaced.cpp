#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "analytic/deflection.h"
#include "analytic/deformed.h"
#include "analytic/model.h"
#include "msa/base/index.h"

namespace deflect::analytic {
namespace {

/// Of the largest force. Forces of second order are about a strain times that, 1e-6 or more of it.
constexpr double idle_force = 1e-7;

bool same_steps(const std::vector<Step>& all, const std::vector<Step>& others) {
  const auto same = [](const Step& a, const Step& b) { return a.offset == b.offset && a.compliance == b.compliance; };
  return std::equal(all.begin(), all.end(), others.begin(), others.end(), same);
}

/// The deformed shape under one load, asked again and again with its laws in other steps.
class ShapeInSteps {
 public:
  ShapeInSteps(const Configuration& c, const Vector6& F, const Deformed& rest)
      : configuration_(c), state_(deform(rest, c, F)), steps_(rest.conditions.steps) {}

  const Deformed& in(const std::vector<Step>& steps) {
    if (same_steps(steps, steps_)) return state_;
    state_ = in_other_steps(state_, steps, configuration_);
    steps_ = steps;
    return state_;
  }

  SteppedForces answer(const std::vector<Step>& steps, double length) {
    const Deformed& d = in(steps);
    const auto size = [length](const Vector6& w) { return std::max(w.head<3>().norm(), w.tail<3>().norm() / length); };
    Vector6 moved;
    moved << d.translation, d.rotation_vector;
    SteppedForces out{forces_in_held(d.whole, d.conditions), moved, size(d.whole.F), length, d.converged};
    for (const Vector6& w : d.leg_wrenches) out.largest = std::max(out.largest, size(w));
    out.idle = idle_force * out.largest;
    return out;
  }

 private:
  const Configuration& configuration_;
  Deformed state_;
  std::vector<Step> steps_;
};

std::vector<Step> steps_at(const VectorX& offsets, const VectorX& compliances) {
  std::vector<Step> steps;
  for (Eigen::Index i = 0; i < offsets.size(); ++i) steps.push_back({offsets(i), compliances(i), false});
  return steps;
}

}  // namespace

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

Imposed AnalyticModel::offsets_unloaded() const {
  ChainConditions under;
  return imposed_on(stepped_,
                    [&](const std::vector<Step>& steps) { return under_steps(Vector6::Zero(), under, steps, 0); });
}

/// Made on first use.
AnalyticModel::Between& AnalyticModel::linear_response() const {
  if (!imposed_) imposed_ = std::make_shared<Imposed>(offsets_unloaded());
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
  const bool in_part = conditions.geometry != Geometry::linear && !forceless(F + weight_, conditions);
  if (in_part && stepped_.empty()) return solve(F, conditions);
  AnalyticSolution s;
  if (const auto in_shape = in_part ? jumps_in_shape(F + weight_, conditions) : std::nullopt) {
    s.converged = true;
    s.slips = in_shape->laws.slips;
    s.load = F;
    s.displacement = in_shape->displacement;
    return s;
  }
  const std::optional<Quick> found = quick(F + weight_, conditions);
  if (!found) return solve(F, conditions);
  s.converged = found->laws.converged;
  s.message = found->laws.reason;
  s.slips = found->laws.slips;
  if (found->laws.moves) s.loose = found->laws.loose;
  s.load = F;
  s.displacement = found->displacement;
  if (!in_part || !s.converged) return s;
  ChainConditions under;
  under.warmer = conditions.warmer;
  under.steps = held_at(found->laws.offsets);
  s.leg_wrenches = equilibrium_under(F + weight_, under).leg_wrenches;
  return with_shape(std::move(s), conditions.geometry);
}

/// The laws and the shape in turn, round by round of Newton's method; nothing where the laws do not come to rest. From
/// `begun`. `far`: laws give way by more than the length of the mechanism, so that no shape is near.
std::optional<AnalyticModel::InShape> AnalyticModel::balanced_on_the_way(const Deformed& begun, const Vector6& F,
                                                                         const Conditions& conditions, Imposed& imposed,
                                                                         bool& far) const {
  const bool idle = std::all_of(begun.conditions.steps.begin(), begun.conditions.steps.end(),
                                [](const Step& step) { return step.offset == 0; });
  if (F.isZero(0) && idle) return std::nullopt;
  InShape out;
  const auto size_of = [this](VectorX o) {  // rotations times length
    for (Eigen::Index i = 0; i < o.size(); ++i)
      if (nth(stepped_, i).rotation) o(i) *= legs_.length;
    return largest(o);
  };
  Deformed rest = begun;
  rest.move_steps = [&](const VectorX& forces, double largest, std::vector<Step>& steps) {
    const SteppedForces at{forces, Vector6::Zero(), largest, legs_.length, true, idle_force * largest};
    VectorX offsets(std::ssize(steps));
    for (std::size_t i = 0; i < steps.size(); ++i) offsets(as_index(i)) = steps[i].offset;
    StepsMoved moved;
    out.laws = balance_about(offsets, at, stepped_, conditions.slips, imposed, moved.lacking);
    far = out.laws.converged && size_of(out.laws.offsets) > legs_.length;
    if (!out.laws.converged || far) return StepsMoved{};
    moved.by = size_of(out.laws.offsets - offsets);
    steps = steps_at(out.laws.offsets, imposed.c);
    return moved;
  };
  const Deformed d = deform(rest, configuration_, F);
  if (!d.converged) return std::nullopt;
  out.displacement << d.translation, d.rotation_vector;
  out.discretisation = d.discretisation;
  return out;
}

/// The same from where linear geometry has the laws, if they are frictions and laws that bend. The compliance that
/// `imposed` has in the place of a law may be far more than its own, as much as the mechanism yields along it: offsets
/// are then as large as the machine, and what they do in its shape is another thing than in linear geometry. Here those
/// of laws that bend are their own.
std::optional<AnalyticModel::InShape> AnalyticModel::balanced_from_linear(const Vector6& F,
                                                                          const Conditions& conditions,
                                                                          Imposed imposed) const {
  const auto follows_on = [](const SteppedLaw& l) {
    return std::holds_alternative<FrictionLaw>(l.law) || (row_of(l.law).curve != Curve::jumps && !remembers(l.law));
  };
  if (frictions_ == 0 || !std::all_of(stepped_.begin(), stepped_.end(), follows_on)) return std::nullopt;
  const std::optional<Quick> linear = quick(F, conditions);
  if (!linear || !linear->laws.converged || !between_) return std::nullopt;
  const VectorX forces = held_under(*between_, F, conditions).forces - imposed.S * linear->laws.offsets;
  VectorX less = VectorX::Zero(forces.size());  // compliance
  for (Eigen::Index i = 0; i < forces.size(); ++i)
    if (const SteppedLaw& l = nth(stepped_, i); !std::holds_alternative<FrictionLaw>(l.law))
      less(i) = std::max(0.0, imposed.c(i) - analytic::compliance(l.law, forces(i) + l.preload));
  const MatrixX without = MatrixX::Identity(less.size(), less.size()) - MatrixX(imposed.S * less.asDiagonal());
  imposed.S = without.partialPivLu().solve(imposed.S);
  imposed.c -= less;
  if (!imposed.S.allFinite()) return std::nullopt;
  const VectorX offsets = linear->laws.offsets + less.cwiseProduct(forces);
  bool far = false;
  const Deformed begun = at_rest_in(steps_at(offsets, imposed.c), configuration_, conditions.geometry);
  return balanced_on_the_way(begun, F, conditions, imposed, far);
}

/// Nothing in the cases that solve() names, and where the laws are not found in balance.
std::optional<AnalyticModel::InShape> AnalyticModel::jumps_in_shape(const Vector6& F,
                                                                    const Conditions& conditions) const {
  if (apart_) return std::nullopt;
  const bool heated = conditions.warmer != 0 && heat_force_ > 0;
  // A law of this model's own, which tells a friction the load beside it, is none of the configuration.
  const bool watched =
      std::any_of(stepped_.begin(), stepped_.end(), [](const SteppedLaw& law) { return law.load >= 0; });
  if (!as_printed_.empty() || !legs_.fits() || stepped_.empty() || lines_ || heated || watched) return std::nullopt;
  // No load has told it yet: not that it depends on the load, where the compliances are unknown too.
  if (!imposed_ || (imposed_->S.size() == 0 && imposed_->c.size() > 0))
    imposed_ = std::make_shared<Imposed>(offsets_unloaded());
  Imposed imposed = imposed_->S.size() > 0 ? *imposed_ : offsets_unloaded();
  const VectorX c = imposed.c;
  const std::vector<Step> without_offsets = steps_at(VectorX::Zero(c.size()), c);
  if (!rest_in_steps_ || rest_in_steps_->conditions.geometry != conditions.geometry ||
      !same_steps(rest_in_steps_->conditions.steps, without_offsets))
    rest_in_steps_ = std::make_shared<const Deformed>(at_rest_in(without_offsets, configuration_, conditions.geometry));
  bool far = false;
  if (auto found = balanced_from_linear(F, conditions, imposed)) return found;
  if (auto found = balanced_on_the_way(*rest_in_steps_, F, conditions, imposed, far)) return found;
  if (far) return std::nullopt;
  ShapeInSteps shape(configuration_, F, *rest_in_steps_);
  if (!shape.in(without_offsets).converged) return std::nullopt;
  // A part that is pulled hangs within its play by a stiffness that it has under the load alone.
  const AskSteps ask = [&](const std::vector<Step>& steps) { return shape.answer(steps, legs_.length); };
  imposed = imposed_on(stepped_, ask, std::move(imposed));
  if (auto found = balanced_on_the_way(*rest_in_steps_, F, conditions, imposed, far)) return found;
  if (far) return std::nullopt;
  BalancedSteps laws = balance(stepped_, conditions.slips, ask, imposed, false);
  if (!laws.converged) return std::nullopt;
  // Members bend otherwise there than without offsets, for which they were divided.
  const Deformed d =
      deform(at_rest_in(steps_at(laws.offsets, c), configuration_, conditions.geometry), configuration_, F);
  if (!d.converged) return std::nullopt;
  InShape out{std::move(laws), Vector6::Zero(), d.discretisation};
  out.displacement << d.translation, d.rotation_vector;
  return out;
}

/// Puts what floats in linear geometry where the deformed shape has it.
void AnalyticModel::put_play(const InShape& found, const Vector6& F, AnalyticSolution& s) const {
  if (s.loose.empty()) return;
  for (const std::size_t i : s.loose)
    if (!found.laws.steps[i].released) s.under.steps[i] = found.laws.steps[i];
  const AnalyticSolution there = equilibrium_under(F, s.under);
  s.displacement = there.displacement;
  s.leg_wrenches = there.leg_wrenches;
  s.loose.clear();
  s.free.resize(6, 0);
  s.least = s.most = Vector6::Zero();
}

}  // namespace deflect::analytic
