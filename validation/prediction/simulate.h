// Measurements of a device as an instrument would hand them over, computed by the MSA: never by the theory that
// diagnoses them.
#pragma once

#include <cstdint>
#include <functional>

#include "msa/base/geometry.h"
#include "msa/frame/mechanism/build.h"
#include "validation/measurement/measurements.h"
#include "validation/parallel/work.h"

namespace deflect::prediction {

struct SimulationOptions {
  std::uint64_t seed = 1;
  double sigma_u = 2e-6;                 ///< m: of a reading; 0: exact readings without σ in the file
  std::optional<double> sigma_th;        ///< rad; absent: rotations are not measured
  double tolerances = 1;                 ///< times those of the device; 0: built as drawn
  double outliers = 0;                   ///< share of gross outliers among the readings, 10 to 30 σ
  double temperature = 20, swing = 0;    ///< °C; slow wave about it over the sequence, K
  Geometry geometry = Geometry::finite;  ///< equilibrium in which shape
  frame::MemberDivision division;
};

/// The plan with displacements. One machine is drawn by lot within the device's tolerances (as_built.h), its actuators
/// once for every pose; every true load differs from the recorded one by the load's tolerance; then the reading's
/// noise. The same seed gives the same file. Readings are rounded to a thousandth of σ.
measurement::Measurements simulate(const Mechanism&, measurement::Measurements plan, const SimulationOptions&,
                                   const parallel::Work& = {});

/// How many times the plan's loads the machine as drawn carries, to a percent, at the first of its poses where it does
/// not carry all; 1 where it carries all, 0 where it does not carry a millionth.
double share_carried(const Mechanism&, const measurement::Measurements& plan, const SimulationOptions&);

}  // namespace deflect::prediction
