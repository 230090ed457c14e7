// The basis of a comparison: the subject at its poses, predictions, forces at sites.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "validation/measurement/replicates.h"
#include "validation/statistics/load_errors.h"
#include "validation/subject/subject.h"

namespace deflect::compare {

/// Everything that patterns of the residual are made of. SI, base axes; by reading unless stated otherwise.
struct ResidualStudy {
  std::optional<subject::Subject> subject;
  const measurement::Measurements* data = nullptr;
  std::shared_ptr<const subject::Standing> standing;  ///< the subject at the poses, as drawn
  std::vector<measurement::MeasuredValue> values;     ///< the measured numbers
  MatrixX loads;                                      ///< by load channel and reading (loads_of)
  std::vector<VectorX> predicted;                     ///< of all channels (Standing::predict)
  statistics::LoadErrors load_errors;                 ///< of `predicted`; in a comparison with those of play that count
  prediction::Floating floating;                      ///< with `predicted`
  std::vector<MatrixX> open_play;                     ///< what that may do to readings (open_play.h)
  std::vector<VectorX> deformed_shape;                ///< finite − linear geometry; empty: in `predicted`, or unknown
  std::vector<std::vector<subject::Site>> sites;      ///< by pose
  subject::InnerSites inner;                          ///< of a subject without tool point
  std::vector<Matrix6> compliance;                    ///< by pose: Standing::compliance()
  std::vector<VectorX> force;                         ///< of each site, N or Nm
  std::vector<VectorX> heading;  ///< of each site: sign of the last change of its force; 0 before the first
  bool sequence = false;         ///< whether the order of the readings is known
};

/// Computes everything except `deformed_shape`. The data must outlive the study.
ResidualStudy residual_study(const subject::Subject&, const measurement::Measurements&, const parallel::Work& = {});

/// ResidualStudy::deformed_shape, for a subject in linear geometry that is really in another (true_geometry). This
/// takes most of the time of a study.
std::vector<VectorX> deformed_shape_of(const ResidualStudy&, const parallel::Work& = {});

/// Estimates deformed_shape of a reading under another load: it is even in the load and scales with its square. Zero
/// where it is not known.
VectorX deformed_shape_under(const ResidualStudy&, std::size_t reading, const Vector6& load);

}  // namespace deflect::compare
