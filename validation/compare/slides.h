// Elongations of sites by compliance along and across the slides of a machine.
#pragma once

#include "validation/compare/patterns.h"

namespace deflect::compare {

/// Whether some site has a slide at an angle to its line; whether the slides have different extensions in the data.
bool has_slides(const ResidualStudy&);
bool varies_in_extension(const ResidualStudy&);

double mean_extension(const ResidualStudy&);  ///< m; 1 without slides

/// e ∝ f · along: compliance along the slides.
VectorX elastic_along(const ResidualStudy&);

/// e ∝ f (1 − along) (L/L̄)^p: compliance across the slides at extension L, with L̄ the mean.
VectorX elastic_across(const ResidualStudy&, double power);

}  // namespace deflect::compare
