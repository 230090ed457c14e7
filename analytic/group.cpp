#include <fmt/format.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>

#include "analytic/chain.h"
#include "msa/base/error.h"

namespace deflect::analytic {
namespace {

/// Moments in the unit of forces.
Vector6 weighed(const Vector6& F, double length) {
  Vector6 w = F;
  w.tail<3>() /= length;
  return w;
}

/// One branch linearised about its force F, in the principal axes of its compliance (singular values: as printed it
/// need not be symmetric): it carries N λ when Mᵀt = g λ + e; M = N but for signs where it is. A g that is lost in the
/// rounding of the largest is 0: there the branch is rigid.
struct Linearised {
  Linearised(const Flexibility& f, const Vector6& d, const Vector6& F, double length) : N(f.N), M(f.N) {
    if (N.cols() == 0) return;
    const Eigen::JacobiSVD<MatrixX> principal(f.N.transpose() * f.C * f.N, Eigen::ComputeFullU | Eigen::ComputeFullV);
    N *= principal.matrixV();
    M *= principal.matrixU();
    g = principal.singularValues();
    for (Eigen::Index i = 0; i < g.size(); ++i)
      if (!(g(i) > 1e-14 * g(0))) g(i) = 0;
    Matrix6X coordinates = N;  // of F: N is orthonormal in weighed moments
    coordinates.bottomRows<3>() /= length * length;
    e = M.transpose() * d - g.cwiseProduct(coordinates.transpose() * F);
  }

  Matrix6X N, M;
  VectorX g, e;
};

/// Branches side by side: Σ N_i λ_i = F, M_iᵀt = g_i λ_i + e_i, with t = c R y. What yields is eliminated,
/// λ = (mᵀt − e)/g; what hardly yields, or not at all, stays as an unknown force μ along B = RᵀN, with A = RᵀM, so that
/// no digits are lost and rigid branches are constraints:
///   [ Σ (c/g) Rᵀn mᵀR    B          ] [y]   [ Rᵀ(F + Σ n e/g) ]
///   [ Aᵀ                −g/c − Y Zᵀ ] [μ] = [ e/c             ]
/// Z spans the forces of rigid branches that cancel each other, none of which act when the branches fit, Yᵀe = 0.
class Parallel {
 public:
  Parallel(std::vector<Linearised> branches, const Matrix6X& R) : branches_(std::move(branches)), R_(R) {
    for (const Linearised& b : branches_)
      if (b.g.size() > 0) c_ = std::max(c_, b.g(0));
    if (c_ == 0) c_ = 1;
    const Eigen::Index r = R.cols();
    MatrixX K = MatrixX::Zero(r, r), A(r, 0), B(r, 0);
    const auto append = [](MatrixX& columns, const VectorX& column) {
      columns.conservativeResize(column.size(), columns.cols() + 1);
      columns.rightCols<1>() = column;
    };
    for (const Linearised& b : branches_)
      for (Eigen::Index j = 0; j < b.g.size(); ++j) {
        const VectorX n = R.transpose() * b.N.col(j), m = R.transpose() * b.M.col(j);
        if (eliminated(b, j)) {
          K += n * (c_ / b.g(j)) * m.transpose();
        } else {
          append(B, n);
          append(A, m);
          kept_.push_back({b.g(j) / c_, b.e(j) / c_});
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
        S(r + i, r + i) = -kept_[static_cast<std::size_t>(i)].g;
        yields(i, i) = kept_[static_cast<std::size_t>(i)].g > 0 ? 1 : 0;
      }
      const auto cancelling = [&](const MatrixX& columns) {
        MatrixX rows(k, r + k);
        rows << columns.transpose(), yields;
        return complement(rows);
      };
      Y_ = cancelling(A);
      S.bottomRightCorner(k, k) -= Y_ * cancelling(B).transpose();
    }
    lu_.compute(S);
  }

  /// Displacement and the branches' wrenches under F.
  void solve(const Vector6& F, Vector6& t, std::vector<Vector6>& wrenches, const std::string& name) const {
    const Eigen::Index r = R_.cols(), k = lu_.cols() - r;
    VectorX right(r + k);
    right.head(r) = R_.transpose() * F;
    for (const Linearised& b : branches_)
      for (Eigen::Index j = 0; j < b.g.size(); ++j)
        if (eliminated(b, j)) right.head(r) += R_.transpose() * b.N.col(j) * (b.e(j) / b.g(j));
    for (Eigen::Index i = 0; i < k; ++i) right(r + i) = kept_[static_cast<std::size_t>(i)].e;
    double size = F.norm();
    for (const Linearised& b : branches_) size = std::max(size, b.e.norm() / c_);
    if (k > 0 && (Y_.transpose() * right.tail(k)).norm() > 1e-9 * size)
      throw ModelError(
          fmt::format("{} cannot be assembled: the misfits contradict each other by {:.3g} mm and nothing yields", name,
                      1e3 * c_ * (Y_.transpose() * right.tail(k)).cwiseAbs().maxCoeff()));
    const VectorX solution = lu_.solve(right);
    t = c_ * (R_ * solution.head(r));
    Eigen::Index next = r;
    for (std::size_t i = 0; i < branches_.size(); ++i) {
      const Linearised& b = branches_[i];
      wrenches[i].setZero();
      for (Eigen::Index j = 0; j < b.g.size(); ++j)
        wrenches[i] += b.N.col(j) * (eliminated(b, j) ? (b.M.col(j).dot(t) - b.e(j)) / b.g(j) : solution(next++));
    }
  }

  Matrix6 compliance() const {
    const Eigen::Index r = R_.cols();
    const MatrixX y = lu_.inverse().topLeftCorner(r, r);
    return c_ * (R_ * y * R_.transpose());
  }

 private:
  struct Kept {
    double g, e;
  };

  bool eliminated(const Linearised& b, Eigen::Index j) const { return b.g(j) > 1e-6 * c_; }

  std::vector<Linearised> branches_;
  const Matrix6X& R_;
  double c_ = 0;  // largest compliance
  std::vector<Kept> kept_;
  MatrixX Y_;
  Eigen::PartialPivLU<MatrixX> lu_;
};

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

Group group_of(const std::string& name, std::vector<Chain> branches, double length) {
  Group g;
  g.name = name;
  g.length = length;
  g.branches = std::move(branches);
  split(g.branches, length, g.J, g.R);
  return g;
}

Group legs_of(const Configuration& c, const AsPrinted& as_printed) {
  std::vector<Chain> chains;
  for (const PlacedLeg& leg : c.legs) {
    Vector3 reference = c.pose.p_WT;
    if (as_printed.count(Erratum::tcp_transfer))  // the platform joint: where the last member ends
      for (const PlacedPart& part : leg.parts)
        if (const auto* m = std::get_if<PlacedMember>(&part)) reference = m->p_W_end;
    chains.push_back(chain_of(leg, reference, c.size, as_printed));
  }
  return group_of("the mechanism", std::move(chains), c.size);
}

Group::State Group::solve(const Vector6& F, const AsPrinted& p) const {
  // A chain alone is asked directly: stiffness is needed to share forces only.
  if (branches.size() == 1) {
    const Response r = branches[0].respond(F, 0, p);
    return {r.d, {F}, r.converged, 1, 0};
  }
  State s;
  s.wrenches.assign(branches.size(), Vector6::Zero());
  s.converged = R.cols() == 0;  // carries nothing
  const double load = weighed(F, length).norm();
  // Contacts have no stiffness at rest: the first step takes them as under the whole load (where there is none, 1 N),
  // the others at a force far below the largest for rest.
  double least = load > 0 ? load : 1;
  while (!s.converged && s.iterations < 100) {
    ++s.iterations;
    std::vector<Linearised> linearised;
    for (std::size_t i = 0; i < branches.size(); ++i) {
      const Response r = branches[i].respond(s.wrenches[i], least, p);
      linearised.emplace_back(r.tangent, r.d, s.wrenches[i], length);
    }
    std::vector<Vector6> next(branches.size());
    Parallel(std::move(linearised), R).solve(F, s.t, next, name);
    double change = 0, largest = 0;
    for (std::size_t i = 0; i < branches.size(); ++i) {
      change = std::max(change, weighed(next[i] - s.wrenches[i], length).norm());
      largest = std::max(largest, weighed(next[i], length).norm());
    }
    s.wrenches = std::move(next);
    least = 1e-9 * std::max(load, largest);
    if (least == 0) least = 1e-9;
    s.converged = change <= 1e-13 * largest || (s.iterations > 3 && change <= 1e-11 * largest);
  }
  double size = 0;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    if (branches[i].N.cols() == 0) continue;
    const Response r = branches[i].respond(s.wrenches[i], least, p);
    s.converged = s.converged && r.converged;
    const VectorX d = branches[i].N.transpose() * r.d, moved = branches[i].N.transpose() * s.t;
    s.misfit = std::max(s.misfit, (moved - d).cwiseAbs().maxCoeff());
    size = std::max({size, moved.cwiseAbs().maxCoeff(), d.cwiseAbs().maxCoeff()});
  }
  if (size > 0) s.misfit /= size;
  s.converged = s.converged && s.misfit < 1e-9;
  return s;
}

Flexibility Group::flexibility(const std::vector<Vector6>& wrenches, double least, const AsPrinted& p) const {
  if (branches.size() == 1) return branches[0].respond(wrenches[0], least, p).tangent;
  std::vector<Flexibility> tangents;
  bool released = false;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    tangents.push_back(branches[i].respond(wrenches[i], least, p).tangent);
    released = released || tangents[i].N.cols() < branches[i].N.cols();
  }
  Flexibility f;
  f.J = J;
  Matrix6X others = R;
  if (released) split(tangents, length, f.J, others);
  if (others.cols() == 0) return f;
  f.N = carried_wrenches(f.J, length);
  std::vector<Linearised> linearised;
  for (const Flexibility& t : tangents) linearised.emplace_back(t, Vector6::Zero(), Vector6::Zero(), length);
  f.C = Parallel(std::move(linearised), others).compliance();
  return f;
}

Matrix6 Group::stiffness(const std::vector<Vector6>& wrenches, const AsPrinted& p) const {
  Matrix6 K = Matrix6::Zero();
  for (std::size_t i = 0; i < branches.size(); ++i) K += branches[i].stiffness(wrenches[i], p);
  return K;
}

bool Group::linear() const {
  return std::all_of(branches.begin(), branches.end(), [](const Chain& c) { return c.linear(); });
}

bool Group::fits() const {
  return std::all_of(branches.begin(), branches.end(), [](const Chain& c) { return c.fits(); });
}

}  // namespace deflect::analytic
