// Laws in series at places: what a small one does to the readings follows from the forces that statics puts on the
// place (Transmissions), without a prediction for each.
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
  /// Of the effects among these that are laws in series with one parameter, at places where statics agrees with a
  /// prediction: the readings of the first pose, one law at each place, to a hundredth.
  ByStatics(const Observations&, const std::vector<effects::PlacedEffect>&, int threads);

  /// The change of the whitened residual at the start values; nothing where it has to be predicted.
  std::optional<VectorX> change(const effects::PlacedEffect&) const;

 private:
  std::optional<std::vector<Vector6>> by_force(const effects::PlacedEffect&, const VectorX& values,
                                               const measurement::Measurements&) const;
  bool agrees(const effects::PlacedEffect&) const;

  const Observations& observations_;
  std::unique_ptr<const subject::Transmissions> transmissions_;
  std::map<std::string, bool> known_;  ///< by place
};

}  // namespace deflect::diagnosis
