// Eigen with its decompositions compiled only once, in decompositions.cpp; they took a third of the compile time. Pass
// a matrix of one of these sizes and not an expression, which would be instantiated at the point of use:
// SelfAdjointEigenSolver<Matrix6>(Matrix6(A + A.transpose())).
#pragma once

#include <Eigen/Dense>

#ifndef DEFLECT_COMPILED
#define DEFLECT_COMPILED extern
#endif

namespace Eigen {

using Matrix6d = Matrix<double, 6, 6>;

DEFLECT_COMPILED template SelfAdjointEigenSolver<MatrixXd>& SelfAdjointEigenSolver<MatrixXd>::compute(
    const EigenBase<MatrixXd>&, int);
DEFLECT_COMPILED template SelfAdjointEigenSolver<Matrix6d>& SelfAdjointEigenSolver<Matrix6d>::compute(
    const EigenBase<Matrix6d>&, int);
DEFLECT_COMPILED template SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(
    const EigenBase<Matrix3d>&, int);
DEFLECT_COMPILED template LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
DEFLECT_COMPILED template LLT<Matrix6d>& LLT<Matrix6d>::compute(const EigenBase<Matrix6d>&);
DEFLECT_COMPILED template void PartialPivLU<MatrixXd>::compute();
DEFLECT_COMPILED template void PartialPivLU<Matrix6d>::compute();
DEFLECT_COMPILED template void FullPivLU<MatrixXd>::computeInPlace();
DEFLECT_COMPILED template void FullPivLU<Matrix6d>::computeInPlace();
DEFLECT_COMPILED template void HouseholderQR<MatrixXd>::computeInPlace();
DEFLECT_COMPILED template void ColPivHouseholderQR<MatrixXd>::computeInPlace();
DEFLECT_COMPILED template void CompleteOrthogonalDecomposition<MatrixXd>::computeInPlace();
DEFLECT_COMPILED template JacobiSVD<MatrixXd>& JacobiSVD<MatrixXd>::compute(const MatrixXd&, unsigned int);
DEFLECT_COMPILED template void FullPivLU<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
DEFLECT_COMPILED template void FullPivLU<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;
DEFLECT_COMPILED template void ColPivHouseholderQR<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
DEFLECT_COMPILED template void ColPivHouseholderQR<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;
DEFLECT_COMPILED template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl(const VectorXd&, VectorXd&) const;
DEFLECT_COMPILED template void CompleteOrthogonalDecomposition<MatrixXd>::_solve_impl(const MatrixXd&, MatrixXd&) const;
DEFLECT_COMPILED template LDLT<Matrix6d>& LDLT<Matrix6d>::compute(const EigenBase<Matrix6d>&);
DEFLECT_COMPILED template void ColPivHouseholderQR<Matrix3d>::computeInPlace();
DEFLECT_COMPILED template void CompleteOrthogonalDecomposition<Matrix3d>::computeInPlace();
DEFLECT_COMPILED template void CompleteOrthogonalDecomposition<Matrix3d>::_solve_impl(const Vector3d&, Vector3d&) const;
DEFLECT_COMPILED template void CompleteOrthogonalDecomposition<Matrix3d>::_solve_impl(const Matrix3d&, Matrix3d&) const;

}  // namespace Eigen

namespace deflect {

/// Q of a QR decomposition as a matrix, from its householderQ().
Eigen::MatrixXd evaluated(const Eigen::HouseholderSequence<Eigen::MatrixXd, Eigen::VectorXd>& Q);
/// Only the first columns of Q, with fewer operations.
Eigen::MatrixXd leading_columns(const Eigen::HouseholderSequence<Eigen::MatrixXd, Eigen::VectorXd>& Q,
                                Eigen::Index columns);

/// Estimate in the 1-norm.
double reciprocal_condition(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu);

}  // namespace deflect
