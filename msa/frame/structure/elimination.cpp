#include "msa/frame/structure/elimination.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "msa/base/error.h"
#include "msa/base/index.h"

namespace deflect::frame {
namespace {

/// A linear form being worked on: values by index (freedoms, then constraint values) and the indices that were touched.
class Expression {
 public:
  explicit Expression(std::size_t size) : values_(size, 0) {}

  void add(int index, double value) {
    double& v = nth(values_, index);
    if (v == 0) touched_.push_back(index);
    v += value;
  }
  double take(int index) { return std::exchange(nth(values_, index), 0); }

  /// Replaces eliminated freedoms by what they were eliminated to, until none is left: touched_ grows as it is walked.
  void substitute(const std::vector<LinearForm>& rows, const std::vector<char>& eliminated) {
    for (std::size_t i = 0; i < touched_.size(); ++i) {
      const auto dof = as_size(touched_[i]);
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
    if (best.dof < 0 || nth(uses, t.dof) < nth(uses, best.dof)) best = t;
  }
  return best;
}

/// Of a constraint whose form the earlier ones imply; n freedoms, behind them the constraints' values.
Redundancy redundancy_of(int constraint, const LinearForm& form, int n) {
  Redundancy r{constraint, {}};
  for (const Term& t : form)
    if (t.dof >= n && t.dof != n + constraint && std::abs(t.coefficient) > 1e-12)
      r.implied_by.push_back({t.dof - n, t.coefficient});
  return r;
}

/// Numbers the freedoms that stay; T and G from what the others were eliminated to.
void set_independent(Elimination& out, const std::vector<LinearForm>& rows, const std::vector<char>& eliminated) {
  const std::size_t size = rows.size();
  const auto n = static_cast<int>(size);
  std::vector<int> q_of_dof(size, -1);
  for (int dof = 0; dof < n; ++dof)
    if (!nth(eliminated, dof)) {
      nth(q_of_dof, dof) = out.independent++;
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
        out.T[dof].push_back({nth(q_of_dof, t.dof), t.coefficient});
      else
        out.G[dof].push_back({t.dof - n, t.coefficient});
  }
}

template <class Vector>
Vector expanded(const Elimination& e, const Vector& q, const VectorX& values) {
  Vector u(std::ssize(e.T));
  for (std::size_t dof = 0; dof < e.T.size(); ++dof) {
    typename Vector::Scalar sum = 0;
    for (const Term& t : e.T[dof]) sum += t.coefficient * q(t.dof);
    for (const Term& t : e.G[dof]) sum += t.coefficient * values(t.dof);
    u(as_index(dof)) = sum;
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
  VectorX b(std::ssize(m.constraints));
  for (std::size_t k = 0; k < m.constraints.size(); ++k) b(as_index(k)) = m.constraints[k].value;
  return b;
}

Elimination eliminate(const Model& m) {
  const int n = m.dofs();
  const auto size = as_size(n);
  const Weights weight{static_cast<int>(6 * m.nodes.size()), characteristic_length(m)};
  std::vector<int> uses(size, 0);
  for (const Constraint& c : m.constraints)
    for (const Term& t : c.form) ++nth(uses, t.dof);

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
      out.redundant.push_back(redundancy_of(static_cast<int>(k), form, n));
      out.pivot.push_back(-1);
      continue;
    }
    const Term pivot = pivot_of(form, m.constraints[k].eliminates, n, largest, weight, uses);
    std::erase_if(form, [&](const Term& t) { return t.dof == pivot.dof; });
    for (Term& t : form) t.coefficient /= -pivot.coefficient;
    nth(rows, pivot.dof) = std::move(form);
    nth(eliminated, pivot.dof) = 1;
    order.push_back(pivot.dof);
    out.pivot.push_back(pivot.dof);
  }
  // An expression may name freedoms that were eliminated later; from the last to the first all become final.
  for (auto it = order.rbegin(); it != order.rend(); ++it) {
    LinearForm& row = nth(rows, *it);
    for (const Term& t : row) work.add(t.dof, t.coefficient);
    work.substitute(rows, eliminated);
    row = work.drain();
  }
  set_independent(out, rows, eliminated);
  return out;
}

namespace {

/// The value that the others imply, where it is not the constraint's own to 1e-9.
std::optional<double> contradiction(const Redundancy& r, const VectorX& values) {
  double implied = 0, scale = std::abs(values(r.constraint));
  for (const Term& t : r.implied_by) {
    implied += t.coefficient * values(t.dof);
    scale = std::max(scale, std::abs(t.coefficient * values(t.dof)));
  }
  if (std::abs(implied - values(r.constraint)) > 1e-9 * scale) return implied;
  return std::nullopt;
}

}  // namespace

bool consistent(const Elimination& e, const VectorX& values) {
  return std::none_of(e.redundant.begin(), e.redundant.end(),
                      [&](const Redundancy& r) { return contradiction(r, values).has_value(); });
}

void check_consistent(const Model& m, const Elimination& e, const VectorX& values) {
  for (const Redundancy& r : e.redundant) {
    const std::optional<double> implied = contradiction(r, values);
    if (!implied) continue;
    std::string names;
    for (const Term& t : r.implied_by)
      if (names.size() < 200) names += fmt::format("{}'{}'", names.empty() ? "" : ", ", nth(m.constraints, t.dof).name);
    throw ModelError(fmt::format("constraint '{}' contradicts {}: they imply the value {:.9g}, it asks for {:.9g}",
                                 nth(m.constraints, r.constraint).name, names, *implied, values(r.constraint)));
  }
}

std::vector<std::string> redundancies(const Model& m, const Elimination& e) {
  std::vector<std::string> notes;
  for (const Redundancy& r : e.redundant) {
    if (nth(m.constraints, r.constraint).may_repeat) continue;
    std::string names;
    for (std::size_t i = 0; i < std::min<std::size_t>(r.implied_by.size(), 6); ++i)
      names += fmt::format("{}'{}'", i ? ", " : "", nth(m.constraints, r.implied_by[i].dof).name);
    notes.push_back(
        fmt::format("constraint '{}' is redundant: {} already imply it", nth(m.constraints, r.constraint).name, names));
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
    for (const Term& t : T[dof]) r(t.dof) += t.coefficient * f(as_index(dof));
  return r;
}

}  // namespace deflect::frame
