// Readings of a subject as drawn by lot within its tolerances, or of one that is worse than it is said to be.
#pragma once

#include <optional>

#include "tests/benchmark/cases.h"
#include "tests/benchmark/plan.h"

namespace deflect::benchmark {

/// The plan's readings of that subject; another one is drawn where the MSA finds no equilibrium for the first ones.
/// Nothing where it finds none for five. Heavy tails are a machine's.
std::optional<measurement::Measurements> as_measured(const Plan&, const subject::Subject&, std::optional<Stress>,
                                                     std::uint64_t seed);

}  // namespace deflect::benchmark
