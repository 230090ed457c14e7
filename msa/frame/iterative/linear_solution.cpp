#include "msa/frame/iterative/linear_solution.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

#include "msa/base/index.h"
#include "msa/frame/iterative/conjugate_gradients.h"
#include "msa/frame/structure/relative.h"
#include "msa/frame/structure/standing.h"

namespace deflect::frame {
namespace {

constexpr int many_freedoms = 20000, narrow = 50, many_cases = 4;
constexpr double poor = 1e-9;  // reciprocal condition below which rounding may eat what is asked
constexpr double most_rounding = 100, half_last_place = 1.1e-16;

VectorX spring_tangents(const Model& m) {
  VectorX k(std::ssize(m.springs));
  for (std::size_t s = 0; s < m.springs.size(); ++s) k(as_index(s)) = tangent(m.springs[s].law, 0);
  return k;
}

/// Entries 0, 1 and −1 only: turning by it rounds nothing.
bool is_exact(const Matrix3& R) { return (R.array() == 0 || R.array() == 1 || R.array() == -1).all(); }

/// Half the last place of each, with signs as they come.
VectorX last_places(VectorX v) {
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    const auto hash = static_cast<std::uint32_t>(i) * 2654435761u;
    v(i) *= hash >> 31 ? half_last_place : -half_last_place;
  }
  return v;
}

/// What rounding leaves of the sums of forces at a freedom: half the last place of what is added there, with signs as
/// they come. Displacements of a beam's ends are subtracted before they are multiplied, turned axes round first.
VectorX rounding_of_forces(const Model& m, const VectorX& u, const VectorX& tangents) {
  VectorX sum = VectorX::Zero(u.size());
  for (const Beam& beam : m.beams) {
    const Vector12 d_W = end_displacements(beam, u);
    Vector12 d;
    for (int i = 0; i < 12; i += 3) d.segment<3>(i) = beam.R_WM.transpose() * d_W.segment<3>(i);
    Vector12 parts = d.cwiseAbs();
    if (is_exact(beam.R_WM)) {
      parts.head<4>().setZero();
      parts.segment<4>(6) = (d.segment<4>(6) - d.head<4>()).cwiseAbs();
    }
    const Vector12 f = local_stiffness(beam.rigidity, beam.length).cwiseAbs() * parts;
    for (int i = 0; i < 12; i += 3)
      sum.segment<3>(6 * (i < 6 ? beam.a : beam.b) + i % 6) += beam.R_WM.cwiseAbs() * f.segment<3>(i);
  }
  for (std::size_t s = 0; s < m.springs.size(); ++s)
    for (const Term& t : m.springs[s].elongation)
      for (const Term& other : m.springs[s].elongation)
        sum(t.dof) += tangents(as_index(s)) * std::abs(t.coefficient * other.coefficient * u(other.dof));
  return last_places(sum);
}

/// One way's answer, or why there is none.
struct Attempt {
  bool answered = false;
  std::string why;
  LinearSolution solution;
};

class Iterative {
 public:
  Iterative(const Model& m, const EquationOptions& options) : m_(m), options_(options) {}

  Attempt operator()(const MatrixX& loads, const MatrixX& values) {
    Attempt out;
    if (m_.dofs() < many_freedoms && automatic())
      return refused(out, fmt::format("{} freedoms, fewer than {}", m_.dofs(), many_freedoms));
    if (loads.cols() > many_cases && automatic())
      return refused(out, fmt::format("{} load cases share one factorisation", loads.cols()));
    if (wants_relative_motion(m_)) return refused(out, "parts whose stiffnesses differ by more than 1e5");
    if (std::string body = not_proved_standing(m_); !body.empty())
      return refused(out, fmt::format("not proved to stand: {}", body));
    LinearSolution& s = out.solution;
    s.elimination = eliminate(m_);
    s.summary.freedoms = s.elimination.independent;
    for (Eigen::Index c = 0; c < values.cols(); ++c) check_consistent(m_, s.elimination, values.col(c));
    if (s.elimination.independent == 0) return refused(out, "nothing is free to move");
    if (s.elimination.independent < many_freedoms && automatic())
      return refused(out, fmt::format("{} free freedoms, fewer than {}", s.elimination.independent, many_freedoms));
    const VectorX tangents = spring_tangents(m_);
    std::optional<IncompleteCholesky> factor;
    {
      const Assembly assembly(m_, s.elimination, options_.threads);
      NodeBlocks blocks = node_blocks(s.elimination, assembly.pattern(), assembly.values(tangents));
      if (blocks.widest_level <= narrow && automatic())
        return refused(out, fmt::format("narrow, at most {} nodes side by side", blocks.widest_level));
      factor.emplace(std::move(blocks));
    }
    if (!factor->positive()) return refused(out, "the incomplete factor is not positive");
    s.u.resize(m_.dofs(), loads.cols());
    s.summary.error_bound = 0;
    for (Eigen::Index c = 0; c < loads.cols(); ++c) {
      std::string failure = solve(*factor, loads.col(c), values.col(c), tangents, s, c);
      if (!failure.empty()) return refused(out, std::move(failure));
    }
    s.notes = redundancies(m_, s.elimination);
    out.answered = true;
    return out;
  }

 private:
  bool automatic() const { return options_.solver == Equations::automatic; }

  static Attempt& refused(Attempt& out, std::string why) {
    out.why = std::move(why);
    return out;
  }

  /// One load case; what hindered it, or nothing.
  std::string solve(const IncompleteCholesky& factor, const VectorX& load, const VectorX& values,
                    const VectorX& tangents, LinearSolution& s, Eigen::Index column) const {
    const Elimination& e = s.elimination;
    VectorX q = VectorX::Zero(e.independent), u = e.expand(q, values);
    VectorX r = factor.forces_inside(e.reduce(load - tangent_forces(m_, u, tangents)));
    if (r.isZero(0)) {
      s.u.col(column) = u;
      return "";
    }
    GradientOptions options;
    options.error = options_.error / 2;
    options.threads = options_.threads;
    if (options_.progress)
      options.progress = [&](double share) {
        options_.progress((static_cast<double>(column) + share) / static_cast<double>(s.u.cols()));
      };
    double bound = 0, rounding = 0;
    for (int pass = 0; pass < 2; ++pass) {
      const GradientSummary g = conjugate_gradients(factor, r, options);
      s.summary.iterations += g.iterations;
      const double condition = g.smallest / g.largest * factor.smallest_pivot();
      if (!(condition > poor)) return fmt::format("ill-conditioned, reciprocal condition {:.1e}", condition);
      if (!g.converged) return fmt::format("an error of {:.1e} after {} iterations", g.error, g.iterations);
      q += factor.motion_outside(g.x);
      u = e.expand(q, values);
      if (pass == 0) options.size = g.size, options.smallest = g.smallest, options.progress = {};
      if (pass == 1) {  // of the correction: what is left of it, and the last places that it rounded
        bound = g.error + rounding + energy_norm(last_places(u), tangents) / options.size;
        break;
      }
      const double per_force = 2 / std::sqrt(g.smallest) / g.size;
      r = factor.forces_inside(e.reduce(load - tangent_forces(m_, u, tangents)));
      rounding = per_force * factor.forces_inside(e.reduce(rounding_of_forces(m_, u, tangents))).norm();
      bound = per_force * r.norm() + rounding;
      if (per_force * r.norm() <= options_.error) break;
    }
    if (!(bound <= most_rounding * options_.error)) return fmt::format("the error bound stays at {:.1e}", bound);
    s.summary.error_bound = std::max(*s.summary.error_bound, bound);
    s.u.col(column) = u;
    return "";
  }

  double energy_norm(const VectorX& u, const VectorX& tangents) const {
    return std::sqrt(std::max(0.0, u.dot(tangent_forces(m_, u, tangents))));
  }

  const Model& m_;
  const EquationOptions& options_;
};

LinearSolution direct(Model model, const MatrixX& loads, const MatrixX& values) {
  LinearSolution s;
  Solver solver(std::move(model));
  s.fine = solver.linear(spring_tangents(solver.model()), loads, values);
  s.u = s.fine.cast<double>();
  s.notes = solver.notes();
  s.summary.solver = "direct";
  s.summary.freedoms = solver.elimination().independent;
  std::tie(s.model, s.elimination) = std::move(solver).structure();
  return s;
}

}  // namespace

LinearSolution solve_linear(Model model, const MatrixX& loads, const MatrixX& values, const EquationOptions& options) {
  std::string why = "as asked for";
  if (options.solver != Equations::direct) {
    Attempt attempt = Iterative(model, options)(loads, values);
    if (attempt.answered) {
      LinearSolution& s = attempt.solution;
      s.fine = s.u.cast<Extended>();
      s.model = std::move(model);
      s.summary.solver = "iterative";
      if (options.solver == Equations::automatic)
        why = fmt::format("{} free freedoms, {} or more", s.summary.freedoms, many_freedoms);
      s.summary.why = why;
      return std::move(s);
    }
    why = (options.solver == Equations::iterative ? "not iteratively: " : "") + attempt.why;
  }
  LinearSolution s = direct(std::move(model), loads, values);
  s.summary.why = why;
  return s;
}

}  // namespace deflect::frame
