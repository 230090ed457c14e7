#define DEFLECT_COMPILED  // here
#include "msa/base/decompositions.h"

namespace deflect {

using Sequence = Eigen::HouseholderSequence<Eigen::MatrixXd, Eigen::VectorXd>;

Eigen::MatrixXd evaluated(const Sequence& Q) { return Q; }

Eigen::MatrixXd leading_columns(const Sequence& Q, Eigen::Index columns) {
  return Q * Eigen::MatrixXd::Identity(Q.rows(), columns);
}

double reciprocal_condition(const Eigen::PartialPivLU<Eigen::MatrixXd>& lu) { return lu.rcond(); }

}  // namespace deflect
