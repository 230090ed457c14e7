#include "validation/diagnosis/discrepancy.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "validation/compare/columns.h"
#include "validation/compare/finding_text.h"
#include "validation/compare/tail.h"
#include "validation/diagnosis/evidence.h"

namespace deflect {
namespace {

const std::vector<double>& scales() {
  static const std::vector<double> all = log_spaced(1e-3, 10, 40);
  return all;
}

MatrixX by_sites(const ResidualStudy& s) {
  std::vector<MatrixX> parts;
  for (const Pattern& p : patterns_of(s)) parts.push_back(rows_of(s.values, p.by_reading));
  if (!s.sites.front().empty()) {
    const auto f = [&](std::size_t i, std::size_t k) { return s.force[i](static_cast<Eigen::Index>(k)); };
    const auto site = [&](std::size_t i, std::size_t k) -> const Site& { return s.sites[s.data->readings[i].pose][k]; };
    const auto add = [&](const auto& e) { parts.push_back(rows_of(s.values, site_columns(s, e))); };
    add([&](std::size_t i, std::size_t k) { return f(i, k) == 0 ? 0 : std::copysign(1, f(i, k)); });
    add([&](std::size_t i, std::size_t k) { return std::copysign(std::pow(std::abs(f(i, k)), 2.0 / 3), f(i, k)); });
    add([&](std::size_t i, std::size_t k) { return std::copysign(f(i, k) * f(i, k), f(i, k)); });
    add([&](std::size_t i, std::size_t k) { return std::abs(f(i, k)); });
    if (has_slides(s)) {
      add([&](std::size_t i, std::size_t k) { return f(i, k) * site(i, k).along; });
      for (const int power : {0, 1, 2, 3, 4})
        add([&](std::size_t i, std::size_t k) {
          return f(i, k) * (1 - site(i, k).along) * std::pow(site(i, k).extension / mean_extension(s), power);
        });
    }
    if (s.sequence) add([&](std::size_t i, std::size_t k) { return s.heading[i](static_cast<Eigen::Index>(k)); });
  }
  return side_by_side(parts, static_cast<Eigen::Index>(s.values.size()));
}

/// Columns of all measured components c: basis(reading, b) in column b · 6 + c.
MatrixX by_component(const ResidualStudy& s, const std::vector<VectorX>& basis) {
  const Eigen::Index count = basis.front().size();
  MatrixX out = MatrixX::Zero(static_cast<Eigen::Index>(s.values.size()), 6 * count);
  for (std::size_t i = 0; i < s.values.size(); ++i)
    for (Eigen::Index b = 0; b < count; ++b)
      out(static_cast<Eigen::Index>(i), 6 * b + static_cast<Eigen::Index>(s.values[i].component)) =
          basis[s.values[i].reading](b);
  return out;
}

MatrixX by_poses(const ResidualStudy& s) {
  const std::vector<Reading>& readings = s.data->readings;
  const auto poses = static_cast<Eigen::Index>(s.data->poses.size());
  std::vector<VectorX> basis(readings.size(), VectorX::Zero(4 * poses));
  for (std::size_t i = 0; i < readings.size(); ++i)
    basis[i].segment<4>(4 * static_cast<Eigen::Index>(readings[i].pose)) << 10, readings[i].load.head<3>();  // 10 N
  return by_component(s, basis);
}

MatrixX by_loads(const ResidualStudy& s) {
  const std::vector<Reading>& readings = s.data->readings;
  std::vector<VectorX> basis(readings.size(), VectorX(15));
  double first = INFINITY, last = -INFINITY;
  for (const Reading& r : readings)
    if (r.sequence) first = std::min(first, *r.sequence), last = std::max(last, *r.sequence);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    const Vector3 f = readings[i].load.head<3>();
    const double time =
        readings[i].sequence && last > first ? 2 * (*readings[i].sequence - first) / (last - first) - 1 : 0;
    const double warmer = readings[i].temperature_C - 20;
    Eigen::Index at = 0;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double sign = f(k) > 0 ? 1 : f(k) < 0 ? -1 : 0;
      for (const double value : {sign, std::abs(f(k)), sign * f(k) * f(k), f(k) * f((k + 1) % 3)})
        basis[i](at++) = value;
    }
    basis[i].tail<3>() << time * time, time * time * time, warmer * warmer;
  }
  return by_component(s, basis);
}

}  // namespace

Families discrepancy_families(const ResidualStudy& s) { return {by_sites(s), by_poses(s), by_loads(s)}; }

Discrepancy::Discrepancy(const Families& families, const MatrixX& fitted) {
  const MatrixX Q = fitted.cols() > 0 ? orthonormal(fitted) : MatrixX(families.front().rows(), 0);
  for (const MatrixX& columns : families) {
    MatrixX B = columns;
    const double length = std::sqrt(static_cast<double>(B.rows()));
    for (auto column : B.colwise())
      if (const double norm = column.norm(); norm > 0) column *= length / norm;
    B -= Q * (Q.transpose() * B);
    const Eigen::SelfAdjointEigenSolver<MatrixX> axes(B.transpose() * B);
    const VectorX& all = axes.eigenvalues();
    Eigen::Index first = 0;
    while (first < all.size() && !(all(first) > 1e-10 * all(all.size() - 1))) ++first;
    Family family;
    family.w = all.tail(all.size() - first);
    family.Q = B * axes.eigenvectors().rightCols(family.w.size()) * family.w.cwiseSqrt().cwiseInverse().asDiagonal();
    families_.push_back(std::move(family));
  }
}

std::vector<double> Discrepancy::log_likelihoods(const Family& family, const VectorX& r) {
  const VectorX along = family.Q.transpose() * r;
  std::vector<double> out;
  for (const double tau : scales()) {
    double sum = 0;
    for (Eigen::Index i = 0; i < family.w.size(); ++i) {
      const double more = tau * tau * family.w(i);
      sum += 0.5 * (along(i) * along(i) * more / (1 + more) - std::log1p(more));
    }
    out.push_back(sum);
  }
  return out;
}

double Discrepancy::log_evidence(const VectorX& r) const {
  std::vector<double> all;
  for (const Family& family : families_)
    for (const double l : log_likelihoods(family, r)) all.push_back(l);
  return log_mean_exp(all);
}

Discrepancy::Size Discrepancy::likeliest(const VectorX& r) const {
  Size out;
  double most = -INFINITY;
  for (std::size_t f = 0; f < families_.size(); ++f) {
    const std::vector<double> all = log_likelihoods(families_[f], r);
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i] > most) most = all[i], out = {f, scales()[i]};
  }
  return out;
}

double Discrepancy::p_value(const VectorX& r) const {
  double least = 1;
  for (const Family& family : families_) {
    // Patterns that are all but one another's sum say nothing of their own.
    const Eigen::Index own = family.w.size() > 0 ? (family.w.array() > 1e-6 * family.w.maxCoeff()).count() : 0;
    if (own == 0) continue;
    const double gain = (family.Q.rightCols(own).transpose() * r).squaredNorm();
    least = std::min(least, chi_squared_tail(static_cast<double>(own), gain));
  }
  return std::min(1.0, least * static_cast<double>(families_.size()));
}

VectorX Discrepancy::whitened(const VectorX& r, const Size& size) const {
  const Family& family = families_[size.family];
  VectorX along = family.Q.transpose() * r;
  for (Eigen::Index i = 0; i < along.size(); ++i) along(i) *= 1 / std::sqrt(1 + size.tau * size.tau * family.w(i)) - 1;
  return r + family.Q * along;
}

}  // namespace deflect
