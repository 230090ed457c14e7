// Springs whose law is not linear as scalar laws that the structure around them couples (set_valued_laws.h).
#pragma once

#include "msa/base/set_valued_laws.h"
#include "msa/frame/elements/spring_law.h"

namespace deflect::frame {

/// The force beside the preload by the elongation from the state at rest, m or rad. It refers to the law.
ScalarLaw scalar_law(const SpringLaw&);

/// Stiffness of the law itself where it carries the force s at the elongation d: infinite where it is rigid. `end` as
/// in SetValuedSolution.
double tangent_at(const SpringLaw&, double d, double s, int end);

/// Slip after a load that ends there.
double slip_at(const FrictionSpring&, double at_rest, double d, int end);

}  // namespace deflect::frame
