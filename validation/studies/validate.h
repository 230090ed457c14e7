// The theories at the same poses under the same loads.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "analytic/erratum.h"
#include "msa/mechanism/stand.h"
#include "validation/studies/workspace.h"
#include "validation/theories/theory.h"

namespace deflect::studies {

/// One pose, one load along one axis. Displacements of T in base axes: mm and rad.
struct ValidationRow {
  ValidationPoint point;
  int axis = 0;  ///< 0, 1, 2: force along x, y, z
  double load_N = 0;
  std::vector<Vector6> displacements;  ///< by theory
  std::optional<Vector6> as_printed;   ///< analytic with the errata asked for, where any were
  double relative_difference = 0;      ///< the largest of any two theories, see relative_difference()
};

struct Validation {
  std::string device;
  theories::Theories theories;
  std::set<Erratum> as_printed;
  std::vector<ValidationRow> rows;  ///< point by point, x y z each
  double max_relative_difference = 0, rms_relative_difference = 0;
};

/// `load_N` along x, y and z at every point by each theory, checks at every point and load as in solve(). The theory
/// as printed is added where errata are asked for; its checks are not enforced.
Validation validate(const Mechanism&, const std::vector<ValidationPoint>&, double load_N, const std::set<Erratum>&,
                    const frame::MemberDivision&, const theories::Theories& = theories::all_theories());

}  // namespace deflect::studies
