#include "validation/diagnosis/discrepancy.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "msa/base/index.h"
#include "validation/compare/slides.h"
#include "validation/parallel/cases.h"
#include "validation/statistics/columns.h"
#include "validation/statistics/evidence.h"
#include "validation/statistics/tail.h"

namespace deflect::diagnosis {
namespace {

const std::vector<double>& scales() {
  static const std::vector<double> all = statistics::log_spaced(1e-3, 10, 40);
  return all;
}

/// The freedoms that a number's channel is one of: the six of T, or the sensors of a subject without T.
VectorX freedoms_of(const compare::ResidualStudy& s, const measurement::MeasuredValue& v) {
  if (s.standing->has_tool_point()) return v.form;
  return VectorX::Unit(std::ssize(s.data->instruments.sensors), as_index(v.channel) - 6);
}

/// The loads that patterns are made of, by reading (columns): forces at T, or the most used loads of a frame, each as a
/// share of its largest.
MatrixX leading_loads(const compare::ResidualStudy& s) {
  if (s.standing->has_tool_point()) return s.loads.topRows(3);
  constexpr Eigen::Index most = 6;
  std::vector<Eigen::Index> order(as_size(s.loads.rows()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  const VectorX largest = s.loads.cwiseAbs().rowwise().maxCoeff();
  const auto used = [&](Eigen::Index k) { return (s.loads.row(k).array() != 0).count(); };
  std::stable_sort(order.begin(), order.end(), [&](Eigen::Index a, Eigen::Index b) { return used(a) > used(b); });
  MatrixX out(std::min(most, s.loads.rows()), s.loads.cols());
  for (Eigen::Index k = 0; k < out.rows(); ++k)
    out.row(k) = s.loads.row(nth(order, k)) / std::max(largest(nth(order, k)), 1e-300);
  return out;
}

/// Of a subject that is read by sensors alone: what each channel can read in proportion to each load, to its size, and
/// whatever its size.
MatrixX by_influence(const compare::ResidualStudy& s) {
  const MatrixX loads = leading_loads(s);
  MatrixX out;
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    const VectorX freedoms = freedoms_of(s, s.values[i]);
    const Eigen::Index n = freedoms.size();
    if (i == 0) out = MatrixX::Zero(std::ssize(s.values), 3 * n * loads.rows());
    for (Eigen::Index k = 0; k < loads.rows(); ++k) {
      const double f = loads(k, as_index(s.values[i].reading));
      const double shapes[] = {f, std::abs(f), f > 0 ? 1.0 : f < 0 ? -1.0 : 0.0};
      for (Eigen::Index b = 0; b < 3; ++b)
        out.row(as_index(i)).segment(n * (3 * k + b), n) = shapes[b] * freedoms.transpose();
    }
  }
  return out;
}

}  // namespace

MatrixX site_patterns(const compare::ResidualStudy& s) {
  std::vector<MatrixX> parts;
  for (const compare::Pattern& p : compare::patterns_of(s)) parts.push_back(p.rows);
  if (!s.sites.front().empty()) {
    const auto f = [&](std::size_t i, std::size_t k) { return s.force[i](as_index(k)); };
    const auto site = [&](std::size_t i, std::size_t k) -> const subject::Site& {
      return s.sites[s.data->readings[i].pose][k];
    };
    const auto add = [&](const auto& e) {
      parts.push_back(statistics::rows_of(s.values, compare::site_columns(s, e)));
    };
    add([&](std::size_t i, std::size_t k) { return f(i, k) == 0 ? 0 : std::copysign(1, f(i, k)); });
    add([&](std::size_t i, std::size_t k) { return std::copysign(std::pow(std::abs(f(i, k)), 2.0 / 3), f(i, k)); });
    add([&](std::size_t i, std::size_t k) { return std::copysign(f(i, k) * f(i, k), f(i, k)); });
    add([&](std::size_t i, std::size_t k) { return std::abs(f(i, k)); });
    if (compare::has_slides(s)) {
      const double mean = compare::mean_extension(s);
      add([&](std::size_t i, std::size_t k) { return f(i, k) * site(i, k).along; });
      for (const int power : {0, 1, 2, 3, 4})
        add([&](std::size_t i, std::size_t k) {
          return f(i, k) * (1 - site(i, k).along) * std::pow(site(i, k).extension / mean, power);
        });
    }
    if (s.sequence) add([&](std::size_t i, std::size_t k) { return s.heading[i](as_index(k)); });
  }
  if (!s.standing->has_tool_point()) parts.push_back(by_influence(s));
  return statistics::side_by_side(parts, std::ssize(s.values));
}

namespace {

/// At each pose and for each freedom c of what is read (column b n + c): as much as 10 N do (in a frame all loads), and
/// what is in proportion to each load.
statistics::PartedColumns by_poses(const compare::ResidualStudy& s) {
  statistics::PartedColumns out(MatrixX(std::ssize(s.values), 0));
  out.groups.resize(s.data->poses.size());
  for (std::size_t i = 0; i < s.values.size(); ++i)
    out.groups[s.data->readings[s.values[i].reading].pose].rows.push_back(as_index(i));
  const MatrixX loads = leading_loads(s);
  const double unit_load = s.standing->has_tool_point() ? 10 : 1;
  for (statistics::GroupColumns& g : out.groups) {
    for (std::size_t i = 0; i < g.rows.size(); ++i) {
      const measurement::MeasuredValue& v = nth(s.values, g.rows[i]);
      const VectorX freedoms = freedoms_of(s, v);
      const Eigen::Index n = freedoms.size();
      if (i == 0) g.columns = MatrixX::Zero(std::ssize(g.rows), n * (1 + loads.rows()));
      for (Eigen::Index b = 0; b <= loads.rows(); ++b)
        g.columns.row(as_index(i)).segment(n * b, n) =
            (b == 0 ? unit_load : loads(b - 1, as_index(v.reading))) * freedoms.transpose();
    }
  }
  return out;
}

MatrixX by_loads(const compare::ResidualStudy& s) {
  const std::vector<measurement::Reading>& readings = s.data->readings;
  const MatrixX loads = leading_loads(s);
  const Eigen::Index count = loads.rows();
  std::vector<VectorX> basis(readings.size(), VectorX(4 * count + 3));
  double first = INFINITY, last = -INFINITY;
  for (const measurement::Reading& r : readings)
    if (r.sequence) first = std::min(first, *r.sequence), last = std::max(last, *r.sequence);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const VectorX f = loads.col(as_index(i));
    const double time =
        readings[i].sequence && last > first ? 2 * (*readings[i].sequence - first) / (last - first) - 1 : 0;
    const double warmer = readings[i].temperature_C - 20;
    Eigen::Index at = 0;
    for (Eigen::Index k = 0; k < count; ++k) {
      const double sign = f(k) > 0 ? 1 : f(k) < 0 ? -1 : 0;
      for (const double value : {sign, std::abs(f(k)), sign * f(k) * f(k), f(k) * f((k + 1) % count)})
        basis[i](at++) = value;
    }
    basis[i].tail<3>() << time * time, time * time * time, warmer * warmer;
  }
  // Of all freedoms c of what is read: basis(reading, b) in column b n + c.
  MatrixX out;
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    const VectorX freedoms = freedoms_of(s, s.values[i]);
    const Eigen::Index n = freedoms.size();
    if (i == 0) out = MatrixX::Zero(std::ssize(s.values), n * basis.front().size());
    for (Eigen::Index b = 0; b < basis.front().size(); ++b)
      out.row(as_index(i)).segment(n * b, n) = basis[s.values[i].reading](b) * freedoms.transpose();
  }
  return out;
}

}  // namespace

Families discrepancy_families(const compare::ResidualStudy& s) { return {site_patterns(s), by_poses(s), by_loads(s)}; }

WhitenedFamilies::WhitenedFamilies(Families all, std::shared_ptr<const statistics::Whitening> with, int threads)
    : whitening(std::move(with)) {
  const double length = std::sqrt(static_cast<double>(whitening->rows()));
  const auto factor = [length](double norm) { return norm > 0 ? length / norm : 0; };
  for (statistics::PartedColumns& family : all) {
    Family out;
    // A few columns at a time: their number does not depend on the threads, lest sums do.
    constexpr Eigen::Index some = 16;
    out.columns = std::move(family.shared);
    parallel::for_each_case(as_size((out.columns.cols() + some - 1) / some), 1, threads, [&](std::size_t k) {
      const Eigen::Index first = as_index(k) * some, count = std::min(some, out.columns.cols() - first);
      MatrixX X = (*whitening)(out.columns.middleCols(first, count));
      for (auto column : X.colwise()) column *= factor(column.norm());
      out.columns.middleCols(first, count) = X;
    });
    out.gram = out.columns.transpose() * out.columns;
    out.groups = std::move(family.groups);
    whitening->white_within_groups(out.groups);
    parallel::for_each_case(out.groups.size(), 1, threads, [&](std::size_t k) {
      statistics::GroupColumns& g = out.groups[k];
      const VectorX norms = whitening->norms_of_shared(g);
      for (Eigen::Index i = 0; i < norms.size(); ++i) g.columns.col(i) *= factor(norms(i));
    });
    families.push_back(std::move(out));
  }
}

Discrepancy::Discrepancy(std::shared_ptr<const WhitenedFamilies> white, const MatrixX& fitted)
    : white_(std::move(white)),
      fitted_(fitted.cols() > 0 ? statistics::orthonormal(fitted) : MatrixX(white_->whitening->rows(), 0)) {
  constexpr double none = 1e-10;  // of the largest w
  for (const WhitenedFamilies::Family& of : white_->families) {
    Family family;
    if (!of.groups.empty()) {
      const statistics::Whitening& w = *white_->whitening;
      statistics::ScaledGroups& groups = family.own.groups.emplace(of.groups, w.shared(), w.undo_shared(fitted_), none);
      family.own.none = groups.at(0, 1);
      for (const double tau : scales()) family.own.scaled.push_back(groups.at(tau * tau, 1));
    } else {
      OfAll& f = family.all;
      f.along_fitted = of.columns.transpose() * fitted_;
      const Eigen::SelfAdjointEigenSolver<MatrixX> axes(MatrixX(of.gram - f.along_fitted * f.along_fitted.transpose()));
      const VectorX& all = axes.eigenvalues();
      Eigen::Index first = 0;
      while (first < all.size() && !(all(first) > none * all(all.size() - 1))) ++first;
      f.w = all.tail(all.size() - first);
      f.V = axes.eigenvectors().rightCols(f.w.size()) * f.w.cwiseSqrt().cwiseInverse().asDiagonal();
    }
    families_.push_back(std::move(family));
  }
}

VectorX Discrepancy::along(std::size_t family, const VectorX& r) const {
  const OfAll& f = families_[family].all;
  return f.V.transpose() *
         (white_->families[family].columns.transpose() * r - f.along_fitted * (fitted_.transpose() * r));
}

statistics::ScaledGroups::Seen Discrepancy::seen(std::size_t family, const VectorX& r) const {
  return families_[family].own.groups->seen(white_->whitening->undo_shared(r));
}

std::vector<double> Discrepancy::log_likelihoods(std::size_t family, const VectorX& r) const {
  std::vector<double> out;
  const Family& f = families_[family];
  if (f.own.groups) {
    const statistics::ScaledGroups::Seen seen_of_r = seen(family, r);
    const double nothing = f.own.groups->log_likelihood(f.own.none, seen_of_r);
    for (const statistics::ScaledGroups::Scaled& s : f.own.scaled)
      out.push_back(f.own.groups->log_likelihood(s, seen_of_r) - nothing);
    return out;
  }
  const VectorX a = along(family, r);
  for (const double tau : scales()) {
    double sum = 0;
    for (Eigen::Index i = 0; i < f.all.w.size(); ++i) {
      const double more = tau * tau * f.all.w(i);
      sum += 0.5 * (a(i) * a(i) * more / (1 + more) - std::log1p(more));
    }
    out.push_back(sum);
  }
  return out;
}

double Discrepancy::log_evidence(const VectorX& r) const {
  std::vector<double> all;
  for (std::size_t f = 0; f < families_.size(); ++f)
    for (const double l : log_likelihoods(f, r)) all.push_back(l);
  return statistics::log_mean_exp(all);
}

Discrepancy::Size Discrepancy::likeliest(const VectorX& r) const {
  Size out;
  double most = -INFINITY;
  for (std::size_t f = 0; f < families_.size(); ++f) {
    const std::vector<double> all = log_likelihoods(f, r);
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i] > most) most = all[i], out = {f, scales()[i]};
  }
  return out;
}

// Patterns that are all but one another's sum say nothing of their own.
Discrepancy::Gain Discrepancy::own_gain(std::size_t family, const VectorX& r) const {
  constexpr double least = 1e-6;  // of the largest w
  const Family& f = families_[family];
  if (f.own.groups) {
    const statistics::ScaledGroups::Gain of_groups = f.own.groups->free_gain(seen(family, r), least);
    return {of_groups.gain, of_groups.freedoms};
  }
  const Eigen::Index own = f.all.w.size() > 0 ? (f.all.w.array() > least * f.all.w.maxCoeff()).count() : 0;
  return {along(family, r).tail(own).squaredNorm(), static_cast<int>(own)};
}

double Discrepancy::p_value(const VectorX& r) const {
  double smallest = 1;
  for (std::size_t f = 0; f < families_.size(); ++f) {
    const Gain own = own_gain(f, r);
    if (own.freedoms > 0) smallest = std::min(smallest, statistics::chi_squared_tail(own.freedoms, own.gain));
  }
  return std::min(1.0, smallest * static_cast<double>(families_.size()));
}

double Discrepancy::chi2(const VectorX& r, const Size& size) const {
  const Family& f = families_[size.family];
  const double scale = size.tau * size.tau;
  if (f.own.groups) {
    const statistics::ScaledGroups::Seen of_r = seen(size.family, r);
    return r.squaredNorm() + f.own.groups->chi2(f.own.groups->at(scale, 1), of_r) -
           f.own.groups->chi2(f.own.none, of_r);
  }
  const VectorX a = along(size.family, r);
  const VectorX more = scale * f.all.w;
  return r.squaredNorm() - (a.array().square() * more.array() / (1 + more.array())).sum();
}

}  // namespace deflect::diagnosis
