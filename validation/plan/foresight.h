// What a campaign will be able to tell, before anything is measured, and a better one of the same length.
//
// The readings are filled in as the subject is predicted to read them. Signatures of all effects (signatures.h) then
// say how large each must be to be seen and what it looks like. The identification Jacobian is that of the subject's
// tolerances, which are the parameters that a calibration would fit.
//
// A better campaign is chosen among possible_readings() from nothing, for one of two aims:
//   effects    each effect as large as λ = 8 in the given campaign; −8 ln ⟨exp(−λ²_ij/8)⟩ over pairs, λ²_ij what is
//              left of i beside tolerances and j; without effects that remember the loads before them and without
//              pairs that no reading separates;
//   precision  the test-pose criterion (observability.h).
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
  MatrixX separations;  ///< λ² of what is left of one effect (row) beside tolerances and another (column), each as
                        ///< large as λ = 8 in the given campaign
};

/// Chance of taking the wrong one of two effects, one of which is there: Φ(−λ/2), λ² their separation.
double chance_of_confusion(double separation);

struct Foresight {
  std::string subject, campaign;
  std::array<bool, 6> read = {};  ///< components of the displacement
  Insight given, better;
  Toward toward = Toward::effects;
};

/// The effects must outlive the result. Throws as compare::compare() and possible_readings() do.
Foresight foresight(const subject::Subject&, const measurement::Measurements& plan, const std::vector<effects::Effect>&,
                    const ForesightOptions&, const parallel::Work& = {});

/// Readings of a plan as they are predicted, in the geometry in which equilibrium really is or in linear geometry.
measurement::Measurements filled_in(const subject::Subject&, measurement::Measurements plan, const ForesightOptions&,
                                    bool linear);

/// Sensitivity of the displacement of T (translations; of a frame: of its displacement sensors) in use to the
/// tolerances of these names, one column each: m.
MatrixX sensitivity_in_use(const subject::Subject&, const measurement::Measurements& use,
                           const std::vector<std::string>& names, const ForesightOptions&, const parallel::Work&);

}  // namespace deflect::plan
