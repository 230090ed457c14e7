#include "validation/theories/msa_theory.h"

#include <fmt/format.h>

#include <algorithm>

#include "meshes/structure.h"
#include "msa/base/error.h"

namespace deflect::theories {
namespace {

constexpr const char* by_msa = "MSA";
constexpr double small_error = 1e-6;  // relative: is divided no further

std::string because(const std::string& reason) { return reason.empty() ? "" : ": " + reason; }

}  // namespace

const Theory& msa_theory() {
  static const Theory row = {"msa",
                             by_msa,
                             "the MSA",
                             "MSA",
                             "matrix structural analysis (MSA)",
                             0,
                             true,
                             [](const Configuration& c, const TheoryOptions& o) -> std::unique_ptr<TheoryAt> {
                               return std::make_unique<MsaAt>(c, o);
                             }};
  return row;
}

MsaAt::MsaAt(const Configuration& c, const TheoryOptions& options)
    : configuration_(&c), options_(options), division_(options.division) {
  if (!options_.condense) (void)model();  // what cannot stand is refused here
}

void MsaAt::move_to(const Configuration& c) {
  configuration_ = &c;
  sweep_here_ = false;
  division_ = options_.division;
  model_.reset();
  before_.reset();
  halvings_ = 0;
  stiffness_.reset();
  rest_.reset();
}

frame::MsaModel& MsaAt::model() {
  if (!model_) model_ = std::make_unique<frame::MsaModel>(*configuration_, division_);
  return *model_;
}

/// The sweep at this pose; null where the device has none.
frame::MsaSweep* MsaAt::sweep() {
  const Configuration& c = *configuration_;
  if (!std::exchange(sweep_tried_, true)) {
    sweep_.emplace(c, options_.division);
    if (!sweep_->applies()) sweep_.reset();
    for (const PlacedLeg& leg : c.legs) legs_.push_back({leg.name, Matrix6::Zero(), {}});
  }
  if (!sweep_) return nullptr;
  if (std::exchange(sweep_here_, true)) return &*sweep_;
  sweep_->at(c);
  for (std::size_t i = 0; i < legs_.size(); ++i) sweep_->find_passive_twists(c, i, legs_[i].passive_twists);
  return &*sweep_;
}

Asked MsaAt::asked() const { return {by_msa, options_.device, *configuration_}; }

void MsaAt::halve() {
  division_ = frame::halved(*configuration_, division_);
  before_ = std::move(model_);
  stiffness_.reset();
  ++halvings_;
}

/// last_ again by smaller elements where its own leave too much.
void MsaAt::refine(const Vector6& F, const Conditions& conditions) {
  constexpr int most = 3;
  const double length = configuration_->size;
  const auto norms = [](const Vector6& d) { return Eigen::Vector2d(d.head<3>().norm(), d.tail<3>().norm()); };
  const Eigen::Array2d weights(1, length);
  const auto relative = [&] {
    const double size = (weights * norms(last_.displacement).array()).maxCoeff();
    return size > 0 ? (weights * discretisation_.array()).maxCoeff() / size : 0;
  };
  const frame::LeftOut known = last_.state.geometric->left_out;
  discretisation_ = known.relative * norms(last_.displacement);
  discretisation_ += known.twist * Eigen::Vector2d(length, 1);
  if (!last_.state.converged || relative() <= small_error) return;
  frame::MsaSolution coarse = before_ ? before_->solve(F, conditions) : last_;
  if (!before_) {
    halve();
    last_ = model().solve(F, conditions);
  }
  for (;;) {
    if (!coarse.state.converged || !last_.state.converged) return;
    discretisation_ = norms(last_.displacement - coarse.displacement) / 3;
    const double left = relative();
    if (left <= small_error) return;
    if (halvings_ == most && left > 1e-4)
      throw NumericalError(fmt::format("{}: the MSA: members bend so far that its elements leave an error of {:.1e}",
                                       place_text(options_.device, *configuration_), left));
    if (halvings_ == most) return;
    coarse = std::move(last_);
    halve();
    last_ = model().solve(F, conditions);
  }
}

Answer MsaAt::answer(const Vector6& F, const Conditions& conditions) {
  if (options_.condense && conditions.geometry == Geometry::linear && conditions.warmer == 0)
    if (frame::MsaSweep* s = sweep(); s && s->solve(F)) return swept_answer(*s, legs_, asked(), F, s->reaction());
  last_ = model().solve(F, conditions);
  if (last_.state.geometric && conditions.geometry == Geometry::finite && !options_.keep_division)
    refine(F, conditions);
  const frame::Solution& state = last_.state;
  if (!state.converged && state.geometric)
    throw NumericalError(
        fmt::format("{}: the MSA: {}", place_text(options_.device, *configuration_), state.geometric->message));
  if (!state.converged)
    throw NumericalError(fmt::format("{}: the MSA did not converge in {} steps (residual {:.3g}){}",
                                     place_text(options_.device, *configuration_), state.iterations, state.residual,
                                     because(state.message)));
  return state.geometric ? deformed() : linear_answer(conditions);
}

Answer MsaAt::deformed() {
  const frame::MsaModel::Stiffness found = model().stiffness(last_.state);
  Answer answer{last_.displacement, found.K, last_.energies};
  answer.slips = last_.slips;
  answer.discretisation = discretisation_;
  if (last_.state.geometric->geometry == Geometry::second_order)
    answer.left_out = last_.state.geometric->left_out.relative;
  const Vector6 reaction = model().base_reaction(last_.load, last_.state);
  return deformed_answer(std::move(answer), asked(), {last_.load, reaction}, found.rounding);
}

const MsaAt::Stiffness& MsaAt::stiffness() {
  if (stiffness_ && stiffness_->tangents == last_.state.spring_tangents) return *stiffness_;
  frame::MsaModel& m = model();
  const frame::MsaModel::Stiffness found = m.stiffness(last_.state);
  std::vector<LegStiffness> legs;
  for (std::size_t i = 0; i < configuration_->legs.size(); ++i)
    legs.push_back({configuration_->legs[i].name, found.legs[i], m.passive_twists(i)});
  const StiffnessChecks checks = check_stiffness(found.K, legs, bound_with(checked_to, m.rounding()));
  enforce_stiffness(checks, asked());
  stiffness_ = {last_.state.spring_tangents, found.K, 6 - static_cast<int>(found.motions.cols()), checks};
  return *stiffness_;
}

Answer MsaAt::linear_answer(const Conditions& conditions) {
  const Configuration& c = *configuration_;
  const Stiffness& known = stiffness();
  Answer answer{last_.displacement, known.K, last_.energies, known.checks, last_.slips};
  answer.rigid = known.rigid;
  answer.floating.loose = last_.state.loose;
  if (!last_.state.loose.empty()) answer.floating.least = last_.state.least, answer.floating.most = last_.state.most;
  answer.rounding = model().rounding();
  // The reaction acts at the base origin; about T its moment changes by the arm.
  const Vector6 reaction =
      shift_twist(c.base.p_W - c.pose.p_WT).transpose() * model().base_reaction(last_.load, last_.state);
  if (!rest_) rest_ = at_rest(c);
  check_answer(answer, asked(), {last_.load, reaction, total(last_.energies), model().linear(), answer.rounding},
               *rest_, conditions);
  return answer;
}

Prediction MsaAt::predict(const Vector6& F, const Conditions& conditions) {
  frame::MsaSolution s = model().solve(F, conditions);
  Prediction out{s.displacement, s.state.converged, s.slips, s.state.message};
  if (s.state.converged && !options_.inside.empty()) out.inside = model().inside(options_.inside, s);
  return out;
}

Assembled MsaAt::assembled() { return {model().assembled().u.segment<6>(6 * mechanism().tool)}; }

std::optional<Structure> MsaAt::structure() {
  return Structure{lines_of(mechanism()), fields_of(mechanism(), displacements(), last_.state.geometric.get())};
}

std::vector<std::string> MsaAt::notes() const { return model_ ? model_->notes() : std::vector<std::string>(); }

}  // namespace deflect::theories
