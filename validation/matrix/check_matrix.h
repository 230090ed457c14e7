// The trust checks of a stiffness that came from elsewhere, and which usual mistake explains it when they fail.
//
// What K alone can tell: one-sided mistakes leave it asymmetric, a reversed sign or blocks in different units leave it
// without K ⪰ 0, and a wrong unit of length, a wrong order or an inverse leave a device of an absurd size. What leaves
// K a possible stiffness of another device is seen only beside a reference: another point, other axes, a factor, rules
// of a compliance on both sides, locked joints where their twists are not given.
#pragma once

#include "validation/matrix/elastic_structure.h"
#include "validation/matrix/explain_matrix.h"

namespace deflect::matrix {

/// Matrices are translation first, in N, rad and the unit of length, at one point and in one set of axes.
struct MatrixCheckOptions {
  PrintedMatrix K;
  double unit_m = 1e-3;
  std::optional<PrintedMatrix> passive_twists;  ///< 6×m: K J = 0 is wanted, and no other free direction
  std::optional<PrintedMatrix> reference;
  std::optional<double> tolerance;  ///< relative, instead of the digits printed
  PlausibleSize plausible;
};

struct MatrixCheck {
  Matrix6 K_mm = Matrix6::Zero();  ///< as it was read: N/mm, N, Nmm, rad
  std::vector<Check> checks;
  std::vector<MatrixDiagnosis> explanations;  ///< usual mistakes: one of them was made; several where K cannot tell
  bool guessed = false;                       ///< explanations rest on nothing but what size a device may have
  std::vector<MatrixDiagnosis> findings;      ///< what is wrong whatever the cause; each is true
  double max_asymmetry = 0;                   ///< largest |K − Kᵀ| as part of the largest entry, rotations weighed
  double weighing_length_mm = 0;
  Vector6 eigenvalues_N_mm = Vector6::Zero();  ///< of the symmetric part, rotations weighed, rising
  std::optional<ElasticStructure> structure;   ///< N, mm, rad; of a matrix that is symmetric and positive
  std::optional<Eigen::Vector2d> ratio;        ///< smallest and largest stiffness along a motion, K by the reference

  bool passes() const;
};

/// Throws InputError where the reference is not symmetric and positive itself.
MatrixCheck check_matrix(const MatrixCheckOptions&);

}  // namespace deflect::matrix
