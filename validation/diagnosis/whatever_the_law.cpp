#include "validation/diagnosis/whatever_the_law.h"

#include <fmt/format.h>

#include <vector>

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
  if (!changes_->may_rub(place)) return nullptr;
  return
      [changes = changes_, place, leg, o = std::move(o)] { return as_seen(*o, changes->by_any_friction(place, leg)); };
}

Columns WhateverTheLaw::where_no_law_is(const subject::Place& place, std::optional<int> leg,
                                        std::shared_ptr<const Observations> o) const {
  Columns out = at(place, leg, o);
  return out ? out : friction_at(place, leg, std::move(o));
}

}  // namespace deflect::diagnosis
