#include "msa/frame/structure/extended_structure.h"
#include "msa/base/index.h"

#include <map>

namespace deflect::frame {
namespace {

constexpr double lost_pivot = 1e-28;  // of the diagonal that it is left of
constexpr double no_load = 1e-12;     // of all loads

Extended entry(const Matrix3& M, int i, int j) { return M(i, j); }

/// [δ; θ] of end b beside the body of end a, in the beam's axes: row by row over the structure's freedoms.
std::vector<std::vector<std::pair<int, Extended>>> strains_of(const Beam& beam) {
  std::vector<std::vector<std::pair<int, Extended>>> rows(6);
  const Matrix3& R = beam.R_WM;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Extended along = entry(R, j, i);
      if (beam.relative >= 0) {
        nth(rows, i).emplace_back(beam.relative + j, along);
        nth(rows, 3 + i).emplace_back(beam.relative + 3 + j, along);
        continue;
      }
      nth(rows, i).emplace_back(6 * beam.b + j, along);
      nth(rows, i).emplace_back(6 * beam.a + j, -along);
      nth(rows, 3 + i).emplace_back(6 * beam.b + 3 + j, along);
      nth(rows, 3 + i).emplace_back(6 * beam.a + 3 + j, -along);
      // −(θ_a × x)_j along axis i, x = L R e_x: the cross product of both with θ_a's coefficient k.
      for (int k = 0; k < 3; ++k) {
        if (k == j) continue;
        const int l = 3 - j - k;  // (θ × x)_j = ± θ_k x_l
        const Extended x = Extended(beam.length) * entry(R, l, 0);
        const bool plus = (j + 1) % 3 == k;
        nth(rows, i).emplace_back(6 * beam.a + 3 + k, plus ? -along * x : along * x);
      }
    }
  return rows;
}

std::vector<std::vector<std::pair<int, Extended>>> extended(const std::vector<LinearForm>& forms) {
  std::vector<std::vector<std::pair<int, Extended>>> out;
  for (const LinearForm& form : forms) {
    out.emplace_back();
    for (const Term& t : form) out.back().emplace_back(t.dof, t.coefficient);
  }
  return out;
}

/// What forms of the freedoms are over others, of which the freedoms are the forms `by`.
std::vector<std::pair<int, Extended>> through(const std::vector<std::pair<int, Extended>>& form,
                                              const std::vector<std::vector<std::pair<int, Extended>>>& by) {
  std::map<int, Extended> sums;
  for (const auto& [dof, c] : form)
    for (const auto& [i, b] : nth(by, dof)) sums[i] += c * b;
  return {sums.begin(), sums.end()};
}

Extended at(const std::vector<std::pair<int, Extended>>& form, const ExtendedVector& x) {
  Extended sum = 0;
  for (const auto& [i, c] : form) sum += c * x(i);
  return sum;
}

}  // namespace

ExtendedStructure::ExtendedStructure(const Model& m, const Elimination& e, const VectorX& tangents)
    : T_(extended(e.T)), G_(extended(e.G)), L_(ExtendedMatrix::Zero(e.independent, e.independent)) {
  for (int pass = 0; pass < 2; ++pass) eliminate_again(m, e);
  for (const Beam& beam : m.beams)
    add({strains_of(beam), {}, local_stiffness(beam.rigidity, beam.length).bottomRightCorner<6, 6>()});
  for (std::size_t s = 0; s < m.springs.size(); ++s) {
    Form form;
    for (const Term& t : m.springs[s].elongation) form.emplace_back(t.dof, t.coefficient);
    add({{form}, {}, MatrixX::Constant(1, 1, tangents(as_index(s)))});
  }
  factor();
}

/// A step of Newton's method for T and G, whose rounding a nearly singular system of constraints has amplified: with
/// constraints C u = b and u = T q + G b, what C T leaves is taken off by G.
void ExtendedStructure::eliminate_again(const Model& m, const Elimination& e) {
  std::vector<Form> left_of_T, left_of_G;
  for (std::size_t k = 0; k < m.constraints.size(); ++k) {
    left_of_T.emplace_back(), left_of_G.emplace_back();
    if (e.pivot[k] < 0) continue;  // redundant
    Form form;
    for (const Term& t : m.constraints[k].form) form.emplace_back(t.dof, t.coefficient);
    left_of_T[k] = through(form, T_);
    left_of_G[k] = through(form, G_);
    left_of_G[k].emplace_back(static_cast<int>(k), -1);
  }
  const auto take = [](Form& from, const Form& more) {
    std::map<int, Extended> sums(from.begin(), from.end());
    for (const auto& [i, c] : more) sums[i] -= c;
    from.assign(sums.begin(), sums.end());
  };
  const std::vector<Form> G = G_;
  for (std::size_t dof = 0; dof < T_.size(); ++dof) {
    if (G[dof].empty()) continue;
    take(T_[dof], through(G[dof], left_of_T));
    take(G_[dof], through(G[dof], left_of_G));
  }
}

ExtendedVector ExtendedStructure::expand(const ExtendedVector& q, const VectorX& values) const {
  ExtendedVector u(std::ssize(T_));
  for (std::size_t dof = 0; dof < T_.size(); ++dof) {
    Extended sum = at(T_[dof], q);
    for (const auto& [k, c] : G_[dof]) sum += c * Extended(values(k));
    u(as_index(dof)) = sum;
  }
  return u;
}

void ExtendedStructure::add(Part part) {
  for (const Form& of_u : part.of_u) part.of_q.push_back(through(of_u, T_));
  for (Eigen::Index i = 0; i < part.k.rows(); ++i)
    for (Eigen::Index j = 0; j < part.k.cols(); ++j) {
      if (part.k(i, j) == 0) continue;
      for (const auto& [p, a] : nth(part.of_q, i))
        for (const auto& [q, b] : nth(part.of_q, j))
          if (p >= q) L_(p, q) += a * Extended(part.k(i, j)) * b;
    }
  parts_.push_back(std::move(part));
}

/// Column by column, each from those before it.
void ExtendedStructure::factor() {
  const Eigen::Index n = L_.rows();
  ExtendedVector scaled(n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Extended whole = L_(j, j);
    for (Eigen::Index k = 0; k < j; ++k) scaled(k) = L_(j, k) * L_(k, k);
    for (Eigen::Index k = 0; k < j; ++k) L_.col(j).tail(n - j) -= scaled(k) * L_.col(k).tail(n - j);
    if (L_(j, j) > Extended(lost_pivot) * whole)
      L_.col(j).tail(n - j - 1) /= L_(j, j);
    else
      L_.col(j).tail(n - j).setZero();
  }
}

std::optional<ExtendedVector> ExtendedStructure::solve(const VectorX& load, const VectorX& values) const {
  const Eigen::Index n = L_.rows();
  const ExtendedVector u0 = expand(ExtendedVector::Zero(n), values);
  ExtendedVector q = ExtendedVector::Zero(n);
  for (std::size_t dof = 0; dof < T_.size(); ++dof)
    for (const auto& [i, c] : T_[dof]) q(i) += c * Extended(load(as_index(dof)));
  for (const Part& part : parts_)
    for (Eigen::Index j = 0; j < part.k.cols(); ++j) {
      const Extended strain = at(nth(part.of_u, j), u0);
      if (strain == 0) continue;
      for (Eigen::Index i = 0; i < part.k.rows(); ++i)
        for (const auto& [p, a] : nth(part.of_q, i)) q(p) -= a * Extended(part.k(i, j)) * strain;
    }
  // In doubles: Eigen takes abs(int) for numbers of this type.
  const Extended drives = no_load * q.cast<double>().cwiseAbs().sum();
  for (Eigen::Index j = 0; j < n; ++j) {
    if (L_(j, j) > 0)
      q.tail(n - j - 1) -= q(j) * L_.col(j).tail(n - j - 1);
    else if (q(j) > drives || -q(j) > drives)
      return std::nullopt;
    else
      q(j) = 0;
  }
  for (Eigen::Index j = n; j-- > 0;) {
    if (!(L_(j, j) > 0)) continue;
    q(j) /= L_(j, j);
    for (Eigen::Index i = j + 1; i < n; ++i) q(j) -= L_(i, j) * q(i);
  }
  return expand(q, values);
}

}  // namespace deflect::frame
