// A serial arm by the dice: six driven joints about z, y, y, z, y or x, z from the base, tubes of steel or aluminium
// between them, and bearings that yield at one joint in three. 0.6 to 2 m long. Its modulus, tubes, drives and loads
// have tolerances.
#pragma once

#include <cstdint>

#include "msa/mechanism/description.h"

namespace deflect::benchmark {

/// The same seed gives the same arm. Its workspace, a cube of 150 mm about its home pose, is within reach: arms that do
/// not reach a corner are drawn again.
Mechanism random_arm(std::uint64_t seed);

}  // namespace deflect::benchmark
