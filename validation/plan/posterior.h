// What the readings taken leave open of a rival's parameters, as draws.
//
// Where λ² grows about the fit as a parabola does, the draws are normal with its covariance. Where a law bends, or a
// bound is near, they are of
//   p(x) ∝ exp(−λ²(x)/2) within the bounds,  λ²(x): what tolerances leave of the readings taken less μ(x),
// x the coordinates of the parameters (fit_problem.h). Of a spring that hardens, for instance, few readings know little
// more than one combination of its stiffness and the displacement at which that has doubled: a valley, narrow and bent.
// Along each coordinate that is known to less than a factor √e the valley is followed from the fit to both sides, the
// others fitted again at every step; a mixture of normals there, each as narrow as λ² says and no wider than a step,
// proposes draws, which are weighted by p over its density (importance sampling: Kloek, van Dijk, Econometrica 46,
// 1978).
#pragma once

#include "validation/measurement/random.h"
#include "validation/plan/rival.h"

namespace deflect::plan {

/// So many draws, three at least (columns: coordinates). Normal ones have over all of them the mean of the fit and the
/// mean square of the covariance, and the fit is the first; others are quantiles along their longest axis.
MatrixX draws_of(const RivalModel&, const Linearised& fit, Eigen::Index draws, measurement::Random&);

}  // namespace deflect::plan
