// What a device would have made the instruments say: readings predicted one by one.
//
// The recorded load F becomes the true one, gain · R_cell F, forces and moments alike; the theory gives the
// displacement of T against the assembled, weightless machine at 20 °C, at the reading's temperature, in the order in
// which the readings were taken (`sequence`, else the file's). Frictions are relaxed before the first reading; those
// beside legs keep the force that they carry when the machine goes on to another pose, others are relaxed there. The
// sensor records R_sensor d + drift · rank / N, rank 0 … N − 1 in the sequence. R is the rotation by a rotation vector.
#pragma once

#include <optional>
#include <vector>

#include "msa/base/geometry.h"
#include "msa/frame/mechanism/build.h"
#include "msa/mechanism/configuration.h"
#include "validation/measurement/measurements.h"
#include "validation/parallel/work.h"
#include "validation/theories/theory.h"

namespace deflect::prediction {

struct PredictionOptions {
  const theories::Theory* theory = theories::all_theories().front();
  std::optional<Geometry> geometry;  ///< absent: the device's
  frame::MemberDivision division;    ///< of members in the MSA
};

/// d_T_W as recorded, per reading, all six components (m, rad). `machines`: where the device stands, one per pose of
/// the measurements (configure_all, configure_as_built). Throws NumericalError "file:line: …" where the theory finds no
/// equilibrium, InputError where the device needs a sequence that the file does not have.
std::vector<Vector6> predict(const Mechanism&, const std::vector<Configuration>& machines,
                             const measurement::Measurements&, const PredictionOptions& = {},
                             const parallel::Work& = {});

/// The true load of a recorded one, and the recorded displacement of a true one without drift.
Vector6 true_load(const LoadCell&, const Vector6& recorded);
Vector6 recorded_displacement(const Sensor&, const Vector6& true_displacement);

}  // namespace deflect::prediction
