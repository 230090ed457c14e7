// A plan of measurements with what is known before anything is measured: how every effect would change its numbers.
//
// Measured numbers are the translations of all readings, reading by reading (m); of a frame what its sensors read (SI).
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "validation/diagnosis/observations.h"
#include "validation/diagnosis/signatures.h"
#include "validation/prediction/simulate.h"

namespace deflect::benchmark {

inline constexpr double sigma_u = 2e-6;  // m: of a reading
inline constexpr double force = 50;      // N: largest of a plan

/// An effect at a place: what it adds to the numbers at the start of its parameters, parameter by parameter where each
/// can vanish alone.
struct Change {
  effects::PlacedEffect effect;
  MatrixX measured, elsewhere;  ///< of the plan's numbers; at the new poses
};

struct PlanOptions {
  double sigma = sigma_u;  ///< m: of a machine's reading
  /// A record of a machine whose poses, loads, σ and filled cells are the plan, in place of a campaign; there are no
  /// new poses then.
  const measurement::Measurements* record = nullptr;
  bool temperature = false;  ///< is recorded
  bool changes = true;       ///< `changes` is wanted: for the other methods
};

/// Must stand where it was made: its parts point at each other.
struct Plan {
  Plan(const subject::Subject&, const std::vector<effects::Effect>&, const std::string& campaign, std::uint64_t seed,
       const PlanOptions& = {});
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  prediction::SimulationOptions simulation;               ///< of a machine within tolerances, read with noise
  measurement::Measurements readings;                     ///< poses and loads
  measurement::Measurements healthy;                      ///< nothing hidden, seed of its own
  std::unique_ptr<diagnosis::Observations> observations;  ///< of `healthy`
  std::unique_ptr<const diagnosis::SignaturesAtPlaces> at_places;
  std::vector<diagnosis::Signature> signatures;  ///< of these
  std::vector<Change> changes;
  measurement::Measurements elsewhere;  ///< of a machine: twenty poses that are not in the plan, three loads each
  VectorX nominal_elsewhere;            ///< m: prediction there with nothing added
  VectorX nominal;                      ///< m: the same of the plan's numbers

  /// Measured − predicted with nothing added, m.
  VectorX residual(const measurement::Measurements&) const;
  /// Σ^(−1/2) times what an effect changes in the plan's numbers.
  VectorX whitened_change(const effects::EffectInstance&) const;
  /// The same, and all signatures, without the readings whose load leaves play of the subject with the effect open:
  /// small forces decide where in it the subject stands, so that these readings tell no law from another.
  struct Told {
    std::vector<diagnosis::Signature> signatures;
    VectorX change;
  };
  Told told(const effects::EffectInstance&) const;
};

/// The plan's readings as taken from a subject; of a machine by the MSA in the deformed shape, of a frame by the MSA in
/// the geometry that it names. Of a record that is the plan the same cells are filled.
measurement::Measurements simulated(const subject::Subject&, const measurement::Measurements& plan,
                                    const prediction::SimulationOptions&);

/// Translations of a device at the plan's new poses in the deformed shape, m. NumericalError where there is none.
VectorX predict_elsewhere(const Plan&, const Mechanism&, const theories::Theory&);

/// Plans of all campaigns, made when first asked for; from any thread.
class Plans {
 public:
  Plans(const Mechanism&, const std::vector<effects::Effect>&, std::uint64_t seed);

  static constexpr int variants = 4;  ///< of one campaign: other poses, and temperatures recorded in those that are odd
  const Plan& at(const std::string& campaign, int variant);

 private:
  struct Slot {
    std::once_flag once;
    std::unique_ptr<Plan> plan;
  };
  const Mechanism& device_;
  const std::vector<effects::Effect>& effects_;
  std::uint64_t seed_;
  std::vector<Slot> slots_;
};

}  // namespace deflect::benchmark
