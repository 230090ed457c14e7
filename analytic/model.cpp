#include "analytic/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

#include "analytic/deformed.h"
#include "analytic/rotation_vector.h"
#include "msa/base/error.h"
#include "msa/base/motion_text.h"
#include "msa/mechanism/table.h"

namespace deflect::analytic {
namespace {

/// What moves for nothing, of the mechanism in series: its joints of base and tool, its legs.
void refuse_motion(const Matrix6X& J, double length) {
  if (J.cols() == 0) return;
  Eigen::Index largest = 0;
  J.col(0).cwiseAbs().maxCoeff(&largest);
  throw ModelError("the platform cannot stand: the legs do not resist its " +
                   motion_text(J(largest, 0) < 0 ? Vector6(-J.col(0)) : Vector6(J.col(0)), length));
}

/// The same for what no erratum is about: base and tool.
ChainConditions drawn(ChainConditions c) {
  c.printed.clear();
  return c;
}

/// Laws that jump taken out, where the legs carry `wrenches` and base and tool F: gaps are closed, frictions side by
/// side with something let go and others stick, a table that remembers keeps its curve of loading, a one-sided law
/// yields as on the side on which it is. Within groups, whose branches' wrenches are not known here, its sides yield
/// alike.
Configuration without_steps(Configuration c, const std::vector<Vector6>& wrenches, const Vector6& F) {
  const auto strip = [&](PlacedJoint& joint, bool beside, const Vector6* wrench) {
    for (std::size_t i = 0; i < 6; ++i) {
      std::vector<Law> smooth;
      for (const Law& law : joint.laws[i]) {
        const auto* friction = std::get_if<FrictionLaw>(&law);
        if (friction && beside) joint.freedoms[i] = Freedom::free;
        if (friction && !beside) smooth.push_back(LinearLaw{friction->stiffness});
        if (!deflect::jumps(law)) smooth.push_back(law);
        if (remembers(law)) smooth.push_back(identified({std::get<TableLaw>(law).points}));
        const auto* sides = std::get_if<OneSidedLaw>(&law);
        if (!sides) continue;
        const double pull = sides->pull.value_or(0), push = sides->push.value_or(0);
        const double force = wrench ? freedom_twist(joint, i, c.pose.p_WT).dot(*wrench) + joint.preload[i] : 0;
        const double yields = !wrench ? (pull + push) / 2 : force < 0 ? push : pull;
        if (yields > 0) smooth.push_back(LinearLaw{1 / yields});
      }
      joint.laws[i] = std::move(smooth);
    }
  };
  for (std::size_t l = 0; l < c.legs.size(); ++l)
    for (PlacedPart& part : c.legs[l].parts) {
      if (auto* joint = std::get_if<PlacedJoint>(&part)) strip(*joint, c.legs[l].beside, &wrenches[l]);
      if (auto* group = std::get_if<PlacedParallel>(&part))
        for (PlacedLeg& branch : group->branches) {
          const bool beside = c.legs[l].beside || (group->one_joint && &branch != &group->branches.front());
          for_each_part(std::span(&branch, 1), [&](auto& inner) {
            if constexpr (requires { inner.laws; }) strip(inner, beside, nullptr);
          });
        }
    }
  strip(c.base, false, &F);
  strip(c.tool, false, &F);
  return c;
}

}  // namespace

AnalyticModel::AnalyticModel(const Configuration& given, const AsPrinted& as_printed, bool apart)
    : configuration_(given), as_printed_(as_printed), apart_(apart) {
  Configuration& c = configuration_;
  frictions_ = number_slips(c);
  legs_ = legs_of(c, as_printed);
  through_ = chain_of({"base and tool", {c.base, c.tool}}, c.pose.p_WT, c.size);
  weight_ << c.weight, Vector3::Zero();
  const bool jumps = through_.has_steps() || std::any_of(legs_.branches.begin(), legs_.branches.end(),
                                                         [](const Chain& leg) { return leg.has_steps(); });
  const auto number_legs = [this] {
    stepped_.clear();
    int number = 0;
    for (Chain& leg : legs_.branches) {
      const std::size_t first = stepped_.size();
      leg.number_steps(stepped_);
      for (std::size_t i = first; i < stepped_.size(); ++i) stepped_[i].leg = number;
      ++number;
    }
  };
  number_legs();
  if (!through_.has_steps() && as_printed.empty()) lines_ = Lines::of(legs_);
  if (jumps && !lines_ && as_printed.empty()) {
    for (Chain& leg : legs_.branches) leg.bent_laws_to_steps();
    through_.bent_laws_to_steps();
    number_legs();
  }
  through_.number_steps(stepped_);
  double stiffest = 0, beside = 0;
  for_each_part(c.legs, [&](const auto& part) {
    if constexpr (requires { part.section; }) {
      stiffest = std::max(stiffest, part.E * part.section.A / part.length());
      heat_force_ = std::max(heat_force_, std::abs(part.E * part.section.A * part.expansion));
    }
  });
  for (const PlacedLeg& leg : c.legs)
    beside = std::max({beside, leg.misfit.head<3>().norm(), leg.misfit.tail<3>().norm() * c.size});
  misfit_force_ = stiffest * beside;
}

/// Displacements from the drawing.
AnalyticSolution AnalyticModel::equilibrium_under(const Vector6& F, const ChainConditions& under) const {
  return solution(legs_.solve(F, under), F, under);
}

AnalyticSolution AnalyticModel::solution(const Group::State& state, const Vector6& F,
                                         const ChainConditions& under) const {
  AnalyticSolution s;
  s.displacement = state.t + through_.deflection(F, drawn(under));
  s.load = F;
  s.leg_wrenches = state.wrenches;
  s.converged = state.converged;
  s.iterations = state.iterations;
  s.misfit = state.misfit;
  s.under = under;
  return s;
}

void AnalyticModel::refuse_motions(const Vector6& F) const {
  refuse_motion(through_.J_q, through_.length);
  // Where an erratum takes away the moments' arms, the smallest displacement answers loads that drive no free motion.
  const bool driven =
      (legs_.J.transpose() * F).norm() > 1e-9 * (F.head<3>().norm() + F.tail<3>().norm() / legs_.length);
  if (driven || !as_printed_.count(Erratum::tcp_transfer)) refuse_motion(legs_.J, legs_.length);
}

SteppedForces AnalyticModel::under_steps(const Vector6& F, ChainConditions& under, const std::vector<Step>& steps,
                                         double held) const {
  under.steps = steps;
  const AnalyticSolution s = equilibrium_under(F, under);
  const double length = legs_.length;
  const auto size = [length](const Vector6& w) { return std::max(w.head<3>().norm(), w.tail<3>().norm() / length); };
  SteppedForces out{VectorX::Zero(std::ssize(stepped_)), s.displacement, std::max(size(F), held), length, s.converged};
  for (std::size_t i = 0; i < s.leg_wrenches.size(); ++i) {
    legs_.branches[i].add_step_forces(s.leg_wrenches[i], under, out.forces);
    out.largest = std::max(out.largest, size(s.leg_wrenches[i]));
  }
  through_.add_step_forces(F, under, out.forces);
  return out;
}

AnalyticSolution AnalyticModel::equilibrium(const Vector6& F, const Conditions& conditions) const {
  refuse_motions(F);
  ChainConditions under = as_printed_;
  under.warmer = conditions.warmer;
  if (conditions.geometry != Geometry::linear && !(F.isZero(0) && legs_.fits()))
    return deformed_equilibrium(F, conditions.geometry);
  if (stepped_.empty()) return equilibrium_under(F, under);
  if (lines_)
    if (const std::optional<Lines::Answer> found = lines_->solve(legs_, F, conditions.slips, under)) {
      under.steps = found->steps;
      AnalyticSolution s = solution(found->state, F, under);
      s.slips = found->slips;
      return s;
    }
  const double held = held_without_load(conditions);
  if (!imposed_) imposed_ = std::make_shared<Imposed>();
  const BalancedSteps found = balance(
      stepped_, conditions.slips, [&](const std::vector<Step>& steps) { return under_steps(F, under, steps, held); },
      *imposed_);
  under.steps = found.steps;
  AnalyticSolution s = equilibrium_under(F, under);
  s.slips = found.slips;
  s.converged = s.converged && found.converged;
  s.message = found.reason;
  s.loose = found.loose;
  s.free = found.twists, s.least = found.least, s.most = found.most;
  return s;
}

AnalyticSolution AnalyticModel::deformed_equilibrium(const Vector6& F, Geometry geometry) const {
  AnalyticSolution s;
  if (!rest_ || rest_->conditions.geometry != geometry)
    rest_ = std::make_shared<const Deformed>(at_rest(configuration_, geometry, linear()));
  s.deformed = std::make_shared<const Deformed>(deform(*rest_, configuration_, F));
  const Deformed& d = *s.deformed;
  s.displacement << d.translation, d.rotation_vector;
  s.load = F;
  s.leg_wrenches = d.leg_wrenches;
  s.converged = d.converged;
  s.iterations = d.iterations;
  s.misfit = d.residual;
  s.message = d.message;
  s.discretisation = d.discretisation;
  return s;
}

AnalyticSolution AnalyticModel::assembled(Geometry geometry) const {
  return equilibrium(Vector6::Zero(), as_printed_.empty() && stepped_.empty() ? geometry : Geometry::linear);
}

bool AnalyticModel::forceless(const Vector6& F, const Conditions& conditions) const {
  const bool heated = conditions.warmer != 0 && heat_force_ > 0;
  return F.isZero(0) && legs_.fits() && !heated &&
         std::all_of(conditions.slips.begin(), conditions.slips.end(), [](double x) { return x == 0; });
}

AnalyticSolution AnalyticModel::solve_in_part(const Vector6& F, const Conditions& conditions) const {
  Conditions linear = conditions;
  linear.geometry = Geometry::linear;
  AnalyticSolution s = solve(F, linear);
  if (!s.converged) return s;
  if (forceless(F + weight_, conditions)) return s;
  if (const std::optional<InShape> found = jumps_in_shape(F + weight_, conditions)) {
    put_play(*found, F + weight_, s);
    s.shape = found->displacement - s.displacement;
    s.displacement = found->displacement;
    s.slips = found->laws.slips;
    s.discretisation = found->discretisation;
    return s;
  }
  return with_shape(std::move(s), conditions.geometry);
}

/// The deformed shape's share is that of the mechanism without gaps, friction and heat.
AnalyticSolution AnalyticModel::with_shape(AnalyticSolution s, Geometry geometry) const {
  const AnalyticModel smooth(without_steps(configuration_, s.leg_wrenches, s.load + weight_));
  const AnalyticSolution deformed = smooth.solve(s.load, geometry), straight = smooth.solve(s.load);
  s.apart = !stepped_.empty();
  s.shape = deformed.displacement - straight.displacement;
  s.displacement += s.shape;
  s.discretisation = deformed.discretisation;
  s.converged = s.converged && deformed.converged && straight.converged;
  if (s.message.empty()) s.message = deformed.message;
  return s;
}

AnalyticSolution AnalyticModel::solve(const Vector6& F, const Conditions& conditions) const {
  if (!conditions.slips.empty() && static_cast<int>(conditions.slips.size()) != frictions_)
    throw InputError(
        fmt::format("{} slips are given, the laws of the mechanism have {}", conditions.slips.size(), frictions_));
  const Geometry geometry = as_printed_.empty() ? conditions.geometry : Geometry::linear;
  if (geometry != Geometry::linear && (!stepped_.empty() || (conditions.warmer != 0 && heat_force_ > 0)))
    return solve_in_part(F, conditions);
  Conditions in = conditions;
  in.geometry = geometry;
  AnalyticSolution s = equilibrium(F + weight_, in);
  s.load = F;
  if (legs_.fits()) return s;
  const AnalyticSolution reference = assembled(geometry);
  s.converged = s.converged && reference.converged;
  s.displacement -= reference.displacement;
  s.discretisation = s.discretisation + reference.discretisation;
  if (geometry == Geometry::finite)
    s.displacement.tail<3>() = rotation_vector(combined(s.deformed->turning, reference.deformed->turning.transpose()));
  return s;
}

Flexibility AnalyticModel::flexibility(const AnalyticSolution& s) const {
  Flexibility whole = legs_.flexibility(s.leg_wrenches, 0, s.under);
  const Flexibility through = through_.respond(s.load + weight_, 0, drawn(s.under)).tangent;
  whole.C += through.C;
  whole.rooted = whole.rooted && through.rooted;
  whole.roots.conservativeResize(6, whole.roots.cols() + through.roots.cols());
  whole.roots.rightCols(through.roots.cols()) = through.roots;
  if (through.J.cols() > 0) {
    whole.J.conservativeResize(6, whole.J.cols() + through.J.cols());
    whole.J.rightCols(through.J.cols()) = through.J;
    whole.N = carried_wrenches(whole.J, legs_.length);
  }
  return whole;
}

Matrix6 AnalyticModel::leg_stiffness(std::size_t leg, const AnalyticSolution& s) const {
  if (s.deformed) return analytic::leg_stiffness(*s.deformed, leg);
  return legs_.branches[leg].resistance(s.leg_wrenches[leg], s.under).K;
}

Resistance AnalyticModel::resistance(const AnalyticSolution& s) const {
  if (s.deformed) return {analytic::stiffness(*s.deformed), Matrix6X(6, 0)};
  // Between a rigid base and a rigid tool the legs' stiffnesses add up without a digit lost.
  if (through_.members.empty() && through_.freedoms.empty()) return legs_.resistance(s.leg_wrenches, s.under);
  return analytic::resistance(flexibility(s), legs_.length);
}

Matrix6 AnalyticModel::stiffness(const AnalyticSolution& s) const {
  if (s.deformed) return analytic::stiffness(*s.deformed);
  if (through_.members.empty() && through_.freedoms.empty()) return legs_.stiffness(s.leg_wrenches, s.under);
  return finite(resistance(s), legs_.length, legs_.name);
}

Matrix6 AnalyticModel::compliance(const AnalyticSolution& s) const {
  if (s.deformed) return analytic::compliance(*s.deformed);
  const Flexibility whole = flexibility(s);
  refuse_motion(whole.J, legs_.length);
  return whole.C;
}

std::vector<std::pair<std::string, double>> AnalyticModel::energies(const AnalyticSolution& s) const {
  std::map<std::string, double> sums;
  if (s.deformed) s.deformed->whole.add_energies(s.deformed->conditions, sums);
  for (std::size_t i = 0; !s.deformed && i < s.leg_wrenches.size(); ++i)
    legs_.branches[i].add_energies(s.leg_wrenches[i], s.under, sums);
  if (!s.deformed) through_.add_energies(s.load + weight_, drawn(s.under), sums);
  std::vector<std::pair<std::string, double>> sorted(sums.begin(), sums.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return sorted;
}

}  // namespace deflect::analytic
