// Readings that are out of all proportion to the others.
#pragma once

#include "validation/compare/patterns.h"
#include "validation/statistics/parted_columns.h"
#include "validation/statistics/uncertainty.h"

namespace deflect::compare {

/// By reading: those that neither tolerances nor the patterns (columns over the measured numbers) bring within 4.5 of
/// the others' standard deviations, which chance does to one reading in 50 000. The rest of one that is set aside is
/// judged by what the others say. A, σ, residual: of the study's values, as in uncertainty.h.
struct Outliers {
  std::vector<bool> aside;
  statistics::Uncertainty uncertainty;  ///< of the others
};
Outliers gross_outliers(const ResidualStudy&, const statistics::PartedColumns& A, const std::vector<double>& sigma,
                        const VectorX& residual, const MatrixX& patterns, int threads = 1);

}  // namespace deflect::compare
