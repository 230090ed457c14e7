#include "msa/frame/assembly.h"

#include <algorithm>
#include <map>

namespace deflect::frame {
namespace {

/// A linear form over the model's freedoms, in terms of q; ascending, merged.
LinearForm reduced(const LinearForm& form, const Elimination& e) {
  std::map<int, double> sum;
  for (const Term& t : form)
    for (const Term& r : e.T[static_cast<std::size_t>(t.dof)]) sum[r.dof] += t.coefficient * r.coefficient;
  LinearForm out;
  for (const auto& [q, c] : sum) out.push_back({q, c});
  return out;
}

struct ReducedBeam {
  std::vector<int> q;
  MatrixX K;
};

ReducedBeam reduced(const Beam& beam, const Elimination& e) {
  std::vector<int> dofs;  // those of end a count only where the beam has no relative motion of its own
  for (int i = 0; i < 6 && beam.relative < 0; ++i) dofs.push_back(6 * beam.a + i);
  for (int i = 0; i < 6; ++i) dofs.push_back(beam.relative < 0 ? 6 * beam.b + i : beam.relative + i);
  ReducedBeam out;
  for (const int dof : dofs)
    for (const Term& t : e.T[static_cast<std::size_t>(dof)]) out.q.push_back(t.dof);
  std::sort(out.q.begin(), out.q.end());
  out.q.erase(std::unique(out.q.begin(), out.q.end()), out.q.end());
  MatrixX B = MatrixX::Zero(static_cast<Eigen::Index>(dofs.size()), static_cast<Eigen::Index>(out.q.size()));
  for (std::size_t i = 0; i < dofs.size(); ++i)
    for (const Term& t : e.T[static_cast<std::size_t>(dofs[i])]) {
      const auto column = std::lower_bound(out.q.begin(), out.q.end(), t.dof) - out.q.begin();
      B(static_cast<Eigen::Index>(i), column) += t.coefficient;
    }
  const auto ends = static_cast<Eigen::Index>(dofs.size());
  out.K = B.transpose() * stiffness(beam).bottomRightCorner(ends, ends) * B;
  return out;
}

SparsePattern pattern_of(int n, const std::vector<std::vector<int>>& groups) {
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(n));
  for (int j = 0; j < n; ++j) columns[static_cast<std::size_t>(j)].push_back(j);
  for (const std::vector<int>& q : groups)  // ascending
    for (std::size_t j = 0; j < q.size(); ++j)
      columns[static_cast<std::size_t>(q[j])].insert(columns[static_cast<std::size_t>(q[j])].end(),
                                                     q.begin() + static_cast<std::ptrdiff_t>(j) + 1, q.end());
  SparsePattern p{n, {0}, {}};
  for (auto& column : columns) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    p.row.insert(p.row.end(), column.begin(), column.end());
    p.column_start.push_back(static_cast<int>(p.row.size()));
  }
  return p;
}

int position(const SparsePattern& p, int row, int column) {
  const auto from = p.row.begin() + p.column_start[static_cast<std::size_t>(column)];
  const auto to = p.row.begin() + p.column_start[static_cast<std::size_t>(column) + 1];
  return static_cast<int>(std::lower_bound(from, to, row) - p.row.begin());
}

VectorX beam_forces(const Model& m, const VectorX& u) {
  VectorX f = VectorX::Zero(m.dofs());
  for (const Beam& beam : m.beams) {
    const Vector12 pulls = pull(beam, end_displacements(beam, u));
    if (beam.relative < 0) {
      f.segment<6>(6 * beam.a) += pulls.head<6>();
      f.segment<6>(6 * beam.b) += pulls.tail<6>();
    } else {
      f.segment<6>(beam.relative) += pulls.tail<6>();
    }
  }
  return f;
}

}  // namespace

Assembly::Assembly(const Model& m, const Elimination& e) {
  std::vector<std::vector<int>> groups;
  std::vector<ReducedBeam> beams;
  for (const Beam& beam : m.beams) {
    beams.push_back(reduced(beam, e));
    groups.push_back(beams.back().q);
  }
  for (const Spring& spring : m.springs) {
    springs_.push_back({reduced(spring.elongation, e), {}});
    std::vector<int> q;
    for (const Term& t : springs_.back().form) q.push_back(t.dof);
    groups.push_back(std::move(q));
  }
  pattern_ = pattern_of(e.independent, groups);
  beams_.assign(pattern_.row.size(), 0);
  for (const ReducedBeam& beam : beams)
    for (std::size_t j = 0; j < beam.q.size(); ++j)
      for (std::size_t i = j; i < beam.q.size(); ++i)
        beams_[static_cast<std::size_t>(position(pattern_, beam.q[i], beam.q[j]))] +=
            beam.K(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  for (ReducedSpring& spring : springs_)
    for (std::size_t i = 0; i < spring.form.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        spring.positions.push_back(position(pattern_, spring.form[i].dof, spring.form[j].dof));
}

std::vector<double> Assembly::values(const VectorX& spring_tangents) const {
  std::vector<double> values = beams_;
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const double k = spring_tangents(static_cast<Eigen::Index>(s));
    const ReducedSpring& spring = springs_[s];
    std::size_t at = 0;
    for (std::size_t i = 0; i < spring.form.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        values[static_cast<std::size_t>(spring.positions[at++])] +=
            k * spring.form[i].coefficient * spring.form[j].coefficient;
  }
  return values;
}

VectorX padded(const VectorX& v, Eigen::Index size) {
  VectorX out = VectorX::Zero(size);
  out.head(v.size()) = v;
  return out;
}

double evaluate(const LinearForm& form, const VectorX& u) {
  double sum = 0;
  for (const Term& t : form) sum += t.coefficient * u(t.dof);
  return sum;
}

VectorX internal_forces(const Model& m, const VectorX& u, VectorX& spring_tangents) {
  VectorX f = beam_forces(m, u);
  spring_tangents.resize(static_cast<Eigen::Index>(m.springs.size()));
  for (std::size_t s = 0; s < m.springs.size(); ++s) {
    const Spring& spring = m.springs[s];
    const double elongation = evaluate(spring.elongation, u), pull = force(spring.law, elongation);
    for (const Term& t : spring.elongation) f(t.dof) += t.coefficient * pull;
    spring_tangents(static_cast<Eigen::Index>(s)) = tangent(spring.law, elongation);
  }
  return f;
}

VectorX forces_with(const Model& m, const VectorX& u, const VectorX& spring_forces) {
  VectorX f = beam_forces(m, u);
  for (std::size_t s = 0; s < m.springs.size(); ++s)
    for (const Term& t : m.springs[s].elongation)
      f(t.dof) += t.coefficient * spring_forces(static_cast<Eigen::Index>(s));
  return f;
}

VectorX tangent_forces(const Model& m, const VectorX& u, const VectorX& spring_tangents) {
  VectorX f = beam_forces(m, u);
  for (std::size_t s = 0; s < m.springs.size(); ++s) {
    const LinearForm& form = m.springs[s].elongation;
    const double pull = spring_tangents(static_cast<Eigen::Index>(s)) * evaluate(form, u);
    for (const Term& t : form) f(t.dof) += t.coefficient * pull;
  }
  return f;
}

}  // namespace deflect::frame
