#include "analytic/pose_sweep.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "analytic/chain.h"
#include "analytic/member.h"
#include "msa/base/index.h"

namespace deflect::analytic {
namespace {

constexpr double dependent = 1e-9;  // of twists, as in complement()

/// The wrenches that do no work on the twists, as many columns as come out: Gauss and Jordan with full pivoting on the
/// rows twistᵀ, rotations weighed by the length.
template <class Twists, class Columns>
void carried_by(const Twists& twists, double length, Columns& N) {
  const std::size_t count = as_size(twists.cols());
  double row[Twists::MaxColsAtCompileTime][6];
  std::array<Eigen::Index, 6> freedom = {0, 1, 2, 3, 4, 5};  // by column
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i)
    for (Eigen::Index k = 0; k < 6; ++k) {
      row[i][k] = twists(k, as_index(i)) * (k < 3 ? 1 : length);
      largest = std::max(largest, std::abs(row[i][k]));
    }
  std::size_t rank = 0;
  for (; rank < std::min<std::size_t>(6, count); ++rank) {
    std::size_t pivot_row = rank, pivot = rank;
    double most = 0;
    for (std::size_t i = rank; i < count; ++i)
      for (std::size_t k = rank; k < 6; ++k)
        if (const double size = std::abs(row[i][k]); size > most) most = size, pivot_row = i, pivot = k;
    if (!(most > dependent * largest)) break;
    if (pivot_row != rank) std::swap(row[rank], row[pivot_row]);
    if (pivot != rank) {
      for (std::size_t i = 0; i < count; ++i) std::swap(row[i][rank], row[i][pivot]);
      std::swap(freedom[rank], freedom[pivot]);
    }
    const double own = 1 / row[rank][rank];
    for (std::size_t k = rank + 1; k < 6; ++k) row[rank][k] *= own;
    for (std::size_t i = 0; i < count; ++i) {
      if (i == rank) continue;
      const double factor = row[i][rank];
      for (std::size_t k = rank + 1; k < 6; ++k) row[i][k] -= factor * row[rank][k];
    }
  }
  N.setZero(6, as_index(6 - rank));
  for (std::size_t k = rank; k < 6; ++k) {
    auto column = N.col(as_index(k - rank));
    column(freedom[k]) = 1;
    for (std::size_t r = 0; r < rank; ++r) column(freedom[r]) = -row[r][k];
    column.normalize();
  }
  N.template bottomRows<3>() *= length;
}

}  // namespace

PoseSweep::PoseSweep(const Configuration& c) {
  applies_ = c.base.rigid() && c.tool.rigid();
  for (std::size_t l = 0; applies_ && l < c.legs.size(); ++l) {
    const PlacedLeg& placed = c.legs[l];
    Leg leg;
    applies_ = !placed.beside && placed.misfit.isZero(0);
    for (std::size_t p = 0; applies_ && p < placed.parts.size(); ++p) {
      const auto shared = [&](const std::string& name) {
        if (parts_.empty() || parts_.back().leg != l || parts_.back().name != name) parts_.push_back({l, name});
        return parts_.size() - 1;
      };
      if (const auto* member = std::get_if<PlacedMember>(&placed.parts[p])) {
        leg.members.push_back({p, shared(member->part), {}});
        continue;
      }
      const auto* joint = std::get_if<PlacedJoint>(&placed.parts[p]);
      applies_ = joint && !joint->stiffness;
      for (std::size_t i = 0; applies_ && i < 6; ++i) {
        if (joint->free(i)) leg.passive.emplace_back(p, i);
        if (!joint->elastic(i)) continue;
        const std::vector<Law>& laws = joint->laws[i];
        applies_ = std::none_of(laws.begin(), laws.end(), deflect::jumps);
        linear_ = linear_ && std::all_of(laws.begin(), laws.end(), deflect::is_linear);
        const bool by_pose =
            std::any_of(laws.begin(), laws.end(), [](const Law& law) { return row_of(law).length_from_pose; });
        leg.springs.push_back({p, i, shared(joint->part), {laws, joint->preload[i]}, by_pose});
      }
    }
    applies_ = applies_ && leg.passive.size() <= most_passive;
    legs_.push_back(std::move(leg));
  }
  derivatives_.resize(parts_.size());
}

/// What the leg carries, and the part of its compliance that no force changes.
void PoseSweep::carry(Leg& leg, const PlacedLeg& placed, const Vector3& p_WT, double length) {
  leg.twists.resize(6, std::ssize(leg.passive));
  for (Eigen::Index k = 0; k < leg.twists.cols(); ++k) {
    const auto& [part, index] = nth(leg.passive, k);
    leg.twists.col(k) = freedom_twist(std::get<PlacedJoint>(placed.parts[part]), index, p_WT);
  }
  carried_by(leg.twists, length, leg.N);
  const Eigen::Index n = leg.N.cols();
  leg.members_A.setZero(n, n);
  leg.expansion.setZero();
  for (Flexible& f : leg.members) {
    const auto& member = std::get<PlacedMember>(placed.parts[f.part]);
    const Matrix6 C = tip_compliance(member);
    const Vector3 arm = p_WT - member.p_W_end;
    Columns w(6, n);  // at the tip, in member axes
    for (Eigen::Index k = 0; k < n; ++k) {
      const Vector3 force = leg.N.col(k).head<3>();
      w.col(k).head<3>() = member.R_WM.transpose() * force;
      w.col(k).tail<3>() = member.R_WM.transpose() * (leg.N.col(k).tail<3>() + arm.cross(force));
    }
    f.A.noalias() = w.transpose().lazyProduct(Columns(C.lazyProduct(w)));
    leg.members_A += f.A;
    leg.expansion += member.expansion * (member.p_W_end - member.p_W_start);
  }
  for (Freedom& f : leg.springs) {
    const auto& joint = std::get<PlacedJoint>(placed.parts[f.part]);
    if (f.given_by_pose) f.spring.laws = joint.laws[f.index];
    const Vector6 twist = freedom_twist(joint, f.index, p_WT);
    for (Eigen::Index k = 0; k < n; ++k) nth(f.twist, k) = twist.dot(leg.N.col(k));
  }
}

/// Whether statics alone gives λ of all legs; false where what depends on a force must know it and does not.
bool PoseSweep::determine() {
  Eigen::Index carried = 0;
  for (const Leg& leg : legs_) carried += leg.N.cols();
  determinate_ = carried == 6;
  if (!determinate_) return linear_;
  Matrix6 all;
  Eigen::Index at = 0;
  for (const Leg& leg : legs_)
    for (Eigen::Index k = 0; k < leg.N.cols(); ++k) all.col(at++) = leg.N.col(k);
  statics_.compute(all);
  const Vector6 pivots = statics_.matrixLU().diagonal().cwiseAbs();
  return pivots.minCoeff() > 1e-12 * pivots.maxCoeff();
}

void PoseSweep::at(const Configuration& c) {
  weight_ = c.weight;
  size_ = c.size;
  for (std::size_t l = 0; l < legs_.size(); ++l) carry(legs_[l], c.legs[l], c.pose.p_WT, size_);
  held_ = determine() && (!linear_ || assemble());
}

/// The legs' compliance and the stiffness of all, at the forces of the laws.
bool PoseSweep::assemble(bool loaded) {
  stiffness_.setZero();
  for (Leg& leg : legs_) {
    const Eigen::Index n = leg.N.cols();
    if (n == 0) continue;
    leg.A = leg.members_A;
    for (Freedom& f : leg.springs) {
      f.yields = compliance(f.spring, f.force);
      if (!std::isfinite(f.yields)) {
        if (loaded) return false;
        continue;
      }
      const Eigen::Map<const Numbers> w(f.twist.data(), n);
      leg.A += f.yields * w.lazyProduct(w.transpose());
    }
    if (!invert(leg)) return false;
    for (Freedom& f : leg.springs)
      if (!std::isfinite(f.yields)) release(leg, f);
    stiffness_ += leg.N * leg.inverse.lazyProduct(leg.N.transpose());
  }
  if (determinate_) return true;
  Matrix6 weighed = stiffness_;
  weighed.rightCols<3>() /= size_;
  weighed.bottomRows<3>() /= size_;
  factor_.compute(weighed);
  return factor_.isPositive() && factor_.vectorD().minCoeff() > 1e-10 * factor_.vectorD().maxCoeff();
}

bool PoseSweep::invert(Leg& leg) {
  const Eigen::Index n = leg.N.cols();
  if (n == 1) {
    if (!(leg.A(0, 0) > 0)) return false;
    leg.inverse = Small::Constant(1, 1, 1 / leg.A(0, 0));
    return true;
  }
  const Eigen::LLT<Small> llt(leg.A);
  const auto pivots = llt.matrixLLT().diagonal();
  if (llt.info() != Eigen::Success || !(pivots.minCoeff() > 1e-6 * pivots.maxCoeff())) return false;
  leg.inverse = llt.solve(Small::Identity(n, n));
  return true;
}

/// A freedom that yields without end: A⁻¹ − A⁻¹w wᵀA⁻¹ / wᵀA⁻¹w, the limit of (A + y w wᵀ)⁻¹. Its part of the
/// stiffness, y A⁻¹w wᵀA⁻¹ / (1 + y wᵀA⁻¹w)², goes to 0.
void PoseSweep::release(Leg& leg, Freedom& f) {
  f.yields = 0;
  const Eigen::Map<const Numbers> w(f.twist.data(), leg.N.cols());
  const Numbers along = leg.inverse.lazyProduct(w);
  const double held = w.dot(along);
  constexpr double rounding = 1e-12;
  const double before = leg.inverse.cwiseAbs().maxCoeff();
  if (!(held > rounding * w.squaredNorm() * before)) return;
  leg.inverse -= (along / held).lazyProduct(along.transpose());
  if (leg.inverse.cwiseAbs().maxCoeff() < rounding * before) leg.inverse.setZero();
}

/// The laws', from λ of their leg.
void PoseSweep::tell_forces(Leg& leg) {
  for (Freedom& f : leg.springs) f.force = Eigen::Map<const Numbers>(f.twist.data(), leg.N.cols()).dot(leg.lambda);
}

/// Of determinate legs: t from N_iᵀ t = e_i.
Vector6 PoseSweep::moved_by_deflections(double warmer) const {
  Vector6 e = Vector6::Zero();
  Eigen::Index at = 0;
  for (const Leg& leg : legs_) {
    const Eigen::Index n = leg.N.cols();
    auto own = e.segment(at, n);
    own = leg.members_A.lazyProduct(leg.lambda);
    if (warmer != 0) own += warmer * leg.N.topRows<3>().transpose() * leg.expansion;
    for (const Freedom& f : leg.springs)
      own += Eigen::Map<const Numbers>(f.twist.data(), n) * deflection(f.spring, f.force);
    at += n;
  }
  return statics_.transpose().solve(e);
}

bool PoseSweep::solve(const Vector6& F_T_W, double warmer) {
  if (!held_ || (warmer != 0 && !determinate_)) return false;
  Vector6 F = F_T_W;
  F.head<3>() += weight_;
  if (determinate_) {
    const Vector6 lambda = statics_.solve(F);
    Eigen::Index at = 0;
    for (Leg& leg : legs_) {
      leg.lambda = lambda.segment(at, leg.N.cols());
      tell_forces(leg);
      at += leg.N.cols();
    }
    if (!linear_ && !assemble(!F.isZero(0) || warmer != 0)) return false;
    displacement_ = moved_by_deflections(warmer);
    return true;
  }
  F.tail<3>() /= size_;
  displacement_ = factor_.solve(F);
  displacement_.tail<3>() /= size_;
  for (Leg& leg : legs_) {
    leg.lambda = leg.inverse * (leg.N.transpose() * displacement_);
    tell_forces(leg);
  }
  return true;
}

Matrix6 PoseSweep::leg_stiffness(std::size_t leg) const {
  const Leg& l = legs_[leg];
  if (l.N.cols() == 0) return Matrix6::Zero();
  return l.N * l.inverse * l.N.transpose();
}

double PoseSweep::energy() const {
  double sum = 0;
  for (const Leg& leg : legs_) {
    for (const Flexible& f : leg.members) sum += 0.5 * leg.lambda.dot(f.A * leg.lambda);
    for (const Freedom& f : leg.springs) sum += stored_energy(f.spring, f.force);
  }
  return sum;
}

const std::vector<Matrix6>& PoseSweep::derivatives() {
  for (Matrix6& d : derivatives_) d.setZero();
  for (const Leg& leg : legs_) {
    const Eigen::Index n = leg.N.cols();
    if (n == 0) continue;
    const Columns line = leg.N.lazyProduct(leg.inverse);
    for (const Flexible& f : leg.members) derivatives_[f.shared] += line * f.A * line.transpose();
    for (const Freedom& f : leg.springs) {
      const Eigen::Map<const Numbers> w(f.twist.data(), n);
      const Vector6 along = line.lazyProduct(w);
      derivatives_[f.shared] += (f.yields * along) * along.transpose();
    }
  }
  return derivatives_;
}

}  // namespace deflect::analytic
