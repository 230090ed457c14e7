// Gross outliers among the readings.
#pragma once

#include "validation/compare/patterns.h"
#include "validation/statistics/parted_columns.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {

/// A reading is set aside where, after fitting tolerances and patterns (columns over the measured numbers) to the
/// readings kept, a component is left that exceeds 4.5 standard deviations of the scatter of the readings; chance does
/// this to one reading in 50 000. Repeated until nothing changes (at most five times). `A`, `sigma` and `residual`
/// belong to the study's values, as in uncertainty.h.
struct Outliers {
  std::vector<bool> aside;
  statistics::Uncertainty uncertainty;  ///< of the readings kept
};
Outliers gross_outliers(const ResidualStudy&, const statistics::PartedColumns& A, const std::vector<double>& sigma,
                        const VectorX& residual, const MatrixX& patterns, int threads = 1);

}  // namespace deflect::compare
