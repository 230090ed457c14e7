// Observability indices of an identification Jacobian, as robot calibration uses them to choose poses.
//
// J: measured numbers × parameters, rows divided by σ of the number (and free of the errors of their pose), columns per
// standard deviation of the parameter; m numbers, singular values σ₁ ≥ … ≥ σ_L ≥ 0. Larger is better.
//   O1 = (σ₁ ⋯ σ_L)^(1/L) / √m       J.-H. Borm, C.-H. Menq, Int. J. Robotics Research 1991 (m there: poses)
//   O2 = σ_L / σ₁                    M. R. Driels, U. S. Pathre, J. Robotic Systems 1990 (there its reciprocal)
//   O3 = σ_L                         A. Nahvi, J. M. Hollerbach, V. Hayward, ICRA 1994
//   O4 = σ_L² / σ₁                   A. Nahvi, J. M. Hollerbach, ICRA 1996: the noise amplification index
//   O5 = 1 / (1/σ₁ + … + 1/σ_L)      Y. Sun, J. M. Hollerbach, ICRA 2008, Observability Index Selection for Robot
//                                    Calibration; not checked against the paper, which was not at hand
// D-gain = ½ ln |1 + JᵀJ|: what the readings tell of the parameters, in nats (D. V. Lindley 1956, Bayesian
// D-optimality).
// The test-pose criterion (A. Klimchik, A. Pashkevich, Y. Wu, S. Caro, B. Furet 2012; I-optimality): root mean square,
// over readings V at the user's own poses, of the error of their prediction by the fitted parameters,
//   √(tr V (1 + JᵀJ)⁻¹ Vᵀ / rows of V).
#pragma once

#include <array>

#include "msa/base/spatial.h"

namespace deflect::plan {

struct Observability {
  std::array<double, 5> O = {};  ///< O1 … O5
  double D_gain = 0;
};

/// `information`: JᵀJ; m: numbers.
Observability observability(const MatrixX& information, double m);

/// Root mean square of V's rows under the covariance of the parameters; unit of V.
double test_pose_error(const MatrixX& covariance, const MatrixX& V);

}  // namespace deflect::plan
