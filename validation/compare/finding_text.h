// Findings as sentences with numbers.
#pragma once

#include "validation/compare/findings.h"

namespace deflect {

/// What the pattern means, where, how large; with the exponents of force and extension and whether all sites are alike
/// where it lies in the sites. `beside`: columns of the findings before it.
std::string sentence_of(const Finding&, const ResidualStudy&, const Uncertainty&, const VectorX& residual,
                        const MatrixX& beside);

/// Whether the sites have slides at an angle to their lines, and slides that stand at different lengths in the data.
bool has_slides(const ResidualStudy&);
bool varies_in_extension(const ResidualStudy&);

double mean_extension(const ResidualStudy&);  ///< m; 1 without slides

/// e ∝ f · along: what yields along slides.
VectorX elastic_along(const ResidualStudy&);

/// e ∝ f (1 − along) (L/L̄)^p: what yields across slides of extension L, L̄ their mean.
VectorX elastic_across(const ResidualStudy&, double power);

}  // namespace deflect
