#include <Eigen/SparseLU>
#include <algorithm>

#include "msa/frame/solver.h"

namespace deflect::frame {

VectorX constraint_forces(const Model& m, const Elimination& e, const VectorX& u, const VectorX& load) {
  VectorX tangents;
  return constraint_forces(m, e, MatrixX(internal_forces(m, u, tangents) - load));
}

MatrixX constraint_forces(const Model& m, const Elimination& e, const MatrixX& unbalanced) {
  // Cᵀ λ = r restricted to the eliminated freedoms is square: one equation for each constraint that is not redundant.
  std::vector<int> row_of_dof(static_cast<std::size_t>(m.dofs()), -1), active;
  for (std::size_t k = 0; k < m.constraints.size(); ++k)
    if (e.pivot[k] >= 0) {
      row_of_dof[static_cast<std::size_t>(e.pivot[k])] = static_cast<int>(active.size());
      active.push_back(static_cast<int>(k));
    }
  MatrixX forces = MatrixX::Zero(static_cast<Eigen::Index>(m.constraints.size()), unbalanced.cols());
  if (active.empty()) return forces;
  const auto n = static_cast<Eigen::Index>(active.size());
  std::vector<Eigen::Triplet<double>> entries;
  MatrixX rhs(n, unbalanced.cols());
  for (Eigen::Index column = 0; column < n; ++column) {
    const auto k = static_cast<std::size_t>(active[static_cast<std::size_t>(column)]);
    for (const Term& t : m.constraints[k].form)
      if (const int row = row_of_dof[static_cast<std::size_t>(t.dof)]; row >= 0)
        entries.emplace_back(row, static_cast<int>(column), t.coefficient);
    rhs.row(column) = unbalanced.row(e.pivot[k]);
  }
  Eigen::SparseMatrix<double> Ct(n, n);
  Ct.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(Ct);
  const MatrixX lambda = lu.solve(rhs);
  for (Eigen::Index i = 0; i < n; ++i) forces.row(active[static_cast<std::size_t>(i)]) = lambda.row(i);
  return forces;
}

std::vector<std::pair<std::string, double>> energies(const Model& m, const VectorX& u) {
  std::vector<std::pair<std::string, double>> sums;
  const auto add = [&sums](const std::string& part, double energy) {
    const auto found = std::find_if(sums.begin(), sums.end(), [&](const auto& s) { return s.first == part; });
    if (found == sums.end())
      sums.emplace_back(part, energy);
    else
      found->second += energy;
  };
  for (const Beam& beam : m.beams) {
    const Vector12 d = end_displacements(beam, u);
    add(beam.part, 0.5 * d.dot(pull(beam, d)));
  }
  for (const Spring& spring : m.springs) add(spring.part, energy(spring.law, evaluate(spring.elongation, u)));
  return sums;
}

}  // namespace deflect::frame
