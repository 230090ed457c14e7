#include "tests/benchmark/gaussian_process.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace deflect::benchmark {
namespace {

using namespace measurement;

/// Poses over 25 mm and 7.5 deg, loads over the plan's largest force and 20 mm of it; a column each reading.
struct Inputs {
  Matrix6X pose, load;
};
Inputs inputs(const Measurements& data) {
  const auto n = static_cast<Eigen::Index>(data.readings.size());
  Inputs out{Matrix6X(6, n), Matrix6X(6, n)};
  Vector6 pose_unit, load_unit;
  pose_unit << 25, 25, 25, 7.5, 7.5, 7.5;
  load_unit << Vector3::Constant(force), Vector3::Constant(0.02 * force);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Reading& r = data.readings[static_cast<std::size_t>(i)];
    out.pose.col(i) = data.poses[r.pose].pose_mm_deg.cwiseQuotient(pose_unit);
    out.load.col(i) = r.load.cwiseQuotient(load_unit);
  }
  return out;
}

MatrixX squared_distances(const Matrix6X& a, const Matrix6X& b) {
  MatrixX out = -2 * a.transpose() * b;
  out.colwise() += a.colwise().squaredNorm().transpose();
  out.rowwise() += b.colwise().squaredNorm();
  return out;
}

}  // namespace

VectorX gaussian_process(const Plan& plan, const VectorX& residual) {
  const Inputs here = inputs(plan.readings), there = inputs(plan.elsewhere);
  const MatrixX poses = squared_distances(here.pose, here.pose), loads = squared_distances(here.load, here.load);
  const MatrixX new_poses = squared_distances(there.pose, here.pose);
  const MatrixX new_loads = squared_distances(there.load, here.load);
  const Eigen::Index n = poses.rows();
  const MatrixX Y = Eigen::Map<const MatrixX>(residual.data(), 3, n).transpose();
  const double scale = std::sqrt(Y.squaredNorm() / static_cast<double>(Y.size()));
  double best = -INFINITY;
  MatrixX prediction;
  for (const double pose_length : {1.0, 3.0, 10.0})
    for (const double load_length : {0.5, 1.5, 5.0})
      for (const double size : {0.5, 2.0, 8.0})
        for (const double noise : {1.0, 1.5}) {
          const auto kernel = [&](const MatrixX& p, const MatrixX& l) {
            return MatrixX(std::pow(size * scale, 2) *
                           (-0.5 * (p / (pose_length * pose_length) + l / (load_length * load_length)).array()).exp());
          };
          MatrixX K = kernel(poses, loads);
          K.diagonal().array() += std::pow(noise * sigma_u, 2);
          const Eigen::LLT<MatrixX> factor(K);
          const MatrixX weights = factor.solve(Y);
          const double likelihood =
              -0.5 * Y.cwiseProduct(weights).sum() - 3 * factor.matrixLLT().diagonal().array().log().sum();
          if (!(likelihood > best)) continue;
          best = likelihood;
          prediction = kernel(new_poses, new_loads) * weights;
        }
  const MatrixX rows = prediction.transpose();
  return Eigen::Map<const VectorX>(rows.data(), rows.size());
}

}  // namespace deflect::benchmark
