// What the sensors of a frame read under the loads of measurements, by matrix structural analysis.
#pragma once

#include <vector>

#include "msa/frame/file/frame_description.h"
#include "validation/measurement/measurements.h"

namespace deflect::subject {

/// By reading: six zeros, because a frame has no tool point, then what each sensor of the measurements records. In
/// linear geometry with linear laws each load is solved once and readings are sums; else each reading has its own
/// equilibrium, and friction keeps its state from reading to reading in the order of `sequence`. True loads are
/// load_gain times the recorded ones. Throws NumericalError "file:line: …" where a reading has no equilibrium or a
/// check of the analysis fails, InputError where the frame lacks a sensor, a node or a load case of the measurements.
std::vector<VectorX> predicted_readings(const frame::FrameDescription&, const measurement::Measurements&, Geometry);

/// Whether a reading depends on the loads before it.
bool has_history(const frame::FrameDescription&);

}  // namespace deflect::subject
