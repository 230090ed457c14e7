// Which usual mistake (mistakes.h) turns a right stiffness into the given one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validation/matrix/matrix_checks.h"

namespace deflect::matrix {

struct MatrixDiagnosis {
  std::string id;        ///< "metres"; "negated+metres" where two were made
  std::string sentence;  ///< "it" is the matrix
  std::string remedy;
};

/// Mistakes of which one, undone, leaves a matrix that is sound by itself: more than one where K cannot tell them
/// apart, in the order of the table, or where size alone decides the most plausible first. Empty where none does.
std::vector<MatrixDiagnosis> explain(const PrintedMatrix& K, double unit_m, const PlausibleSize&);

struct Explanation {
  std::vector<MatrixDiagnosis> diagnosis;  ///< each explains the whole difference, to the digits printed
  std::optional<MatrixDiagnosis> nearest;  ///< where none does: what leaves least
  double difference = 0, remaining = 0;    ///< |K − R| and what `nearest` leaves, of the largest entry of R, weighed
};

/// Mistakes, or pairs of them where no single one does, that make K of the reference R.
Explanation explain(const PrintedMatrix& K, const PrintedMatrix& R, double unit_m);

/// |K − R| by entry as part of the largest of R, rotations weighed: the entry that exceeds its digits most.
Check equals_reference(const PrintedMatrix& K, const PrintedMatrix& R);

}  // namespace deflect::matrix
