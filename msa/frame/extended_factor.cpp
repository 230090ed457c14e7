#include "msa/frame/extended_factor.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace deflect::frame {

ExtendedFactor::ExtendedFactor(const Model& m, const Elimination& e, const VectorX& tangents) {
  Matrix K = Matrix::Zero(e.independent, e.independent);
  const auto add = [&](const LinearForm& a, const LinearForm& b, long double k) {
    for (const Term& i : a)
      for (const Term& j : b) K(i.dof, j.dof) += k * i.coefficient * j.coefficient;
  };
  for (const Beam& beam : m.beams) {
    const Matrix12 K_e = stiffness(beam);
    const int first = beam.relative < 0 ? 0 : 6;
    const auto dof = [&](int i) {
      return static_cast<std::size_t>(beam.relative >= 0 ? beam.relative + i - 6
                                                         : 6 * (i < 6 ? beam.a : beam.b) + i % 6);
    };
    for (int i = first; i < 12; ++i)
      for (int j = first; j < 12; ++j) add(e.T[dof(i)], e.T[dof(j)], K_e(i, j));
  }
  for (std::size_t s = 0; s < m.springs.size(); ++s) {
    Vector form = Vector::Zero(e.independent);
    for (const Term& t : m.springs[s].elongation)
      for (const Term& r : e.T[static_cast<std::size_t>(t.dof)])
        form(r.dof) += static_cast<long double>(t.coefficient) * r.coefficient;
    K += static_cast<long double>(tangents(static_cast<Eigen::Index>(s))) * form * form.transpose();
  }
  scale_ = K.diagonal().cwiseSqrt().cwiseInverse();
  if (!scale_.allFinite()) {
    failed_ = true;
    return;
  }
  const Eigen::LLT<Matrix> llt(scale_.asDiagonal() * K * scale_.asDiagonal());
  failed_ = llt.info() != Eigen::Success;
  if (!failed_) L_ = llt.matrixL();
}

VectorX ExtendedFactor::solve(const VectorX& f) const {
  Vector x = scale_.cwiseProduct(f.cast<long double>());
  L_.triangularView<Eigen::Lower>().solveInPlace(x);
  L_.transpose().triangularView<Eigen::Upper>().solveInPlace(x);
  return scale_.cwiseProduct(x).cast<double>();
}

}  // namespace deflect::frame
