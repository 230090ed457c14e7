#include "msa/frame/structure/extended_structure.h"
#include "msa/base/index.h"

#include <algorithm>
#include <array>
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

using Extended3 = Eigen::Matrix<Extended, 3, 1>;

Extended3 position(const Model& m, int node) { return nth(m.nodes, node).position.cast<Extended>(); }

/// Along the beams of these axes that follow each other from the node on, to the end of the last; zero if there is
/// none.
Extended3 line_from(const Model& m, int node, const Matrix3& R) {
  int here = node;
  const Beam* last = nullptr;
  for (const Beam* beam = nullptr;; last = beam) {
    beam = nullptr;
    for (const Beam& b : m.beams)
      if ((b.a == here || b.b == here) && &b != last && b.R_WM == R) beam = &b;
    if (!beam) return position(m, here) - position(m, node);
    here = beam->a == here ? beam->b : beam->a;
  }
}

/// Axes of a connection. Those of a member are set right about the line between its ends: it may spin about that by any
/// angle and strain nothing.
std::array<Extended3, 3> exact_axes(const Model& m, const Connection& c, std::size_t half) {
  const Matrix3& R = c.axes[half];
  std::array<Extended3, 3> out{R.col(0).cast<Extended>(), R.col(1).cast<Extended>(), R.col(2).cast<Extended>()};
  const Extended3 line = line_from(m, c.b, R);
  const Extended squared = line.dot(line);
  if (squared == 0) return out;
  for (Extended3* across : {&out[1], &out[2]}) *across -= line * (line.dot(*across) / squared);
  out[0] = line * (line.dot(out[0]) / squared);
  return out;
}

using ExtendedForm = std::vector<std::pair<int, Extended>>;

void set(ExtendedForm& form, int dof, const Extended& value) {
  const auto at = std::find_if(form.begin(), form.end(), [&](const auto& term) { return term.first == dof; });
  if (at != form.end())
    at->second = value;
  else if (value != 0)
    form.emplace_back(dof, value);
}

/// The part of a node in the motion of two bodies at p beside each other, times factor.
void set_part(ExtendedForm& form, const Model& m, int node, const Extended3& p, const Extended3& axis, bool rotation,
              int factor) {
  const Extended3 arm = p - position(m, node), turning = arm.cross(axis);
  for (int i = 0; i < 3; ++i) {
    set(form, 6 * node + (rotation ? 3 : 0) + i, factor * axis(i));
    if (!rotation) set(form, 6 * node + 3 + i, factor * turning(i));
  }
}

/// Constraints and springs' elongations with what doubles round in them: arms, which are differences of positions and
/// add up round a rigid body, and axes of members.
struct ExactForms {
  std::vector<ExtendedForm> constraints, elongations;

  explicit ExactForms(const Model& m) {
    std::vector<LinearForm> forms;
    for (const Constraint& c : m.constraints) forms.push_back(c.form);
    constraints = extended(forms);
    forms.clear();
    for (const Spring& s : m.springs) forms.push_back(s.elongation);
    elongations = extended(forms);
    for (const Connection& c : m.connections)
      if (c.a >= 0) set_connection(m, c);
    for (const Beam& beam : m.beams)
      for (int i = 0; beam.relative >= 0 && i < 3; ++i) {
        const Extended3 axis = Vector3(Vector3::Unit(i)).cast<Extended>();
        set_part(nth(constraints, beam.defined_by + i), m, beam.a, position(m, beam.b), axis, false, -1);
      }
  }

 private:
  void set_connection(const Model& m, const Connection& c) {
    const std::array<std::array<Extended3, 3>, 2> axes{exact_axes(m, c, 0), exact_axes(m, c, 1)};
    for (int i = 0; i < 6; ++i) {
      const int spring = nth(c.spring, i);
      const int constraint = spring < 0 ? nth(c.constraint, i) : nth(m.springs, spring).defined_by;
      if (constraint < 0 && spring < 0) continue;
      ExtendedForm& form = constraint >= 0 ? nth(constraints, constraint) : nth(elongations, spring);
      const Extended3 p = c.p.cast<Extended>(), &axis = nth(nth(axes, i / 3), i % 3);
      set_part(form, m, c.b, p, axis, i >= 3, 1);
      set_part(form, m, c.a, p, axis, i >= 3, -1);
    }
  }
};

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
  const ExactForms exact(m);
  for (int pass = 0; pass < 2; ++pass) eliminate_again(exact.constraints, e);
  for (const Beam& beam : m.beams)
    add({strains_of(beam), {}, local_stiffness(beam.rigidity, beam.length).bottomRightCorner<6, 6>()});
  for (std::size_t s = 0; s < m.springs.size(); ++s)
    add({{exact.elongations[s]}, {}, MatrixX::Constant(1, 1, tangents(as_index(s)))});
  factor();
}

/// A step of Newton's method for T and G, whose rounding a nearly singular system of constraints has amplified: with
/// constraints C u = b and u = T q + G b, what C T leaves is taken off by G.
void ExtendedStructure::eliminate_again(const std::vector<Form>& constraints, const Elimination& e) {
  std::vector<Form> left_of_T, left_of_G;
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    left_of_T.emplace_back(), left_of_G.emplace_back();
    if (e.pivot[k] < 0) continue;  // redundant
    left_of_T[k] = through(constraints[k], T_);
    left_of_G[k] = through(constraints[k], G_);
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

/// Column by column, each from those before it. Legs meet in the platform alone: most of L is zero.
void ExtendedStructure::factor() {
  const Eigen::Index n = L_.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    const Extended whole = L_(j, j);
    for (Eigen::Index k = 0; k < j; ++k) {
      if (L_(j, k) == 0) continue;
      const Extended scaled = L_(j, k) * L_(k, k);
      for (Eigen::Index i = j; i < n; ++i)
        if (L_(i, k) != 0) L_(i, j) -= scaled * L_(i, k);
    }
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
