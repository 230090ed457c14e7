// What the readings of a frame change where a place inside it yields.
#pragma once

#include <functional>

#include "validation/compare/residual_study.h"

namespace deflect::compare {

/// The change of each measured number when the site is as much longer as `elongation`, called once for each reading,
/// says at the force that passes.
VectorX change_by_yielding(const ResidualStudy&, const subject::InnerSite&,
                           const std::function<double(double force)>& elongation);
/// Three columns over the measured numbers: their change when the site is deformed in proportion to the force f that
/// passes, to |f|, and by a step where f turns, which are as large at the largest f.
MatrixX changes_by_yielding(const ResidualStudy&, const subject::InnerSite&);

}  // namespace deflect::compare
