// Simulated measurements of a frame, and plans of them.
#pragma once

#include <cstdint>
#include <string>

#include "msa/frame/file/frame_description.h"
#include "validation/measurement/measurements.h"
#include "validation/prediction/simulate.h"

namespace deflect::subject {

/// Plans of the names in campaign.h, made of the frame's load cases; factors on them:
///   paper   each case once
///   cycle   each case in a loop 0 → 1 → −1 → 0 in steps of a quarter, in sequence
///   rich    each case ±1, ±½, ±¼, and each two of them together with both senses, all of it twice
///   random  200 readings, each of two or three cases with factors between −1 and 1
measurement::Measurements frame_campaign(const std::string& name, const frame::FrameDescription&, std::uint64_t seed);

/// The plan with readings of all sensors filled in, by the MSA in the geometry that the description names. Drawn at
/// random: one frame within the declared tolerances, the gain of each sensor, an unknown zero of each sensor that has
/// one (of the size of its largest reading), the difference of each true load from the recorded one, the noise of each
/// reading (a sensor without sigma: sigma_u, sigma_th, else 1/1000 of its largest reading, rounded up to one digit; the
/// result's description of the sensor has it). The same seed gives the same file. Readings are rounded to a thousandth
/// of σ or finer.
measurement::Measurements simulate_frame(const frame::FrameDescription&, measurement::Measurements plan,
                                         const prediction::SimulationOptions&);

}  // namespace deflect::subject
