// Nonlinear springs as scalar laws, coupled by the surrounding structure (set_valued_laws.h).
#pragma once

#include "msa/base/set_valued_laws.h"
#include "msa/frame/elements/spring_law.h"

namespace deflect::frame {

/// The force in excess of the preload as a function of the elongation from the state at rest, m or rad. It refers to
/// the law, which must outlive it.
ScalarLaw scalar_law(const SpringLaw&);

/// Tangent stiffness of the law at force s and elongation d: infinite where it is rigid. `end` as in SetValuedSolution.
double tangent_at(const SpringLaw&, double d, double s, int end);

/// What the load leaves in a law that has a number, among those of all laws: the slip of a friction, what is left in a
/// table. d, s and `end` as above.
void keep_slips(const SpringLaw&, double d, double s, int end, std::vector<double>& slips);

}  // namespace deflect::frame
