#include "validation/plan/rival.h"

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/diagnosis/fit_problem.h"
#include "validation/effects/effect_file.h"

namespace deflect::plan {
namespace {

constexpr double wide = 3, half_range = 1;  // prior deviation of a coordinate: of a logarithm, e³; of a linear one
constexpr double step = 1e-5;               // of derivatives
constexpr int most_steps = 10, halvings = 4;
constexpr double apart = 9;                          // λ² from which a fit is begun elsewhere too
constexpr double far[] = {-6, -3, -1.5, 1.5, 3, 6};  // there: by so much of a coordinate
constexpr double near_enough = 0.01, share = 1e-3;   // of λ²: what a step left and what it promised

}  // namespace

std::vector<Rival> rivals_of(const diagnosis::FoundTie& tie, const std::vector<effects::Effect>& all) {
  std::vector<Rival> out;
  double sum = 0;
  for (const diagnosis::FoundTie::Rival& found : tie.rivals) {
    Rival& rival = out.emplace_back();
    rival.probability = found.probability;
    sum += found.probability;
    for (const diagnosis::FoundEffect& each : found.effects) {
      const effects::EffectInstance instance = diagnosis::instance(effects::find_effect(all, each.effect), each);
      const Eigen::Index before = rival.values.size(), own = instance.values.size();
      rival.values.conservativeResize(before + own);
      rival.values.tail(own) = instance.values;
      rival.hypothesis.push_back(instance);
    }
  }
  for (Rival& r : out) r.probability = sum > 0 ? r.probability / sum : 1 / static_cast<double>(out.size());
  return out;
}

subject::Subject subject_with(const subject::Subject& s, const Rival& r, const VectorX& values) {
  return effects::PreparedEffects(s, r.hypothesis)(values);
}

subject::Subject subject_with_likeliest(const subject::Subject& s, const std::vector<Rival>& all) {
  const Rival& best = *std::ranges::max_element(all, {}, &Rival::probability);
  return subject_with(s, best, best.values);
}

RivalModel::RivalModel(const Prospect& prospect, const subject::Subject& s, Rival rival)
    : prospect_(&prospect),
      rival_(std::move(rival)),
      prepared_(s, rival_.hypothesis),
      fitted_(diagnosis::coordinates_of(rival_.hypothesis, rival_.values)),
      mean_(fitted_),
      prior_(fitted_.size()) {
  const auto parameters = diagnosis::parameters_of(rival_.hypothesis);
  for (Eigen::Index i = 0; i < prior_.size(); ++i) {
    double deviation = nth(parameters, i)->log ? wide : half_range;
    if (const auto own = diagnosis::prior_of_coordinate(*nth(parameters, i))) {
      mean_(i) = own->mean, deviation = own->deviation;
      known_.push_back(i);
    }
    prior_(i) = deviation * deviation;
  }
}

VectorX RivalModel::within(const VectorX& coordinates) const {
  return diagnosis::coordinates_of(rival_.hypothesis, diagnosis::values_at(rival_.hypothesis, coordinates));
}

VectorX RivalModel::predicted(const VectorX& x) const {
  return prospect_->predicted(prepared_(diagnosis::values_at(rival_.hypothesis, x)));
}

Linearised RivalModel::at(const VectorX& x) const {
  const VectorX values = diagnosis::values_at(rival_.hypothesis, x);
  Linearised out{x, prospect_->predicted(prepared_(values)), {}};
  MatrixX J = MatrixX::Zero(out.predicted.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i)
    for (const double by : {step, -step}) {
      VectorX moved = x;
      moved(i) += by;
      const VectorX there = diagnosis::values_at(rival_.hypothesis, moved);
      if (there(i) == values(i)) continue;  // at a bound
      J.col(i) = (prospect_->predicted(prepared_(there)) - out.predicted) / by;
      break;
    }
  out.beside = prospect_->white(J);
  return out;
}

MatrixX RivalModel::covariance(const Linearised& fit) const {
  const MatrixX none(fit.predicted.size(), 0);
  return prospect_->design(none, fit.beside, prior_).covariance().bottomRightCorner(fit.at.size(), fit.at.size());
}

VectorX RivalModel::taken_as_linear() const {
  const subject::Subject fitted = prepared_(rival_.values);
  return prospect_->off_taken(fitted) + prospect_->white_of_taken(prospect_->predicted_of_taken(fitted));
}

std::optional<VectorX> RivalModel::residual_of_taken(const VectorX& x, const VectorX& taken_as_linear) const {
  constexpr double rounding = 1e-9;
  if ((within(x) - x).cwiseAbs().maxCoeff() > rounding) return std::nullopt;
  const auto there =
      outcome_of([&] { return prospect_->predicted_of_taken(prepared_(diagnosis::values_at(rival_.hypothesis, x))); });
  if (!there || !there->allFinite()) return std::nullopt;
  VectorX out = prospect_->left_of_taken(taken_as_linear - prospect_->white_of_taken(*there));
  out.conservativeResize(out.size() + std::ssize(known_));
  const VectorX off = (x - mean_).cwiseQuotient(prior_.cwiseSqrt());
  out.tail(std::ssize(known_)) = off(known_);
  return out;
}

VectorX RivalModel::target(const VectorX& y, const Linearised& here) const {
  return prospect_->white(y - here.predicted) + here.beside * (here.at - mean_);
}

double RivalModel::left_at(const VectorX& y, const VectorX& x, const VectorX& predicted, bool all) const {
  const MatrixX none(y.size(), 0);
  const Design rest = prospect_->design(prospect_->white(y - predicted), none, VectorX(0), all);
  return rest.Q()(0, 0) + (x - mean_).cwiseAbs2().cwiseQuotient(prior_).sum();
}

Refitted RivalModel::fitted_to(const VectorX& y, const Linearised& from, bool all) const {
  Refitted out = search(y, from, all);
  if (out.left < apart) return out;
  Refitted start{{}, INFINITY};
  for (Eigen::Index i = 0; i < fitted_.size(); ++i)
    for (const double by : far) {
      VectorX x = fitted_;
      x(i) += by;
      x = within(x);
      const auto there = outcome_of([&] { return predicted(x); });
      if (!there || !there->allFinite()) continue;
      if (const double left = left_at(y, x, *there, all); left < start.left) start = {x, left};
    }
  if (start.at.size() == 0) return out;
  const auto begun = outcome_of([&] { return at(start.at); });
  if (!begun) return out;
  Refitted other = search(y, *begun, all);
  return other.left < out.left ? other : out;
}

Refitted RivalModel::search(const VectorX& y, Linearised here, bool all) const {
  Refitted out{here.at, left_at(y, here.at, here.predicted, all)};
  for (int steps = 0; steps < most_steps; ++steps) {
    const Design design = prospect_->design(target(y, here), here.beside, prior_, all);
    const double promised = design.Q()(0, 0), before = out.left;
    const auto done = [&] { return out.left <= promised + near_enough + share * promised; };
    if (done()) break;
    const VectorX whole = mean_ + design.absorbed().col(0).tail(mean_.size()) - here.at;
    double length = 1;
    for (int tries = 0; tries < halvings && out.left == before; ++tries, length /= 2) {
      const VectorX x = within(here.at + length * whole);
      const auto there = outcome_of([&] { return predicted(x); });
      if (!there || !there->allFinite()) continue;
      if (const double left = left_at(y, x, *there, all); left < out.left) out = {x, left};
    }
    if (out.left == before || done()) break;
    auto next = outcome_of([&] { return at(out.at); });
    if (!next) break;
    here = std::move(*next.value);
  }
  return out;
}

}  // namespace deflect::plan
