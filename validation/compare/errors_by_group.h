// The size of residuals, overall and by group.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "msa/base/spatial.h"
#include "validation/measurement/replicates.h"

namespace deflect::compare {

/// Whether only rotations were measured. The errors are then those of rotations, in rad instead of m.
bool rotations_alone(const std::vector<measurement::MeasuredValue>&);

/// Root mean square over the translations (m), or over the rotations (rad) where only these were measured; 0 without
/// any.
double rms_of_errors(const std::vector<measurement::MeasuredValue>&, const VectorX&);

/// The same over the readings not set aside.
double rms_of_kept(const std::vector<measurement::MeasuredValue>&, const VectorX&, const std::vector<bool>& set_aside);

/// Statistics of the residuals measured − predicted: translations in m, or rotations in rad where only these were
/// measured.
struct Errors {
  std::string group;  ///< "pose 3", "fx > 0", "30 … 50 N"; empty for all
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
