// How the stiffness of a map varies with the positions of the slides.
#pragma once

#include <vector>

#include "validation/studies/map.h"

namespace deflect::report {

/// How two series vary together: −1 … 1. Pearson's r; Spearman's ρ is r of the ranks, ties sharing their mean rank.
/// Both are 0 where a series is constant.
struct Correlation {
  double pearson = 0, spearman = 0;
};
Correlation correlation(const std::vector<double>& a, const std::vector<double>& b);

/// Correlation of the stiffness along `axis` with the mean position of the slides over the poses reached, by the
/// theory that the figures show.
Correlation with_slides(const studies::StiffnessMap&, int axis);

}  // namespace deflect::report
