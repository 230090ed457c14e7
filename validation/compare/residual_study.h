// The ground of a comparison: where the subject stands, predictions, forces at sites.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "validation/measurement/replicates.h"
#include "validation/subject/subject.h"

namespace deflect::compare {

/// Everything that patterns of the residual are made of: SI, base axes; by reading where not said otherwise.
struct ResidualStudy {
  std::optional<subject::Subject> subject;
  const measurement::Measurements* data = nullptr;
  std::shared_ptr<const subject::Standing> standing;  ///< where it stands at the poses, as drawn
  std::vector<measurement::MeasuredValue> values;     ///< the measured numbers
  std::vector<Vector6> predicted;                     ///< as recorded
  std::vector<Vector6> deformed_shape;  ///< finite − linear geometry; empty where it is predicted or unknown
  std::vector<std::vector<subject::Site>> sites;  ///< by pose
  std::vector<Matrix6> compliance;                ///< by pose: tangent at T at rest (contacts as under 1 N)
  std::vector<VectorX> force;                     ///< of each site, N or Nm
  std::vector<VectorX> heading;  ///< of each site: sign of the last change of its force, 0 before the first
  bool sequence = false;         ///< the readings' order is known
};

/// Predicts and looks inside: the data must outlive the study. Without `deformed_shape`.
ResidualStudy residual_study(const subject::Subject&, const measurement::Measurements&, const parallel::Work& = {});

/// ResidualStudy::deformed_shape of a subject in linear geometry: most of the time that a study takes.
std::vector<Vector6> deformed_shape_of(const ResidualStudy&, const parallel::Work& = {});

/// About what it is under another load of a reading: even in the load, it goes with the load's square.
Vector6 deformed_shape_under(const ResidualStudy&, std::size_t reading, const Vector6& load);

}  // namespace deflect::compare
