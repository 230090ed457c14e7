// Findings as sentences with numbers.
#pragma once

#include "validation/compare/findings.h"

namespace deflect::compare {

/// What the pattern means, where it acts and how large it is. For a pattern at the sites also the exponents of force
/// and extension, and whether all sites are alike. `beside`: columns of the findings before it.
std::string sentence_of(const Finding&, const ResidualStudy&, const statistics::Uncertainty&, const VectorX& residual,
                        const MatrixX& beside);

}  // namespace deflect::compare
