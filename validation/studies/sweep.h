// A device from pose to pose, by several theories, which condense it once for all poses; and many poses at once, as
// rows of the caller's arrays.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "msa/mechanism/configuration.h"
#include "validation/parallel/work.h"
#include "validation/theories/theory.h"

namespace deflect::studies {

/// The device must outlive it. Of one thread.
class Sweep {
 public:
  Sweep(const Mechanism& m, const theories::Theories& asked) : device_(&m), asked_(asked), posing_(m) {}

  /// The configuration at the pose (mm, deg), valid until the next call. Throws ModelError where the kinematics refuse
  /// the pose.
  const Configuration& at(const Vector6& pose_mm_deg);

  /// At that pose, by the theory of this index, with its checks: throws as TheoryAt::answer() does, and ModelError
  /// where the device cannot stand.
  theories::Answer answer(std::size_t theory, const Vector6& F_T_W);

 private:
  const Mechanism* device_;
  theories::Theories asked_;
  Posing posing_;
  const Configuration* here_ = nullptr;
  bool moved_ = false;  ///< the theories to `here_`
  std::vector<std::unique_ptr<theories::TheoryAt>> at_;
};

struct ManyPoses {
  std::span<const double> poses_mm_deg;  ///< n × 6: x y z (mm), roll pitch yaw (deg)
  std::span<const double> loads_N_Nmm;   ///< n × 6, or 6 for all poses: on T about T, base axes
  bool keep_unreachable = false;         ///< a pose that the kinematics refuse has NaN and does not end the work
};

/// Where one theory's answers go. An empty span is not wanted.
struct ManyAnswers {
  std::span<double> displacement_mm_rad;  ///< n × 6: ux uy uz (mm), thx thy thz (rad)
  std::span<double> stiffness_mm;         ///< n × 6 × 6, row by row, tangent under the load: N/mm, N, Nmm
};

/// In linear geometry, with the checks of answer.h at each pose by each theory, and their agreement; `out` by theory.
/// The result has the same bits for any number of threads; where contacts are solved, the last digits of a row can
/// depend on the rows before it. Throws ModelError "pose 17: …" for the first row that is out of reach, InputError for
/// rows of another number and for numbers that are not finite, NumericalError as solve() does.
void solve_many(const Mechanism&, const ManyPoses&, const theories::Theories&, std::span<const ManyAnswers> out,
                const parallel::Work& = {});

}  // namespace deflect::studies
