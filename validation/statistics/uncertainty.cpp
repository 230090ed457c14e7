#include "validation/statistics/uncertainty.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>

#include "validation/parallel/cases.h"
#include "validation/prediction/as_built.h"
#include "validation/prediction/prediction.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/scaled_groups.h"
#include "validation/statistics/tail.h"

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

/// Sensitivities are those of the machine in linear geometry; the sensor's drift, which no tolerance changes, goes by
/// the rank among all readings, where those of a pose are predicted alone.
Mechanism simplified(const Mechanism& m) {
  Mechanism out = m;
  out.geometry = Geometry::linear;
  out.sensor.drift.setZero();
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
  out.A.shared = MatrixX::Zero(nominal.size(), static_cast<Eigen::Index>(shared));
  for (const Move& move : moves) out.nuisances.push_back(move.nuisance);
  // Where a pose has nuisances of its own: its rows and columns, and which column each move fills.
  std::vector<Eigen::Index> column(moves.size(), 0), count(drawn.size(), 0);
  for (std::size_t k = shared; k < moves.size(); ++k) column[k] = count[static_cast<std::size_t>(moves[k].pose)]++;
  if (moves.size() > shared) {
    out.A.groups.resize(drawn.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      out.A.groups[data.readings[values[i].reading].pose].rows.push_back(static_cast<Eigen::Index>(i));
    for (std::size_t p = 0; p < drawn.size(); ++p)
      out.A.groups[p].columns.resize(std::ssize(out.A.groups[p].rows), count[p]);
  }
  const auto move_shared = [&](std::size_t k) {
    const Mechanism geometry = with_geometry(m, moves[k].built);
    std::vector<Configuration> moved;
    for (const Configuration& c : drawn) moved.push_back(configure_as_built(geometry, moves[k].built, c));
    out.A.shared.col(static_cast<Eigen::Index>(k)) = rows_of(values, predict(m, moved, data, o)) - nominal;
  };
  const auto move_own = [&](std::size_t p, std::size_t first, std::size_t last) {
    const Measurements alone = one_pose(data, p);
    const Mechanism geometry = with_geometry(m, moves[first].built);
    // Of the rows of this pose's readings, the reading in `alone`.
    GroupColumns& own = out.A.groups[p];
    std::vector<std::size_t> reading;
    for (const Eigen::Index row : own.rows) {
      const std::vector<std::size_t>& all = data.poses[p].readings;
      reading.push_back(static_cast<std::size_t>(
          std::lower_bound(all.begin(), all.end(), values[static_cast<std::size_t>(row)].reading) - all.begin()));
    }
    for (std::size_t k = first; k < last; ++k) {
      VectorX errors = VectorX::Zero(static_cast<Eigen::Index>(drawn[p].actuators.size()));
      errors(moves[k].actuator) = moves[k].nuisance.sigma;
      const std::vector<Vector6> d =
          predict(m, {configure_as_built(geometry, moves[k].built, drawn[p], errors)}, alone, o);
      for (std::size_t i = 0; i < own.rows.size(); ++i)
        own.columns(static_cast<Eigen::Index>(i), column[k]) =
            d[reading[i]](static_cast<Eigen::Index>(values[static_cast<std::size_t>(own.rows[i])].component)) -
            nominal(own.rows[i]);
    }
  };
  // First the moves of all poses, then pose by pose.
  std::vector<std::pair<std::size_t, std::size_t>> of_pose;  // first and last move
  for (std::size_t k = shared; k < moves.size(); ++k) {
    if (k == shared || moves[k].pose != moves[k - 1].pose) of_pose.emplace_back(k, k);
    ++of_pose.back().second;
  }
  const std::size_t cases = shared + of_pose.size();
  const auto done = [&](std::size_t through) { told(static_cast<double>(through) / static_cast<double>(cases)); };
  for_each_case(
      cases, 1, threads,
      [&](std::size_t k) {
        if (k < shared) return move_shared(k);
        const auto [first, last] = of_pose[k - shared];
        move_own(static_cast<std::size_t>(moves[first].pose), first, last);
      },
      told ? std::function<void(std::size_t)>(done) : nullptr);
  return out;
}

Uncertainty::Uncertainty(const PartedColumns& A, const std::vector<MeasuredValue>& values,
                         const std::vector<double>& sigma, const std::vector<Vector6>& predicted, double load,
                         const std::vector<bool>& set_aside, int threads)
    : A_(A) {
  for (std::size_t first = 0; first < values.size();) {
    std::size_t last = first;
    while (last < values.size() && values[last].reading == values[first].reading) ++last;
    const auto size = static_cast<Eigen::Index>(last - first);
    NoiseBlock block{static_cast<Eigen::Index>(first), size, {}};
    if (set_aside.empty() || !set_aside[values[first].reading]) {
      VectorX d(size);
      block.covariance = MatrixX::Zero(size, size);
      for (Eigen::Index i = 0; i < size; ++i) {
        const std::size_t at = first + static_cast<std::size_t>(i);
        d(i) = load * predicted[values[at].reading](static_cast<Eigen::Index>(values[at].component));
        block.covariance(i, i) = sigma[at] * sigma[at];
      }
      block.covariance += d * d.transpose();
      count_ += static_cast<std::size_t>(size);
    }
    blocks_.push_back(std::move(block));
    first = last;
  }
  whitening_ = std::make_shared<const Whitening>(blocks_, A_, threads);
}

// Errors of poses s times as large, those of all too; the span of `beside` is taken out.
double Uncertainty::scale_of_tolerances(const VectorX& residual, const MatrixX& beside) const {
  if (A_.cols() == 0) return 1;
  const MatrixX flat =
      beside.cols() > 0 ? orthonormal(whitening_->by_noise(beside), 1e-8) : MatrixX(residual.size(), 0);
  const ScaledGroups scaled(whitening_->groups_by_noise(), whitening_->by_noise(A_.shared), flat, 1e-13);
  const ScaledGroups::Seen seen = scaled.seen(whitening_->by_noise(residual));
  const auto log_likelihood = [&](double s) { return scaled.log_likelihood(scaled.at(s * s, s * s), seen); };
  double best = 1, most = log_likelihood(1) + 2;
  for (double s = 1; s <= 3; s *= 1.1)
    if (const double here = log_likelihood(s); here > most) most = here, best = s;
  return best;
}

Uncertainty::OfContrasts Uncertainty::of_contrasts(const Eigen::SparseMatrix<double, Eigen::RowMajor>& T) const {
  using Row = Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator;
  struct Entry {
    Eigen::Index contrast, number;
    double weight;
  };
  std::vector<Entry> entries;
  for (Eigen::Index i = 0; i < T.rows(); ++i)
    for (Row at(T, i); at; ++at) entries.push_back({i, at.col(), at.value()});
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.number < b.number; });
  OfContrasts out{MatrixX::Zero(T.rows(), T.rows()), PartedColumns(T * A_.shared)};
  auto entry = entries.begin();
  for (const NoiseBlock& b : blocks_) {
    auto end = entry;
    while (end != entries.end() && end->number < b.first + b.size) ++end;
    for (auto i = entry; i != end; ++i)
      for (auto k = entry; k != end; ++k)
        out.noise(i->contrast, k->contrast) +=
            i->weight * k->weight * b.covariance(i->number - b.first, k->number - b.first);
    entry = end;
  }
  std::vector<std::size_t> group(static_cast<std::size_t>(A_.rows()), A_.groups.size());
  std::vector<Eigen::Index> row(group.size(), 0);  // of the group
  for (std::size_t g = 0; g < A_.groups.size(); ++g)
    for (std::size_t i = 0; i < A_.groups[g].rows.size(); ++i) {
      const auto number = static_cast<std::size_t>(A_.groups[g].rows[i]);
      group[number] = g;
      row[number] = static_cast<Eigen::Index>(i);
    }
  std::vector<std::vector<Eigen::Index>> contrasts(A_.groups.size() + 1);
  for (Eigen::Index i = 0; i < T.rows(); ++i)
    if (const Row first(T, i); first) contrasts[group[static_cast<std::size_t>(first.col())]].push_back(i);
  for (std::size_t g = 0; g < A_.groups.size(); ++g) {
    const MatrixX& columns = A_.groups[g].columns;
    GroupColumns own{contrasts[g], MatrixX::Zero(std::ssize(contrasts[g]), columns.cols())};
    for (std::size_t i = 0; i < own.rows.size(); ++i)
      for (Row at(T, own.rows[i]); at; ++at)
        own.columns.row(static_cast<Eigen::Index>(i)) +=
            at.value() * columns.row(row[static_cast<std::size_t>(at.col())]);
    out.errors.groups.push_back(std::move(own));
  }
  return out;
}

MatrixX Uncertainty::covariance(const Eigen::SparseMatrix<double, Eigen::RowMajor>& T) const {
  const OfContrasts of = of_contrasts(T);
  const MatrixX errors = of.errors.dense();
  return of.noise + errors * errors.transpose();
}

Regressions::Regressions(const Uncertainty& u, const VectorX& residual, const MatrixX& beside)
    : uncertainty_(&u), y_(u.whitened(residual)) {
  if (beside.cols() == 0) return;
  beside_ = u.whitened(beside);
  of_beside_.compute(beside_.transpose() * beside_);
  fitted_ = of_beside_.solve(VectorX(beside_.transpose() * y_));
}

Regression Regressions::on_whitened(const MatrixX& g) const {
  Regression out;
  out.amplitude = VectorX::Zero(g.cols());
  out.covariance = MatrixX::Zero(g.cols(), g.cols());
  if (g.cols() == 0) return out;
  MatrixX information = g.transpose() * g;
  VectorX score = g.transpose() * y_;
  // Columns in their own units, so that ranks can be told.
  const VectorX own = information.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  if (beside_.cols() > 0) {
    const MatrixX cross = beside_.transpose() * g;
    information -= cross.transpose() * of_beside_.solve(cross);
    score -= cross.transpose() * fitted_;
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

Regression regress(const Uncertainty& u, const VectorX& r, const MatrixX& G, const MatrixX& beside) {
  return Regressions(u, r, beside).on(G);
}

}  // namespace deflect
