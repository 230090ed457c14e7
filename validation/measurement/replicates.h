// Replicates: readings that differ by chance only, and what they say about the noise of one reading.
//
// Replicates share pose label and load (to 1e-9 N and 1e-9 Nm). Where the file has a sequence they also share the
// direction in which the load was reached, the signs of its changes since the last reading of another load; a reading
// with another pose label before it starts from no load. Otherwise the loop of friction would pass for noise.
// Temperature is not looked at.
//
// Pooled variance over groups g of n_g values with mean d̄_g ("pure error"):
//   s² = Σ_g Σ_i (d_gi − d̄_g)² / ν,   ν = Σ_g (n_g − 1),
// every component of the displacement counting as a group of its own, translations and rotations apart. It contains
// neither what an approach's readings have in common nor the error of the model; gross outliers enlarge it. ν s² / σ²
// is χ² with ν degrees of freedom where the noise is Gaussian.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/measurement/measurements.h"

namespace deflect::measurement {

enum class Reached { in_same_direction, in_any_direction };

/// Groups of two or more readings, each ascending, in the order of their first readings.
std::vector<std::vector<std::size_t>> replicates(const Measurements&, Reached = Reached::in_same_direction);

/// Standard deviation of one measured number.
struct NoiseEstimate {
  double sigma = 0;  ///< m or rad, > 0
  std::size_t degrees_of_freedom = 0;
};

/// Empty where it cannot be told: no replicates, or replicates alike to the last digit, which are rounded more coarsely
/// than they scatter.
struct PureError {
  std::optional<NoiseEstimate> u, th;  ///< of T's components
};
PureError pure_error(const Measurements&, Reached = Reached::in_same_direction);
/// Of all numbers of one quantity, T's components and sensors.
std::optional<NoiseEstimate> pure_error_of(const Measurements&, Quantity);

/// One measured number, of a channel: 0 … 5 are the components of d_T_W = [δ; θ], the sensors follow.
struct MeasuredValue {
  std::size_t reading = 0;
  std::size_t channel = 0;
  double value = 0;             ///< SI
  std::optional<double> sigma;  ///< the file's; else from the replicates; empty where there is neither
  Quantity quantity = Quantity::length;
  bool by_replicates = false;      ///< so is sigma; what errors of the recorded loads do is in it
  Vector6 form = Vector6::Zero();  ///< the first-order reading of a small displacement d of T: form · d

  /// Whether it is one of d_T_W's components.
  bool of_tool_point() const { return channel < 6; }
};

/// That of a component of d_T_W, 0 … 5.
MeasuredValue tool_point_value(std::size_t reading, std::size_t component, double value, std::optional<double> sigma);

/// All of them, reading by reading. A sensor's σ is the description's, else its replicates', else that of the file.
std::vector<MeasuredValue> measured_values(const Measurements&, const SensorForm& = nullptr);

/// "ux", "probe".
std::string channel_name(const Measurements&, std::size_t channel);

}  // namespace deflect::measurement
