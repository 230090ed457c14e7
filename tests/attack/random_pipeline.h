// Measurements by the dice: a random machine, a random frame or a built-in one, a plan of poses and loads, effects
// hidden in it, and what a laboratory does to a file. They are run by pipeline_run.h.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "validation/subject/subject.h"

namespace deflect::attack {

enum class PipelineKind { machine, nonlinear_machine, frame, built_in };
inline constexpr const char* pipeline_kind_names[] = {"machine", "machine of nonlinear laws", "frame", "built-in"};

struct HiddenEffect {
  std::string name;
  std::optional<int> leg;
  std::string words;  ///< "joint_clearance,gap_mm=0.02", as `simulate --with` takes it
};

/// What is done to the simulated file before it is compared.
struct Spoilt {
  std::vector<std::size_t> channels;  ///< of displacement and sensors: left out altogether, one remains
  double blank = 0;                   ///< share of cells that are emptied
  bool no_sequence = false, no_sigma = false;
};

struct Pipeline {
  unsigned seed = 0;
  PipelineKind kind = PipelineKind::machine;
  subject::Subject subject;
  measurement::Measurements plan;
  std::vector<HiddenEffect> hidden;
  double noise_mm = 0, noise_rad = 0;  ///< σ of a reading; noise_rad 0: rotations are not measured
  double outliers = 0;
  Spoilt spoilt;
};

/// The same seed gives the same pipeline. Machines and frames that cannot stand under their loads are drawn again, up
/// to a limit: nullopt beyond it.
std::optional<Pipeline> random_pipeline(unsigned seed);

/// The measurements as spoilt: the same seed empties the same cells.
measurement::Measurements spoilt(measurement::Measurements, const Spoilt&, unsigned seed);

}  // namespace deflect::attack
