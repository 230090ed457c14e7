#include "msa/frame/mechanism/msa_sweep.h"

#include <algorithm>
#include <cmath>

namespace deflect::frame {
namespace {

constexpr double settled = 1e-13;  // change of the springs' forces, of the largest
constexpr int most_iterations = 40;
constexpr double too_stiff = 1e5;  // beside the whole

}  // namespace

MsaSweep::MsaSweep(const Configuration& c, const MemberDivision& division) {
  applies_ = c.base.rigid() && c.tool.rigid();
  for (const PlacedLeg& placed : c.legs) {
    CondensedLeg& leg = legs_.emplace_back(placed, division);
    applies_ = applies_ && leg.applies();
    linear_ = linear_ && leg.springs().empty();
  }
}

void MsaSweep::at(const Configuration& c) {
  weight_ = c.weight;
  size_ = c.size;
  held_ = true;
  for (std::size_t l = 0; held_ && l < legs_.size(); ++l) held_ = legs_[l].condense(c.legs[l], c.pose.p_WT);
  if (linear_) held_ = held_ && assemble();
}

/// The legs side by side; rotations are weighed by the size.
bool MsaSweep::assemble() {
  stiffness_.setZero();
  double stiffest = 0;
  for (const CondensedLeg& leg : legs_) {
    stiffness_ += leg.stiffness();
    stiffest = std::max(stiffest, leg.stiffest());
  }
  if (stiffest > too_stiff * stiffness_.diagonal().head<3>().maxCoeff()) return false;
  Matrix6 weighed = stiffness_;
  weighed.rightCols<3>() /= size_;
  weighed.bottomRows<3>() /= size_;
  factor_.compute(weighed);
  const Vector6 pivots = factor_.matrixLLT().diagonal();
  return factor_.info() == Eigen::Success && pivots.minCoeff() > 1e-5 * pivots.maxCoeff();
}

Vector6 MsaSweep::moved_by(Vector6 F) const {
  F.tail<3>() /= size_;
  Vector6 d = factor_.solve(F);
  d.tail<3>() /= size_;
  return d;
}

bool MsaSweep::solve(const Vector6& F_T_W) {
  if (!held_) return false;
  Vector6 F = F_T_W;
  F.head<3>() += weight_;
  if (linear_) {
    displacement_ = moved_by(F);
    iterations_ = 1;
  } else if (!(F.isZero(0) ? rest() : iterate(F))) {
    return false;
  }
  energy_ = 0;
  reaction_.setZero();
  for (const CondensedLeg& leg : legs_) {
    const CondensedLeg::LegForces r = leg.follow(displacement_);
    energy_ += r.energy;
    reaction_ += r.reaction;
  }
  return true;
}

/// The springs by what they yield at this force beside the preload. Returns false where one has no stiffness there.
bool MsaSweep::linearise_about(double force) {
  bool all_hold = true;
  for (CondensedLeg& leg : legs_)
    for (CondensedLeg::Spring& spring : leg.springs()) {
      spring.k = force > 0 ? tangent_at_force(spring.law, force) : tangent(spring.law, 0);
      spring.s = 0;
      all_hold = all_hold && spring.k > 0;
    }
  return all_hold;
}

/// No load: nothing moves, if the legs hold T when each spring carries a newton.
bool MsaSweep::rest() {
  const auto take_in = [](CondensedLeg& leg) { return leg.linearise(); };
  if (!linearise_about(1) || !std::all_of(legs_.begin(), legs_.end(), take_in) || !assemble()) return false;
  (void)linearise_about(0);
  if (!std::all_of(legs_.begin(), legs_.end(), take_in)) return false;
  displacement_.setZero();
  stiffness_.setZero();
  for (CondensedLeg& leg : legs_) {
    leg.stretch(displacement_);
    stiffness_ += leg.stiffness();
  }
  iterations_ = 1;
  return true;
}

/// Newton on the springs' forces.
bool MsaSweep::iterate(const Vector6& F) {
  const double size = std::hypot(F.head<3>().norm(), F.tail<3>().norm() / size_);
  if (!linearise_about(size)) return false;
  for (iterations_ = 1; iterations_ <= most_iterations; ++iterations_) {
    Vector6 left = F;
    for (CondensedLeg& leg : legs_) {
      if (leg.springs().empty()) continue;
      if (!leg.linearise()) return false;
      left -= leg.pull();
    }
    if (!assemble()) return false;
    displacement_ = moved_by(left);
    double largest = size;
    for (CondensedLeg& leg : legs_) {
      leg.stretch(displacement_);
      for (const CondensedLeg::Spring& spring : leg.springs())
        largest = std::max(largest, std::abs(spring.force) * (spring.law.rotation ? 1 / size_ : 1));
    }
    const double change = settle();
    if (!std::isfinite(change)) return false;
    if (change <= settled * largest) return true;
  }
  return false;
}

/// Springs linearised about the forces that they have been found to carry: how far that changes what they pull with at
/// the elongation found, N or Nm; infinite where a contact carries nothing.
double MsaSweep::settle() {
  double change = 0;
  for (CondensedLeg& leg : legs_)
    for (CondensedLeg::Spring& spring : leg.springs()) {
      const auto [at, stiffness] = yielding(spring.law, spring.force);
      spring.k = stiffness;
      if (!(spring.k > 0) || !std::isfinite(spring.k)) return INFINITY;
      spring.s = spring.force - spring.k * at;
      change = std::max(change, spring.k * std::abs(spring.elongation - at));
    }
  return change;
}

void MsaSweep::find_passive_twists(const Configuration& c, std::size_t leg, Matrix6X& out) const {
  legs_[leg].find_passive_twists(c.legs[leg], c.pose.p_WT, out);
}

}  // namespace deflect::frame
