#include "msa/frame/msa_sweep.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "msa/frame/component.h"

namespace deflect::frame {
namespace {

constexpr double settled = 1e-13;  // change of the springs' forces, of the largest
constexpr int most_iterations = 40;
constexpr double too_stiff = 1e5;  // beside the whole
constexpr double idle = 1e-12;     // of a freedom's own stiffness, what is rounding

bool rigid(const PlacedJoint& j) {
  for (std::size_t i = 0; i < 6; ++i)
    if (j.elastic(i) || j.free(i)) return false;
  return true;
}

/// Of the body at `at`, for a unit motion in freedom i of the joint.
Vector6 motion(const PlacedJoint& j, std::size_t i, const Vector3& at) {
  const Vector3 axis = j.R_WJ.col(static_cast<Eigen::Index>(i % 3));
  Vector6 t = Vector6::Zero();
  if (i < 3)
    t.head<3>() = axis;
  else
    t << axis.cross(at - j.p_W), axis;
  return t;
}

/// To another point of the same body, X = [1 −[r]×; 0 1], d_old = X d_new.
void move_to(const Vector3& point, Vector3& at, Matrix6& K, Vector6& p) {
  const Vector3 r = at - point;
  at = point;
  if (r.isZero(0)) return;
  const Matrix3 B = -skew(r);
  K.rightCols<3>() += K.leftCols<3>().lazyProduct(B);
  K.bottomRows<3>() += B.transpose().lazyProduct(K.topRows<3>()).eval();
  p.tail<3>() += B.transpose() * p.head<3>();
}

Matrix6 turned(const Matrix3& R, const Matrix6& K) {
  Matrix6 out;
  for (Eigen::Index j = 0; j < 6; j += 3)
    for (Eigen::Index i = 0; i < 6; i += 3) {
      const Matrix3 once = R.lazyProduct(K.block<3, 3>(i, j));
      out.block<3, 3>(i, j) = once.lazyProduct(R.transpose());
    }
  return out;
}

Vector6 turned(const Matrix3& R, const Vector6& p) {
  Vector6 out;
  out << R * p.head<3>(), R * p.tail<3>();
  return out;
}

}  // namespace

MsaSweep::MsaSweep(const Configuration& c, const MemberDivision& division) {
  applies_ = rigid(c.base) && rigid(c.tool);
  for (const PlacedLeg& placed : c.legs) {
    applies_ = applies_ && !placed.beside && placed.misfit.isZero(0);
    Leg leg;
    bool member_seen = false;
    std::size_t motions_before = 0;
    leg.first_nonlinear = SIZE_MAX;
    for (std::size_t part = 0; applies_ && part < placed.parts.size(); ++part) {
      Step step{part, {}, {}, {}};
      if (const auto* member = std::get_if<PlacedMember>(&placed.parts[part])) {
        const auto found = division.find(member->part);
        const std::vector<double> at = found == division.end() ? std::vector<double>{0, 1} : found->second;
        for (std::size_t i = 1; i < at.size(); ++i)
          step.elements.push_back({at[i] - at[i - 1], Matrix6::Zero(), Vector6::Zero()});
        if (!member_seen) leg.first_member = leg.steps.size();
        member_seen = true;
      } else if (const auto* joint = std::get_if<PlacedJoint>(&placed.parts[part]); joint && !joint->stiffness) {
        for (std::size_t i = 0; i < 6; ++i) {
          if (joint->free(i)) step.freedoms.push_back({i, -1, Vector6::Zero(), Vector6::Zero()});
          for (const Law& law : joint->laws[i]) {
            if (std::holds_alternative<CableLaw>(law)) {
              applies_ = false;
              break;
            }
            SpringLaw spring = preloaded(spring_of(law), joint->preload[i]);
            spring.rotation = i >= 3;
            applies_ = applies_ && !jumps(spring);
            if (!is_linear(spring)) leg.first_nonlinear = std::min(leg.first_nonlinear, leg.steps.size());
            step.freedoms.push_back({i, static_cast<int>(springs_.size()), Vector6::Zero(), Vector6::Zero()});
            springs_.push_back({spring, is_linear(spring) ? tangent(spring, 0) : 0});
          }
        }
        if (step.freedoms.empty()) continue;
        if (!member_seen) motions_before += step.freedoms.size();
      } else {
        applies_ = false;
      }
      leg.steps.push_back(std::move(step));
    }
    applies_ = applies_ && member_seen && motions_before <= most_motions;
    if (leg.first_nonlinear < SIZE_MAX) linear_ = false;
    if (leg.first_nonlinear < leg.first_member) leg.first_nonlinear = 0;
    legs_.push_back(std::move(leg));
  }
}

/// Over the first element of the first member, joints behind it.
bool MsaSweep::start(Leg& leg, const PlacedMember& member, const Matrix12& k, Element& element, Matrix6& K,
                     Vector6& p) {
  Motions motions(6, 0);
  Angles stiffness(0), s(0);
  for (std::size_t i = 0; i < leg.first_member; ++i)
    for (const Freedom& f : leg.steps[i].freedoms) {
      const Eigen::Index n = motions.cols();
      motions.conservativeResize(6, n + 1);
      motions.col(n) = turned(member.R_WM.transpose(), f.t);
      stiffness.conservativeResize(n + 1);
      s.conservativeResize(n + 1);
      const Spring* spring = f.spring < 0 ? nullptr : &springs_[static_cast<std::size_t>(f.spring)];
      stiffness(n) = spring ? spring->k : 0;
      s(n) = spring ? spring->s : 0;
    }
  K = k.bottomRightCorner<6, 6>();
  p.setZero();
  element.back.setZero();
  element.shift.setZero();
  leg.theta_back.resize(motions.cols(), 6);
  leg.theta_shift.resize(motions.cols());
  if (motions.cols() == 0) return true;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_motions, most_motions> A =
      motions.transpose() * k.topLeftCorner<6, 6>() * motions;
  A.diagonal() += stiffness;
  const Eigen::LLT<decltype(A)> llt(A);
  if (llt.info() != Eigen::Success) return false;
  leg.theta_back = -llt.solve(AnglesBy6(motions.transpose() * k.topRightCorner<6, 6>()));
  leg.theta_shift = -llt.solve(s);
  element.back = motions * leg.theta_back;
  element.shift = motions * leg.theta_shift;
  K += k.bottomLeftCorner<6, 6>() * element.back;
  p = k.bottomLeftCorner<6, 6>() * element.shift;
  return true;
}

/// From step `from` on, what lies before it as it was.
bool MsaSweep::condense(Leg& leg, const PlacedLeg& placed, const Vector3& p_WT, std::size_t from) {
  Pull now = leg.steps[from].before;
  for (std::size_t i = from; i < leg.steps.size(); ++i) {
    Step& step = leg.steps[i];
    step.before = now;
    if (const auto* joint = std::get_if<PlacedJoint>(&placed.parts[step.part])) {
      // Before the first member everything is referred to its start.
      const Vector3 at = i < leg.first_member
                             ? std::get<PlacedMember>(placed.parts[leg.steps[leg.first_member].part]).p_W_start
                             : now.at;
      for (Freedom& f : step.freedoms) {
        f.t = motion(*joint, f.index, at);
        if (i < leg.first_member) continue;
        const Spring* spring = f.spring < 0 ? nullptr : &springs_[static_cast<std::size_t>(f.spring)];
        f.u.noalias() = now.K * f.t;
        f.a = f.t.dot(f.u) + (spring ? spring->k : 0);
        f.pull = f.t.dot(now.p) - (spring ? spring->s : 0);
        if (!(f.a > idle * f.t.cwiseAbs2().dot(now.K.diagonal().cwiseAbs()))) {
          f.a = 0;
          continue;
        }
        now.K -= (f.u / f.a) * f.u.transpose();
        now.p -= f.u * (f.pull / f.a);
      }
      continue;
    }
    const auto& member = std::get<PlacedMember>(placed.parts[step.part]);
    const BeamRigidity r = rigidity(member);
    const double length = member.length();
    const bool first = i == leg.first_member;
    Matrix6 K;
    Vector6 p;
    if (!first) {
      move_to(member.p_W_start, now.at, now.K, now.p);
      K = turned(member.R_WM.transpose(), now.K);
      p = turned(member.R_WM.transpose(), now.p);
    }
    Matrix12 k;
    double share = -1;
    for (std::size_t e = 0; e < step.elements.size(); ++e) {
      Element& element = step.elements[e];
      if (element.share != share) k = local_stiffness(r, element.share * length);
      share = element.share;
      stiffest_ = std::max(stiffest_, k.diagonal().head<3>().maxCoeff());
      if (first && e == 0) {
        if (!start(leg, member, k, element, K, p)) return false;
        continue;
      }
      const Matrix6 M = k.topLeftCorner<6, 6>() + K;
      const Eigen::LLT<Matrix6> llt(M);
      if (llt.info() != Eigen::Success) return false;
      element.back = -llt.solve(Matrix6(k.topRightCorner<6, 6>()));
      element.shift = -llt.solve(p);
      K = k.bottomRightCorner<6, 6>() + k.bottomLeftCorner<6, 6>().lazyProduct(element.back);
      p = k.bottomLeftCorner<6, 6>() * element.shift;
    }
    now.at = member.p_W_end;
    now.K = turned(member.R_WM, K);
    now.p = turned(member.R_WM, p);
  }
  move_to(p_WT, now.at, now.K, now.p);
  leg.end = now;
  return true;
}

/// From the platform back to the ground: the springs' motions and forces. Calls of_element(member, element, d_a, d_b)
/// with the displacements of its ends, member axes.
template <class OfElement>
void MsaSweep::follow(Leg& leg, const PlacedLeg& placed, const Vector3& p_WT, const OfElement& of_element) {
  Vector6 d = displacement_;
  Vector3 at = p_WT;
  const auto see_from = [&](const Vector3& point) {
    d.head<3>() += d.tail<3>().cross(point - at);
    at = point;
  };
  const auto tell = [&](int number, double theta) {
    if (number < 0) return;
    Spring& spring = springs_[static_cast<std::size_t>(number)];
    spring.elongation = theta;
    spring.force = spring.s + spring.k * theta;
  };
  for (std::size_t i = leg.steps.size(); i-- > leg.first_member;) {
    Step& step = leg.steps[i];
    if (const auto* member = std::get_if<PlacedMember>(&placed.parts[step.part])) {
      see_from(member->p_W_end);
      d = turned(member->R_WM.transpose(), d);
      for (std::size_t e = step.elements.size(); e-- > 0;) {
        if (i == leg.first_member && e == 0) {
          Eigen::Index n = 0;
          const Angles theta = leg.theta_back * d + leg.theta_shift;
          for (std::size_t joint = 0; joint < i; ++joint)
            for (const Freedom& f : leg.steps[joint].freedoms) tell(f.spring, theta(n++));
        }
        const Vector6 near = step.elements[e].back * d + step.elements[e].shift;
        of_element(*member, step.elements[e], near, d);
        d = near;
      }
      d = turned(member->R_WM, d);
      at = member->p_W_start;
      continue;
    }
    see_from(step.before.at);
    for (std::size_t n = step.freedoms.size(); n-- > 0;) {
      const Freedom& f = step.freedoms[n];
      if (f.a == 0) continue;
      const double theta = (f.u.dot(d) + f.pull) / f.a;
      tell(f.spring, theta);
      d -= f.t * theta;
    }
  }
}

void MsaSweep::follow_springs(const Configuration& c) {
  for (std::size_t l = 0; l < legs_.size(); ++l)
    follow(legs_[l], c.legs[l], c.pose.p_WT,
           [](const PlacedMember&, const Element&, const Vector6&, const Vector6&) {});
}

/// Energies and reactions of the elements themselves.
void MsaSweep::conclude(const Configuration& c) {
  energy_ = 0;
  reaction_.setZero();
  for (std::size_t l = 0; l < legs_.size(); ++l) {
    Vector6 foot = Vector6::Zero();  // on the first end of the last element that is reported, the first of the leg
    Vector3 p_W_foot = Vector3::Zero();
    follow(legs_[l], c.legs[l], c.pose.p_WT,
           [&](const PlacedMember& member, const Element& element, const Vector6& a, const Vector6& b) {
             const Matrix12 k = local_stiffness(rigidity(member), element.share * member.length());
             Vector12 ends;
             ends << a, b;
             const Vector12 forces = k * ends;
             energy_ += 0.5 * forces.dot(ends);
             foot = turned(member.R_WM, Vector6(forces.head<6>()));
             p_W_foot = member.p_W_start;
           });
    foot.tail<3>() += (p_W_foot - c.pose.p_WT).cross(foot.head<3>());
    reaction_ += foot;
  }
  for (const Spring& spring : springs_) energy_ += frame::energy(spring.law, spring.elongation);
}

Matrix6X MsaSweep::passive_twists(const Configuration& c, std::size_t leg) const {
  Matrix6X out(6, 0);
  for (const Step& step : legs_[leg].steps)
    for (const Freedom& f : step.freedoms)
      if (f.spring < 0) {
        out.conservativeResize(6, out.cols() + 1);
        out.rightCols<1>() = motion(std::get<PlacedJoint>(c.legs[leg].parts[step.part]), f.index, c.pose.p_WT);
      }
  return out;
}

/// Springs linearised about the forces that they have been found to carry: how far that changes what they pull with at
/// the elongation found, N or Nm; infinite where a contact carries nothing.
double MsaSweep::settle() {
  double change = 0;
  for (Spring& spring : springs_) {
    if (is_linear(spring.law)) continue;
    const double at = frame::elongation(spring.law, spring.force);
    spring.k = std::visit([&](const auto& l) { return l.at_force(spring.force + spring.law.preload); }, spring.law);
    if (!(spring.k > 0) || !std::isfinite(spring.k)) return INFINITY;
    spring.s = spring.force - spring.k * at;
    change = std::max(change, spring.k * std::abs(spring.elongation - at));
  }
  return change;
}

bool MsaSweep::solve(const Configuration& c, const Vector6& F_T_W) {
  Vector6 F = F_T_W, weight = Vector6::Ones();
  F.head<3>() += c.weight;
  weight.tail<3>().setConstant(1 / c.size);
  const double size = F.cwiseProduct(weight).norm();
  for (Spring& spring : springs_) {
    spring.s = 0;
    if (is_linear(spring.law)) continue;
    spring.k = tangent_at_force(spring.law, size);
    if (!(spring.k > 0)) return false;
  }
  stiffest_ = 0;
  for (iterations_ = 1; iterations_ <= most_iterations; ++iterations_) {
    stiffness_.setZero();
    Vector6 left = F;
    for (std::size_t l = 0; l < legs_.size(); ++l) {
      Leg& leg = legs_[l];
      if (iterations_ == 1 || leg.first_nonlinear < SIZE_MAX) {
        const std::size_t from = iterations_ == 1 ? 0 : leg.first_nonlinear;
        if (!condense(leg, c.legs[l], c.pose.p_WT, from)) return false;
      }
      stiffness_ += leg.end.K;
      left -= leg.end.p;
    }
    if (stiffest_ > too_stiff * stiffness_.diagonal().head<3>().maxCoeff()) return false;
    const Matrix6 weighed = weight.asDiagonal() * stiffness_ * weight.asDiagonal();
    const Eigen::LLT<Matrix6> llt(weighed);
    const Vector6 pivots = llt.matrixLLT().diagonal();
    if (llt.info() != Eigen::Success || !(pivots.minCoeff() > 1e-5 * pivots.maxCoeff())) return false;
    displacement_ = weight.cwiseProduct(llt.solve(weight.cwiseProduct(left)));
    if (linear_) {
      conclude(c);
      return true;
    }
    follow_springs(c);
    double largest = size;
    for (const Spring& spring : springs_)
      largest = std::max(largest, std::abs(spring.force) * (spring.law.rotation ? 1 / c.size : 1));
    const double change = settle();
    if (!std::isfinite(change)) return false;
    if (change <= settled * largest) {
      conclude(c);
      return true;
    }
  }
  return false;
}

}  // namespace deflect::frame
