// Both theories at the same poses under the same loads.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analytic/erratum.h"
#include "msa/base/geometry.h"
#include "msa/frame/mechanism/build.h"
#include "msa/mechanism/stand.h"

namespace deflect {

/// A pose to be validated: a label for tables ("0" … "8"), x y z roll pitch yaw in mm and deg as written to results.
struct ValidationPoint {
  std::string label;
  Vector6 pose_mm_deg = Vector6::Zero();
};

/// One pose, one load along one axis. Displacements of T in base axes: mm and rad.
struct ValidationRow {
  ValidationPoint point;
  int axis = 0;  ///< 0, 1, 2: force along x, y, z
  double load_N = 0;
  Vector6 analytic, msa;              ///< corrected analytic theory; MSA
  std::optional<Vector6> as_printed;  ///< analytic with the errata asked for, where any were
  double relative_difference = 0;     ///< of analytic and MSA, see relative_difference()
};

struct Validation {
  std::string device;
  std::set<Erratum> as_printed;
  std::vector<ValidationRow> rows;  ///< point by point, x y z each
  double max_relative_difference = 0, rms_relative_difference = 0;
};

/// The larger of |δa − δb| / |δb| and |θa − θb| / |θb| for displacements in mm and rad, Euclidean norms of translation
/// and rotation. Where symmetry makes one of the two vanish its rounding is measured by the other: a rotation against
/// at least |δb| / 1 m, a translation against at least |θb| · 1 mm.
double relative_difference(const Vector6& a, const Vector6& b);

struct SolveResult;

/// Both theories at one pose under one wrench (N, Nmm at T, base axes). Throws NumericalError naming the check where
/// one of the checks fails, or where a theory does not converge. In the deformed shape the MSA has at least eight
/// elements in each member.
SolveResult solve(const Mechanism&, const Stand&, const Vector6& load_N_Nmm, const frame::MemberDivision&,
                  Geometry = Geometry::linear);

/// `load_N` along x, y and z at every point by both theories, checks at every point and load as in solve(). The theory
/// as printed is added where errata are asked for; its checks are not enforced.
Validation validate(const Mechanism&, const std::vector<ValidationPoint>&, double load_N, const std::set<Erratum>&,
                    const frame::MemberDivision&);

/// The price of one erratum: deflection along the load as printed / corrected at the points, smallest and largest ratio
/// for loads along x, y, z. `refused` says why there is no number where the variant has no solution somewhere.
struct ErratumPrice {
  Erratum erratum;
  Vector3 smallest, largest;
  std::string failed_check;  ///< of the stiffness as printed, at the first point where one fails; may be empty
  std::string refused;
};
std::vector<ErratumPrice> price_errata(const Mechanism&, const std::vector<ValidationPoint>&, double load_N);

}  // namespace deflect
