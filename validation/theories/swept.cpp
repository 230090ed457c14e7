#include "validation/theories/swept.h"

#include <fmt/format.h>

#include <utility>

#include "msa/base/error.h"
#include "validation/theories/agreement.h"

namespace deflect {

SweptTheories::SweptTheories(const Mechanism& m) : mechanism_(&m), posing_(m) {}

const Configuration& SweptTheories::at(const Pose& pose) {
  const bool first = !configuration_;
  analytic_.reset();
  msa_.reset();
  analytic_is_there_ = msa_is_there_ = false;
  const Configuration& c = posing_.at(pose);
  configuration_ = &c;
  if (first) {
    analytic_sweep_.emplace(c);
    msa_sweep_.emplace(c);
    if (!analytic_sweep_->applies()) analytic_sweep_.reset();
    if (!msa_sweep_->applies()) msa_sweep_.reset();
    for (const PlacedLeg& leg : c.legs) analytic_legs_.push_back({leg.name, Matrix6::Zero(), {}});
    msa_legs_ = analytic_legs_;
  }
  for (std::size_t i = 0; i < c.legs.size(); ++i) {
    if (analytic_sweep_) analytic_legs_[i].passive_twists = analytic_sweep_->passive_twists(c, i);
    if (msa_sweep_) msa_legs_[i].passive_twists = msa_sweep_->passive_twists(c, i);
  }
  return c;
}

double SweptTheories::bound() const {
  const bool linear = analytic_ ? analytic_->model().linear() : analytic_sweep_->linear();
  return agreement_bound(linear, msa_ ? msa_->rounding() : 0);
}

std::string SweptTheories::where() const {
  const Vector3 p = 1e3 * configuration_->pose.p_WT, a = rpy_from_rotation(configuration_->pose.R_WT) * 180 / pi;
  return fmt::format("{} at ({:.6g}, {:.6g}, {:.6g}, {:.6g}, {:.6g}, {:.6g})", mechanism_->name, p.x(), p.y(), p.z(),
                     a.x(), a.y(), a.z());
}

template <class Sweep>
Answer SweptTheories::checked(const Sweep& sweep, std::vector<LegStiffness>& legs, const Vector6& F,
                              const Vector6& reaction, const char* theory) const {
  for (std::size_t i = 0; i < legs.size(); ++i) legs[i].K = sweep.leg_stiffness(i);
  Answer answer{sweep.displacement(),
                sweep.stiffness(),
                {},
                check_stiffness(sweep.stiffness(), legs),
                {},
                Eigen::Vector2d::Zero(),
                {}};
  if (!answer.checks.failure.empty())
    throw NumericalError(fmt::format("{}: the {} stiffness fails a check: {}", where(), theory, answer.checks.failure));
  Vector6 load = F;
  load.head<3>() += configuration_->weight;
  const std::string failure =
      response_failure({load, sweep.displacement(), reaction, sweep.energy(), sweep.linear(), true});
  if (!failure.empty())
    throw NumericalError(fmt::format("{}: the {} response fails a check: {}", where(), theory, failure));
  return answer;
}

Answer SweptTheories::analytic(const Vector6& F) {
  if (analytic_sweep_ && !std::exchange(analytic_is_there_, true)) analytic_sweep_->at(*configuration_);
  if (analytic_sweep_ && analytic_sweep_->solve(F)) {
    Vector6 reaction = Vector6::Zero();
    for (std::size_t i = 0; i < configuration_->legs.size(); ++i) reaction -= analytic_sweep_->leg_wrench(i);
    return checked(*analytic_sweep_, analytic_legs_, F, reaction, "analytic");
  }
  if (!analytic_) analytic_.emplace(*configuration_, where());
  return analytic_->solve(F);
}

Answer SweptTheories::msa(const Vector6& F) {
  if (msa_sweep_ && !std::exchange(msa_is_there_, true)) msa_sweep_->at(*configuration_);
  if (msa_sweep_ && msa_sweep_->solve(F)) return checked(*msa_sweep_, msa_legs_, F, msa_sweep_->reaction(), "MSA");
  if (!msa_) msa_.emplace(*configuration_, frame::MemberDivision(), where());
  return msa_->solve(F);
}

}  // namespace deflect
