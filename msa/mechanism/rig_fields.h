// Fields that every named instrument has, of machines and frames.
#pragma once

#include <optional>
#include <string>

#include "msa/mechanism/fields.h"

namespace deflect {

/// "uz", "rx" or "[0, 0.6, 0.8]" under the key `direction`; sets the unit vector in base axes and whether it is a
/// rotation about it.
void describe_direction(FieldVisitor&, std::string& text, Vector3& axis, bool& rotation);

/// A sensor of a machine whose legs are described already: its drive says in which unit it reads.
void describe(FieldVisitor&, PointSensor&, const Mechanism&);

/// gain, sigma, zero and offset, of this dimension.
void describe_errors(FieldVisitor&, InstrumentErrors&, Dimension);

/// An angle for a length, a moment for a force, and the other way round: what the same field may have in other sensors.
std::optional<Dimension> other_of(Dimension);

}  // namespace deflect
