// Play that a load leaves open: where in it the machine stands.
//
// Under a load that puts no force on play, the prediction in linear geometry stands in its middle and the machine at
// one of its ends: what presses it there is small. Equilibrium in the deformed shape is known; friction, a cable,
// weight and a joint that is not quite where it is drawn are not. Where these decide, a reading is off by up to the
// whole play, 2 J, with J the motion from the middle to an end: by 0 or 2 J with equal probability, of mean square 2 J
// Jᵀ about the end that is predicted, and J Jᵀ about the middle.
#pragma once

#include <vector>

#include "validation/measurement/measurements.h"
#include "validation/statistics/uncertainty.h"
#include "validation/subject/subject.h"

namespace deflect::statistics {

/// By reading, channels × columns: errors of covariance 2 Σ J Jᵀ over the open play at the reading, no columns where
/// none is open; empty where none is at any, or where it cannot be told. J by the readings under a little more load
/// along and about each axis, which closes the play. `standing`: at the poses of the measurements.
std::vector<MatrixX> open_play(const subject::Standing& standing, const measurement::Measurements&);

/// Whether a residual is likelier with these errors of play than without, each with its uncertainty, of the same
/// readings. What is missing elsewhere also is in these readings: likelihoods count in units of what is left of all.
bool is_anywhere_in_play(const Uncertainty& with, const Uncertainty& without, const VectorX& residual);

}  // namespace deflect::statistics
