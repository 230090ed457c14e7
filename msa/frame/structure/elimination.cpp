#include "msa/frame/structure/elimination.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "msa/base/error.h"

namespace deflect::frame {
namespace {

/// A linear form being worked on: values by index (freedoms, then constraint values) and the indices that were touched.
class Expression {
 public:
  explicit Expression(std::size_t size) : values_(size, 0) {}

  void add(int index, double value) {
    double& v = values_[static_cast<std::size_t>(index)];
    if (v == 0) touched_.push_back(index);
    v += value;
  }
  double take(int index) { return std::exchange(values_[static_cast<std::size_t>(index)], 0); }
  double at(int index) const { return values_[static_cast<std::size_t>(index)]; }

  /// Replaces eliminated freedoms by what they were eliminated to, until none is left: touched_ grows as it is walked.
  void substitute(const std::vector<LinearForm>& rows, const std::vector<char>& eliminated) {
    for (std::size_t i = 0; i < touched_.size(); ++i) {
      const auto dof = static_cast<std::size_t>(touched_[i]);
      if (dof >= eliminated.size() || !eliminated[dof]) continue;
      const double factor = take(touched_[i]);
      if (factor == 0) continue;
      for (const Term& t : rows[dof]) add(t.dof, factor * t.coefficient);
    }
  }

  /// The terms that are not zero, ascending; the expression is empty afterwards.
  LinearForm drain() {
    std::sort(touched_.begin(), touched_.end());
    LinearForm form;
    for (const int index : touched_)
      if (const double value = take(index); value != 0) form.push_back({index, value});
    touched_.clear();
    return form;
  }

 private:
  std::vector<double> values_;
  std::vector<int> touched_;
};

struct Weights {
  int nodal;      // freedoms of nodes
  double length;  // a rotation of 1 rad counts as this many metres
  double operator()(int dof, double c) const { return std::abs(c) / (dof < nodal && dof % 6 >= 3 ? length : 1); }
};

/// The freedom to eliminate: the wanted one where it may, else of those with a comparable weight the least connected.
Term pivot_of(const LinearForm& form, int wanted, int n, double largest, const Weights& weight,
              const std::vector<int>& uses) {
  for (const Term& t : form)
    if (t.dof == wanted && weight(t.dof, t.coefficient) >= 1e-6 * largest) return t;
  Term best{-1, 0};
  for (const Term& t : form) {
    if (t.dof >= n || weight(t.dof, t.coefficient) < 0.3 * largest) continue;
    if (best.dof < 0 || uses[static_cast<std::size_t>(t.dof)] < uses[static_cast<std::size_t>(best.dof)]) best = t;
  }
  return best;
}

template <class Vector>
Vector expanded(const Elimination& e, const Vector& q, const VectorX& values) {
  Vector u(static_cast<Eigen::Index>(e.T.size()));
  for (std::size_t dof = 0; dof < e.T.size(); ++dof) {
    typename Vector::Scalar sum = 0;
    for (const Term& t : e.T[dof]) sum += t.coefficient * q(t.dof);
    for (const Term& t : e.G[dof]) sum += t.coefficient * values(t.dof);
    u(static_cast<Eigen::Index>(dof)) = sum;
  }
  return u;
}

}  // namespace

double characteristic_length(const Model& m) {
  if (m.nodes.empty()) return 1;
  Vector3 low = m.nodes.front().position, high = low;
  for (const Node& node : m.nodes) low = low.cwiseMin(node.position), high = high.cwiseMax(node.position);
  const double diagonal = (high - low).norm();
  return diagonal > 0 ? diagonal : 1;
}

VectorX constraint_values(const Model& m) {
  VectorX b(static_cast<Eigen::Index>(m.constraints.size()));
  for (std::size_t k = 0; k < m.constraints.size(); ++k) b(static_cast<Eigen::Index>(k)) = m.constraints[k].value;
  return b;
}

Elimination eliminate(const Model& m) {
  const int n = m.dofs();
  const auto size = static_cast<std::size_t>(n);
  const Weights weight{static_cast<int>(6 * m.nodes.size()), characteristic_length(m)};
  std::vector<int> uses(size, 0);
  for (const Constraint& c : m.constraints)
    for (const Term& t : c.form) ++uses[static_cast<std::size_t>(t.dof)];

  Elimination out;
  std::vector<LinearForm> rows(size);
  std::vector<char> eliminated(size, 0);
  std::vector<int> order;
  Expression work(size + m.constraints.size());
  for (std::size_t k = 0; k < m.constraints.size(); ++k) {
    double scale = 0;
    for (const Term& t : m.constraints[k].form) {
      work.add(t.dof, t.coefficient);
      scale = std::max(scale, weight(t.dof, t.coefficient));
    }
    work.add(n + static_cast<int>(k), -1);
    work.substitute(rows, eliminated);
    LinearForm form = work.drain();
    std::erase_if(form, [&](const Term& t) {  // what cancelled but for rounding
      return t.dof < n && weight(t.dof, t.coefficient) <= 1e-13 * scale;
    });
    double largest = 0;
    for (const Term& t : form)
      if (t.dof < n) largest = std::max(largest, weight(t.dof, t.coefficient));
    if (largest <= 1e-9 * scale) {
      Redundancy r{static_cast<int>(k), {}};
      for (const Term& t : form)
        if (t.dof >= n && t.dof != n + static_cast<int>(k) && std::abs(t.coefficient) > 1e-12)
          r.implied_by.push_back({t.dof - n, t.coefficient});
      out.redundant.push_back(std::move(r));
      out.pivot.push_back(-1);
      continue;
    }
    const Term pivot = pivot_of(form, m.constraints[k].eliminates, n, largest, weight, uses);
    std::erase_if(form, [&](const Term& t) { return t.dof == pivot.dof; });
    for (Term& t : form) t.coefficient /= -pivot.coefficient;
    rows[static_cast<std::size_t>(pivot.dof)] = std::move(form);
    eliminated[static_cast<std::size_t>(pivot.dof)] = 1;
    order.push_back(pivot.dof);
    out.pivot.push_back(pivot.dof);
  }
  // An expression may name freedoms that were eliminated later; from the last to the first all become final.
  for (auto it = order.rbegin(); it != order.rend(); ++it) {
    LinearForm& row = rows[static_cast<std::size_t>(*it)];
    for (const Term& t : row) work.add(t.dof, t.coefficient);
    work.substitute(rows, eliminated);
    row = work.drain();
  }

  std::vector<int> q_of_dof(size, -1);
  for (int dof = 0; dof < n; ++dof)
    if (!eliminated[static_cast<std::size_t>(dof)]) {
      q_of_dof[static_cast<std::size_t>(dof)] = out.independent++;
      out.dof_of_q.push_back(dof);
    }
  out.T.resize(size);
  out.G.resize(size);
  for (std::size_t dof = 0; dof < size; ++dof) {
    if (!eliminated[dof]) {
      out.T[dof] = {{q_of_dof[dof], 1.0}};
      continue;
    }
    for (const Term& t : rows[dof])
      if (t.dof < n)
        out.T[dof].push_back({q_of_dof[static_cast<std::size_t>(t.dof)], t.coefficient});
      else
        out.G[dof].push_back({t.dof - n, t.coefficient});
  }
  return out;
}

void check_consistent(const Model& m, const Elimination& e, const VectorX& values) {
  for (const Redundancy& r : e.redundant) {
    double implied = 0, scale = std::abs(values(r.constraint));
    std::string names;
    for (const Term& t : r.implied_by) {
      implied += t.coefficient * values(t.dof);
      scale = std::max(scale, std::abs(t.coefficient * values(t.dof)));
      if (names.size() < 200)
        names += fmt::format("{}'{}'", names.empty() ? "" : ", ", m.constraints[static_cast<std::size_t>(t.dof)].name);
    }
    if (std::abs(implied - values(r.constraint)) > 1e-9 * scale)
      throw ModelError(fmt::format("constraint '{}' contradicts {}: they imply the value {:.9g}, it asks for {:.9g}",
                                   m.constraints[static_cast<std::size_t>(r.constraint)].name, names, implied,
                                   values(r.constraint)));
  }
}

std::vector<std::string> redundancies(const Model& m, const Elimination& e) {
  std::vector<std::string> notes;
  for (const Redundancy& r : e.redundant) {
    if (m.constraints[static_cast<std::size_t>(r.constraint)].may_repeat) continue;
    std::string names;
    for (std::size_t i = 0; i < std::min<std::size_t>(r.implied_by.size(), 6); ++i)
      names += fmt::format("{}'{}'", i ? ", " : "", m.constraints[static_cast<std::size_t>(r.implied_by[i].dof)].name);
    notes.push_back(fmt::format("constraint '{}' is redundant: {} already imply it",
                                m.constraints[static_cast<std::size_t>(r.constraint)].name, names));
  }
  return notes;
}

VectorX Elimination::expand(const VectorX& q, const VectorX& values) const { return expanded(*this, q, values); }

ExtendedVector Elimination::expand_fine(const ExtendedVector& q, const VectorX& values) const {
  return expanded(*this, q, values);
}

VectorX Elimination::reduce(const VectorX& f) const {
  VectorX r = VectorX::Zero(independent);
  for (std::size_t dof = 0; dof < T.size(); ++dof)
    for (const Term& t : T[dof]) r(t.dof) += t.coefficient * f(static_cast<Eigen::Index>(dof));
  return r;
}

}  // namespace deflect::frame
