// What can be wrong with a sensor, whatever the cause.
#pragma once

#include <map>
#include <string>

#include "validation/compare/residual_study.h"

namespace deflect::compare {

/// By the sensor's name; rows: the measured numbers (SI), zero in those of other channels. With p the prediction of the
/// channel's readings, the columns are
///   1, |p|               a zero, a scale that differs between the two senses,
///   p                    a scale,
///   p of the others      those of the same quantity: crosstalk,
///   time                 from the first reading to the last,
///   p less what it shows if it follows only where it lags by more than 0, a tenth and three tenths of its largest |p|.
/// The last two only where the order of the readings is known.
///
/// Of "sensor", which reads the motion (u, θ) of a machine's tool point: θ × e of another point, e × u and e × θ of
/// other axes, u and θ of other scales, e along x, y and z. A column that is zero is left out.
std::map<std::string, MatrixX> channel_shapes(const ResidualStudy&);

/// Whether the order of the readings is known and this is one of the named sensors.
bool may_lag(const ResidualStudy&, const std::string& sensor);
/// In the same rows: p less what the sensor shows if it follows only where it lags by more than a band, for sixteen
/// bands, each 0.7 of the one before, from 0.7 of its largest |p|. A column that is zero is left out; none where it may
/// not lag.
MatrixX lags_of_channel(const ResidualStudy&, const std::string& sensor);

}  // namespace deflect::compare
