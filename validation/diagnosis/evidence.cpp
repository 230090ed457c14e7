#include "validation/diagnosis/evidence.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numeric>

namespace deflect {
namespace {

double log_mean_exp(const std::vector<double>& x) {
  const double most = *std::max_element(x.begin(), x.end());
  double sum = 0;
  for (const double v : x) sum += std::exp(v - most);
  return most + std::log(sum / static_cast<double>(x.size()));
}

std::vector<double> scales(double low, double high, int count) {
  std::vector<double> out;
  for (int i = 0; i < count; ++i) out.push_back(low * std::pow(high / low, (i + 0.5) / count));
  return out;
}

}  // namespace

double log_evidence(double gain, int parameters, bool one_sided) {
  const boost::math::normal normal;
  std::vector<double> terms;
  for (const double tau : scales(0.5, 500, 40)) {
    const double share = tau * tau / (1 + tau * tau);
    double term = -0.5 * parameters * std::log1p(tau * tau) + 0.5 * gain * share;
    if (one_sided) term += std::log(2 * boost::math::cdf(normal, std::sqrt(gain * share)));
    terms.push_back(term);
  }
  return log_mean_exp(terms);
}

double log_evidence_of_discrepancy(const VectorX& r, const MatrixX& B) {
  const auto n = static_cast<double>(r.size());
  MatrixX scaled = B;
  for (auto column : scaled.colwise())
    if (const double norm = column.norm(); norm > 0) column *= std::sqrt(n) / norm;
  // In the principal axes of BBᵀ: independent numbers of variance 1 + τ² w.
  const Eigen::SelfAdjointEigenSolver<MatrixX> axes(scaled.transpose() * scaled);
  VectorX along(axes.eigenvalues().size()), w = axes.eigenvalues();
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    if (!(w(i) > 1e-10 * w(w.size() - 1))) {
      w(i) = along(i) = 0;
      continue;
    }
    along(i) = (scaled * axes.eigenvectors().col(i)).dot(r) / std::sqrt(w(i));
  }
  std::vector<double> terms;
  for (const double tau : scales(1e-3, 10, 40)) {
    double sum = 0;
    for (Eigen::Index i = 0; i < w.size(); ++i) {
      const double more = tau * tau * w(i);
      sum += -0.5 * std::log1p(more) + 0.5 * along(i) * along(i) * more / (1 + more);
    }
    terms.push_back(sum);
  }
  return log_mean_exp(terms);
}

std::vector<double> normalised(const std::vector<double>& x) {
  const double most = *std::max_element(x.begin(), x.end());
  std::vector<double> out;
  double sum = 0;
  for (const double v : x) sum += std::exp(v - most);
  for (const double v : x) out.push_back(std::exp(v - most) / sum);
  return out;
}

}  // namespace deflect
