#include "validation/compare/uncertainty.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>

#include "validation/compare/as_built.h"
#include "validation/compare/columns.h"
#include "validation/compare/prediction.h"
#include "validation/compare/tail.h"
#include "validation/parallel/cases.h"

namespace deflect {
namespace {

/// One tolerance, moved by a standard deviation: in every pose, or in one.
struct Move {
  Nuisance nuisance;
  AsBuilt built;
  std::ptrdiff_t pose = -1, actuator = -1;
};

std::vector<Move> shared_moves(const Mechanism& m) {
  const Tolerances& t = m.tolerances;
  const auto legs = static_cast<std::size_t>(leg_count(m));
  std::vector<Move> moves;
  const auto add = [&](const std::string& name, double sigma, const std::function<void(AsBuilt&)>& change) {
    if (!(sigma > 0)) return;
    Move move{{name, sigma}, {}};
    move.built.legs.resize(legs);
    change(move.built);
    moves.push_back(std::move(move));
  };
  add("modulus", t.modulus, [&](AsBuilt& b) { b.modulus = t.modulus; });
  const bool seats = std::holds_alternative<SixPsu>(m.kinematics) || !m.mounts.empty();
  for (std::size_t i = 0; i < legs; ++i) {
    const std::string leg = fmt::format("leg {} ", i + 1);
    add(leg + "guide diameter", t.guide_diameter, [&](AsBuilt& b) { b.legs[i].guide_diameter = t.guide_diameter; });
    if (!seats) continue;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      add(leg + "base joint " + "xyz"[axis], t.joint_position,
          [&](AsBuilt& b) { b.legs[i].base_joint(axis) = t.joint_position; });
      add(leg + "platform joint " + "xyz"[axis], t.joint_position,
          [&](AsBuilt& b) { b.legs[i].platform_joint(axis) = t.joint_position; });
    }
    if (std::holds_alternative<SixPsu>(m.kinematics))
      add(leg + "link length", t.link_length, [&](AsBuilt& b) { b.legs[i].link_length = t.link_length; });
  }
  return moves;
}

/// Sensitivities are those of the machine in linear geometry, without history.
Mechanism simplified(const Mechanism& m) {
  Mechanism out = m;
  out.geometry = Geometry::linear;
  return out;
}

}  // namespace

MatrixX rows_of(const std::vector<MeasuredValue>& values,
                const std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>>& by_reading) {
  MatrixX out(static_cast<Eigen::Index>(values.size()), by_reading.empty() ? 0 : by_reading.front().cols());
  for (std::size_t i = 0; i < values.size(); ++i)
    out.row(static_cast<Eigen::Index>(i)) =
        by_reading[values[i].reading].row(static_cast<Eigen::Index>(values[i].component));
  return out;
}

VectorX rows_of(const std::vector<MeasuredValue>& values, const std::vector<Vector6>& by_reading) {
  VectorX out(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    out(static_cast<Eigen::Index>(i)) = by_reading[values[i].reading](static_cast<Eigen::Index>(values[i].component));
  return out;
}

ToleranceModel tolerance_model(const Mechanism& device, const std::vector<Configuration>& drawn,
                               const Measurements& data, const std::vector<MeasuredValue>& values, int threads,
                               const Told& told) {
  const Mechanism m = simplified(device);
  PredictionOptions o;
  o.threads = 1;
  const VectorX nominal = rows_of(values, predict(m, drawn, data, o));
  std::vector<Move> moves = shared_moves(m);
  const std::size_t shared = moves.size();
  if (m.tolerances.actuator_repeatability > 0)
    for (std::size_t p = 0; p < drawn.size(); ++p)
      for (std::size_t q = 0; q < drawn[p].actuators.size(); ++q) {
        if (drawn[p].actuators[q].rotation) continue;
        const double sigma = m.tolerances.actuator_repeatability;
        moves.push_back({{fmt::format("pose {} {}", data.poses[p].label, drawn[p].actuators[q].name), sigma},
                         {},
                         static_cast<std::ptrdiff_t>(p),
                         static_cast<std::ptrdiff_t>(q)});
      }

  ToleranceModel out;
  out.A = MatrixX::Zero(nominal.size(), static_cast<Eigen::Index>(moves.size()));
  for (const Move& move : moves) out.nuisances.push_back(move.nuisance);
  const auto move_one = [&](std::size_t k) {
    const Move& move = moves[k];
    const Mechanism geometry = with_geometry(m, move.built);
    if (k < shared) {
      std::vector<Configuration> moved;
      for (const Configuration& c : drawn) moved.push_back(configure_as_built(geometry, move.built, c));
      out.A.col(static_cast<Eigen::Index>(k)) = rows_of(values, predict(m, moved, data, o)) - nominal;
      return;
    }
    const auto p = static_cast<std::size_t>(move.pose);
    VectorX errors = VectorX::Zero(static_cast<Eigen::Index>(drawn[p].actuators.size()));
    errors(move.actuator) = move.nuisance.sigma;
    const Measurements alone = one_pose(data, p);
    const std::vector<Vector6> d = predict(m, {configure_as_built(geometry, move.built, drawn[p], errors)}, alone, o);
    // Back to the rows of this pose's readings.
    std::vector<std::ptrdiff_t> place(data.readings.size(), -1);
    for (std::size_t i = 0; i < data.poses[p].readings.size(); ++i)
      place[data.poses[p].readings[i]] = static_cast<std::ptrdiff_t>(i);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (const std::ptrdiff_t at = place[values[i].reading]; at >= 0)
        out.A(row, static_cast<Eigen::Index>(k)) =
            d[static_cast<std::size_t>(at)](static_cast<Eigen::Index>(values[i].component)) - nominal(row);
    }
  };
  const auto count = [&](std::size_t done) { told(static_cast<double>(done) / static_cast<double>(moves.size())); };
  for_each_case(moves.size(), 1, threads, move_one, told ? std::function<void(std::size_t)>(count) : nullptr);
  return out;
}

Uncertainty::Uncertainty(const MatrixX& A, const std::vector<MeasuredValue>& values, const std::vector<double>& sigma,
                         const std::vector<Vector6>& predicted, double load, const std::vector<bool>& set_aside) {
  for (std::size_t first = 0; first < values.size();) {
    std::size_t last = first;
    while (last < values.size() && values[last].reading == values[first].reading) ++last;
    const auto size = static_cast<Eigen::Index>(last - first);
    Block block{static_cast<Eigen::Index>(first), size, MatrixX::Zero(size, size), MatrixX::Zero(size, size)};
    const bool used = set_aside.empty() || !set_aside[values[first].reading];
    if (used) {
      VectorX d(size);
      MatrixX covariance = MatrixX::Zero(size, size);
      for (Eigen::Index i = 0; i < size; ++i) {
        const std::size_t at = first + static_cast<std::size_t>(i);
        d(i) = load * predicted[values[at].reading](static_cast<Eigen::Index>(values[at].component));
        covariance(i, i) = sigma[at] * sigma[at];
      }
      covariance += d * d.transpose();
      block.inverse_factor = covariance.llt().matrixL().solve(MatrixX::Identity(size, size));
      block.covariance = covariance;
      count_ += static_cast<std::size_t>(size);
    }
    blocks_.push_back(std::move(block));
    first = last;
  }
  bare_A_ = A;
  A_ = whitened_by_noise(A);
  Q_.resize(A.rows(), 0);
  V_.resize(A.cols(), 0);
  S_.resize(0);
  if (A.cols() == 0) return;
  const Eigen::SelfAdjointEigenSolver<MatrixX> axes(A_.transpose() * A_);
  const VectorX& squares = axes.eigenvalues();
  Eigen::Index zero = 0;
  while (zero < squares.size() && !(squares(zero) > 1e-13 * squares(squares.size() - 1))) ++zero;
  S_ = squares.tail(squares.size() - zero).cwiseSqrt();
  V_ = axes.eigenvectors().rightCols(S_.size());
  Q_ = A_ * V_ * S_.cwiseInverse().asDiagonal();
}

MatrixX Uncertainty::whitened_by_noise(const MatrixX& X) const {
  MatrixX out(X.rows(), X.cols());
  for (const Block& b : blocks_)
    out.middleRows(b.first, b.size).noalias() = b.inverse_factor * X.middleRows(b.first, b.size);
  return out;
}

// (1 + A Aᵀ)^(−1/2) = 1 + Q ((1 + S²)^(−1/2) − 1) Qᵀ.
MatrixX Uncertainty::whitened(const MatrixX& X) const {
  MatrixX out = whitened_by_noise(X);
  const VectorX less = (1 + S_.array().square()).rsqrt() - 1;
  out += Q_ * (less.asDiagonal() * (Q_.transpose() * out)).eval();
  return out;
}

// η = Aᵀ (1 + A Aᵀ)⁻¹ r = V S/(1 + S²) Qᵀ r.
VectorX Uncertainty::nuisances(const VectorX& r) const {
  const VectorX share = S_.array() / (1 + S_.array().square());
  return V_ * share.cwiseProduct(Q_.transpose() * whitened_by_noise(r));
}

// In the axes of PA, P taking out the span of `beside`: numbers of variance 1 + s² w.
double Uncertainty::scale_of_tolerances(const VectorX& residual, const MatrixX& beside) const {
  if (A_.cols() == 0) return 1;
  MatrixX A = A_;
  VectorX r = whitened_by_noise(residual);
  if (beside.cols() > 0) {
    const MatrixX Q = orthonormal(whitened_by_noise(beside), 1e-8);
    A -= Q * (Q.transpose() * A);
    r -= Q * (Q.transpose() * r);
  }
  const Eigen::SelfAdjointEigenSolver<MatrixX> axes(A.transpose() * A);
  const VectorX w = axes.eigenvalues();
  // (uᵀr)² of the unit vectors u = A v/√w, times w.
  const VectorX along = axes.eigenvectors().transpose() * (A.transpose() * r);
  const auto log_likelihood = [&](double s) {
    double sum = 0;
    for (Eigen::Index i = 0; i < w.size(); ++i) {
      const double more = s * s * std::max(0.0, w(i));
      sum += 0.5 * (along(i) * along(i) * s * s / (1 + more) - std::log1p(more));
    }
    return sum;
  };
  double best = 1, most = log_likelihood(1) + 2;
  for (double s = 1; s <= 3; s *= 1.1)
    if (const double here = log_likelihood(s); here > most) most = here, best = s;
  return best;
}

MatrixX Uncertainty::covariance(const Eigen::SparseMatrix<double, Eigen::RowMajor>& T) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Block& b : blocks_)
    for (Eigen::Index i = 0; i < b.size; ++i)
      for (Eigen::Index j = 0; j < b.size; ++j) entries.emplace_back(b.first + i, b.first + j, b.covariance(i, j));
  Eigen::SparseMatrix<double> noise(T.cols(), T.cols());
  noise.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SparseMatrix<double> own = T * noise * T.transpose();
  MatrixX out(own);
  const MatrixX TA = T * bare_A_;
  out += TA * TA.transpose();
  return out;
}

Regression regress(const Uncertainty& u, const VectorX& r, const MatrixX& G, const MatrixX& beside) {
  Regression out;
  out.amplitude = VectorX::Zero(G.cols());
  out.covariance = MatrixX::Zero(G.cols(), G.cols());
  if (G.cols() == 0) return out;
  const MatrixX g = u.whitened(G);
  const VectorX y = u.whitened(r);
  MatrixX information = g.transpose() * g;
  VectorX score = g.transpose() * y;
  // Columns in their own units, so that ranks can be told.
  const VectorX own = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  if (beside.cols() > 0) {
    const MatrixX n = u.whitened(beside), cross = n.transpose() * g;
    const Eigen::CompleteOrthogonalDecomposition<MatrixX> cod(n.transpose() * n);
    information -= cross.transpose() * cod.solve(cross);
    score -= cross.transpose() * cod.solve(VectorX(n.transpose() * y));
  }
  const MatrixX scaled = own.asDiagonal() * ((information + information.transpose()) / 2) * own.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixX> axes(scaled);
  for (Eigen::Index i = 0; i < axes.eigenvalues().size(); ++i) {
    const double w = axes.eigenvalues()(i);
    if (!(w > 1e-9)) continue;
    const VectorX direction = own.asDiagonal() * axes.eigenvectors().col(i);
    const double along = direction.dot(score);
    out.amplitude += direction * (along / w);
    out.covariance += direction * direction.transpose() / w;
    out.gain += along * along / w;
    ++out.freedoms;
  }
  out.p_value = chi_squared_tail(out.freedoms, out.gain);
  return out;
}

}  // namespace deflect
