#include "msa/frame/mechanism/condensed_leg.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/frame/laws/component.h"
#include "msa/mechanism/law.h"

namespace deflect::frame {
namespace {

constexpr double idle = 1e-12;  // of a freedom's own stiffness, what is rounding

/// Of the body at `at`, for a unit motion in freedom i of the joint.
Vector6 motion(const PlacedJoint& j, std::size_t i, const Vector3& at) {
  const Vector3 axis = j.R_WJ.col(as_index(i % 3));
  Vector6 t = Vector6::Zero();
  if (i < 3)
    t.head<3>() = axis;
  else
    t << axis.cross(at - j.p_W), axis;
  return t;
}

/// To another point of the same body, X = [1 −[r]×; 0 1], d_old = X d_new.
template <class Columns>
void move_to(const Vector3& point, Vector3& at, Matrix6& K, Columns& G) {
  const Vector3 r = at - point;
  at = point;
  if (r.isZero(0)) return;
  const Matrix3 B = -skew(r);
  K.rightCols<3>() += K.leftCols<3>().lazyProduct(B);
  K.bottomRows<3>() += B.transpose().lazyProduct(K.topRows<3>()).eval();
  G.template bottomRows<3>() += B.transpose().lazyProduct(G.template topRows<3>());
}

/// Of a symmetric K.
Matrix6 turned(const Matrix3& R, const Matrix6& K) {
  Matrix6 out;
  const auto turn = [&](Eigen::Index i, Eigen::Index j) {
    const Matrix3 once = R.lazyProduct(K.block<3, 3>(i, j));
    out.block<3, 3>(i, j) = once.lazyProduct(R.transpose());
  };
  turn(0, 0), turn(3, 0), turn(3, 3);
  out.topRightCorner<3, 3>() = out.bottomLeftCorner<3, 3>().transpose();
  return out;
}

/// Twists or wrenches, in columns.
template <class Columns>
Columns turned(const Matrix3& R, const Columns& w) {
  Columns out(6, w.cols());
  out.template topRows<3>() = R.lazyProduct(w.template topRows<3>());
  out.template bottomRows<3>() = R.lazyProduct(w.template bottomRows<3>());
  return out;
}

/// H = L D Lᵀ of a positive definite H, without pivots, for columns that are solved side by side: Eigen packs several
/// columns as it does for large matrices, and divides in each.
class Factored {
 public:
  explicit Factored(const Matrix6& H) {
    for (Eigen::Index j = 0; j < 6; ++j) {
      double along[6], pivot = H(j, j);
      for (Eigen::Index k = 0; k < j; ++k) {
        along[k] = L_(j, k) * D_[k];
        pivot -= along[k] * L_(j, k);
      }
      positive_ = positive_ && pivot > 0;
      D_[j] = pivot;
      inverse_[j] = 1 / pivot;
      for (Eigen::Index i = j + 1; i < 6; ++i) {
        double rest = H(i, j);
        for (Eigen::Index k = 0; k < j; ++k) rest -= L_(i, k) * along[k];
        L_(i, j) = rest * inverse_[j];
      }
    }
  }
  bool positive() const { return positive_; }

  /// H⁻¹ w.
  Matrix6 solve(const Matrix6& w) const { return solved(Eigen::Matrix<double, 6, 6, Eigen::RowMajor>(w)); }
  template <class Columns>
  Columns solve_each(Columns w) const {
    for (Eigen::Index i = 0; i < w.cols(); ++i) w.col(i) = solved(Vector6(w.col(i)));
    return w;
  }

 private:
  template <class Rows>
  Rows solved(Rows w) const {
    for (Eigen::Index i = 1; i < 6; ++i)
      for (Eigen::Index j = 0; j < i; ++j) w.row(i) -= L_(i, j) * w.row(j);
    for (Eigen::Index i = 6; i-- > 0;) {
      w.row(i) *= inverse_[i];
      for (Eigen::Index j = i + 1; j < 6; ++j) w.row(i) -= L_(j, i) * w.row(j);
    }
    return w;
  }

  bool positive_ = true;
  Matrix6 L_;  // below its diagonal
  double D_[6], inverse_[6];
};

}  // namespace

CondensedLeg::CondensedLeg(const PlacedLeg& placed, const MemberDivision& division) {
  applies_ = !placed.beside && placed.misfit.isZero(0);
  bool member_seen = false;
  std::size_t freedoms_before = 0;
  for (std::size_t part = 0; applies_ && part < placed.parts.size(); ++part) {
    Step step{part, {}, {}};
    if (const auto* member = std::get_if<PlacedMember>(&placed.parts[part])) {
      const auto found = division.find(member->part);
      step.member = Member{CondensedMember(found == division.end() ? std::vector<double>{0, 1} : found->second)};
      if (!member_seen) first_member_ = steps_.size();
      member_seen = true;
    } else if (const auto* joint = std::get_if<PlacedJoint>(&placed.parts[part]); joint && !joint->stiffness) {
      add_freedoms(step, *joint);
      if (step.freedoms.empty()) continue;
      if (!member_seen) freedoms_before += step.freedoms.size();
    } else {
      applies_ = false;
    }
    steps_.push_back(std::move(step));
  }
  applies_ = applies_ && member_seen && freedoms_before <= most && springs_.size() <= most;
}

void CondensedLeg::add_freedoms(Step& step, const PlacedJoint& joint) {
  for (std::size_t i = 0; i < 6; ++i) {
    if (joint.free(i)) step.freedoms.push_back({i, -1});
    for (const Law& law : joint.laws[i]) {
      if (row_of(law).length_from_pose) {
        applies_ = false;
        return;
      }
      SpringLaw spring = preloaded(spring_of(law), joint.preload[i]);
      spring.rotation = i >= 3;
      applies_ = applies_ && !jumps(spring);
      if (is_linear(spring)) {
        step.freedoms.push_back({i, -1, tangent(spring, 0)});
      } else {
        step.freedoms.push_back({i, std::ssize(springs_)});
        springs_.push_back({spring});
      }
    }
  }
}

bool CondensedLeg::condense(const PlacedLeg& placed, const Vector3& p_WT) {
  p_WT_ = p_WT;
  stiffest_ = 0;
  for (Step& step : steps_)
    if (step.member) {
      const auto& member = std::get<PlacedMember>(placed.parts[step.part]);
      step.member->p_W_start = member.p_W_start;
      step.member->p_W_end = member.p_W_end;
      step.member->R_WM = member.R_WM;
      if (!step.member->condensed.set(rigidity(member), member.length())) return false;
      stiffest_ = std::max(stiffest_, step.member->condensed.stiffest());
    }
  const auto n = std::ssize(springs_);
  Behind now;
  now.at = steps_[first_member_].member->p_W_start;  // what lies before it is referred to it
  now.G.setZero(6, n);
  now.A.setZero(n, n);
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    Step& step = steps_[i];
    if (step.member) {
      if (!pass(*step.member, now, i == first_member_)) return false;
      continue;
    }
    step.at = now.at;
    for (Freedom& f : step.freedoms) {
      f.t = motion(std::get<PlacedJoint>(placed.parts[step.part]), f.index, step.at);
      if (i > first_member_) pass(f, now);
    }
  }
  move_to(p_WT_, now.at, now.K, now.G);
  end_ = held_ = now;
  s_.resize(n);
  theta_.resize(n);
  return true;
}

/// Over a member, which leaves what it needs to be followed back.
bool CondensedLeg::pass(Member& member, Behind& now, bool first) const {
  const Matrix12& k = member.condensed.stiffness();
  move_to(member.p_W_start, now.at, now.K, now.G);
  Motions G = turned(Matrix3(member.R_WM.transpose()), now.G);
  Matrix6 K;
  if (first) {
    if (!start(member, G)) return false;
    K = k.bottomRightCorner<6, 6>() + k.bottomLeftCorner<6, 6>().lazyProduct(member.back);
  } else {
    const Matrix6 behind = turned(member.R_WM.transpose(), now.K);
    const Factored M(k.topLeftCorner<6, 6>() + behind);
    if (!M.positive()) return false;
    member.back = -M.solve(k.topRightCorner<6, 6>());
    member.back_springs = -M.solve_each(G);
    Matrix6 pulls = behind.lazyProduct(member.back);
    const double length = (member.p_W_end - member.p_W_start).norm();
    pulls.row(4) += length * pulls.row(2);
    pulls.row(5) -= length * pulls.row(1);
    K = (pulls + pulls.transpose()) / 2;  // as the walk takes it to be
  }
  now.at = member.p_W_end;
  now.A += G.transpose().lazyProduct(member.back_springs);
  now.K = turned(member.R_WM, K);
  now.G = turned(member.R_WM, Motions(k.bottomLeftCorner<6, 6>().lazyProduct(member.back_springs)));
  return true;
}

/// At the start of the first member, its axes: how d_a follows d_b and the springs, joints behind it; G is k_aa Φ of
/// the springs.
bool CondensedLeg::start(Member& member, Motions& G) const {
  const Matrix12& k = member.condensed.stiffness();
  Motions springs = Motions::Zero(6, G.cols()), others(6, 0);
  Angles stiffness(0);
  for (std::size_t i = 0; i < first_member_; ++i)
    for (const Freedom& f : steps_[i].freedoms) {
      const Vector6 t = turned(Matrix3(member.R_WM.transpose()), f.t);
      if (f.kept >= 0) {
        springs.col(f.kept) = t;
        continue;
      }
      const Eigen::Index n = others.cols();
      others.conservativeResize(6, n + 1);
      others.col(n) = t;
      stiffness.conservativeResize(n + 1);
      stiffness(n) = f.k;
    }
  G = k.topLeftCorner<6, 6>().lazyProduct(springs);
  member.back.setZero();
  member.back_springs = springs;
  if (others.cols() == 0) return true;
  Square H = others.transpose() * k.topLeftCorner<6, 6>() * others;
  H.diagonal() += stiffness;
  const Eigen::LLT<Square> llt(H);
  if (llt.info() != Eigen::Success) return false;
  const Motions across = k.bottomLeftCorner<6, 6>() * others;
  member.back -= others * llt.solve(across.transpose());
  member.back_springs -= others * llt.solve(Square(others.transpose() * G));
  return true;
}

/// Over a freedom of a joint.
void CondensedLeg::pass(Freedom& f, Behind& now) {
  f.u.noalias() = now.K * f.t;
  f.g = now.G.transpose().lazyProduct(f.t);
  if (f.kept >= 0) {
    now.G.col(f.kept) = -f.u;
    now.A.col(f.kept) = -f.g;
    now.A.row(f.kept) = -f.g.transpose();
    now.A(f.kept, f.kept) = f.t.dot(f.u);
    return;
  }
  f.a = f.t.dot(f.u) + f.k;
  if (!(f.a > idle * f.t.cwiseAbs2().dot(now.K.diagonal().cwiseAbs()))) {
    f.a = 0;
    return;
  }
  now.K -= (f.u / f.a) * f.u.transpose();
  now.G -= (f.u / f.a).lazyProduct(f.g.transpose());
  now.A -= (f.g / f.a).lazyProduct(f.g.transpose());
}

bool CondensedLeg::linearise() {
  held_ = end_;
  p_.setZero();
  const Eigen::Index n = theta_.size();
  bool all_hold = true;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Spring& spring = nth(springs_, i);
    if (!(spring.k >= 0) || !std::isfinite(spring.k)) return false;
    all_hold = all_hold && spring.k > 0;
    held_.A(i, i) += spring.k;
    s_(i) = spring.s;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    const double a = held_.A(i, i);
    if (nth(springs_, i).k == 0 && !(a > idle * end_.A(i, i))) {  // a free joint that does not move, as in pass()
      held_.A(i, i) = 1;
      held_.A.row(i).tail(n - i - 1).setZero();
      held_.G.col(i).setZero();
      continue;
    }
    if (!(a > 0)) return false;
    const Vector6 u = held_.G.col(i) / a;
    held_.K -= u * held_.G.col(i).transpose();
    p_ -= u * s_(i);
    for (Eigen::Index j = i + 1; j < n; ++j) {
      const double share = held_.A(i, j) / a;
      held_.G.col(j) -= share * held_.G.col(i);
      held_.A.col(j).tail(n - i - 1) -= share * held_.A.col(i).tail(n - i - 1);
      s_(j) -= share * s_(i);
    }
  }
  if (!all_hold && held_.K.cwiseAbs().maxCoeff() < idle * end_.K.cwiseAbs().maxCoeff()) held_.K.setZero();
  return true;
}

void CondensedLeg::stretch(const Vector6& d) {
  for (Eigen::Index i = theta_.size(); i-- > 0;) {
    double pull = s_(i) + held_.G.col(i).dot(d);
    for (Eigen::Index j = i + 1; j < theta_.size(); ++j) pull += held_.A(i, j) * theta_(j);
    theta_(i) = -pull / held_.A(i, i);
    Spring& spring = nth(springs_, i);
    spring.elongation = theta_(i);
    spring.force = spring.s + spring.k * theta_(i);
  }
}

CondensedLeg::LegForces CondensedLeg::follow(const Vector6& d_T) const {
  LegForces out;
  Vector6 d = d_T, foot = Vector6::Zero();
  Vector3 at = p_WT_;
  const auto see_from = [&](const Vector3& point) {
    d.head<3>() += d.tail<3>().cross(point - at);
    at = point;
  };
  for (std::size_t i = steps_.size(); i-- > first_member_;) {
    const Step& step = steps_[i];
    if (const auto& member = step.member) {
      see_from(member->p_W_end);
      Vector12 ends;
      ends.tail<6>() = turned(Matrix3(member->R_WM.transpose()), d);
      ends.head<6>() = member->back * ends.tail<6>() + member->back_springs.lazyProduct(theta_);
      const Vector12 forces = member->condensed.stiffness() * ends;
      out.energy += 0.5 * forces.dot(ends);
      d = turned(member->R_WM, Vector6(ends.head<6>()));
      foot = turned(member->R_WM, Vector6(forces.head<6>()));
      at = member->p_W_start;
      continue;
    }
    see_from(step.at);
    for (std::size_t n = step.freedoms.size(); n-- > 0;) {
      const Freedom& f = step.freedoms[n];
      if (f.kept < 0 && f.a == 0) continue;
      const double q = f.kept < 0 ? (f.u.dot(d) + f.g.dot(theta_)) / f.a : theta_(f.kept);
      out.energy += f.k * q * q / 2;
      d -= f.t * q;
    }
  }
  for (std::size_t i = 0; i < first_member_; ++i)
    for (const Freedom& f : steps_[i].freedoms)
      if (f.k > 0) out.energy += std::pow(f.t.dot(foot), 2) / (2 * f.k);
  for (const Spring& spring : springs_) out.energy += frame::energy(spring.law, spring.elongation);
  foot.tail<3>() += (at - p_WT_).cross(foot.head<3>());
  out.reaction = foot;
  return out;
}

void CondensedLeg::find_passive_twists(const PlacedLeg& placed, const Vector3& p_WT, Matrix6X& out) const {
  Eigen::Index count = 0;
  const auto for_each_passive = [&](const auto& f) {
    for (const Step& step : steps_)
      for (const Freedom& freedom : step.freedoms)
        if (freedom.kept < 0 && freedom.k == 0) f(step.part, freedom.index);
  };
  for_each_passive([&](std::size_t, std::size_t) { ++count; });
  out.resize(6, count);
  count = 0;
  for_each_passive([&](std::size_t part, std::size_t index) {
    out.col(count++) = motion(std::get<PlacedJoint>(placed.parts[part]), index, p_WT);
  });
}

}  // namespace deflect::frame
