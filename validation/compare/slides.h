// What the slides of a machine do to the elongations of its sites.
#pragma once

#include "validation/compare/patterns.h"

namespace deflect::compare {

/// Whether the sites have slides at an angle to their lines, and slides that stand at different lengths in the data.
bool has_slides(const ResidualStudy&);
bool varies_in_extension(const ResidualStudy&);

double mean_extension(const ResidualStudy&);  ///< m; 1 without slides

/// e ∝ f · along: what yields along slides.
VectorX elastic_along(const ResidualStudy&);

/// e ∝ f (1 − along) (L/L̄)^p: what yields across slides of extension L, L̄ their mean.
VectorX elastic_across(const ResidualStudy&, double power);

}  // namespace deflect::compare
