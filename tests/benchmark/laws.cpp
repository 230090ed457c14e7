#include "tests/benchmark/laws.h"

#include <cmath>

namespace deflect::benchmark {
namespace {

using namespace compare;
using namespace measurement;
using namespace subject;

constexpr double um = 1e-6;

/// Σ g e over the legs, translations.
template <class E>
Vector3 by_legs(const std::vector<Site>& legs, const E& elongation) {
  Vector3 out = Vector3::Zero();
  for (std::size_t k = 0; k < legs.size(); ++k) out += legs[k].g.head<3>() * elongation(k);
  return out;
}

/// The lead of the drives' screws, 17 mm, is in the stiffness.
Vector3 screw(const std::vector<Site>& legs, const VectorX& f, const Vector6&, double) {
  return by_legs(legs, [&](std::size_t k) {
    return um * f(static_cast<Eigen::Index>(k)) * std::sin(2 * pi * legs[k].extension / 0.017);
  });
}

/// Every second leg is soft where its guideway is long.
Vector3 second_legs(const std::vector<Site>& legs, const VectorX& f, const Vector6&, double) {
  double mean = 0;
  for (const Site& leg : legs) mean += leg.extension / static_cast<double>(legs.size());
  return by_legs(legs, [&](std::size_t k) {
    return k % 2 == 0 ? um * f(static_cast<Eigen::Index>(k)) * std::pow(legs[k].extension / mean, 2) : 0;
  });
}

/// A force along x opens a gap along y, which closes at some 10 N.
Vector3 sideways(const std::vector<Site>&, const VectorX&, const Vector6& F, double) {
  return {0, um * std::tanh(F(0) / 10), 0};
}

/// The machine stands on a wavy rail along x.
Vector3 ripple(const std::vector<Site>&, const VectorX&, const Vector6& F, double x) {
  return {0, 0, um * std::sin(2 * pi * x / 0.013) * (F(2) / force + 0.5 * F(1) / force)};
}

}  // namespace

const std::vector<Law>& laws() {
  static const std::vector<Law> all = {{"screw lead in the stiffness", screw},
                                       {"every second leg, grows with length squared", second_legs},
                                       {"load along x opens a gap along y", sideways},
                                       {"ripple of the stiffness along x", ripple}};
  return all;
}

std::vector<Vector6> added_by(const Law& law, const Plan& plan) {
  const ResidualStudy& study = plan.observations->comparison().study;
  std::vector<Vector6> out(plan.readings.readings.size(), Vector6::Zero());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Reading& r = plan.readings.readings[i];
    const double x = plan.readings.poses[r.pose].pose_mm_deg(0) / 1e3;
    out[i].head<3>() = law.displacement(study.sites[r.pose], study.force[i], r.load, x);
  }
  return out;
}

}  // namespace deflect::benchmark
