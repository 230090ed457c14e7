// Findings as sentences with numbers.
#pragma once

#include "validation/compare/findings.h"

namespace deflect::compare {

/// What the pattern means, where, how large; with the exponents of force and extension and whether all sites are alike
/// where it lies in the sites. `beside`: columns of the findings before it.
std::string sentence_of(const Finding&, const ResidualStudy&, const statistics::Uncertainty&, const VectorX& residual,
                        const MatrixX& beside);

}  // namespace deflect::compare
