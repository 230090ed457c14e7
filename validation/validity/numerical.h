// Numerical uncertainty u_num of predictions by a study of the mesh (ASME V&V 20-2009, section 2; P. J. Roache,
// Verification and Validation in Computational Science and Engineering, 1998: Richardson, grid convergence index).
//
// The MSA predicts every reading with the elements that it has, f_0, with each halved, f_1, and halved again, f_2:
//   p     observed order, 2^p = |f_0 − f_1| / |f_1 − f_2| as root mean squares over a quantity, kept within ½ … 4: in
//         the deformed shape elements have the order 4 under loads at nodes, and 2 under line loads
//         (geometric_solver.h) and where a member is twisted as well as bent
//   f*    = f_2 + (f_2 − f_1)/(2^p − 1), extrapolated to elements of no length
//   u_num = F |S − f*| / k with F = 1.25, or 3 where the differences do not fall as elements are halved, and k = 1.15
// S is the prediction that is compared with the data. Where another theory gives it, which has no elements and shares
// no stiffness formula with the MSA, what it leaves out is in S − f* too. In linear geometry an element is exact at its
// ends, and all of this is rounding: of differences below 1e-9 of the prediction no order is taken.
#pragma once

#include <optional>
#include <vector>

#include "validation/fit/predicted.h"

namespace deflect::validity {

/// Of one quantity.
struct MeshOrder {
  measurement::Quantity quantity = measurement::Quantity::length;
  double first = 0, second = 0;  ///< root mean squares of f_0 − f_1 and f_1 − f_2, SI
  std::optional<double> order;   ///< observed; absent: the differences are rounding
};

struct NumericalStudy {
  std::vector<double> u;  ///< u_num by number of the plan, SI
  std::vector<MeshOrder> orders;
};

/// `subject`: what the plan was predicted of. Throws as Standing::predict() does.
NumericalStudy numerical_study(const subject::Subject&, const fit::PredictedPlan&, const parallel::Work& = {});

}  // namespace deflect::validity
