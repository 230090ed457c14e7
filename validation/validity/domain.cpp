#include "validation/validity/domain.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "msa/base/index.h"
#include "validation/validity/hull.h"

namespace deflect::validity {
namespace {

using measurement::Measurements;

constexpr const char* pose_names[] = {"x", "y", "z", "roll", "pitch", "yaw"};

/// Of each pose its six numbers, or its joint coordinates, as columns.
MatrixX poses_of(const Measurements& m) {
  MatrixX out(m.by_joints() ? std::ssize(m.joint_rotates) : 6, std::ssize(m.poses));
  for (std::size_t p = 0; p < m.poses.size(); ++p)
    out.col(as_index(p)) = m.by_joints() ? m.poses[p].joints : VectorX(m.poses[p].pose_mm_deg);
  return out;
}

/// Loads by channel name: of all channels that either file has.
struct Loads {
  std::vector<measurement::LoadChannel> channels;
  MatrixX validation, use;
};

MatrixX by_channel(const Measurements& m, const std::vector<measurement::LoadChannel>& channels) {
  std::map<std::string, Eigen::Index> own;
  const std::vector<measurement::LoadChannel> all = measurement::load_channels(m);
  for (std::size_t i = 0; i < all.size(); ++i) own[all[i].name] = as_index(i);
  const MatrixX loads = measurement::loads_of(m);
  MatrixX out = MatrixX::Zero(std::ssize(channels), loads.cols());
  for (std::size_t i = 0; i < channels.size(); ++i)
    if (const auto at = own.find(channels[i].name); at != own.end()) out.row(as_index(i)) = loads.row(at->second);
  return out;
}

Loads loads_of(const Measurements& validation, const Measurements& use) {
  Loads out;
  out.channels = measurement::load_channels(validation);
  for (const measurement::LoadChannel& c : measurement::load_channels(use))
    if (std::none_of(out.channels.begin(), out.channels.end(), [&](const auto& other) { return other.name == c.name; }))
      out.channels.push_back(c);
  out.validation = by_channel(validation, out.channels);
  out.use = by_channel(use, out.channels);
  return out;
}

void add_range(std::vector<Range>& out, const std::string& name, const std::string& unit, double per,
               const VectorX& validation, const VectorX& use) {
  Range r{
      name, unit, per * validation.minCoeff(), per * validation.maxCoeff(), per * use.minCoeff(), per * use.maxCoeff()};
  if (r.low != r.high || r.use_low != r.use_high || r.use_low != r.low) out.push_back(std::move(r));
}

void add_poses(std::vector<Range>& out, const Measurements& validation, const Measurements& use) {
  if (validation.instruments.stationary || validation.by_joints() != use.by_joints()) return;
  const MatrixX a = poses_of(validation), b = poses_of(use);
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    if (!validation.by_joints())
      add_range(out, nth(pose_names, i), i < 3 ? "mm" : "deg", 1, a.row(i), b.row(i));
    else
      add_range(out, "q" + std::to_string(i + 1), validation.joint_rotates[as_size(i)] ? "rad" : "mm",
                validation.joint_rotates[as_size(i)] ? 1 : 1e3, a.row(i), b.row(i));
}

/// Distance of q from the hull of the columns, 0 within rounding.
double distance(const MatrixX& X, const VectorX& q) {
  const double d = (nearest_in_hull(X, q) - q).norm();
  return d > 1e-6 * std::max(X.cwiseAbs().maxCoeff(), q.cwiseAbs().maxCoeff()) ? d : 0;
}

/// Rows over what makes them comparable: positions as they are, joint coordinates over their range.
VectorX scales_of(const MatrixX& X, bool joints) {
  VectorX out = VectorX::Ones(X.rows());
  for (Eigen::Index i = 0; i < X.rows() && joints; ++i)
    if (const double width = X.row(i).maxCoeff() - X.row(i).minCoeff(); width > 0) out(i) = width;
  return out;
}

}  // namespace

std::vector<Range> ranges(const Measurements& validation, const Measurements* given) {
  const Measurements& use = given ? *given : validation;
  std::vector<Range> out;
  add_poses(out, validation, use);
  const Loads loads = loads_of(validation, use);
  for (std::size_t i = 0; i < loads.channels.size(); ++i) {
    const measurement::LoadChannel& c = loads.channels[i];
    const bool factor = c.name.starts_with("load.");
    add_range(out, c.name,
              factor     ? ""
              : c.moment ? "Nmm"
                         : "N",
              c.moment ? 1e3 : 1, loads.validation.row(as_index(i)), loads.use.row(as_index(i)));
  }
  return out;
}

std::vector<UsePoint> use_points(const Measurements& validation, const Measurements& use) {
  const Loads loads = loads_of(validation, use);
  // Each load over the largest of validation in its channel; where there was none, over the largest of use.
  VectorX scale(loads.validation.rows());
  for (Eigen::Index i = 0; i < scale.size(); ++i) {
    scale(i) = loads.validation.row(i).cwiseAbs().maxCoeff();
    if (scale(i) == 0) scale(i) = std::max(loads.use.row(i).cwiseAbs().maxCoeff(), 1e-300);
  }
  MatrixX hull(scale.size(), loads.validation.cols() + 1);
  hull << scale.cwiseInverse().asDiagonal() * loads.validation, VectorX::Zero(scale.size());
  const bool posed = !validation.instruments.stationary && validation.by_joints() == use.by_joints();
  MatrixX poses, points;
  std::vector<double> by_pose(use.poses.size(), 0);
  if (posed) {
    const Eigen::Index rows = validation.by_joints() ? std::ssize(validation.joint_rotates) : 3;
    poses = poses_of(validation).topRows(rows), points = poses_of(use).topRows(rows);
    const VectorX own = scales_of(poses, validation.by_joints());
    for (std::size_t p = 0; p < by_pose.size(); ++p)
      by_pose[p] =
          distance(own.cwiseInverse().asDiagonal() * poses, own.cwiseInverse().asDiagonal() * points.col(as_index(p)));
  }
  std::vector<UsePoint> out;
  for (std::size_t i = 0; i < use.readings.size(); ++i)
    out.push_back({i, by_pose[use.readings[i].pose],
                   distance(hull, scale.cwiseInverse().asDiagonal() * loads.use.col(as_index(i)))});
  return out;
}

}  // namespace deflect::validity
