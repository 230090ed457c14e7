// What a campaign will be able to tell, before anything is measured, and a better one of the same length.
//
// The readings are filled in as the subject is predicted to read them. Signatures of all effects (signatures.h) then
// say how large each must be to be seen and what it looks like. The identification Jacobian is that of the subject's
// tolerances, which are the parameters that a calibration would fit.
//
// A better campaign is what exchanges of single readings and of whole poses make of the given one among
// possible_campaign() and, where readings are few, of one that is chosen from nothing; for one of two aims:
//   effects    each effect as large as λ = 8 in the given campaign; −8 ln ⟨exp(−λ²_ij/8)⟩ over pairs, λ²_ij what is
//              left of i beside tolerances and j; without effects that remember the loads before them and without
//              pairs that no reading separates;
//   precision  the test-pose criterion (observability.h).
// It counts as better where it tells at least as many effects apart and takes the wrong one more seldom (Confusion),
// all effects counted, or errs less in use.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/diagnosis/detectable.h"
#include "validation/plan/choice.h"
#include "validation/plan/observability.h"
#include "validation/plan/prospect.h"

namespace deflect::plan {

enum class Toward { effects, precision };
inline constexpr const char* toward_names[] = {"effects", "precision"};

struct ForesightOptions {
  Limits limits;
  double sigma_u = 2e-6;                         ///< m: of a reading
  std::optional<double> sigma_th;                ///< rad; absent: rotations of a machine are not read
  std::optional<measurement::Measurements> use;  ///< poses and loads where the machine will be used; absent: twelve
                                                 ///< poses of its workspace, the largest force along x, y, z
  Toward toward = Toward::effects;
  std::size_t most_poses = 0;  ///< of the better campaign; 0: as many as the given one has
  std::uint64_t seed = 1;
};

/// What a campaign reads: components of the displacement at T, and sensors.
struct Channels {
  std::array<bool, 6> displacement = {};
  std::vector<measurement::SensorChannel> sensors;
};

/// Those that the plan has cells for (measurement::read_campaign()). Of a plan without any: the subject's sensors or,
/// where it has none, translations, and rotations if their σ is told. InputError where a rotation is read and nobody
/// tells its σ.
Channels channels_of(const subject::Subject&, const measurement::Measurements& plan, const ForesightOptions&);

/// What the first so many readings bring toward the aim.
struct Gain {
  std::size_t readings = 0;
  double value = 0;  ///< effects: bound on the mean chance of taking the wrong one of two, ½ ⟨exp(−λ²/8)⟩ (A.
                     ///< Bhattacharyya 1943); precision: error in use, m or rad
};

/// Of one campaign.
struct Insight {
  measurement::Measurements readings;             ///< the plan, not filled in
  std::vector<diagnosis::Detectable> detectable;  ///< one for each row of `cosines`
  std::vector<std::string> names;                 ///< of these
  MatrixX cosines;                                ///< between the signatures
  std::vector<diagnosis::LeftOut> left_out;
  Observability observability;
  std::size_t parameters = 0, numbers = 0;
  double error_before = 0, error_after = 0;  ///< m or rad: test-pose criterion by the tolerances, and once they are
                                             ///< fitted
  std::vector<Gain> gain;                    ///< readings in the order in which they bring most, of many in their own
  MatrixX separations;  ///< λ² of what is left of one effect (row) beside tolerances and another (column), each as
                        ///< large as λ = 8 in the given campaign
};

/// Chance of taking the wrong one of two effects, one of which is there: Φ(−λ/2), λ² their separation.
double chance_of_confusion(double separation);

/// How two different effects of the given campaign, each as large as λ = 8 there, are told apart by a campaign.
struct Confusion {
  std::size_t pairs = 0, told = 0;  ///< told: the wrong one is taken in less than one case of twenty
  double mean = 0;                  ///< chance of taking the wrong one, over the pairs and both as the true one
};
Confusion confusion(const Insight&, const Insight& given);

struct Foresight {
  std::string subject, campaign;
  std::array<bool, 6> read = {};  ///< components of the displacement
  Insight given, better;
  bool found = true;       ///< whether `better` is another campaign than the given one
  bool allowed = true;     ///< whether the given one keeps to the limits; else `better` does, whatever it tells
  bool tells_more = true;  ///< whether `better` counts as better
  Toward toward = Toward::effects;
};

/// The effects must outlive the result. Throws as compare::compare() and possible_readings() do.
Foresight foresight(const subject::Subject&, const measurement::Measurements& plan, const std::vector<effects::Effect>&,
                    const ForesightOptions&, const parallel::Work& = {});

/// Readings of these channels in a plan as they are predicted, in the geometry in which equilibrium really is or in
/// linear geometry. Without channels: channels_of() a plan that has none.
measurement::Measurements filled_in(const subject::Subject&, measurement::Measurements plan, const ForesightOptions&,
                                    bool linear, const std::optional<Channels>& = {});

/// Sensitivity of the displacement of T (translations; of a frame: of its displacement sensors) in use to the
/// tolerances of these names, one column each: m.
MatrixX sensitivity_in_use(const subject::Subject&, const measurement::Measurements& use,
                           const std::vector<std::string>& names, const ForesightOptions&, const parallel::Work&);

}  // namespace deflect::plan
