// Laws in series at places: their small effect on the readings follows from the forces at the place by statics
// (Transmissions), without a prediction for each law. Readings whose load leaves play open are predicted.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "validation/diagnosis/observations.h"
#include "validation/effects/with_effect.h"

namespace deflect::diagnosis {

class ByStatics {
 public:
  /// Covers those of the effects that are laws in series with one parameter, at places where statics agrees with a
  /// prediction. This is checked for one law at each place on the readings of the first pose, to 1 %.
  ByStatics(const Observations&, const std::vector<effects::PlacedEffect>&, int threads);

  /// The change of the whitened residual at the start values; nullopt where it has to be predicted.
  std::optional<VectorX> change(const effects::PlacedEffect&) const;

 private:
  std::optional<subject::Transmissions::Change> by_force(const effects::PlacedEffect&, const VectorX& values,
                                                         const measurement::Measurements&) const;
  bool agrees(const effects::PlacedEffect&) const;

  const Observations& observations_;
  VectorX null_;  ///< Observations::residual() of its subject
  std::unique_ptr<const subject::Transmissions> transmissions_;
  std::map<std::string, bool> known_;  ///< by place: whether statics agrees
};

}  // namespace deflect::diagnosis
