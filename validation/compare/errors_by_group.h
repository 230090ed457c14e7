// The size of residuals, overall and by group.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "msa/base/spatial.h"
#include "validation/measurement/replicates.h"

namespace deflect::compare {

/// The quantity that errors of all numbers together are of: the first that was measured of displacements, rotations,
/// forces, moments, strains. Numbers of the others are left out of them.
measurement::Quantity quantity_of_errors(const std::vector<measurement::MeasuredValue>&);

/// Root mean square over the numbers of that quantity, SI; 0 without any.
double rms_of_errors(const std::vector<measurement::MeasuredValue>&, const VectorX&);

/// The same over the readings not set aside.
double rms_of_kept(const std::vector<measurement::MeasuredValue>&, const VectorX&, const std::vector<bool>& set_aside);

/// Statistics of the residuals measured − predicted, SI; of the quantity of errors, those of one channel of its own.
struct Errors {
  std::string group;  ///< "pose 3", "fx > 0", "30 … 50 N"; empty for all
  measurement::Quantity quantity = measurement::Quantity::length;
  std::size_t readings = 0;
  double rmse = 0;  ///< root mean square over all components of all readings
  Vector3 bias = Vector3::Zero();
  std::array<bool, 3> measured_along{};  ///< x, y, z: whether the bias there is of any number of the tool point
  double worst = 0;                      ///< largest |component|
  std::size_t worst_line = 0;            ///< of the file
  double measured = 0;                   ///< root mean square of the measured components
};

struct Comparison;

/// Fills `all`, `by_axis`, `by_pose`, `by_direction`, `by_magnitude` and, with a sequence, `by_heading`.
void add_errors(Comparison&);

}  // namespace deflect::compare
