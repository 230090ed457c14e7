// How far a verdict hangs on single groups of readings, and whether parameters are the same in all groups.
//
// Leaving out: the agreement (Errors) without one pose, one load direction or one session. Where the verdict changes,
// it hangs on that group.
//
// Same: a parameter's derivative P as one column for each group of a kind; with the common column fitted,
//   r = P a + Σ_g P 1_g a_g,   Σ_g a_g = 0,
// the reduction of χ² by the G − 1 further columns gives the p-value of "the same everywhere".
#pragma once

#include <string>
#include <vector>

#include "validation/fit/posterior.h"
#include "validation/validity/errors.h"

namespace deflect::validity {

/// Verdict: where chance gives so large a χ² less often, the errors are more than u_val explains.
inline constexpr double rejected_below = 0.05;
inline bool agrees(const Agreement& a) { return a.p_value >= rejected_below; }

/// Readings by group, for one kind of group.
struct Grouping {
  std::string kind;                ///< "pose", "load direction", "load size", "session"
  std::vector<std::string> names;  ///< of the groups
  std::vector<std::size_t> group;  ///< of each reading
};

/// Those with two groups or more. Load direction: the largest component and its sense, where forces, moments and
/// factors on load cases are each taken over the largest of their kind in the file; load size: thirds by the size of
/// the prediction; session: by a column whose name begins with note and has "session", "day" or "date" in it.
std::vector<Grouping> groupings(const Errors&);

struct WithoutGroup {
  std::string kind, name;
  std::size_t readings = 0;  ///< left out
  Agreement agreement;
  bool changes = false;  ///< the verdict
};
std::vector<WithoutGroup> leave_out(const Errors&, const std::vector<Grouping>&, int threads = 1);

struct Sameness {
  std::string parameter, kind;
  std::size_t groups = 0;
  double p_value = 1;
};
/// `derivative`: of the predictions, by measured number and parameter.
std::vector<Sameness> same_everywhere(const Errors&, const std::vector<Grouping>&, const MatrixX& derivative,
                                      const std::vector<fit::FreeParameter>&);

}  // namespace deflect::validity
