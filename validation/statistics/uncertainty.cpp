#include "validation/statistics/uncertainty.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

#include "msa/base/index.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/scaled_groups.h"
#include "validation/statistics/tail.h"

namespace deflect::statistics {

MatrixX rows_of(const std::vector<measurement::MeasuredValue>& values,
                const std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>>& by_reading) {
  MatrixX out(std::ssize(values), by_reading.empty() ? 0 : by_reading.front().cols());
  for (std::size_t i = 0; i < values.size(); ++i)
    out.row(as_index(i)) = values[i].form.transpose() * by_reading[values[i].reading];
  return out;
}

VectorX rows_of(const std::vector<measurement::MeasuredValue>& values, const std::vector<Vector6>& by_reading) {
  VectorX out(std::ssize(values));
  for (std::size_t i = 0; i < values.size(); ++i) out(as_index(i)) = values[i].form.dot(by_reading[values[i].reading]);
  return out;
}

VectorX rows_of(const std::vector<measurement::MeasuredValue>& values, const std::vector<VectorX>& by_reading) {
  VectorX out(std::ssize(values));
  for (std::size_t i = 0; i < values.size(); ++i)
    out(as_index(i)) = by_reading[values[i].reading](as_index(values[i].channel));
  return out;
}

namespace {

/// Where a pose has tolerances of its own: the rows of its numbers, with room for so many columns.
std::vector<GroupColumns> room_of_poses(const measurement::Measurements& data,
                                        const std::vector<measurement::MeasuredValue>& values,
                                        const std::vector<Eigen::Index>& columns) {
  std::vector<GroupColumns> groups(columns.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    groups[data.readings[values[i].reading].pose].rows.push_back(as_index(i));
  for (std::size_t p = 0; p < groups.size(); ++p) groups[p].columns.resize(std::ssize(groups[p].rows), columns[p]);
  return groups;
}

/// Tolerances first … last − 1 of one pose, by its readings alone.
void move_own(GroupColumns& own, const subject::Deviations& off, std::size_t first, std::size_t last, std::size_t pose,
              const measurement::Measurements& data, const std::vector<measurement::MeasuredValue>& values,
              const VectorX& nominal) {
  const measurement::Measurements of_pose = measurement::one_pose(data, pose);
  // Of the rows of this pose's readings, the reading in `of_pose`.
  std::vector<std::size_t> reading;
  for (const Eigen::Index row : own.rows) {
    const std::vector<std::size_t>& all = data.poses[pose].readings;
    reading.push_back(as_size(std::lower_bound(all.begin(), all.end(), nth(values, row).reading) - all.begin()));
  }
  for (std::size_t k = first; k < last; ++k) {
    const std::vector<VectorX> d = off.with(k)->predict(of_pose, {}, parallel::alone);
    for (std::size_t i = 0; i < own.rows.size(); ++i)
      own.columns(as_index(i), as_index(k - first)) =
          (d[reading[i]](as_index(nth(values, own.rows[i]).channel)) - nominal(own.rows[i])) / off.tolerances()[k].step;
  }
}

}  // namespace

ToleranceModel tolerance_model(const subject::Standing& standing, const measurement::Measurements& data,
                               const std::vector<measurement::MeasuredValue>& values, const parallel::Work& work) {
  const std::unique_ptr<const subject::Deviations> off = standing.deviations(data);
  const VectorX nominal = rows_of(values, off->drawn().predict(data, {}, parallel::alone));
  ToleranceModel out;
  out.nuisances = off->tolerances();
  const auto own =
      std::find_if(out.nuisances.begin(), out.nuisances.end(), [](const subject::Tolerance& t) { return t.pose; });
  const auto shared = as_size(own - out.nuisances.begin());
  out.A.shared = MatrixX::Zero(nominal.size(), as_index(shared));
  // Of each pose with tolerances of its own, the first and the last of them.
  std::vector<std::pair<std::size_t, std::size_t>> of_pose;
  std::vector<Eigen::Index> columns(standing.poses(), 0);
  for (std::size_t k = shared; k < out.nuisances.size(); ++k) {
    if (k == shared || out.nuisances[k].pose != out.nuisances[k - 1].pose) of_pose.emplace_back(k, k);
    ++of_pose.back().second;
    ++columns[*out.nuisances[k].pose];
  }
  if (!of_pose.empty()) out.A.groups = room_of_poses(data, values, columns);
  const std::size_t cases = shared + of_pose.size();
  const auto done = [&](std::size_t through) {
    work.progress(static_cast<double>(through) / static_cast<double>(cases));
  };
  parallel::for_each_case(
      cases, 1, work.threads,
      [&](std::size_t k) {
        if (k < shared) {
          out.A.shared.col(as_index(k)) =
              (rows_of(values, off->with(k)->predict(data, {}, parallel::alone)) - nominal) / out.nuisances[k].step;
          return;
        }
        const auto [first, last] = of_pose[k - shared];
        const std::size_t pose = *out.nuisances[first].pose;
        move_own(out.A.groups[pose], *off, first, last, pose, data, values, nominal);
      },
      work.progress ? std::function<void(std::size_t)>(done) : nullptr);
  return out;
}

Uncertainty::Uncertainty(const PartedColumns& A, const std::vector<measurement::MeasuredValue>& values,
                         const std::vector<double>& sigma, const LoadErrors& loads, const std::vector<bool>& set_aside,
                         int threads)
    : A_(A) {
  for (std::size_t first = 0; first < values.size();) {
    std::size_t last = first;
    while (last < values.size() && values[last].reading == values[first].reading) ++last;
    const auto size = as_index(last - first);
    NoiseBlock block{as_index(first), size, {}};
    if (set_aside.empty() || !set_aside[values[first].reading]) {
      const MatrixX& of_reading = loads.of(values[first].reading);
      MatrixX d(size, of_reading.cols());
      block.covariance = MatrixX::Zero(size, size);
      for (Eigen::Index i = 0; i < size; ++i) {
        const std::size_t at = first + as_size(i);
        d.row(i) = of_reading.row(as_index(values[at].channel));
        block.covariance(i, i) = sigma[at] * sigma[at];
      }
      for (const auto& each : d.colwise()) block.covariance += each * each.transpose();
      count_ += as_size(size);
    }
    blocks_.push_back(std::move(block));
    first = last;
  }
  whitening_ = std::make_shared<const Whitening>(blocks_, A_, threads);
}

// Errors of poses s times as large, those of all too; what is free is taken out.
std::vector<double> Uncertainty::log_likelihood_of_scales(const VectorX& residual, const MatrixX& beside,
                                                          const std::vector<double>& scales,
                                                          const std::vector<Eigen::Index>& free) const {
  MatrixX all(residual.size(), beside.cols() + std::ssize(free));
  all << beside, A_.shared(Eigen::all, free);
  MatrixX tolerances = A_.shared;
  tolerances(Eigen::all, free).setZero();
  const MatrixX flat = all.cols() > 0 ? orthonormal(whitening_->by_noise(all), 1e-8) : all;
  const ScaledGroups scaled(whitening_->groups_by_noise(), whitening_->by_noise(tolerances), flat, 1e-13);
  const ScaledGroups::Seen seen = scaled.seen(whitening_->by_noise(residual));
  std::vector<double> out;
  for (const double s : scales) out.push_back(scaled.log_likelihood(scaled.at(s * s, s * s), seen));
  return out;
}

double Uncertainty::scale_of_tolerances(const VectorX& residual, const MatrixX& beside) const {
  if (A_.cols() == 0) return 1;
  std::vector<double> scales;
  for (double s = 1; s <= 3; s *= 1.1) scales.push_back(s);
  const std::vector<double> likelihood = log_likelihood_of_scales(residual, beside, scales);
  const auto best = std::max_element(likelihood.begin(), likelihood.end());
  return *best > likelihood.front() + 2 ? nth(scales, best - likelihood.begin()) : 1;
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
  std::vector<std::size_t> group(as_size(A_.rows()), A_.groups.size());
  std::vector<Eigen::Index> row(group.size(), 0);  // of the group
  for (std::size_t g = 0; g < A_.groups.size(); ++g)
    for (std::size_t i = 0; i < A_.groups[g].rows.size(); ++i) {
      const auto number = as_size(A_.groups[g].rows[i]);
      group[number] = g;
      row[number] = as_index(i);
    }
  std::vector<std::vector<Eigen::Index>> contrasts(A_.groups.size() + 1);
  for (Eigen::Index i = 0; i < T.rows(); ++i)
    if (const Row first(T, i); first) contrasts[nth(group, first.col())].push_back(i);
  for (std::size_t g = 0; g < A_.groups.size(); ++g) {
    const MatrixX& columns = A_.groups[g].columns;
    GroupColumns own{contrasts[g], MatrixX::Zero(std::ssize(contrasts[g]), columns.cols())};
    for (std::size_t i = 0; i < own.rows.size(); ++i)
      for (Row at(T, own.rows[i]); at; ++at)
        own.columns.row(as_index(i)) += at.value() * columns.row(nth(row, at.col()));
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

}  // namespace deflect::statistics
