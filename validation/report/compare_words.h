// What the tables, pictures and captions of a comparison say alike: the unit of errors, each reading's three numbers,
// sentences about data, noise and axes.
#pragma once

#include <string>
#include <vector>

#include "validation/compare/comparison.h"

namespace deflect::report {

/// The units of errors (quantity_of_errors).
struct ErrorUnit {
  measurement::Quantity quantity = measurement::Quantity::length;
  const char* micro = "µm";  ///< of `fine` times the error
  const char* milli = "mm";  ///< of `coarse` times
  const char* column = "um";
  double fine = 1e6, coarse = 1e3;
  bool rotations = false;
  const char* load = "N";  ///< of the load that goes with them
  const char* components[3] = {"Δx", "Δy", "Δz"};
  const char* loads[3] = {"fx", "fy", "fz"};
};
ErrorUnit error_unit(const compare::Comparison&);
/// "µm", "N": of errors of one quantity; the number of them in an SI unit.
inline const char* fine_unit(measurement::Quantity q) { return measurement::row_of(q).fine; }
inline double fine_of(measurement::Quantity q) { return measurement::row_of(q).fine_per_SI; }

/// Of a reading, m or rad as Errors speak of: NaN where not measured. The load in N or Nm.
struct ReadingCells {
  Vector3 measured, predicted, residual, load;
  bool pure = false;  ///< nothing but `load`, and of that one component
  bool set_aside = false;
};
std::vector<ReadingCells> cells_of(const compare::Comparison&);

/// " at 9 poses"; nothing of a subject that stands still.
std::string poses_words(const compare::Comparison&);
/// p-value below which a test counts as failed.
inline constexpr double significant = 1e-3;

/// "device against file.csv".
std::string subjects(const compare::Comparison&);

/// Captions: "Device … against data …: readings, poses and where they lie, loads." "σ of a reading …, …" and the axes.
std::string data_sentence(const compare::Comparison&);
std::string noise_sentence(const compare::Comparison&);
std::string axes_sentence(const compare::Comparison&);

}  // namespace deflect::report
