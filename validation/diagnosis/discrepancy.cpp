#include "validation/diagnosis/discrepancy.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "validation/compare/finding_text.h"
#include "validation/compare/tail.h"
#include "validation/diagnosis/evidence.h"

namespace deflect {
namespace {

const std::vector<double>& scales() {
  static const std::vector<double> all = log_spaced(1e-3, 10, 40);
  return all;
}

}  // namespace

MatrixX discrepancy_columns(const ResidualStudy& s) {
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
  Eigen::Index columns = 0;
  for (const MatrixX& p : parts) columns += p.cols();
  MatrixX out(static_cast<Eigen::Index>(s.values.size()), columns);
  columns = 0;
  for (const MatrixX& p : parts) {
    out.middleCols(columns, p.cols()) = p;
    columns += p.cols();
  }
  return out;
}

Discrepancy::Discrepancy(const MatrixX& columns, const MatrixX& fitted) {
  MatrixX B = columns;
  const double length = std::sqrt(static_cast<double>(B.rows()));
  for (auto column : B.colwise())
    if (const double norm = column.norm(); norm > 0) column *= length / norm;
  if (fitted.cols() > 0) {
    const Eigen::ColPivHouseholderQR<MatrixX> qr(fitted);
    const MatrixX Q = qr.householderQ() * MatrixX::Identity(fitted.rows(), qr.rank());
    B -= Q * (Q.transpose() * B);
  }
  const Eigen::SelfAdjointEigenSolver<MatrixX> axes(B.transpose() * B);
  const VectorX& all = axes.eigenvalues();
  Eigen::Index first = 0;
  while (first < all.size() && !(all(first) > 1e-10 * all(all.size() - 1))) ++first;
  w_ = all.tail(all.size() - first);
  Q_ = B * axes.eigenvectors().rightCols(w_.size()) * w_.cwiseSqrt().cwiseInverse().asDiagonal();
}

std::vector<double> Discrepancy::log_likelihoods(const VectorX& r) const {
  const VectorX along = Q_.transpose() * r;
  std::vector<double> out;
  for (const double tau : scales()) {
    double sum = 0;
    for (Eigen::Index i = 0; i < w_.size(); ++i) {
      const double more = tau * tau * w_(i);
      sum += 0.5 * (along(i) * along(i) * more / (1 + more) - std::log1p(more));
    }
    out.push_back(sum);
  }
  return out;
}

double Discrepancy::log_evidence(const VectorX& r) const { return log_mean_exp(log_likelihoods(r)); }

double Discrepancy::likeliest_scale(const VectorX& r) const {
  const std::vector<double> all = log_likelihoods(r);
  return scales()[static_cast<std::size_t>(std::max_element(all.begin(), all.end()) - all.begin())];
}

double Discrepancy::p_value(const VectorX& r) const {
  // Patterns that are all but one another's sum say nothing of their own.
  const Eigen::Index own = (w_.array() > 1e-6 * w_.maxCoeff()).count();
  if (own == 0) return 1;
  const double gain = (Q_.rightCols(own).transpose() * r).squaredNorm();
  return chi_squared_tail(static_cast<double>(own), gain);
}

VectorX Discrepancy::whitened(const VectorX& r, double tau) const {
  VectorX along = Q_.transpose() * r;
  for (Eigen::Index i = 0; i < along.size(); ++i) along(i) *= 1 / std::sqrt(1 + tau * tau * w_(i)) - 1;
  return r + Q_ * along;
}

}  // namespace deflect
