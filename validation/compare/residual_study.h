// The ground of a comparison: machines, predictions, forces at sites.
#pragma once

#include "validation/compare/patterns.h"
#include "validation/parallel/cases.h"

namespace deflect {

/// Predicts and looks inside: the mechanism and the data must outlive the study.
ResidualStudy residual_study(const Mechanism&, const Measurements&, int threads, const Told& = {});

}  // namespace deflect
