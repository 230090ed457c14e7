// What may happen at a place, whether or not a law describes it: columns over the measured numbers, whitened, of unit
// length, without those that tolerances hide.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "validation/diagnosis/changes.h"

namespace deflect::diagnosis {

/// Any curve of deflection over force at a place of a machine (Changes::by_any_curve()). Computed when it is first
/// asked for: all places together would take more memory than all else.
class AnyCurve {
 public:
  AnyCurve(std::shared_ptr<const Observations>, std::shared_ptr<const Changes>, const effects::PlacedEffect& at);
  const MatrixX& columns() const;

 private:
  std::shared_ptr<const Observations> observations_;
  std::shared_ptr<const Changes> changes_;
  effects::PlacedEffect at_;
  mutable std::once_flag once_;
  mutable MatrixX columns_;
};

class WhateverTheLaw {
 public:
  /// `of_parts`: Changes::by_whatever(), by the path of the part.
  WhateverTheLaw(const Observations&, std::shared_ptr<const Changes>, const std::map<std::string, MatrixX>& of_parts);

  /// At sensors, loads and members of frames; null elsewhere, and at groups.
  std::shared_ptr<const MatrixX> at(const effects::PlacedEffect&) const;
  /// Where an effect in a machine acts; null where statics does not tell the forces.
  std::shared_ptr<const AnyCurve> curve_at(const effects::PlacedEffect&) const;

 private:
  using Shapes = std::map<std::string, std::shared_ptr<const MatrixX>>;
  Shapes whitened(const std::map<std::string, MatrixX>&) const;

  std::shared_ptr<const Observations> observations_;
  std::shared_ptr<const Changes> changes_;
  Shapes sensors_, parts_;
};

}  // namespace deflect::diagnosis
