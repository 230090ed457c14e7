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
///
/// Of a subject without tool point more than one reading in twenty that way may be one effect that is missing: a sensor
/// that shows some of another is off under the loads that move the other, and nowhere else. Then they are looked for
/// again beside whatever a linear effect can do, and the fewer are set aside.
struct Outliers {
  std::vector<bool> aside;
  statistics::Uncertainty uncertainty;  ///< of the readings kept
};
Outliers gross_outliers(const ResidualStudy&, const statistics::LoadErrors&, const statistics::PartedColumns& A,
                        const std::vector<double>& sigma, const VectorX& residual, const MatrixX& patterns,
                        int threads = 1);

/// Errors of loads, with these of play (open_play.h) beside them where the residual is likelier so, readings that are
/// gross outliers beside them set aside; without any where it is not.
statistics::LoadErrors with_open_play(const ResidualStudy&, const statistics::LoadErrors&,
                                      const std::vector<MatrixX>& play, const statistics::PartedColumns& A,
                                      const std::vector<double>& sigma, const VectorX& residual, int threads = 1);

}  // namespace deflect::compare
