#include "validation/theories/analytic_theory.h"

#include <fmt/format.h>

#include <algorithm>

#include "analytic/constraint.h"
#include "analytic/deformed.h"
#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "validation/theories/turned.h"

namespace deflect::theories {
namespace {

constexpr const char* by_closed_form = "analytic";

bool fits(const Configuration& c) {
  return std::all_of(c.legs.begin(), c.legs.end(), [](const PlacedLeg& l) { return l.misfit.isZero(0); });
}

/// The tool turns in play too, which a state in the deformed shape leaves to its laws; where it is told apart from what
/// laws that jump do, the tool's rotation is all that is known.
double left_out_in_second_order(const analytic::AnalyticSolution& s) {
  const double turned = s.displacement.tail<3>().squaredNorm();
  return s.deformed ? std::max(turned, analytic::left_out_in_second_order(*s.deformed)) : turned;
}

}  // namespace

const Theory& analytic_theory() {
  static const Theory row = {"analytic",
                             by_closed_form,
                             "the analytic theory",
                             "Analytical",
                             "the closed form (analytical)",
                             0,
                             false,
                             [](const Configuration& c, const TheoryOptions& o) -> std::unique_ptr<TheoryAt> {
                               return std::make_unique<AnalyticAt>(c, o);
                             }};
  return row;
}

AnalyticAt::AnalyticAt(const Configuration& c, const TheoryOptions& options) : configuration_(&c), options_(options) {}

void AnalyticAt::move_to(const Configuration& c) {
  configuration_ = &c;
  sweep_here_ = false;
  rest_.reset();
  model_.reset();
  energy_at_rest_.reset();
  affine_.reset();
}

const analytic::AnalyticModel& AnalyticAt::model() {
  if (!model_) model_.emplace(*configuration_, analytic::AsPrinted{}, options_.apart);
  return *model_;
}

/// The sweep at this pose; null where the device has none.
analytic::PoseSweep* AnalyticAt::sweep() {
  const Configuration& c = *configuration_;
  if (!std::exchange(sweep_tried_, true)) {
    analytic::PoseSweep sweep(c);
    if (sweep.applies()) sweep_.emplace(std::move(sweep));
    for (const PlacedLeg& leg : c.legs) legs_.push_back({leg.name, Matrix6::Zero(), {}});
  }
  if (!sweep_) return nullptr;
  if (std::exchange(sweep_here_, true)) return &*sweep_;
  sweep_->at(c);
  for (std::size_t i = 0; i < legs_.size(); ++i) sweep_->find_passive_twists(i, legs_[i].passive_twists);
  return &*sweep_;
}

Asked AnalyticAt::asked() const { return {by_closed_form, options_.device, *configuration_}; }

Answer AnalyticAt::answer(const Vector6& F, const Conditions& conditions) {
  const Configuration& c = *configuration_;
  if (options_.condense && conditions.geometry == Geometry::linear && conditions.warmer == 0)
    if (analytic::PoseSweep* s = sweep(); s && s->solve(F)) {
      Vector6 reaction = Vector6::Zero();
      for (std::size_t i = 0; i < c.legs.size(); ++i) reaction -= s->leg_wrench(i);
      return swept_answer(*s, legs_, asked(), F, reaction);
    }
  const analytic::AnalyticSolution s = model().solve(F, conditions);
  if (!s.converged && s.message.empty()) (void)model().stiffness(s);  // throws where nothing yields
  if (!s.converged)
    throw NumericalError(s.message.empty()
                             ? fmt::format("{}: the analytic theory did not converge in {} steps (misfit {:.3g})",
                                           place_text(options_.device, c), s.iterations, s.misfit)
                             : fmt::format("{}: the analytic theory: {}", place_text(options_.device, c), s.message));
  const Vector6 load = with_weight(F, c);
  if (!s.deformed) return linear_answer(s, load, conditions);
  Vector6 carried = Vector6::Zero();
  for (const Vector6& wrench : s.leg_wrenches) carried += wrench;
  Answer answer{s.displacement, model().stiffness(s), model().energies(s)};
  answer.slips = s.slips;
  answer.discretisation = s.discretisation;
  if (conditions.geometry == Geometry::second_order) answer.left_out = left_out_in_second_order(s);
  return deformed_answer(std::move(answer), asked(), {load, -carried});
}

Answer AnalyticAt::linear_answer(const analytic::AnalyticSolution& s, const Vector6& load,
                                 const Conditions& conditions) {
  const analytic::AnalyticModel& m = model();
  std::vector<LegStiffness> legs;
  for (std::size_t i = 0; i < m.chains().size(); ++i)
    legs.push_back({m.chains()[i].name, m.leg_stiffness(i, s), m.chains()[i].J_q});
  const analytic::Resistance r = m.resistance(s);
  if (r.rigid.cols() == 6) (void)m.stiffness(s);  // throws: nothing yields at all
  Answer answer{s.displacement, r.K, m.energies(s), check_stiffness(r.K, legs), s.slips};
  answer.discretisation = s.discretisation;
  for (const std::size_t law : s.loose) answer.floating.loose.push_back(m.in_steps()[law].part);
  answer.floating.least = s.least, answer.floating.most = s.most;
  answer.apart = s.apart;
  if (conditions.geometry == Geometry::second_order) answer.left_out = left_out_in_second_order(s);
  answer.rigid = static_cast<int>(r.rigid.cols());
  if (answer.rigid > 0) answer.rigid_motions = analytic::motions_resisted_by(r.rigid, configuration_->size);
  enforce_stiffness(answer.checks, asked());
  Vector6 carried = Vector6::Zero();
  for (const Vector6& wrench : s.leg_wrenches) carried += wrench;
  if (!rest_) rest_ = at_rest(*configuration_);
  Found found{load, -carried, total(answer.energies) - energy_at_rest(), m.linear(),
              rounding_of(answer, configuration_->size)};
  Answer without_shape = answer;  // the energies are those of linear geometry
  without_shape.displacement -= s.shape;
  if (!failure_of(without_shape, found, *rest_, conditions).empty()) {
    found.rounding = std::max(found.rounding, energy_by_turning(s.load, found.energy, conditions));
    answer.rounding = found.rounding;
  }
  // Beside rigid motions what yields little may have no digits: the rigid ones are the cause to tell.
  if (answer.rigid > 0 && !failure_of(without_shape, found, *rest_, conditions).empty()) (void)m.stiffness(s);
  check_answer(without_shape, asked(), found, *rest_, conditions);
  return answer;
}

/// What turning the machine changes of the stored energy, relative, 1e-7 at most; 0 where it finds no equilibrium.
double AnalyticAt::energy_by_turning(const Vector6& F, double energy, const Conditions& conditions) const {
  const Matrix3& R = turn_number(0);
  const Configuration there = turned(*configuration_, R);
  const auto stored = outcome_of([&] {
    const analytic::AnalyticModel m(there);
    Vector6 load;
    load << R * F.head<3>(), R * F.tail<3>();
    const analytic::AnalyticSolution s = m.solve(load, conditions);
    const double rest = fits(there) ? 0 : total(m.energies(m.assembled()));
    return s.converged ? total(m.energies(s)) - rest : energy;
  });
  if (!stored || energy == 0) return 0;
  return std::min(std::abs(*stored - energy) / std::abs(energy), 1e-7);
}

double AnalyticAt::energy_at_rest() {
  if (!energy_at_rest_) energy_at_rest_ = fits(*configuration_) ? 0 : total(model().energies(model().assembled()));
  return *energy_at_rest_;
}

void AnalyticAt::expect_many(bool warmer_or_colder) {
  const bool by_sweep = options_.inside.empty() && sweep();
  if (by_sweep ? !sweep()->linear() : !model().linear() || model().jumps()) return;
  Affine affine;
  const auto at = [&](const Vector6& F, double warmer) {
    Conditions conditions;
    conditions.warmer = warmer;
    Prediction p = predict(F, conditions);
    affine.converged = affine.converged && p.converged;
    return p;
  };
  const Prediction rest = at(Vector6::Zero(), 0);
  const std::size_t inside = rest.inside.size();
  affine.rest = rest.displacement;
  affine.inside_rest = rest.inside;
  affine.inside_C.resize(inside);
  affine.inside_per_kelvin.assign(inside, Vector6::Zero());
  for (Eigen::Index i = 0; i < 6; ++i) {
    const Prediction unit = at(Vector6::Unit(i), 0);
    affine.C.col(i) = unit.displacement - affine.rest;
    for (std::size_t k = 0; k < inside; ++k) affine.inside_C[k].col(i) = unit.inside[k] - rest.inside[k];
  }
  if (warmer_or_colder) {
    const Prediction warm = at(Vector6::Zero(), 1);
    affine.per_kelvin = warm.displacement - affine.rest;
    for (std::size_t k = 0; k < inside; ++k) affine.inside_per_kelvin[k] = warm.inside[k] - rest.inside[k];
  }
  affine_ = std::move(affine);
}

std::vector<Vector6> AnalyticAt::inside_affine(const Vector6& F, double warmer) const {
  std::vector<Vector6> out;
  for (std::size_t k = 0; k < affine_->inside_rest.size(); ++k)
    out.emplace_back(affine_->inside_rest[k] + affine_->inside_C[k] * F + warmer * affine_->inside_per_kelvin[k]);
  return out;
}

/// By leg, part and freedom.
std::vector<std::string> AnalyticAt::floating(const analytic::AnalyticSolution& s) {
  std::vector<std::string> out;
  for (const std::size_t law : s.loose) {
    const analytic::SteppedLaw& l = model().in_steps()[law];
    out.push_back(fmt::format("{} {} {}", l.leg, l.part, l.freedom));
  }
  return out;
}

Prediction AnalyticAt::predict(const Vector6& F, const Conditions& conditions) {
  if (conditions.geometry == Geometry::linear) {
    if (affine_)
      return {affine_->rest + affine_->C * F + conditions.warmer * affine_->per_kelvin,
              affine_->converged,
              {},
              "",
              inside_affine(F, conditions.warmer)};
    if (options_.inside.empty())
      if (analytic::PoseSweep* s = sweep(); s && s->solve(F, conditions.warmer)) return {s->displacement(), true};
  }
  if (!options_.inside.empty()) {
    const analytic::AnalyticSolution s = model().solve(F, conditions);
    Prediction out{s.displacement, s.converged, s.slips, s.message, {}, floating(s)};
    if (s.converged) out.inside = model().inside(options_.inside, s);
    return out;
  }
  const analytic::AnalyticSolution s = model().displaced(F, conditions);
  return {s.displacement, s.converged, s.slips, s.message, {}, floating(s)};
}

Assembled AnalyticAt::assembled() {
  const analytic::AnalyticSolution s = model().assembled();
  Assembled out{s.displacement};
  for (std::size_t i = 0; i < configuration_->legs.size(); ++i)
    out.leg_wrenches.emplace_back(configuration_->legs[i].name, s.leg_wrenches[i]);
  return out;
}

}  // namespace deflect::theories
