#include "msa/frame/iterative/conjugate_gradients.h"
#include "msa/base/index.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace deflect::frame {
namespace {

constexpr int look_every = 20;

/// The Lanczos matrix of the coefficients.
struct Lanczos {
  std::vector<double> alpha, beta;
  std::array<double, 2> extremes() const {
    const auto n = std::ssize(alpha);
    if (n == 0) return {1, 1};
    VectorX diagonal(n), beside(n - 1);
    for (Eigen::Index k = 0; k < n; ++k) {
      const auto i = as_size(k);
      diagonal(k) = 1 / alpha[i] + (i ? beta[i - 1] / alpha[i - 1] : 0);
      if (k + 1 < n) beside(k) = std::sqrt(beta[i]) / alpha[i];
    }
    Eigen::SelfAdjointEigenSolver<MatrixX> eigen;
    eigen.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly);
    return {eigen.eigenvalues()(0), eigen.eigenvalues()(n - 1)};
  }
};

/// The error after so many steps: rho = |r|², the energy is the square of the solution's size.
void estimate(GradientSummary& s, const Lanczos& lanczos, const GradientOptions& o, double rho, double energy) {
  std::tie(s.smallest, s.largest) = std::tuple_cat(lanczos.extremes());
  if (o.smallest > 0) s.smallest = std::min(s.smallest, o.smallest);
  s.residual = std::sqrt(rho);
  s.size = std::sqrt(energy);
  s.error = 2 * s.residual / std::sqrt(s.smallest) / (o.size > 0 ? o.size : s.size);
  s.converged = s.error <= o.error;
}

}  // namespace

GradientSummary conjugate_gradients(const IncompleteCholesky& M, const VectorX& b, const GradientOptions& o) {
  GradientSummary s;
  if (o.smallest > 0) s.smallest = o.smallest;
  s.x = VectorX::Zero(b.size());
  VectorX r = b, p = VectorX::Zero(b.size()), t = p, w = p;
  double rho = b.squaredNorm(), beta = 0, alpha = 0, energy = 0;
  s.converged = rho == 0;
  Lanczos lanczos;
  TwoAtOnce both(o.threads);
  std::array<double, 3> sums{};  // by part, added in this order
  const auto slice = [&M](VectorX& v, int part) {
    const auto [from, to] = M.part(part);
    return v.segment(6 * from, 6 * (to - from));
  };
  const auto turn = [&](int part) { slice(p, part) = slice(r, part) + beta * slice(p, part); };
  const auto close = [&](int part) { nth(sums, part) = slice(p, part).dot(slice(t, part) + slice(w, part)); };
  const auto apply = [&](int part) {
    turn(part);
    M.sweep(part, p, t, w);
    close(part);
  };
  const auto advance = [&](int part) {
    slice(s.x, part) += alpha * slice(p, part);
    slice(r, part) -= alpha * (slice(t, part) + slice(w, part));
    nth(sums, part) = slice(r, part).squaredNorm();
  };
  const auto sum = [&sums] { return sums[0] + sums[1] + sums[2]; };
  const std::function<void()> apply_0 = [&] { apply(0); }, apply_1 = [&] { apply(1); }, advance_0 = [&] { advance(0); },
                              advance_1 = [&] { advance(1); };
  while (!s.converged && s.iterations < o.most_iterations) {
    turn(2);
    M.join(p, t);
    both(apply_0, apply_1);
    M.finish(p, t, w);
    close(2);
    const double curvature = sum();
    if (!(curvature > 0)) break;
    alpha = rho / curvature;
    both(advance_0, advance_1);
    advance(2);
    energy += alpha * rho;
    const double next = sum();
    beta = next / rho;
    rho = next;
    lanczos.alpha.push_back(alpha);
    lanczos.beta.push_back(beta);
    ++s.iterations;
    const double relative_to = o.size > 0 ? o.size : std::sqrt(energy);
    const bool near = 2 * std::sqrt(rho / s.smallest) <= o.error * relative_to;
    if (s.iterations % look_every && !near) continue;
    estimate(s, lanczos, o, rho, energy);
    if (o.progress) o.progress(std::clamp(std::log(s.error) / std::log(o.error), 0.0, 1.0));
    if (!std::isfinite(s.error)) break;
  }
  return s;
}

}  // namespace deflect::frame
