// One pose of the 6-PSU haptic device by each theory: what a sweep repeats, on one core. Poses lie in the cube in which
// the device is validated, no two calls in a row at the same one.
#include <benchmark/benchmark.h>

#include "analytic/model.h"
#include "analytic/pose_sweep.h"
#include "msa/frame/mechanism/msa.h"
#include "msa/frame/mechanism/msa_sweep.h"
#include "tests/support/devices.h"

namespace {

using namespace deflect;

struct Case {
  explicit Case(const char* name) : mechanism(test::device(name)), poses(test::random_poses(mechanism, 64)) {}

  const Pose& next() { return poses[++count % poses.size()]; }

  Mechanism mechanism;
  std::vector<Pose> poses;
  std::size_t count = 0;
  Vector6 F = 50 * Vector6::Unit(0);
};

void configure_anew(benchmark::State& state, const char* name) {
  Case c(name);
  for (auto _ : state) benchmark::DoNotOptimize(configure(c.mechanism, c.next()));
}
BENCHMARK_CAPTURE(configure_anew, haptic_6psu, "haptic-6psu");

void configure_moved(benchmark::State& state, const char* name) {
  Case c(name);
  Posing posing(c.mechanism);
  for (auto _ : state) benchmark::DoNotOptimize(&posing.at(c.next()));
}
BENCHMARK_CAPTURE(configure_moved, haptic_6psu, "haptic-6psu");

void analytic_model(benchmark::State& state, const char* name) {
  Case c(name);
  for (auto _ : state) {
    const analytic::AnalyticModel model(configure(c.mechanism, c.next()));
    benchmark::DoNotOptimize(model.stiffness(model.solve(c.F)));
  }
}
BENCHMARK_CAPTURE(analytic_model, haptic_6psu, "haptic-6psu");

/// From pose to pose, at each under forces along x, y, z, as many as asked for.
void analytic_sweep(benchmark::State& state, const char* name, int loads) {
  Case c(name);
  Posing posing(c.mechanism);
  analytic::PoseSweep sweep(posing.at(c.next()));
  for (auto _ : state) {
    sweep.at(posing.at(c.next()));
    for (int i = 0; i < loads; ++i) {
      if (!sweep.solve(50 * Vector6::Unit(i))) state.SkipWithError("no solution");
      benchmark::DoNotOptimize(sweep.stiffness());
    }
  }
}
BENCHMARK_CAPTURE(analytic_sweep, haptic_6psu, "haptic-6psu", 1);
BENCHMARK_CAPTURE(analytic_sweep, ideal_joints, "haptic-6psu-ideal-joints", 1);
BENCHMARK_CAPTURE(analytic_sweep, haptic_6psu_three_loads, "haptic-6psu", 3);
BENCHMARK_CAPTURE(analytic_sweep, ideal_joints_three_loads, "haptic-6psu-ideal-joints", 3);

/// With the derivatives to the stiffness of every part of every leg: 24.
void analytic_sweep_with_derivatives(benchmark::State& state, const char* name) {
  Case c(name);
  Posing posing(c.mechanism);
  analytic::PoseSweep sweep(posing.at(c.next()));
  for (auto _ : state) {
    sweep.at(posing.at(c.next()));
    if (!sweep.solve(c.F)) state.SkipWithError("no solution");
    benchmark::DoNotOptimize(sweep.derivatives().data());
  }
  state.counters["parts"] = static_cast<double>(sweep.parts().size());
}
BENCHMARK_CAPTURE(analytic_sweep_with_derivatives, haptic_6psu, "haptic-6psu");

/// Displacement and stiffness by the frame solver, members divided in equal elements.
void msa_model(benchmark::State& state, const char* name) {
  Case c(name);
  const auto elements = static_cast<int>(state.range(0));
  for (auto _ : state) {
    const Configuration at = configure(c.mechanism, c.next());
    frame::MsaModel model(at, frame::equal_division(at, elements));
    benchmark::DoNotOptimize(model.stiffness(model.solve(c.F).state));
  }
}
BENCHMARK_CAPTURE(msa_model, haptic_6psu, "haptic-6psu")->Arg(1)->Arg(4);
BENCHMARK_CAPTURE(msa_model, ideal_joints, "haptic-6psu-ideal-joints")->Arg(1)->Arg(4);

/// The same from pose to pose, legs condensed, under as many forces as asked for.
void msa_sweep(benchmark::State& state, const char* name, int loads) {
  Case c(name);
  Posing posing(c.mechanism);
  const Configuration& first = posing.at(c.next());
  frame::MsaSweep sweep(first, frame::equal_division(first, static_cast<int>(state.range(0))));
  for (auto _ : state) {
    sweep.at(posing.at(c.next()));
    for (int i = 0; i < loads; ++i) {
      if (!sweep.solve(50 * Vector6::Unit(i))) state.SkipWithError("no solution");
      benchmark::DoNotOptimize(sweep.stiffness());
    }
  }
}
BENCHMARK_CAPTURE(msa_sweep, haptic_6psu, "haptic-6psu", 1)->Arg(1)->Arg(4);
BENCHMARK_CAPTURE(msa_sweep, ideal_joints, "haptic-6psu-ideal-joints", 1)->Arg(1)->Arg(4);
BENCHMARK_CAPTURE(msa_sweep, haptic_6psu_three_loads, "haptic-6psu", 3)->Arg(1)->Arg(4);
BENCHMARK_CAPTURE(msa_sweep, ideal_joints_three_loads, "haptic-6psu-ideal-joints", 3)->Arg(1)->Arg(4);

}  // namespace

BENCHMARK_MAIN();
