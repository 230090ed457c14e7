#include "msa/frame/deformed/tangent.h"

#include <Eigen/SparseLU>

#include "msa/base/index.h"
#include "msa/frame/structure/sparse_cholesky.h"

namespace deflect::frame {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

Sparse sparse(const std::vector<LinearForm>& rows, Eigen::Index columns) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (const Term& t : rows[i]) entries.emplace_back(static_cast<int>(i), t.dof, t.coefficient);
  Sparse out(std::ssize(rows), columns);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

Sparse twice_the_symmetric_part(const Sparse& K) { return Sparse(K.transpose()) + K; }

struct LowerTriangle {
  SparsePattern pattern;
  std::vector<double> values;

  explicit LowerTriangle(const Sparse& symmetric) : pattern{static_cast<int>(symmetric.cols()), {0}, {}} {
    for (int j = 0; j < pattern.n; ++j) {
      pattern.row.push_back(j);
      values.push_back(symmetric.coeff(j, j));
      for (Sparse::InnerIterator entry(symmetric, j); entry; ++entry)
        if (entry.row() > j) {
          pattern.row.push_back(static_cast<int>(entry.row()));
          values.push_back(entry.value());
        }
      pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
    }
  }
};

}  // namespace

Sparse tangent_stiffness(const Linearisation& at, const VectorX& lambda, const VectorX& loads) {
  std::vector<Eigen::Triplet<double>> entries = at.stiffness;
  for (const Linearisation::Curvature& c : at.curvatures)
    for (int j = 0; j < 12; ++j)
      for (int i = 0; i < 12; ++i) {
        const int a = nth(c.nodes, i / 6), b = nth(c.nodes, j / 6);
        const double value = -lambda(c.constraint) * c.H(i, j);
        if (a >= 0 && b >= 0 && value != 0) entries.emplace_back(6 * a + i % 6, 6 * b + j % 6, value);
      }
  for (std::size_t node = 0; 6 * node + 5 < at.nodal; ++node) {
    const auto first = static_cast<int>(6 * node + 3);
    const Matrix3 half = skew(loads.segment<3>(first)) / 2;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (half(i, j) != 0) entries.emplace_back(first + i, first + j, -half(i, j));
  }
  Sparse K(at.forces.size(), at.forces.size());
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

struct Tangent::Impl {
  Sparse T, G, K, reduced;
  Eigen::SparseLU<Sparse> lu;
  bool regular = true;
};

Tangent::Tangent(const Elimination& e, const Sparse& K) : impl_(std::make_unique<Impl>()) {
  Impl& s = *impl_;
  s.T = sparse(e.T, e.independent);
  s.G = sparse(e.G, std::ssize(e.pivot));
  s.K = K;
  s.reduced = s.T.transpose() * K * s.T;
  s.reduced.makeCompressed();
  if (e.independent == 0) return;
  s.lu.compute(s.reduced);
  s.regular = s.lu.info() == Eigen::Success;
}

Tangent::~Tangent() = default;

bool Tangent::regular() const { return impl_->regular; }

double Tangent::largest_entry() const {
  const Sparse& K = impl_->reduced;
  return K.nonZeros() > 0 ? Eigen::Map<const VectorX>(K.valuePtr(), K.nonZeros()).cwiseAbs().maxCoeff() : 0;
}

bool Tangent::stable() const {
  const Sparse symmetric = twice_the_symmetric_part(impl_->reduced);
  const LowerTriangle lower(symmetric);
  if (SparseCholesky(lower.pattern).factor(lower.values) > 0) return true;
  const Sparse skew_part = Sparse(impl_->reduced.transpose()) - impl_->reduced;
  return impl_->regular && skew_part.norm() > 1e-9 * symmetric.norm() && impl_->lu.signDeterminant() > 0;
}

Tangent::Softest Tangent::softest() const {
  LowerTriangle lower(twice_the_symmetric_part(impl_->reduced));
  if (lower.pattern.n == 0) return {};
  SparseCholesky factor(lower.pattern);
  Softest out{factor.factor(lower.values), {}};
  if (out.condition == 0) {  // what is softest shows beside a little of the diagonal
    for (int j = 0; j < lower.pattern.n; ++j) nth(lower.values, nth(lower.pattern.column_start, j)) *= 1 + 1e-13;
    if (factor.factor(lower.values) == 0) return out;
  }
  out.u = impl_->T * factor.softest().motion;
  return out;
}

MatrixX Tangent::solve(const MatrixX& loads, const MatrixX& values) const {
  const Impl& s = *impl_;
  const MatrixX moved = s.G * values;
  if (s.reduced.cols() == 0) return moved;
  const MatrixX rhs = s.T.transpose() * (loads - s.K * moved);
  return s.T * MatrixX(s.lu.solve(rhs)) + moved;
}

}  // namespace deflect::frame
