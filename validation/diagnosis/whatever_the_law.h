// What may happen at a place, whether or not a law describes it: columns over the measured numbers, whitened, of unit
// length, without those that tolerances hide.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "validation/diagnosis/changes.h"

namespace deflect::diagnosis {

/// Any curve of deflection over force at a place of a machine (Changes::by_any_curve()).
class AnyCurve {
 public:
  AnyCurve(std::shared_ptr<const Observations>, std::shared_ptr<const Changes>, const effects::PlacedEffect& at);
  /// Computed at each call: kept for all places they would take more memory than all else.
  MatrixX columns() const;

 private:
  std::shared_ptr<const Observations> observations_;
  std::shared_ptr<const Changes> changes_;
  effects::PlacedEffect at_;
};

/// Of columns over the measured numbers, those that these observations see, whitened, of unit length.
MatrixX as_seen(const Observations&, const MatrixX& columns);

/// A place in all legs (0) or in one of them, by a name of its own; all that can be wrong with a sensor is at one.
using Spot = std::pair<std::string, int>;
Spot spot_of(const subject::Place&, std::optional<int> leg);

class WhateverTheLaw {
 public:
  /// `columns`: of members and loads those of Changes::by_whatever(), of sensors channel_shapes().
  WhateverTheLaw(const Observations&, std::shared_ptr<const Changes>, const std::map<Spot, MatrixX>& columns);

  /// At sensors, members, and loads of frames; null elsewhere, and at groups.
  std::shared_ptr<const MatrixX> at(const subject::Place&, std::optional<int> leg) const;
  /// Where an effect in a machine acts; null where statics does not tell the forces.
  std::shared_ptr<const AnyCurve> curve_at(const effects::PlacedEffect&) const;

 private:
  using Shapes = std::map<Spot, std::shared_ptr<const MatrixX>>;
  Shapes whitened(const std::map<Spot, MatrixX>&) const;

  std::shared_ptr<const Observations> observations_;
  std::shared_ptr<const Changes> changes_;
  Shapes all_;
};

}  // namespace deflect::diagnosis
