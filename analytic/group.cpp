#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "analytic/chain.h"
#include "msa/base/error.h"
#include "msa/base/index.h"

namespace deflect::analytic {
namespace {

/// Moments in the unit of forces.
Vector6 weighed(const Vector6& F, double length) {
  Vector6 w = F;
  w.tail<3>() /= length;
  return w;
}

}  // namespace

/// Branches side by side: Σ N_i λ_i = F, M_iᵀt = g_i λ_i + e_i, with t = c R y. What yields is eliminated,
/// λ = (mᵀt − e)/g; what hardly yields, or not at all, stays as an unknown force μ along B = RᵀN, with A = RᵀM, so that
/// no digits are lost and rigid branches are constraints:
///   [ Σ (c/g) Rᵀn mᵀR    B          ] [y]   [ Rᵀ(F + Σ n e/g) ]
///   [ Aᵀ                −g/c − Y Zᵀ ] [μ] = [ e/c             ]
/// Z spans the forces of rigid branches that cancel each other, none of which act when the branches fit, Yᵀe = 0.
/// Factorised once for any F and e.
class BranchesInParallel {
 public:
  BranchesInParallel(std::vector<LinearisedBranch> branches, const Matrix6X& R)
      : branches_(std::move(branches)), R_(R) {
    for (const LinearisedBranch& b : branches_)
      if (b.g.size() > 0) c_ = std::max(c_, b.g(0));
    if (c_ == 0) c_ = 1;
    const Eigen::Index r = R.cols();
    MatrixX K = MatrixX::Zero(r, r), A(r, 0), B(r, 0);
    const auto append = [](MatrixX& columns, const VectorX& column) {
      columns.conservativeResize(column.size(), columns.cols() + 1);
      columns.rightCols<1>() = column;
    };
    for (const LinearisedBranch& b : branches_)
      for (Eigen::Index j = 0; j < b.g.size(); ++j) {
        const VectorX n = R.transpose() * b.N.col(j), m = R.transpose() * b.M.col(j);
        if (eliminated(b, j)) {
          K += n * (c_ / b.g(j)) * m.transpose();
        } else {
          append(B, n);
          append(A, m);
          kept_.push_back(b.g(j) / c_);
        }
      }
    const Eigen::Index k = B.cols();
    MatrixX S = MatrixX::Zero(r + k, r + k);
    S.topLeftCorner(r, r) = K;
    if (k > 0) {
      S.topRightCorner(r, k) = B;
      S.bottomLeftCorner(k, r) = A.transpose();
      MatrixX yields = MatrixX::Zero(k, k);
      for (Eigen::Index i = 0; i < k; ++i) {
        S(r + i, r + i) = -nth(kept_, i);
        yields(i, i) = nth(kept_, i) > 0 ? 1 : 0;
      }
      const auto cancelling = [&](const MatrixX& columns) {
        MatrixX rows(k, r + k);
        rows << columns.transpose(), yields;
        return complement(rows);
      };
      Y_ = cancelling(A);
      S.bottomRightCorner(k, k) -= Y_ * cancelling(B).transpose();
    }
    if (k > 0)
      fine_.compute(S.cast<long double>());
    else
      lu_.compute(S);
  }

  const std::vector<LinearisedBranch>& branches() const { return branches_; }

  /// Displacement and the branches' wrenches under F, with e by branch. `size`: of forces, against which contradictions
  /// count.
  void solve(const Vector6& F, const std::vector<VectorX>& e, Vector6& t, std::vector<Vector6>& wrenches, double& size,
             const std::string& name) const {
    const Eigen::Index r = R_.cols(), k = std::ssize(kept_);
    VectorX right(r + k);
    right.head(r) = R_.transpose() * F;
    size = std::max(size, F.norm());
    Eigen::Index rigid = r;
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      const LinearisedBranch& b = branches_[i];
      for (Eigen::Index j = 0; j < b.g.size(); ++j)
        if (eliminated(b, j))
          right.head(r) += R_.transpose() * b.N.col(j) * (e[i](j) / b.g(j));
        else
          right(rigid++) = e[i](j) / c_;
      size = std::max(size, e[i].norm() / c_);
    }
    if (k > 0 && (Y_.transpose() * right.tail(k)).norm() > 1e-9 * size)
      throw ModelError(
          fmt::format("{} cannot be assembled: the misfits contradict each other by {:.3g} mm and nothing yields", name,
                      1e3 * c_ * (Y_.transpose() * right.tail(k)).cwiseAbs().maxCoeff()));
    VectorX solution;
    if (k > 0)
      solution = fine_.solve(right.cast<long double>()).cast<double>();
    else
      solution = lu_.solve(right);
    t = c_ * (R_ * solution.head(r));
    Eigen::Index next = r;
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      const LinearisedBranch& b = branches_[i];
      wrenches[i].setZero();
      for (Eigen::Index j = 0; j < b.g.size(); ++j)
        wrenches[i] += b.N.col(j) * (eliminated(b, j) ? (b.M.col(j).dot(t) - e[i](j)) / b.g(j) : solution(next++));
    }
  }

  Matrix6 compliance() const {
    const Eigen::Index r = R_.cols();
    MatrixX y;
    if (kept_.empty())
      y = lu_.inverse();
    else
      y = fine_.inverse().topLeftCorner(r, r).cast<double>();
    return c_ * (R_ * y * R_.transpose());
  }

 private:
  bool eliminated(const LinearisedBranch& b, Eigen::Index j) const { return b.g(j) > 1e-6 * c_; }

  std::vector<LinearisedBranch> branches_;
  Matrix6X R_;
  double c_ = 0;              // largest compliance
  std::vector<double> kept_;  // g/c of what stays
  MatrixX Y_;
  Eigen::PartialPivLU<MatrixX> lu_;
  /// Where forces are kept: stiff branches that hold each other leave only their small g to tell how they share a load.
  Eigen::PartialPivLU<Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>> fine_;
};

namespace {

/// The twists J to which no wrench of the branches does work, and the others, R.
template <class Branches>
void split(const Branches& branches, double length, Matrix6X& J, Matrix6X& R) {
  Matrix6X N(6, 0);
  for (const auto& b : branches) {
    N.conservativeResize(6, N.cols() + b.N.cols());
    N.rightCols(b.N.cols()) = b.N;
  }
  J = free_twists(N, length);
  Matrix6X wrenches = J;  // that do work on J only
  wrenches.bottomRows<3>() *= length * length;
  R = free_twists(wrenches, length);
}

}  // namespace

/// Branches none of which yields otherwise under other forces, factorised for these compliances of steps.
struct Group::Straight {
  std::vector<double> compliances;
  std::vector<Flexibility> tangents;
  BranchesInParallel parallel;
};

Group group_of(const std::string& name, std::vector<Chain> branches, double length) {
  Group g;
  g.name = name;
  g.length = length;
  g.branches = std::move(branches);
  split(g.branches, length, g.J, g.R);
  MatrixX D(g.R.cols(), 0);
  for (const Chain& branch : g.branches) {
    D.conservativeResize(Eigen::NoChange, D.cols() + branch.N.cols());
    D.rightCols(branch.N.cols()) = g.R.transpose() * branch.N;
  }
  if (D.cols() == D.rows() && D.cols() > 0)
    if (const Eigen::PartialPivLU<MatrixX> lu(D); reciprocal_condition(lu) > 1e-6) g.determinate = lu;
  return g;
}

/// Rᵀ Σ N_i λ_i = RᵀF, then N_iᵀ t = N_iᵀ d_i; nothing where a branch has let go.
std::optional<Group::State> Group::solve_by_statics(const Vector6& F, const ChainConditions& c) const {
  const VectorX lambda = determinate->solve(R.transpose() * F);
  State s;
  s.iterations = 1;
  s.converged = true;
  VectorX e(lambda.size());
  Eigen::Index at = 0;
  for (const Chain& branch : branches) {
    const Eigen::Index own = branch.N.cols();
    s.wrenches.push_back(branch.N * lambda.segment(at, own));
    if (branch.straight(c)) {
      e.segment(at, own) = branch.N.transpose() * branch.deflection(s.wrenches.back(), c, &s.converged);
    } else {
      const ChainResponse r = branch.respond(s.wrenches.back(), 0, c);
      if (r.tangent.N.cols() < own) return std::nullopt;
      s.converged = s.converged && r.converged;
      e.segment(at, own) = branch.N.transpose() * r.d;
    }
    at += own;
  }
  s.t = R * determinate->transpose().solve(e);
  return s;
}

/// Nothing where the stiffness of a branch depends on its force.
std::shared_ptr<const Group::Straight> Group::factorised(const ChainConditions& c) const {
  const auto straight = [&](const Chain& b) { return b.straight(c); };
  if (!c.printed.empty() || !std::all_of(branches.begin(), branches.end(), straight)) return nullptr;
  std::vector<double> compliances;
  for (const Step& step : c.steps) compliances.push_back(step.compliance);
  if (straight_ && straight_->compliances == compliances) return straight_;
  std::vector<Flexibility> tangents;
  std::vector<LinearisedBranch> linearised;
  for (const Chain& branch : branches) {
    tangents.push_back(branch.respond(Vector6::Zero(), 1, c).tangent);
    linearised.emplace_back(tangents.back(), length);
  }
  straight_ = std::make_shared<const Straight>(
      Straight{std::move(compliances), std::move(tangents), BranchesInParallel(std::move(linearised), R)});
  return straight_;
}

Group::NewtonStep Group::newton_step(const Vector6& F, const State& s, double least, const ChainConditions& c,
                                     const Straight* known, double& size) const {
  Vector6 missing = F;
  std::vector<VectorX> e(branches.size());
  std::vector<LinearisedBranch> linearised;
  NewtonStep step{Vector6::Zero(), std::vector<Vector6>(branches.size()), 0};
  for (std::size_t i = 0; i < branches.size(); ++i) {
    Vector6 ahead = -s.t;
    if (known) {
      ahead += branches[i].deflection(s.wrenches[i], c);
    } else {
      const ChainResponse r = branches[i].respond(s.wrenches[i], least, c);
      linearised.emplace_back(r.tangent, length);
      ahead += r.d;
    }
    missing -= s.wrenches[i];
    const LinearisedBranch& b = known ? known->parallel.branches()[i] : linearised.back();
    e[i] = b.M.transpose() * ahead;
    for (Eigen::Index j = 0; j < b.g.size(); ++j)
      if (b.g(j) > 1e-6 * b.g(0)) step.held = std::max(step.held, std::abs(e[i](j)) / b.g(j));
  }
  if (known)
    known->parallel.solve(missing, e, step.moved, step.more, size, name);
  else
    BranchesInParallel(std::move(linearised), R).solve(missing, e, step.moved, step.more, size, name);
  return step;
}

Group::State Group::solve(const Vector6& F, const ChainConditions& c) const {
  // A chain alone is asked directly: stiffness is needed to share forces only.
  if (branches.size() == 1) {
    State s{Vector6::Zero(), {F}, true, 1, 0};
    s.t = branches[0].deflection(F, c, &s.converged);
    return s;
  }
  if (determinate)
    if (std::optional<State> s = solve_by_statics(F, c)) return *s;
  const double load = weighed(F, length).norm();
  State s;
  s.wrenches.assign(branches.size(), Vector6::Zero());
  s.converged = R.cols() == 0;  // carries nothing
  // Contacts have no stiffness at rest: the first step takes them as under the whole load (where there is none, 1 N),
  // the others at a force far below the largest for rest.
  double least = load > 0 ? load : 1;
  double change = std::numeric_limits<double>::infinity(), size_of_forces = 0;
  double held = 0;  // what free deflections would bring, were the far body to stay
  const std::shared_ptr<const Straight> known = R.cols() > 0 ? factorised(c) : nullptr;
  const bool straight = known || linear();
  // What is linear is as near after twelve steps as it will be; settle() allows most from the eleventh on.
  const int most = known ? 12 : 100;
  while (!s.converged && s.iterations < most) {
    ++s.iterations;
    const NewtonStep step = newton_step(F, s, least, c, known.get(), size_of_forces);
    held = std::max(held, step.held);
    const double before = change;
    double largest = 0;
    change = 0;
    for (const Vector6& each : step.more) change = std::max(change, weighed(each, length).norm());
    // A contact that a misfit strains may be thrown to and fro across its rest, where it is soft: shorter steps end
    // that.
    const double part = s.iterations > 5 && !known ? share_of_step(s.wrenches, step.more, least, c) : 1;
    s.t += part * step.moved;
    for (std::size_t i = 0; i < branches.size(); ++i) {
      s.wrenches[i] += part * step.more[i];
      largest = std::max(largest, weighed(s.wrenches[i], length).norm());
    }
    least = 1e-13 * std::max(load, largest);
    if (least == 0) least = 1e-13;
    // Forces are known to the rounding of those that free deflections would bring, of a stiff part to that of its
    // deflection: where changes stop falling, that is left.
    const bool stalled = s.iterations > 5 && change <= 1e-8 * largest && change > 0.5 * before;
    s.converged = change <= 1e-13 * largest || (s.iterations > 3 && change <= 1e-11 * largest) || stalled ||
                  change <= 1e-15 * held;
    // Where nothing depends on its load the first step is the answer, and the second takes its rounding off.
    s.converged = s.converged || (straight && s.iterations > 2 && !(change < 0.5 * before));
    // Of a contact that is hardly loaded, forces that settle may leave the deflection open.
    if (s.converged) settle(s, least, c, known.get());
  }
  if (R.cols() == 0) settle(s, least, c, nullptr);
  return s;
}

/// The share of a step at which the complementary energy is least. Its slope along the step, Σ Δᵢᵀ dᵢ(wᵢ + α Δᵢ), rises
/// with α: the step's forces Δ balance each other, and a deflection grows with its force. 1 where the energy falls all
/// the way.
double Group::share_of_step(const std::vector<Vector6>& from, const std::vector<Vector6>& step, double least,
                            const ChainConditions& c) const {
  const auto slope = [&](double share) {
    double sum = 0;
    for (std::size_t i = 0; i < branches.size(); ++i)
      sum += step[i].dot(branches[i].respond(from[i] + share * step[i], least, c).d);
    return sum;
  };
  const double start = slope(0);
  double low = 0, at_low = start, high = 1, at_high = slope(1);
  if (!(start < 0 && at_high > -0.5 * start)) return 1;
  double share = 1;
  for (int i = 0; i < 30; ++i) {  // regula falsi, with halves where one side does not move
    share = i % 3 == 2 ? (low + high) / 2 : (low * at_high - high * at_low) / (at_high - at_low);
    const double here = slope(share);
    if (std::abs(here) < -0.1 * start) break;
    (here < 0 ? low : high) = share;
    (here < 0 ? at_low : at_high) = here;
  }
  return share;
}

/// Whether the branches' ends are where the far body is.
void Group::settle(State& s, double least, const ChainConditions& c, const Straight* known) const {
  double size = 0, largest = 0;
  for (const Vector6& wrench : s.wrenches) largest = std::max(largest, weighed(wrench, length).norm());
  s.misfit = 0;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    if (branches[i].N.cols() == 0) continue;
    ChainResponse r;
    if (known)
      r.d = branches[i].deflection(s.wrenches[i], c, &r.converged);
    else
      r = branches[i].respond(s.wrenches[i], least, c);
    const Flexibility& tangent = known ? known->tangents[i] : r.tangent;
    s.converged = s.converged && r.converged;
    if (tangent.N.cols() == 0) continue;
    const VectorX d = tangent.N.transpose() * r.d, moved = tangent.N.transpose() * s.t;
    s.misfit = std::max(s.misfit, (moved - d).cwiseAbs().maxCoeff());
    size = std::max({size, moved.cwiseAbs().maxCoeff(), d.cwiseAbs().maxCoeff()});
    // Forces are known to the rounding of the largest: beside a rigid branch the others carry as much by chance, which
    // no further step takes off.
    if (s.iterations > 10)
      size = std::max(size, 1e-6 * (tangent.roots.transpose() * tangent.N).squaredNorm() * largest);
  }
  if (size > 0) s.misfit /= size;
  s.converged = s.converged && s.misfit < 1e-9;
}

Flexibility Group::flexibility(const std::vector<Vector6>& wrenches, double least, const ChainConditions& c) const {
  if (branches.size() == 1) return branches[0].respond(wrenches[0], least, c).tangent;
  std::vector<Flexibility> tangents;
  bool released = false;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    tangents.push_back(branches[i].respond(wrenches[i], least, c).tangent);
    released = released || tangents[i].N.cols() < branches[i].N.cols();
  }
  Flexibility f;
  f.J = J;
  Matrix6X others = R;
  if (released) split(tangents, length, f.J, others);
  if (others.cols() == 0) return f;
  f.N = carried_wrenches(f.J, length);
  std::vector<LinearisedBranch> linearised;
  for (const Flexibility& t : tangents) linearised.emplace_back(t, length);
  f.C = BranchesInParallel(std::move(linearised), others).compliance();
  f.rooted = std::all_of(tangents.begin(), tangents.end(), [](const Flexibility& t) { return t.rooted; });
  if (f.rooted) f.roots = roots_of(f.C, length);
  return f;
}

}  // namespace deflect::analytic
