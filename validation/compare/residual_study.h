// The ground of a comparison: machines, predictions, forces at sites.
#pragma once

#include "validation/compare/patterns.h"
#include "validation/parallel/cases.h"

namespace deflect {

/// Predicts and looks inside: the mechanism and the data must outlive the study. Without `deformed_shape`.
ResidualStudy residual_study(const Mechanism&, const Measurements&, int threads, const Told& = {});

/// ResidualStudy::deformed_shape of a mechanism in linear geometry: most of the time that a study takes.
std::vector<Vector6> deformed_shape_of(const ResidualStudy&, int threads, const Told& = {});

/// About what it is under another load of a reading: even in the load, it goes with the load's square.
Vector6 deformed_shape_under(const ResidualStudy&, std::size_t reading, const Vector6& load);

}  // namespace deflect
