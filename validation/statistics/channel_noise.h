// Noise of a reading where nobody tells it: one σ for each channel, by what no pattern explains.
//
// The residual of a channel c is r_c = G_c a + A_c η + ε_c: patterns G of any size, tolerances η ~ N(0, 1) common to
// all poses, and noise of standard deviation σ_c. What is told of σ stays. The others are components of variance: with
// least squares of weights 1/σ²,
//   σ_c² = v_cᵀ v_c / ν_c,   v = r − G a − A η,   ν_c = Σ_{i∈c} (1 − h_i),
// h the leverages of the numbers; repeated until σ stays (W. Förstner, Ein Verfahren zur Schätzung von Varianz- und
// Kovarianzkomponenten, Allgemeine Vermessungs-Nachrichten 86 (1979) 446–453). So no unit counts more than another, and
// a channel that is known well is not blamed for one that is not. What errors of the recorded loads share of the
// scatter is taken off (noise_beside_loads). What few freedoms tell of σ is uncertain: the result is the mean of σ²
// given them, ν s²/(ν − 2), s the estimate (Jeffreys' prior; A. Gelman et al., Bayesian Data Analysis, 3rd ed.,
// ch. 3.2).
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "validation/measurement/replicates.h"
#include "validation/statistics/parted_columns.h"

namespace deflect::statistics {

/// Of a quantity the largest number that predictions are made of: their rounding is a share of it.
using LargestNumbers = std::map<measurement::Quantity, double>;

/// σ by measured number, SI. Of T's components those of one quantity are one channel; each sensor is one. Where a
/// channel has less than three freedoms ν, all channels of its quantity share one σ. `told`: by measured number. A: of
/// tolerances, of which those of single poses count as noise. σ is no less than 1e-12 in SI, and 1e-12 of the largest
/// number: of the readings, or as given. of_loads: l² by measured number (load_errors.h). Empty where fewer than three
/// freedoms are left for a quantity, or ten for all.
std::optional<std::vector<double>> channel_noise(const std::vector<measurement::MeasuredValue>&,
                                                 const std::vector<std::optional<double>>& told,
                                                 const VectorX& residual, const MatrixX& patterns,
                                                 const PartedColumns& A, const VectorX& of_loads,
                                                 LargestNumbers largest = {});

}  // namespace deflect::statistics
