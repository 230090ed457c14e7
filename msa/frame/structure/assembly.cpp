#include "msa/frame/structure/assembly.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "msa/base/index.h"
#include "msa/frame/elements/two_at_once.h"

namespace deflect::frame {
namespace {

/// A linear form over the model's freedoms, in terms of q; ascending, merged.
LinearForm reduced(const LinearForm& form, const Elimination& e) {
  std::map<int, double> sum;
  for (const Term& t : form)
    for (const Term& r : nth(e.T, t.dof)) sum[r.dof] += t.coefficient * r.coefficient;
  LinearForm out;
  for (const auto& [q, c] : sum) out.push_back({q, c});
  return out;
}

constexpr std::size_t many_beams = 2000, chunk = 1024;

struct ReducedBeam {
  std::vector<int> q, positions;  // of (i, j), i ≥ j, column by column
  MatrixX K;
};

/// Those of end a only where the beam has no relative motion of its own.
std::vector<int> freedoms_of(const Beam& beam) {
  std::vector<int> dofs;
  for (int i = 0; i < 6 && beam.relative < 0; ++i) dofs.push_back(6 * beam.a + i);
  for (int i = 0; i < 6; ++i) dofs.push_back(beam.relative < 0 ? 6 * beam.b + i : beam.relative + i);
  return dofs;
}

/// The q of these freedoms, ascending.
std::vector<int> reduced(const std::vector<int>& dofs, const Elimination& e) {
  std::vector<int> q;
  for (const int dof : dofs)
    for (const Term& t : nth(e.T, dof)) q.push_back(t.dof);
  std::sort(q.begin(), q.end());
  q.erase(std::unique(q.begin(), q.end()), q.end());
  return q;
}

ReducedBeam reduced(const Beam& beam, const Elimination& e) {
  const std::vector<int> dofs = freedoms_of(beam);
  ReducedBeam out;
  out.q = reduced(dofs, e);
  MatrixX B = MatrixX::Zero(std::ssize(dofs), std::ssize(out.q));
  for (std::size_t i = 0; i < dofs.size(); ++i)
    for (const Term& t : nth(e.T, dofs[i])) {
      const auto column = std::lower_bound(out.q.begin(), out.q.end(), t.dof) - out.q.begin();
      B(as_index(i), column) += t.coefficient;
    }
  const auto ends = std::ssize(dofs);
  out.K = B.transpose() * stiffness(beam).bottomRightCorner(ends, ends) * B;
  return out;
}

/// Lists of q, each ascending, one behind the other.
struct Groups {
  std::vector<int> start{0}, q;
  void add(const std::vector<int>& group) {
    q.insert(q.end(), group.begin(), group.end());
    start.push_back(static_cast<int>(q.size()));
  }
};

/// Every two q of a group meet.
SparsePattern pattern_of(int n, const Groups& groups) {
  std::vector<int> first(as_size(n) + 1, 0), member(groups.q.size());  // groups by q
  for (const int q : groups.q) ++first[as_size(q) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (std::size_t g = 0; g + 1 < groups.start.size(); ++g)
    for (int k = groups.start[g]; k < groups.start[g + 1]; ++k)
      nth(member, nth(next, nth(groups.q, k))++) = static_cast<int>(g);
  SparsePattern p{n, {0}, {}};
  std::vector<int> met(as_size(n), -1);
  for (int j = 0; j < n; ++j) {
    const auto from = as_index(p.row.size());
    nth(met, j) = j;
    p.row.push_back(j);
    for (int k = nth(first, j); k < first[as_size(j) + 1]; ++k) {
      const auto g = as_size(nth(member, k));
      for (int at = groups.start[g + 1] - 1; at >= groups.start[g]; --at) {
        const int i = nth(groups.q, at);
        if (i <= j) break;
        if (std::exchange(nth(met, i), j) != j) p.row.push_back(i);
      }
    }
    std::sort(p.row.begin() + from, p.row.end());
    p.column_start.push_back(static_cast<int>(p.row.size()));
  }
  p.row.shrink_to_fit();
  return p;
}

int position(const SparsePattern& p, int row, int column) {
  const auto from = p.row.begin() + nth(p.column_start, column);
  const auto to = p.row.begin() + p.column_start[as_size(column) + 1];
  return static_cast<int>(std::lower_bound(from, to, row) - p.row.begin());
}

ReducedBeam placed(ReducedBeam beam, const SparsePattern& p) {
  for (std::size_t j = 0; j < beam.q.size(); ++j)
    for (std::size_t i = j; i < beam.q.size(); ++i) beam.positions.push_back(position(p, beam.q[i], beam.q[j]));
  return beam;
}

template <class Vector>
VectorX beam_forces(const Model& m, const Vector& u) {
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

VectorX with_springs(const Model& m, VectorX f, const VectorX& spring_forces) {
  for (std::size_t s = 0; s < m.springs.size(); ++s)
    for (const Term& t : m.springs[s].elongation) f(t.dof) += t.coefficient * spring_forces(as_index(s));
  return f;
}

template <class Vector>
VectorX forces_at(const Model& m, const Vector& u, const VectorX& spring_tangents) {
  VectorX pulls(spring_tangents.size());
  for (std::size_t s = 0; s < m.springs.size(); ++s) {
    const auto i = as_index(s);
    pulls(i) = spring_tangents(i) * evaluate(m.springs[s].elongation, u);
  }
  return with_springs(m, beam_forces(m, u), pulls);
}

}  // namespace

Assembly::Assembly(const Model& m, const Elimination& e, int threads) {
  Groups groups;
  for (const Beam& beam : m.beams) groups.add(reduced(freedoms_of(beam), e));
  for (const Spring& spring : m.springs) {
    springs_.push_back({reduced(spring.elongation, e), {}});
    std::vector<int> q;
    for (const Term& t : springs_.back().form) q.push_back(t.dof);
    groups.add(q);
  }
  pattern_ = pattern_of(e.independent, groups);
  groups = {};
  beams_.assign(pattern_.row.size(), 0);
  TwoAtOnce both(m.beams.size() < many_beams ? 1 : threads);
  std::vector<ReducedBeam> some(std::min(chunk, m.beams.size()));
  for (std::size_t from = 0; from < m.beams.size(); from += chunk) {
    const std::size_t to = std::min(from + chunk, m.beams.size()), half = (from + to) / 2;
    const auto reduce = [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) some[b - from] = placed(reduced(m.beams[b], e), pattern_);
    };
    both([&] { reduce(from, half); }, [&] { reduce(half, to); });
    for (std::size_t b = 0; b < to - from; ++b) {  // in the order of the beams, whatever the threads
      auto at = some[b].positions.begin();
      for (Eigen::Index j = 0; j < some[b].K.cols(); ++j)
        for (Eigen::Index i = j; i < some[b].K.cols(); ++i) nth(beams_, *at++) += some[b].K(i, j);
    }
  }
  for (ReducedSpring& spring : springs_)
    for (std::size_t i = 0; i < spring.form.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        spring.positions.push_back(position(pattern_, spring.form[i].dof, spring.form[j].dof));
}

std::vector<double> Assembly::values(const VectorX& spring_tangents) const {
  std::vector<double> values = beams_;
  for (std::size_t s = 0; s < springs_.size(); ++s) {
    const double k = spring_tangents(as_index(s));
    const ReducedSpring& spring = springs_[s];
    std::size_t at = 0;
    for (std::size_t i = 0; i < spring.form.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        nth(values, spring.positions[at++]) += k * spring.form[i].coefficient * spring.form[j].coefficient;
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

double evaluate(const LinearForm& form, const ExtendedVector& u) {
  Extended sum = 0;
  for (const Term& t : form) sum += t.coefficient * u(t.dof);
  return static_cast<double>(sum);
}

VectorX internal_forces(const Model& m, const VectorX& u, VectorX& spring_tangents) {
  VectorX f = beam_forces(m, u);
  spring_tangents.resize(std::ssize(m.springs));
  for (std::size_t s = 0; s < m.springs.size(); ++s) {
    const Spring& spring = m.springs[s];
    const double elongation = evaluate(spring.elongation, u), pull = force(spring.law, elongation);
    for (const Term& t : spring.elongation) f(t.dof) += t.coefficient * pull;
    spring_tangents(as_index(s)) = tangent(spring.law, elongation);
  }
  return f;
}

VectorX spring_forces(const Model& m, const ExtendedVector& u) {
  VectorX forces(std::ssize(m.springs));
  for (std::size_t s = 0; s < m.springs.size(); ++s)
    forces(as_index(s)) = force(m.springs[s].law, evaluate(m.springs[s].elongation, u));
  return forces;
}

VectorX forces_with(const Model& m, const VectorX& u, const VectorX& spring_forces) {
  return with_springs(m, beam_forces(m, u), spring_forces);
}

VectorX forces_with(const Model& m, const ExtendedVector& u, const VectorX& spring_forces) {
  return with_springs(m, beam_forces(m, u), spring_forces);
}

VectorX tangent_forces(const Model& m, const VectorX& u, const VectorX& spring_tangents) {
  return forces_at(m, u, spring_tangents);
}

VectorX tangent_forces(const Model& m, const ExtendedVector& u, const VectorX& spring_tangents) {
  return forces_at(m, u, spring_tangents);
}

}  // namespace deflect::frame
