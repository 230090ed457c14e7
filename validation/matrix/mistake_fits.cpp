#include "validation/matrix/mistake_fits.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <array>
#include <cmath>

#include "msa/base/index.h"
#include "msa/base/motion_text.h"
#include "validation/matrix/elastic_structure.h"
#include "validation/matrix/matrix_checks.h"

namespace deflect::matrix {
namespace {

/// What is fitted is known to few digits: components below the last one that is shown are rounding.
std::string triple(const Vector3& v) {
  const double size = v.cwiseAbs().maxCoeff();
  const auto tidy = [size](double x) { return std::abs(x) < 5e-5 * size ? 0.0 : x; };
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", tidy(v.x()), tidy(v.y()), tidy(v.z()));
}

/// p of A [p]× = M by least squares; shortest where A leaves it open.
Vector3 shift_from(const Matrix3& A, const Matrix3& M) {
  MatrixX system(9, 3);
  for (int k = 0; k < 3; ++k) {
    const Matrix3 column = A * skew(Vector3::Unit(k));
    system.col(k) = Eigen::Map<const VectorX>(column.data(), 9);
  }
  return system.completeOrthogonalDecomposition().solve(VectorX(Eigen::Map<const VectorX>(M.data(), 9)));
}

std::string point_text(const Vector3& p, const MistakeContext& c) {
  return fmt::format(": T + {} mm", triple(1e3 * c.unit_m * p));
}

Undone turned_back(const Matrix6& K, const Matrix3& Q) {
  const Eigen::AngleAxisd turn(Q);
  return {rotate_twist(Q).transpose() * K * rotate_twist(Q),
          fmt::format(": turned by {:.4g} deg about {}", turn.angle() * 180 / pi, triple(turn.axis()))};
}

/// Grows with K's axes: f(diag(Q, Q) K diag(Q, Q)ᵀ) = Q f(K) Qᵀ. The weights only keep blocks from cancelling.
Matrix3 frame_of(const Matrix6& K, double coupling_weight, double rotation_weight) {
  const Matrix3 A = K.topLeftCorner<3, 3>(), B = K.topRightCorner<3, 3>(), D = K.bottomRightCorner<3, 3>();
  Matrix3 M = A / A.norm();
  if (D.norm() > 0) M += rotation_weight * D / D.norm();
  if (D.norm() > 0) M += coupling_weight * (B + B.transpose()) / std::sqrt(A.norm() * D.norm());
  return (M + M.transpose()) / 2;
}

std::optional<Undone> turned(const Matrix6& K, const MistakeContext& c, double coupling_weight,
                             double rotation_weight) {
  if (!c.R || K.topLeftCorner<3, 3>().isZero(0) || c.R->topLeftCorner<3, 3>().isZero(0)) return {};
  const auto frame = [&](const Matrix6& M) {
    return Eigen::SelfAdjointEigenSolver<Matrix3>(frame_of(M, coupling_weight, rotation_weight)).eigenvectors();
  };
  const Matrix3 V_K = frame(K), V_R = frame(*c.R);
  const double length = weighing_length(*c.R);
  std::optional<Undone> best;
  double nearest = 0;
  for (const Vector3& signs : {Vector3(1, 1, 1), Vector3(1, -1, -1), Vector3(-1, 1, -1), Vector3(-1, -1, 1)}) {
    const Matrix3 Q = V_K * signs.asDiagonal() * V_R.transpose();
    Undone candidate = turned_back(K, Q.determinant() > 0 ? Q : Matrix3(-Q));
    const double distance = weighed(candidate.K - *c.R, length).norm();
    if (!best || distance < nearest) best = std::move(candidate), nearest = distance;
  }
  return best;
}

/// The positive part of a difference, its rank, and the motion that it resists most.
struct Positive {
  Matrix6 part;
  int rank;
  Vector6 motion;
};

Positive positive_part(const Matrix6& difference, const Matrix6& whole, double length) {
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(
      Matrix6(weighed((difference + difference.transpose()) / 2, length)));
  const double largest = std::max(eigen.eigenvalues()(5), 0.0);
  const double noise = std::max(-10 * eigen.eigenvalues()(0), 1e-9 * largest);
  Positive out{Matrix6::Zero(), 0, Vector6::Zero()};
  for (int i = 0; i < 6; ++i) {
    if (eigen.eigenvalues()(i) <= 0) continue;
    const Vector6 v = eigen.eigenvectors().col(i);
    out.part += eigen.eigenvalues()(i) * v * v.transpose();
    out.rank += eigen.eigenvalues()(i) > noise;
  }
  Vector6 motion = eigen.eigenvectors().col(5);
  // A leg's locked joint moves nothing but its own spring: of all motions the one with the largest share of it.
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix6> shares(out.part,
                                                                 weighed((whole + whole.transpose()) / 2, length));
  if (shares.info() == Eigen::Success && shares.eigenvectors().allFinite()) motion = shares.eigenvectors().col(5);
  out.part = weighed(out.part, 1 / length);
  motion.tail<3>() /= length;
  out.motion = motion;
  return out;
}

std::string motion_of(const Positive& p, const MistakeContext& c, double length) {
  Vector6 d = p.motion;
  d.head<3>() *= c.unit_m;
  return fmt::format("{} direction{}, most of all {}", p.rank, p.rank == 1 ? "" : "s",
                     motion_text(d, length * c.unit_m));
}

}  // namespace

std::optional<Undone> mirrored_triangle(const Matrix6& K, const MistakeContext&) {
  Matrix6 lower = K.triangularView<Eigen::StrictlyLower>();
  if (!lower.isZero(0)) return {};
  return Undone{K.selfadjointView<Eigen::Upper>(), ""};
}

std::optional<Undone> worst_pair_copied(const Matrix6& K, const MistakeContext&) {
  const Matrix6 w = weighed(K, weighing_length(K));
  Eigen::Index a = 0, b = 0;
  (w - w.transpose()).cwiseAbs().maxCoeff(&a, &b);
  const Eigen::Index i = std::min(a, b), j = std::max(a, b);
  Undone out{K, fmt::format(": {} {} is {:.6g}, {} {} is {:.6g}", nth(wrench_axes, i), nth(displacement_axes, j),
                            K(i, j), nth(wrench_axes, j), nth(displacement_axes, i), K(j, i))};
  out.K(j, i) = K(i, j);
  return out;
}

Undo below_diagonal(const Undo& undo) {
  return [undo](const Matrix6& K, const MistakeContext& c) {
    std::optional<Undone> undone = undo(K.transpose(), c);
    if (undone) undone->K.transposeInPlace();
    return undone;
  };
}

std::optional<Undone> inverse(const Matrix6& K, const MistakeContext&) {
  const double length = weighing_length(K);
  const Eigen::FullPivLU<Matrix6> lu(weighed(K, length));
  if (!lu.isInvertible()) return {};
  return Undone{weighed(lu.inverse(), length), ""};
}

std::optional<Undone> moved_back(const Matrix6& K, const MistakeContext& c) {
  if (!c.R) return {};
  const Vector3 p = shift_from(c.R->topLeftCorner<3, 3>(), c.R->topRightCorner<3, 3>() - K.topRightCorner<3, 3>());
  const Matrix6 back = shift_twist(-p);
  return Undone{back.transpose() * K * back, point_text(-p, c)};
}

std::optional<Undone> moved_on_one_side(const Matrix6& K, const MistakeContext& c) {
  const Vector3 p =
      shift_from(K.topLeftCorner<3, 3>(), K.bottomLeftCorner<3, 3>().transpose() - K.topRightCorner<3, 3>());
  return Undone{K * shift_twist(-p), point_text(-p, c)};
}

std::optional<Undone> turned_on_one_side(const Matrix6& K, const MistakeContext&) {
  const Eigen::JacobiSVD<Matrix3> svd(K.topLeftCorner<3, 3>(), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3 Q = svd.matrixU() * svd.matrixV().transpose();
  if (!(Q.determinant() > 0)) return {};
  return Undone{rotate_twist(Q).transpose() * K, turned_back(K, Q).found};
}

std::optional<Undone> turned_by_all_blocks(const Matrix6& K, const MistakeContext& c) { return turned(K, c, 0.3, 0.5); }
std::optional<Undone> turned_by_translations(const Matrix6& K, const MistakeContext& c) { return turned(K, c, 0, 0); }

std::optional<Undone> scaled(const Matrix6& K, const MistakeContext& c) {
  if (!c.R) return {};
  const double length = weighing_length(*c.R);
  const Matrix6 k = weighed(K, length), r = weighed(*c.R, length);
  const double factor = k.cwiseProduct(r).sum() / r.squaredNorm();
  if (!(factor > 0)) return {};
  return Undone{K / factor, fmt::format(": {:.6g}", factor)};
}

std::optional<Undone> surplus_taken_away(const Matrix6& K, const MistakeContext& c) {
  if (!c.R) return {};
  const double length = weighing_length(*c.R);
  const Positive surplus = positive_part(K - *c.R, K, length);
  return Undone{K - surplus.part, ": in " + motion_of(surplus, c, length)};
}

std::optional<Undone> lack_filled(const Matrix6& K, const MistakeContext& c) {
  if (!c.R) return {};
  const double length = weighing_length(*c.R);
  const Positive lack = positive_part(*c.R - K, *c.R, length);
  return Undone{K + lack.part, ": in " + motion_of(lack, c, length)};
}

}  // namespace deflect::matrix
