#include "validation/diagnosis/whatever_the_law.h"

#include <fmt/format.h>

#include <vector>

#include "msa/base/index.h"
#include "validation/statistics/columns.h"

namespace deflect::diagnosis {
namespace {

/// Of `white`, which are the whitened `raw` columns.
MatrixX that_are_seen(const Observations& o, const MatrixX& raw, const MatrixX& white) {
  constexpr double nothing = 1e-6;  // standard deviations
  constexpr double hidden = 1e-3;   // of the length that it has beside noise alone
  const std::vector<double>& sigma = o.comparison().sigma;
  const VectorX noise = Eigen::Map<const VectorX>(sigma.data(), std::ssize(sigma));
  std::vector<Eigen::Index> seen;
  for (Eigen::Index k = 0; k < white.cols(); ++k)
    if (const double length = white.col(k).norm();
        length > nothing && length >= hidden * raw.col(k).cwiseQuotient(noise).norm())
      seen.push_back(k);
  MatrixX out = white(Eigen::all, seen);
  out.colwise().normalize();
  return out;
}

}  // namespace

AnyCurve::AnyCurve(std::shared_ptr<const Observations> o, std::shared_ptr<const Changes> changes,
                   const effects::PlacedEffect& at)
    : observations_(std::move(o)), changes_(std::move(changes)), at_(at) {}

MatrixX AnyCurve::columns() const { return as_seen(*observations_, changes_->by_any_curve(at_)); }

MatrixX as_seen(const Observations& o, const MatrixX& columns) {
  return that_are_seen(o, columns, o.uncertainty().whitened(columns));
}

Spot spot_of(const subject::Place& p, std::optional<int> leg) {
  const std::string sensor = subject::sensor_of(p);
  if (!sensor.empty()) return {"sensors." + sensor, 0};
  return {p.others.empty() ? fmt::format("{} {}", p.path, subject::motion_of(p)) : subject::id_of(p), leg.value_or(0)};
}

WhateverTheLaw::WhateverTheLaw(const Observations& o, std::shared_ptr<const Changes> changes,
                               const std::map<Spot, MatrixX>& columns)
    : observations_(std::make_shared<const Observations>(o)), changes_(std::move(changes)), all_(whitened(columns)) {}

std::shared_ptr<const MatrixX> WhateverTheLaw::at(const subject::Place& place, std::optional<int> leg) const {
  const auto found = all_.find(spot_of(place, leg));
  return found == all_.end() ? nullptr : found->second;
}

std::shared_ptr<const AnyCurve> WhateverTheLaw::curve_at(const effects::PlacedEffect& e) const {
  if (!e.effect->place || !changes_->is_known_by_statics(*e.effect->place)) return nullptr;
  return std::make_shared<const AnyCurve>(observations_, changes_, e);
}

/// Several columns at once, which takes a fraction of the time; all at once would take as much memory again, twice.
WhateverTheLaw::Shapes WhateverTheLaw::whitened(const std::map<Spot, MatrixX>& all) const {
  constexpr Eigen::Index at_once = 16;
  const auto numbers = as_index(observations_->comparison().sigma.size());
  Shapes out;
  for (auto next = all.begin(); next != all.end();) {
    std::vector<MatrixX> raw;
    Eigen::Index columns = 0;
    for (auto some = next; some != all.end() && columns < at_once; ++some) {
      raw.push_back(some->second);
      columns += some->second.cols();
    }
    const MatrixX white = observations_->uncertainty().whitened(statistics::side_by_side(raw, numbers));
    Eigen::Index at = 0;
    for (const MatrixX& each : raw) {
      MatrixX seen = that_are_seen(*observations_, each, white.middleCols(at, each.cols()));
      if (each.cols() > 0) out[next->first] = std::make_shared<const MatrixX>(std::move(seen));
      at += each.cols();
      ++next;
    }
  }
  return out;
}

}  // namespace deflect::diagnosis
