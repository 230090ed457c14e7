// The checks of a stiffness from elsewhere as a report for a person, JSON and tables.
#pragma once

#include <string>

#include "validation/matrix/check_matrix.h"

namespace deflect::report {

/// The names that the report speaks of.
struct CheckedFiles {
  std::string matrix;
  std::string reference;  ///< a file, or a device at a pose; empty without
};

/// Verdict in a sentence with its remedy, table of checks, structure, and what one matrix cannot tell.
std::string check_report(const matrix::MatrixCheck&, const CheckedFiles&);

/// {"file", "reference", "verdict": a sentence, "passes", "matrix": as read, N/mm, N, Nmm, "checks": [{"check",
/// "quantity", "measured", "at_least", "at_most", "passes"}, …], "diagnosis": [{"id", "sentence", "remedy", "certain"},
/// …], "max_asymmetry", "eigenvalues_N_per_mm", …}; a check that could not be judged has no "measured", one without a
/// bound has none.
std::string check_json(const matrix::MatrixCheck&, const CheckedFiles&);

/// Tables: the checks; the structure as quantity, unit, three values.
std::string checks_csv(const matrix::MatrixCheck&);
std::string structure_csv(const matrix::MatrixCheck&);

}  // namespace deflect::report
