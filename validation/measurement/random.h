// Random numbers that are the same on every machine: the sequence is fixed by the seed, whatever the library.
#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cstdint>

#include "msa/base/spatial.h"

namespace deflect::measurement {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  double normal() { return boost::random::normal_distribution<double>()(engine_); }
  double uniform(double low, double high) {
    return boost::random::uniform_real_distribution<double>(low, high)(engine_);
  }
  /// Student's t with three degrees of freedom, scaled to a standard deviation of 1.
  double heavy_tailed() {
    const double z = normal();
    return z / normal3().norm();
  }
  Vector3 normal3() {
    const double x = normal(), y = normal(), z = normal();  // in this order
    return {x, y, z};
  }
  Vector3 uniform3(double low, double high) {
    const double x = uniform(low, high), y = uniform(low, high), z = uniform(low, high);
    return {x, y, z};
  }

 private:
  boost::random::mt19937_64 engine_;
};

}  // namespace deflect::measurement
