// The checks of one 6×6 stiffness, with bounds that follow from how its numbers are known.
//
// Rotations are weighed by ℓ (elastic_structure.h), so no verdict depends on units. A number counts as known to half
// its last digit printed, or to 5e-10 of the largest entry where more is printed than programs compute. Bounds are the
// most that these can do: u_ij + u_ji to K − Kᵀ, |v|ᵀ u |v| to the eigenvalue of v, |u| |J| + |K| u_J to K J.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "validation/matrix/matrix_file.h"

namespace deflect::matrix {

inline constexpr std::array<const char*, 6> wrench_axes = {"fx", "fy", "fz", "mx", "my", "mz"},
                                            displacement_axes = {"ux", "uy", "uz", "thx", "thy", "thz"};

struct Check {
  std::string id;                  ///< "symmetric"
  std::string quantity;            ///< "|K − Kᵀ| / |K|"
  std::optional<double> measured;  ///< none where other failures leave nothing to judge
  double at_least = -std::numeric_limits<double>::infinity(), at_most = std::numeric_limits<double>::infinity();

  bool passes() const { return !measured || (*measured >= at_least && *measured <= at_most); }
};

/// What is plausible for a device: its characteristic length, m. Translational stiffnesses are taken as plausible from
/// 1 N/m to 1e12 N/m.
struct PlausibleSize {
  double smallest_m = 1e-3, largest_m = 30;
};

struct JudgedMatrix {
  Check symmetric, positive, holds, length, stiffness;
  std::vector<Check> passive;        ///< K J = 0, twist by twist
  Eigen::Index row = 0, column = 1;  ///< of the upper entry that differs most from the one across the diagonal
  int asymmetric_pairs = 0;
  Vector6 eigenvalues = Vector6::Zero();  ///< of the weighed symmetric part, rising, N per unit of length
  std::vector<Vector6> free;              ///< twists [δ; θ] that nothing resists, passive joints apart
  Vector6 softest = Vector6::Zero();      ///< twist of the smallest eigenvalue

  /// As a stiffness of some device: all but free directions and passive joints.
  bool sound() const { return symmetric.passes() && positive.passes() && length.passes() && stiffness.passes(); }
};

/// The digits, but none better than 5e-10 of the largest entry; all alike where a relative `tolerance` is given.
PrintedMatrix with_tolerance(PrintedMatrix K, const std::optional<double>& tolerance);

JudgedMatrix judge(const PrintedMatrix& K, const PrintedMatrix* passive_twists, double unit_m, const PlausibleSize&);

}  // namespace deflect::matrix
