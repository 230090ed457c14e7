// What may happen at a place, whether or not a law describes it.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "validation/diagnosis/changes.h"

namespace deflect::diagnosis {

/// Columns over the measured numbers, whitened, of unit length, without those that tolerances hide. Computed at each
/// call: kept for all places they would take more memory than all else.
using Columns = std::function<MatrixX()>;
using AnyCurve = std::function<MatrixX(Curves)>;

/// A place in all legs (0) or in one of them, by a name of its own; all that can be wrong with a sensor is at one.
using Spot = std::pair<std::string, int>;
Spot spot_of(const subject::Place&, std::optional<int> leg);

class WhateverTheLaw {
 public:
  /// `columns`: whatever_columns().
  WhateverTheLaw(std::shared_ptr<const Changes>, std::map<Spot, MatrixX> columns);

  /// Where there are such columns, as these observations weigh them; null elsewhere.
  Columns at(const subject::Place&, std::optional<int> leg, std::shared_ptr<const Observations>) const;
  /// Any curve of deflection over force where an effect acts (Changes::by_any_curve()); null where the
  /// forces are not known.
  AnyCurve curve_at(const effects::PlacedEffect&, std::shared_ptr<const Observations>) const;
  /// Any friction beside what is there, in a sensor any lag (lags_of_channel()); null where it is not known what that
  /// does (Changes::may_be_held()).
  Columns friction_at(const subject::Place&, std::optional<int> leg, std::shared_ptr<const Observations>) const;
  const std::vector<subject::NodeMotion>& node_motions() const { return changes_->node_motions(); }

 private:
  std::shared_ptr<const Changes> changes_;
  std::shared_ptr<const std::map<Spot, MatrixX>> columns_;
};

}  // namespace deflect::diagnosis
