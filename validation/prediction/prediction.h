// Predicts what the instruments would record, reading by reading.
//
// The true load is gain · R_cell F for the recorded load F, for forces and moments alike. The theory gives the
// displacement d of T at the reading's temperature, relative to the assembled, weightless machine at 20 °C. Readings
// are taken in order (`sequence`, else the order of the file). Friction elements carry no force before the first
// reading, unless the friction law gives a start. When the machine moves to another pose, those in parallel with legs
// keep their force where nothing else has a history; others, and tables that remember, start anew. The sensor records
// R_sensor d + drift · rank / N, with rank 0 … N − 1 in the sequence. Each R is given by a rotation vector.
#pragma once

#include <optional>
#include <set>
#include <string>
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
  frame::MemberDivision division;    ///< of members, in the MSA
  bool apart = false;                ///< laws that jump, in the closed form (theories::TheoryOptions::apart)
  /// By reading of a machine, which are asked for: the numbers of the others mean nothing. Empty: all.
  std::vector<bool> only = {};
};

/// Play that loads leave open (theories::Prediction::floating). In linear geometry only equilibrium in the deformed
/// shape says where in it the mechanism stands.
struct Floating {
  /// By reading, the laws by name: the same law has the same one in every edited copy. Empty: nowhere.
  std::vector<std::set<std::string>> at_readings;
  bool at(std::size_t reading) const { return !at_readings.empty() && !at_readings[reading].empty(); }
};

struct Predicted {
  /// By reading, what every channel records (MeasuredValue): d_T_W, all six components, then the sensors; m, rad.
  std::vector<VectorX> readings;
  Floating floating = {};
};

/// `machines`: the configurations of the device, one per pose of the measurements (configure_all, configure_as_built).
/// Throws NumericalError "file:line: …" where the theory finds no equilibrium, InputError where the device needs a
/// sequence that the file does not have.
Predicted predicted(const Mechanism&, const std::vector<Configuration>& machines, const measurement::Measurements&,
                    const PredictionOptions& = {}, const parallel::Work& = {});
/// The readings alone.
std::vector<VectorX> predict(const Mechanism&, const std::vector<Configuration>& machines,
                             const measurement::Measurements&, const PredictionOptions& = {},
                             const parallel::Work& = {});

}  // namespace deflect::prediction
