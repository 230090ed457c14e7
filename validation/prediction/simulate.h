// Simulated measurements of a device, as an instrument would record them. Computed by the MSA, so that the theory that
// diagnoses them is another.
#pragma once

#include <cstdint>
#include <functional>

#include "msa/base/geometry.h"
#include "msa/frame/mechanism/build.h"
#include "validation/measurement/measurements.h"
#include "validation/measurement/random.h"
#include "validation/parallel/work.h"

namespace deflect::prediction {

struct SimulationOptions {
  std::uint64_t seed = 1;
  std::optional<std::uint64_t> machine;  ///< seed of what is built, apart from that of the readings: campaigns with
                                         ///< the same one are of one machine
  double sigma_u = 2e-6;                 ///< m: of a reading; 0: exact readings without σ in the file
  std::optional<double> sigma_th;        ///< rad; absent: rotations are not measured
  double tolerances = 1;                 ///< factor on those of the device; 0: built as drawn
  bool heavy_tails = false;              ///< noise by Student's t with three degrees of freedom, scaled to the same σ
  double outliers = 0;                   ///< share of gross outliers among the readings, 10 to 30 σ
  double temperature = 20, swing = 0;    ///< °C; amplitude of one slow sine wave about it over the sequence, K
  Geometry geometry = Geometry::finite;  ///< shape in which equilibrium is written
  frame::MemberDivision division;

  /// Of one number, in standard deviations.
  double noise(measurement::Random& random) const { return heavy_tails ? random.heavy_tailed() : random.normal(); }
};

/// The plan with readings filled in: of the device's named sensors, or, where it has none, the displacement of T. Drawn
/// at random: one machine within the device's tolerances (as_built.h), actuator errors for each pose, the gain of each
/// named sensor, the difference of each true load of a reading from the recorded one within the load's tolerance, and
/// the noise of each reading. The same seed gives the same file. Readings are rounded to a thousandth of σ or finer.
measurement::Measurements simulate(const Mechanism&, measurement::Measurements plan, const SimulationOptions&,
                                   const parallel::Work& = {});

/// The share of the plan's loads under which the MSA finds the machine as drawn in equilibrium, at the first pose where
/// it does not under all of them; known to 1 %. 1 where it does everywhere, 0 where not under a millionth of them.
double share_carried(const Mechanism&, const measurement::Measurements& plan, const SimulationOptions&);

}  // namespace deflect::prediction
