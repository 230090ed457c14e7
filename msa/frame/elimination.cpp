#include "msa/frame/elimination.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "msa/base/error.h"

namespace deflect::frame {
namespace {

using Expression = std::map<int, double>;  // freedoms, and constraint values numbered after them

/// Replaces eliminated freedoms by what they were eliminated to, until none is left.
void substitute(Expression& e, const std::vector<Expression>& rows, const std::vector<char>& eliminated) {
  const auto n = static_cast<int>(eliminated.size());
  for (bool again = true; again;) {
    again = false;
    for (auto it = e.begin(); it != e.end() && it->first < n;) {
      if (!eliminated[static_cast<std::size_t>(it->first)]) {
        ++it;
        continue;
      }
      const auto [dof, factor] = *it;
      e.erase(it);
      for (const auto& [index, c] : rows[static_cast<std::size_t>(dof)]) e[index] += factor * c;
      again = true;
      break;
    }
  }
}

struct Weights {
  int nodal;      // freedoms of nodes
  double length;  // a rotation of 1 rad counts as this many metres
  double operator()(int dof, double c) const { return std::abs(c) / (dof < nodal && dof % 6 >= 3 ? length : 1); }
};

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
  std::vector<Expression> rows(size);
  std::vector<char> eliminated(size, 0);
  std::vector<int> order;
  for (std::size_t k = 0; k < m.constraints.size(); ++k) {
    Expression e;
    double scale = 0;
    for (const Term& t : m.constraints[k].form) {
      e[t.dof] += t.coefficient;
      scale = std::max(scale, weight(t.dof, t.coefficient));
    }
    e[n + static_cast<int>(k)] = -1;
    substitute(e, rows, eliminated);
    double largest = 0;
    for (auto it = e.begin(); it != e.end() && it->first < n;) {
      const double w = weight(it->first, it->second);
      largest = std::max(largest, w);
      it = w <= 1e-13 * scale ? e.erase(it) : std::next(it);  // what cancelled but for rounding
    }
    if (largest <= 1e-9 * scale) {
      Redundancy r{static_cast<int>(k), {}};
      for (const auto& [index, c] : e)
        if (index >= n && index != n + static_cast<int>(k) && std::abs(c) > 1e-12)
          r.implied_by.push_back({index - n, c});
      out.redundant.push_back(std::move(r));
      out.pivot.push_back(-1);
      continue;
    }
    int pivot = -1;
    if (const auto wanted = e.find(m.constraints[k].eliminates);
        wanted != e.end() && weight(wanted->first, wanted->second) >= 1e-6 * largest)
      pivot = wanted->first;
    const bool chosen = pivot >= 0;
    for (const auto& [dof, c] : e) {
      if (dof >= n || chosen) break;
      if (weight(dof, c) < 0.3 * largest) continue;
      if (pivot < 0 || uses[static_cast<std::size_t>(dof)] < uses[static_cast<std::size_t>(pivot)]) pivot = dof;
    }
    const double c = e[pivot];
    e.erase(pivot);
    for (auto& [index, value] : e) value /= -c;
    rows[static_cast<std::size_t>(pivot)] = std::move(e);
    eliminated[static_cast<std::size_t>(pivot)] = 1;
    order.push_back(pivot);
    out.pivot.push_back(pivot);
  }
  // An expression may name freedoms that were eliminated later; from the last to the first all become final.
  for (auto it = order.rbegin(); it != order.rend(); ++it)
    substitute(rows[static_cast<std::size_t>(*it)], rows, eliminated);

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
    for (const auto& [index, c] : rows[dof])
      if (index < n)
        out.T[dof].push_back({q_of_dof[static_cast<std::size_t>(index)], c});
      else
        out.G[dof].push_back({index - n, c});
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

VectorX Elimination::expand(const VectorX& q, const VectorX& values) const {
  VectorX u(static_cast<Eigen::Index>(T.size()));
  for (std::size_t dof = 0; dof < T.size(); ++dof) {
    double sum = 0;
    for (const Term& t : T[dof]) sum += t.coefficient * q(t.dof);
    for (const Term& t : G[dof]) sum += t.coefficient * values(t.dof);
    u(static_cast<Eigen::Index>(dof)) = sum;
  }
  return u;
}

VectorX Elimination::reduce(const VectorX& f) const {
  VectorX r = VectorX::Zero(independent);
  for (std::size_t dof = 0; dof < T.size(); ++dof)
    for (const Term& t : T[dof]) r(t.dof) += t.coefficient * f(static_cast<Eigen::Index>(dof));
  return r;
}

}  // namespace deflect::frame
