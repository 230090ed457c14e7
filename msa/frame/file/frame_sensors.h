// What the sensors of a frame read in a state that was solved.
#pragma once

#include "msa/frame/file/frame_analysis.h"

namespace deflect::frame {

/// recorded = gain · true + zero: m, rad, N, Nm or strain. The strain is that of stress alone, as of a gauge that is
/// compensated for temperature. Throws InputError for a name that does not resolve.
double recorded_by(const FrameSensor&, const FrameDescription&, const FrameModel&, const CaseResult&);

/// Without the gain and zero.
double true_reading(const FrameSensor&, const FrameDescription&, const FrameModel&, const CaseResult&);

}  // namespace deflect::frame
