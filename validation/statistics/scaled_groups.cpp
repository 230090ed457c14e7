#include "validation/statistics/scaled_groups.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace deflect::statistics {
namespace {

MatrixX part_of(const MatrixX& X, const GroupColumns& g) { return X(g.rows, Eigen::all); }

}  // namespace

ScaledGroups::ScaledGroups(const std::vector<GroupColumns>& C, const MatrixX& P, const MatrixX& F, double least)
    : PF_(P.rows(), P.cols() + F.cols()), flat_(F.cols()) {
  PF_ << P, F;
  std::vector<Eigen::SelfAdjointEigenSolver<MatrixX>> axes;
  double largest = 0;
  for (const GroupColumns& g : C) {
    axes.emplace_back(g.columns.transpose() * g.columns);
    if (g.columns.cols() > 0) largest = std::max(largest, axes.back().eigenvalues().maxCoeff());
  }
  std::vector<double> w;
  for (std::size_t i = 0; i < C.size(); ++i) {
    const VectorX& all = axes[i].eigenvalues();  // ascending
    Eigen::Index first = 0;
    while (first < all.size() && !(all(first) > least * largest)) ++first;
    const VectorX own = all.tail(all.size() - first);
    U_.push_back({C[i].rows, C[i].columns * axes[i].eigenvectors().rightCols(own.size()) *
                                 own.cwiseSqrt().cwiseInverse().asDiagonal()});
    w.insert(w.end(), own.begin(), own.end());
  }
  w_ = Eigen::Map<const VectorX>(w.data(), std::ssize(w));
  inside_.resize(w_.size(), PF_.cols());
  MatrixX rest = PF_;
  Eigen::Index at = 0;
  for (const GroupColumns& u : U_) {
    MatrixX part = part_of(rest, u);
    inside_.middleRows(at, u.columns.cols()) = u.columns.transpose() * part;
    part -= u.columns * inside_.middleRows(at, u.columns.cols());
    rest(u.rows, Eigen::all) = part;
    at += u.columns.cols();
  }
  beside_ = rest.transpose() * rest;
}

ScaledGroups::Seen ScaledGroups::seen(const VectorX& r) const {
  Seen out;
  out.inside.resize(w_.size());
  VectorX rest = r;
  Eigen::Index at = 0;
  for (const GroupColumns& u : U_) {
    VectorX part = rest(u.rows);
    out.inside.segment(at, u.columns.cols()) = u.columns.transpose() * part;
    part -= u.columns * out.inside.segment(at, u.columns.cols());
    rest(u.rows) = part;
    at += u.columns.cols();
  }
  out.along = PF_.transpose() * rest;
  out.beside = rest.squaredNorm();
  return out;
}

VectorX ScaledGroups::factors(double root_p) const {
  VectorX out = VectorX::Constant(PF_.cols(), root_p);
  out.tail(flat_).setOnes();
  return out;
}

ScaledGroups::Scaled ScaledGroups::at(double g, double p) const {
  Scaled out;
  out.weight = (1 + g * w_.array()).inverse();
  out.root_p = std::sqrt(p);
  const VectorX by = factors(out.root_p);
  MatrixX H = by.asDiagonal() * (beside_ + inside_.transpose() * out.weight.asDiagonal() * inside_) * by.asDiagonal();
  H.diagonal().head(H.rows() - flat_).array() += 1;
  out.H.compute(H);
  out.log_det = (g * w_.array()).log1p().sum();
  if (H.rows() > 0) out.log_det += 2 * out.H.matrixLLT().diagonal().array().log().sum();
  return out;
}

double ScaledGroups::chi2(const Scaled& s, const Seen& r) const {
  const VectorX weighed = s.weight.cwiseProduct(r.inside);
  double out = r.beside + weighed.dot(r.inside);
  if (PF_.cols() == 0) return out;
  const VectorX h = factors(s.root_p).cwiseProduct(r.along + inside_.transpose() * weighed);
  return out - s.H.matrixL().solve(h).squaredNorm();
}

ScaledGroups::Gain ScaledGroups::free_gain(const Seen& r, double least) const {
  Gain out;
  const Scaled none = at(0, 1);
  const VectorX kept = (w_.array() > least * (w_.size() > 0 ? w_.maxCoeff() : 0)).cast<double>();
  const VectorX dropped = 1 - kept.array();
  out.freedoms = static_cast<int>(kept.sum());
  // H and h without what C takes; of F, orthonormal at no size, what lies in C has nothing left to say.
  MatrixX H = beside_ + inside_.transpose() * dropped.asDiagonal() * inside_;
  H.diagonal().head(H.rows() - flat_).array() += 1;
  const VectorX weighed = dropped.cwiseProduct(r.inside);
  VectorX h = r.along + inside_.transpose() * weighed;
  double left = r.beside + weighed.dot(r.inside);
  const Eigen::Index first = H.rows() - flat_;
  if (first > 0) {
    const Eigen::LLT<MatrixX> of_P(MatrixX(H.topLeftCorner(first, first)));
    const MatrixX cross = of_P.solve(H.topRightCorner(first, flat_));
    left -= h.head(first).dot(of_P.solve(h.head(first)));
    h.tail(flat_) -= cross.transpose() * h.head(first);
    H.bottomRightCorner(flat_, flat_) -= H.bottomLeftCorner(flat_, first) * cross;
  }
  if (flat_ > 0) {
    const Eigen::SelfAdjointEigenSolver<MatrixX> axes(MatrixX(H.bottomRightCorner(flat_, flat_)));
    const VectorX along = axes.eigenvectors().transpose() * h.tail(flat_);
    for (Eigen::Index i = 0; i < flat_; ++i) {
      if (axes.eigenvalues()(i) > 1e-6)
        left -= along(i) * along(i) / axes.eigenvalues()(i);
      else
        --out.freedoms;
    }
  }
  out.gain = std::max(0.0, chi2(none, r) - left);
  return out;
}

}  // namespace deflect::statistics
