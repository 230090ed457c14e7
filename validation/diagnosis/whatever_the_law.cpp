#include "validation/diagnosis/whatever_the_law.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "validation/compare/channel_shapes.h"
#include "validation/compare/yielding.h"
#include "validation/diagnosis/whatever_columns.h"
#include "validation/statistics/columns.h"
#include "validation/subject/frame_sites.h"

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
  if (!e.effect->place || !changes_->is_known_by_statics(*e.effect->place)) return nullptr;
  return [changes = changes_, e, o = std::move(o)](Curves c) { return as_seen(*o, changes->by_any_curve(e, c)); };
}

Columns WhateverTheLaw::friction_at(const subject::Place& place, std::optional<int> leg,
                                    std::shared_ptr<const Observations> o) const {
  if (!changes_->may_be_held(place)) return nullptr;
  return [changes = changes_, place, leg, o = std::move(o)] {
    return as_seen(*o, any_friction(*changes, place, leg, std::ssize(o->comparison().study.values)));
  };
}

std::map<Spot, MatrixX> whatever_columns(const Observations& o, const Changes& changes) {
  const compare::ResidualStudy& study = o.comparison().study;
  std::map<Spot, MatrixX> out;
  for_each_place(o.subject(), [&](const subject::Place& p, std::optional<int> leg) {
    if (MatrixX own = changes.by_whatever(p, leg); own.cols() > 0) out.emplace(spot_of(p, leg), std::move(own));
  });
  for (auto& [sensor, shapes] : compare::channel_shapes(study))
    if (shapes.cols() > 0) out.emplace(Spot("sensors." + sensor, 0), std::move(shapes));
  if (const frame::FrameDescription* drawn = o.subject().frame()) {
    const std::vector<subject::InnerSite> joints = subject::joint_sites_of(*drawn, *study.data);
    for_each_place(o.subject(), [&](const subject::Place& p, std::optional<int> leg) {
      std::vector<MatrixX> here;
      for (const subject::InnerSite& site : joints)
        if (site.place.path == p.path && std::ranges::includes(p.freedoms, site.place.freedoms))
          here.push_back(compare::changes_by_yielding(study, site));
      if (!here.empty()) out.emplace(spot_of(p, leg), statistics::side_by_side(here, std::ssize(study.values)));
    });
  }
  return out;
}

}  // namespace deflect::diagnosis
