// 95 % intervals of fitted values, by the profile of χ².
//
// With χ²(x) the least value at the coordinate x of one parameter, all others free within their bounds (tolerances are
// in the whitening), the interval is all x with
//   χ²(x) − χ²(best) ≤ 3.841,
// the 95 % quantile of χ² with one degree of freedom. Where χ² is a parabola this is x ± 1.96 σ, which is tried first
// and kept where it is right to a fortieth of its half-width; else the limits are searched for. Where χ² does not rise
// so far, the limit is the bound of the parameter; infinity where that is the upper bound of play or of what yields in
// one sense, since the part has let go there (lets_go(), signatures.h): all larger sizes say the same, whatever bounds
// a search has.
//
// Where physics fixes a sign and the truth is near the bound, the interval holds at least as often as it says. Of one
// number z = a + N(0, 1) with a ≥ 0 it holds a wherever |z − a| ≤ 1.96 and z ≥ 0, or a² − 2 a z ≤ 3.841 and z < 0: with
// probability Φ(1.96) − Φ(−(a/2 + 1.92/a)) for a < 1.96, that is .975 at the bound, .95 from a = 1.96 on. The shortest
// interval of a posterior with a flat prior on a ≥ 0 holds it as rarely as (1 − α)/(1 + α) = .905 (Roe & Woodroofe,
// Phys. Rev. D 63 (2001) 013009).
#pragma once

#include <utility>

#include "validation/diagnosis/hypothesis.h"

namespace deflect::diagnosis {

/// The fit with the limits of its values (Fit::limits). Not more than 16 steps for each limit, each with eight
/// evaluations for the other values at most, and their derivatives. The same for any number of threads.
Fit with_intervals(const Observations&, const Hypothesis&, Fit, int threads);

/// The values again with their limits, weighed for the subject that they make (Observations::weighed_for).
Fit weighed_for_itself(const Observations&, const Hypothesis&, const Fit&, int threads);

/// Whether the readings do not change with the last value, near the fit: then its limits are not where the derivatives
/// say.
bool says_nothing_of_last(const Fit&);

/// 95 % interval of parameter i: the fit's limits; where it has none, symmetric in the coordinate and cut at the
/// bounds.
std::pair<double, double> interval95(const Hypothesis&, const Fit&, std::size_t i);

}  // namespace deflect::diagnosis
