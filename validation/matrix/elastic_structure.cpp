#include "validation/matrix/elastic_structure.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace deflect::matrix {
namespace {

Vector3 vee_of_difference(const Matrix3& M) { return {M(2, 1) - M(1, 2), M(0, 2) - M(2, 0), M(1, 0) - M(0, 1)}; }

/// Shortest r with (tr S · I − S) r = b.
Vector3 lever(const Matrix3& S, const Vector3& b) {
  const Matrix3 M = S.trace() * Matrix3::Identity() - S;
  return Eigen::CompleteOrthogonalDecomposition<Matrix3>(M).solve(b);
}

}  // namespace

ElasticStructure elastic_structure(const Matrix6& K) {
  ElasticStructure e;
  const Matrix3 A = K.topLeftCorner<3, 3>(), B = K.topRightCorner<3, 3>();
  const Eigen::SelfAdjointEigenSolver<Matrix3> translations(A);
  e.translational = translations.eigenvalues();
  e.axes = translations.eigenvectors();
  for (int j = 0; j < 3; ++j) {  // the largest component positive, so that the same K has the same axes
    Eigen::Index most = 0;
    e.axes.col(j).cwiseAbs().maxCoeff(&most);
    if (e.axes(most, j) < 0) e.axes.col(j) *= -1;
  }
  e.centre_of_stiffness = lever(A, -vee_of_difference(B));
  const Matrix6 X = shift_twist(-e.centre_of_stiffness);
  const Matrix3 D = (X.transpose() * K * X).bottomRightCorner<3, 3>();
  e.rotational = Eigen::SelfAdjointEigenSolver<Matrix3>(D, Eigen::EigenvaluesOnly).eigenvalues();
  if (A.trace() != 0 && D.trace() / A.trace() > 0) e.length = std::sqrt(D.trace() / A.trace());
  const double length = weighing_length(K);
  const Eigen::FullPivLU<Matrix6> lu(weighed(K, length));
  if (lu.isInvertible()) {
    const Matrix6 C = weighed(lu.inverse(), length);
    e.centre_of_compliance = lever(C.bottomRightCorner<3, 3>(), vee_of_difference(C.topRightCorner<3, 3>()));
  }
  return e;
}

double weighing_length(const Matrix6& K) {
  const double translation = K.topLeftCorner<3, 3>().diagonal().cwiseAbs().sum();
  const double rotation = K.bottomRightCorner<3, 3>().diagonal().cwiseAbs().sum();
  return translation > 0 && rotation > 0 ? std::sqrt(rotation / translation) : 1;
}

Matrix6 weighed(const Matrix6& K, double length) {
  Matrix6 w = K;
  w.topRightCorner<3, 3>() /= length;
  w.bottomLeftCorner<3, 3>() /= length;
  w.bottomRightCorner<3, 3>() /= length * length;
  return w;
}

}  // namespace deflect::matrix
