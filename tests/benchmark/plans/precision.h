// How well the tool point is known at new poses once the tolerances are fitted: campaigns of the same length, chosen
// for the test-pose criterion, for effects, for D-optimality and for each observability index.
#pragma once

#include <optional>
#include <string>

namespace deflect::benchmark {

/// A row for each choice, of as many readings at no more poses than the paper's plan of the device has. In the indices
/// the priors of tolerances count as further rows of the Jacobian, without which few readings leave it singular.
/// `force`, `moment`: largest, N and Nm; no moment: the force times an arm of a tenth of the machine's size.
std::string precision_table(const std::string& device, double force, std::optional<double> moment, int threads);

}  // namespace deflect::benchmark
