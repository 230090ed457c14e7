#include "validation/plan/design.h"

#include <Eigen/Cholesky>

namespace deflect::plan {

Design::Design(MatrixX P, MatrixX alpha, MatrixX Q)
    : shared_(P.rows()), P_(std::move(P)), alpha_(std::move(alpha)), Q_(std::move(Q)) {}

Eigen::Index Design::position_of(std::size_t pose) const {
  for (const auto& [known, at] : poses_)
    if (known == pose) return at;
  return -1;
}

Design::Innovation Design::innovation(const WhiteRows& r, bool all, bool taken) const {
  const Eigen::Index at = position_of(r.pose), own = r.own.cols();
  Innovation out;
  const auto of_shared = P_.leftCols(shared_);
  if (all) {
    out.PX = of_shared * r.shared.transpose();
    if (at >= 0) out.PX += P_.middleCols(at, own) * r.own.transpose();
  } else {
    out.PX = P_.topLeftCorner(shared_, shared_) * r.shared.transpose();
    if (at >= 0) out.PX += P_.block(0, at, shared_, own) * r.own.transpose();
  }
  out.S = r.shared * out.PX.topRows(shared_);
  out.e = r.targets - r.shared * alpha_.topRows(shared_);
  if (at >= 0) {
    const MatrixX cross = P_.block(at, 0, own, shared_) * r.shared.transpose();
    out.S += r.own * (cross + P_.block(at, at, own, own) * r.own.transpose());
    out.e -= r.own * alpha_.middleRows(at, own);
  } else {
    out.S += r.own * r.own.transpose();
  }
  if (taken) out.S = -out.S;
  out.S.diagonal().array() += 1;
  return out;
}

MatrixX Design::innovations(const WhiteRows& r, bool taken) const {
  const Innovation i = innovation(r, false, taken);
  return Eigen::LLT<MatrixX>(i.S).matrixL().solve(i.e);
}

MatrixX Design::with(const WhiteRows& r) const {
  const MatrixX white = innovations(r, false);
  return Q_ + white.transpose() * white;
}

MatrixX Design::without(const WhiteRows& r) const {
  const MatrixX white = innovations(r, true);
  return Q_ - white.transpose() * white;
}

double Design::log_determinant(const WhiteRows& r) const {
  const Eigen::LLT<MatrixX> factor(innovation(r, false).S);
  return 2 * factor.matrixLLT().diagonal().array().log().sum();
}

double Design::trace_change(const WhiteRows& r, const MatrixX& V, bool taken) const {
  const Innovation i = innovation(r, false, taken);
  return Eigen::LLT<MatrixX>(i.S).matrixL().solve((V * i.PX).transpose()).squaredNorm();
}

double Design::trace_decrease(const WhiteRows& r, const MatrixX& V) const { return trace_change(r, V, false); }
double Design::trace_increase(const WhiteRows& r, const MatrixX& V) const { return trace_change(r, V, true); }

void Design::take(const WhiteRows& r) {
  if (r.own.cols() > 0 && position_of(r.pose) < 0) {
    const Eigen::Index before = P_.rows(), own = r.own.cols();
    poses_.emplace_back(r.pose, before);
    P_.conservativeResize(before + own, before + own);
    P_.bottomRows(own).setZero();
    P_.rightCols(own).setZero();
    P_.bottomRightCorner(own, own).setIdentity();
    alpha_.conservativeResize(before + own, Eigen::NoChange);
    alpha_.bottomRows(own).setZero();
  }
  update(innovation(r, true), 1);
}

void Design::drop(const WhiteRows& r) { update(innovation(r, true, true), -1); }

void Design::update(const Innovation& i, double sense) {
  const Eigen::LLT<MatrixX> factor(i.S);
  const MatrixX e = factor.matrixL().solve(i.e), gain = factor.matrixL().solve(i.PX.transpose());
  if (Q_.size() > 0) Q_ += sense * e.transpose() * e;
  alpha_ += sense * gain.transpose() * e;
  P_ -= sense * gain.transpose() * gain;
}

}  // namespace deflect::plan
