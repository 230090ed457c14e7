#include "validation/diagnosis/whatever_the_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "msa/base/index.h"
#include "msa/base/outcome.h"
#include "validation/compare/channel_shapes.h"
#include "validation/compare/yielding.h"
#include "validation/diagnosis/whatever_columns.h"
#include "validation/statistics/columns.h"

namespace deflect::diagnosis {
namespace {

/// Of columns over the measured numbers those that these observations see, whitened, of unit length.
MatrixX as_seen(const Observations& o, const MatrixX& columns) {
  constexpr double nothing = 1e-6;  // standard deviations
  constexpr double hidden = 1e-3;   // of the length that it has beside noise alone
  const std::vector<double>& sigma = o.comparison().sigma;
  const VectorX noise = Eigen::Map<const VectorX>(sigma.data(), std::ssize(sigma));
  const MatrixX white = o.uncertainty().whitened(columns);
  std::vector<Eigen::Index> seen;
  for (Eigen::Index k = 0; k < white.cols(); ++k)
    if (const double length = white.col(k).norm();
        length > nothing && length >= hidden * columns.col(k).cwiseQuotient(noise).norm())
      seen.push_back(k);
  MatrixX out = white(Eigen::all, seen);
  out.colwise().normalize();
  return out;
}

constexpr double part_of_a_load = 0.1;
constexpr double hundredth = 1e-2;  // of a machine's load, of its size, or rad
constexpr const char* load_at_tool = "rig.load_cell";
constexpr std::size_t most_apart = 4;  // nodes of a load
constexpr double no_change = 1e-9;     // of what all loads do

constexpr int ways_of_friction = 16;
constexpr double size_of_a_column = 1e-3;  // m

/// Of a motion: holds against it, in its unit, until it slips after `way`. At rest it holds nothing.
Changes::Curve rubbing(double way) {
  return [way, before = 0.0, held = 0.0](double motion) mutable {
    held = std::clamp(held + motion - std::exchange(before, motion), -way, way);
    return held;
  };
}

/// What rubs beside the freedom of a place in whatever way is close to a sum of forces that each hold until they slip
/// (the Prandtl–Ishlinskii model, W. D. Iwan, J. Appl. Mech. 33, 1966): after sixteen ways, each 0.7 of
/// the one before, and one that never slips. Relaxed at each pose.
MatrixX any_friction(const Changes& changes, const subject::Place& place, std::optional<int> leg,
                     Eigen::Index numbers) {
  std::vector<MatrixX> out;
  const auto add = [&](const std::function<Changes::Curve()>& at_rest) {
    const std::optional<VectorX> change = changes.by_holding(place, leg, at_rest);
    if (const double length = change ? change->norm() : 0; length > 0)
      out.emplace_back(size_of_a_column / length * *change);
  };
  double most = 0;
  add([&] {
    return [&most](double motion) {
      most = std::max(most, std::abs(motion));
      return motion;
    };
  });
  for (int i = 1; most > 0 && i <= ways_of_friction; ++i)
    add([way = most * std::pow(0.5, 0.5 * i)] { return rubbing(way); });
  return statistics::side_by_side(out, numbers);
}

/// By how much a load F differs, in the base's axes, whose point lies elsewhere along an axis of the platform (columns
/// 0 to 2, by 1 m), which is turned about an axis of the base (3 to 5, by 1 rad), or of which one component is once
/// larger (6 to 11). R: axes of the platform.
Eigen::Matrix<double, 6, 12> other_loads(const Vector6& F, const Matrix3& R) {
  const Vector3 f = F.head<3>(), m = F.tail<3>();
  Eigen::Matrix<double, 6, 12> out = Eigen::Matrix<double, 6, 12>::Zero();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const Vector3 turn = Vector3::Unit(axis);
    out.col(axis).tail<3>() = R.col(axis).cross(f);
    out.col(3 + axis) << turn.cross(f), turn.cross(m);
  }
  out.rightCols<6>() = F.asDiagonal();
  return out;
}

}  // namespace

Spot spot_of(const subject::Place& p, std::optional<int> leg) {
  const std::string sensor = subject::sensor_of(p);
  if (!sensor.empty()) return {"sensors." + sensor, 0};
  return {p.others.empty() ? fmt::format("{} {}", p.path, subject::motion_of(p)) : subject::id_of(p), leg.value_or(0)};
}

WhateverTheLaw::WhateverTheLaw(std::shared_ptr<const Changes> changes, std::map<Spot, MatrixX> columns)
    : changes_(std::move(changes)), columns_(std::make_shared<const std::map<Spot, MatrixX>>(std::move(columns))) {}

Columns WhateverTheLaw::at(const subject::Place& place, std::optional<int> leg,
                           std::shared_ptr<const Observations> o) const {
  const auto found = columns_->find(spot_of(place, leg));
  if (found == columns_->end()) return nullptr;
  return [all = columns_, found, o = std::move(o)] { return as_seen(*o, found->second); };
}

AnyCurve WhateverTheLaw::curve_at(const effects::PlacedEffect& e, std::shared_ptr<const Observations> o) const {
  if (!e.effect->place || !changes_->knows_forces_at(*e.effect->place)) return nullptr;
  return [changes = changes_, e, o = std::move(o)](Curves c) { return as_seen(*o, changes->by_any_curve(e, c)); };
}

Columns WhateverTheLaw::friction_at(const subject::Place& place, std::optional<int> leg,
                                    std::shared_ptr<const Observations> o) const {
  if (const std::string sensor = subject::sensor_of(place); compare::may_lag(o->comparison().study, sensor))
    return [sensor, o = std::move(o)] { return as_seen(*o, compare::lags_of_channel(o->comparison().study, sensor)); };
  if (!changes_->may_be_held(place)) return nullptr;
  return [changes = changes_, place, leg, o = std::move(o)] {
    return as_seen(*o, any_friction(*changes, place, leg, std::ssize(o->comparison().study.values)));
  };
}

MatrixX Changes::by_whatever(const subject::Place& place, std::optional<int> leg) const {
  const frame::FrameDescription* drawn = observations_.subject().frame();
  if (drawn && place.kind == subject::PlaceKind::load)
    if (const frame::LoadCase* load = find(drawn->loads, place.part)) return by_any_load(*load, place.part);
  if (!drawn && place.kind == subject::PlaceKind::load) return by_any_load_of_a_machine(place);
  if (drawn && place.others.empty()) return by_any_elongation(place);
  if (!drawn && place.kind == subject::PlaceKind::member && place.others.empty()) return by_any_section(place, leg);
  return MatrixX(null_.size(), 0);
}

MatrixX Changes::by_any_load(const frame::LoadCase& load, const std::string& of) const {
  double most = 0;
  for (const auto& [node, wrench] : load.nodes) most = std::max(most, wrench.norm());
  const double size = observations_.comparison().study.standing->size();
  const bool apart = load.nodes.size() <= most_apart;
  std::vector<MatrixX> out;
  const auto add = [&](Eigen::Index axis, const std::string& only) {
    frame::FrameDescription other = *observations_.subject().frame();
    for (auto& [name, each] : other.loads)
      for (auto& [node, wrench] : each.nodes)
        if (name == of && (only.empty() || node == only)) wrench(axis) += part_of_a_load * most * (axis < 3 ? 1 : size);
    if (const auto residual = outcome_of([&] { return observations_.residual(subject::Subject(other)); }))
      out.emplace_back(*residual - null_);
  };
  for (Eigen::Index axis = 0; most > 0 && axis < 6; ++axis) {
    if (!apart) add(axis, "");
    for (std::size_t i = 0; apart && i < load.nodes.size(); ++i) add(axis, load.nodes[i].first);
  }
  return statistics::side_by_side(out, null_.size());
}

MatrixX Changes::by_any_load_of_a_machine(const subject::Place& place) const {
  const compare::ResidualStudy& study = observations_.comparison().study;
  const std::vector<std::string>& points = study.data->instruments.load_points;
  const bool at_tool = place.path == load_at_tool;
  const auto point =
      std::find_if(points.begin(), points.end(), [&](const auto& p) { return place.path == "loads." + p; });
  if (!at_tool && point == points.end()) return MatrixX(null_.size(), 0);  // which the file has no column for
  const auto standing = observations_.subject().stand(*study.data, study.standing.get());
  const auto read = [&](const measurement::Measurements& data) {
    prediction::PredictionOptions linear;
    linear.geometry = Geometry::linear;
    return statistics::rows_of(study.values, standing->predict(data, linear));
  };
  const VectorX before = read(*study.data);
  std::vector<MatrixX> out;
  for (Eigen::Index kind = 0; kind < 12; ++kind) {
    measurement::Measurements other = *study.data;
    bool same = true;
    for (measurement::Reading& r : other.readings) {
      Vector6& load = !at_tool ? r.at_points[as_size(point - points.begin())] : points.empty() ? r.load : r.at_tool;
      const Vector6 more = other_loads(load, standing->tool(r.pose).R_W).col(kind);
      load += hundredth * (kind < 3 ? standing->size() : 1) * more;
      same = same && more.isZero(0);
    }
    if (same) continue;
    if (const auto after = outcome_of([&] { return read(observations_.subject().placed(std::move(other))); }))
      out.emplace_back(before - *after);
  }
  return statistics::side_by_side(out, null_.size());
}

MatrixX Changes::by_any_elongation(const subject::Place& place) const {
  std::vector<MatrixX> out;
  for (const subject::InnerSite* site : sites_at(place))
    out.push_back(compare::changes_by_yielding(observations_.comparison().study, *site));
  return statistics::side_by_side(out, null_.size());
}

MatrixX Changes::by_any_section(const subject::Place& member, std::optional<int> leg) const {
  const compare::ResidualStudy& study = observations_.comparison().study;
  // What a member as long as the machine would do by a unit law, which carries all loads.
  const double size = study.standing->size(), loads = study.loads.cwiseAbs().maxCoeff();
  std::vector<MatrixX> out;
  for (const std::size_t freedom : {0u, 3u, 4u, 5u}) {  // x is along the member
    subject::Place sections = member;
    sections.freedoms = {freedom};
    const auto same = [](double force) { return force; };
    const auto told = transmissions_ ? transmissions_->change(sections, leg, same, *study.data) : std::nullopt;
    if (!told) continue;
    const VectorX change = -statistics::rows_of(study.values, *told);
    const double carrying_all = loads * std::pow(size, freedom < 3 ? 1 : 3);
    if (change.cwiseAbs().maxCoeff() > no_change * carrying_all)
      out.emplace_back(size_of_a_column / change.norm() * change);
  }
  return statistics::side_by_side(out, null_.size());
}

std::map<Spot, MatrixX> whatever_columns(const Observations& o, const Changes& changes) {
  std::map<Spot, MatrixX> out;
  for_each_place(o.subject(), [&](const subject::Place& p, std::optional<int> leg) {
    if (MatrixX own = changes.by_whatever(p, leg); own.cols() > 0) out.emplace(spot_of(p, leg), std::move(own));
  });
  for (auto& [sensor, shapes] : compare::channel_shapes(o.comparison().study))
    if (shapes.cols() > 0) out.emplace(Spot("sensors." + sensor, 0), std::move(shapes));
  return out;
}

}  // namespace deflect::diagnosis
