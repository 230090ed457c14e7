#include "msa/frame/structure/reactions.h"

#include <Eigen/SparseLU>

#include "msa/base/index.h"
#include "msa/frame/structure/assembly.h"

namespace deflect::frame {

/// Cᵀ λ = r restricted to the eliminated freedoms is square: one equation for each constraint that is not redundant.
struct Reactions::Impl {
  std::size_t constraints = 0;
  std::vector<int> active, pivot;  // constraints, and the freedom that each eliminates
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu;
};

Reactions::Reactions(const Model& m, const Elimination& e) : impl_(std::make_unique<Impl>()) {
  impl_->constraints = m.constraints.size();
  std::vector<int> row_of_dof(as_size(m.dofs()), -1);
  for (std::size_t k = 0; k < m.constraints.size(); ++k)
    if (e.pivot[k] >= 0) {
      nth(row_of_dof, e.pivot[k]) = static_cast<int>(impl_->active.size());
      impl_->active.push_back(static_cast<int>(k));
      impl_->pivot.push_back(e.pivot[k]);
    }
  if (impl_->active.empty()) return;
  const auto n = static_cast<int>(impl_->active.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < n; ++column) {
    const auto k = as_size(nth(impl_->active, column));
    for (const Term& t : m.constraints[k].form)
      if (const int row = nth(row_of_dof, t.dof); row >= 0) entries.emplace_back(row, column, t.coefficient);
  }
  Eigen::SparseMatrix<double> Ct(n, n);
  Ct.setFromTriplets(entries.begin(), entries.end());
  impl_->lu.compute(Ct);
}

Reactions::~Reactions() = default;
Reactions::Reactions(Reactions&&) noexcept = default;
Reactions& Reactions::operator=(Reactions&&) noexcept = default;

MatrixX Reactions::forces(const MatrixX& unbalanced) const {
  MatrixX forces = MatrixX::Zero(as_index(impl_->constraints), unbalanced.cols());
  if (impl_->active.empty()) return forces;
  MatrixX rhs(std::ssize(impl_->pivot), unbalanced.cols());
  for (std::size_t i = 0; i < impl_->pivot.size(); ++i) rhs.row(as_index(i)) = unbalanced.row(impl_->pivot[i]);
  const MatrixX lambda = impl_->lu.solve(rhs);
  for (std::size_t i = 0; i < impl_->active.size(); ++i) forces.row(impl_->active[i]) = lambda.row(as_index(i));
  return forces;
}

VectorX constraint_forces(const Model& m, const Elimination& e, const ExtendedVector& u, const VectorX& load) {
  return Reactions(m, e).forces(forces_with(m, u, spring_forces(m, u)) - load);
}

}  // namespace deflect::frame
