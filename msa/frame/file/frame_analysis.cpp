#include "msa/frame/file/frame_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/frame/iterative/linear_solution.h"

namespace deflect::frame {
namespace {

constexpr double cancelling = 1e-7;  // see FrameChecks

/// Unsigned sums of a beam's stiffness times its displacements, local axes: the size of what may cancel.
struct Gross {
  double force = 0, energy = 0;
  void add(const Beam& beam, const Vector12& d_W, double strain) {
    Vector12 d;
    for (int i = 0; i < 12; i += 3) d.segment<3>(i) = (beam.R_WM.transpose() * d_W.segment<3>(i)).cwiseAbs();
    const Vector12 f = local_stiffness(beam.rigidity, beam.length).cwiseAbs() * d;
    force = std::max({force, f.segment<3>(0).maxCoeff(), f.segment<3>(6).maxCoeff()});
    energy += d.dot(f) + beam.rigidity.EA * strain * strain * beam.length;
  }
};

/// A case between its solution and its checks.
struct Work {
  CaseLoad load;
  ExtendedVector fine;  // u, for differences
  VectorX lambda;
  Gross gross;
  double heat = 0, clamped = 0;  // Σ N ε L; what line loads store in clamped elements
};

void find_member_forces(CaseResult& r, const FrameModel& m, Work& work) {
  for (std::size_t member = 0; member + 1 < m.first_element.size(); ++member) {
    MemberForces out;
    double from_start = 0;
    for (int e = m.first_element[member]; e < m.first_element[member + 1]; ++e) {
      const auto k = as_size(e);
      const Beam& beam = m.model.beams[k];
      const ElementLoad& load = work.load.elements[k];
      const Vector12 d = end_displacements(beam, work.fine), f = end_forces(beam, d, load);
      r.end_forces.push_back(f);
      work.gross.add(beam, d, load.strain);
      work.heat += (f(6) - f(0)) / 2 * load.strain * beam.length;  // the mean of N
      work.clamped += clamped_energy(beam.rigidity, beam.length, load);
      out.energy += strain_energy(beam, d, load);
      const auto stationary = stationary_moments(f, load, beam.length);
      for (const double x : {0.0, stationary[0], stationary[1], beam.length}) {
        if (x < 0) continue;
        const Vector6 s = section_forces(f, load, x);
        if (x == 0 && e == m.first_element[member]) out.start = s;
        if (x == beam.length) out.end = s;
        keep_larger(out.My, s(4), from_start + x);
        keep_larger(out.Mz, s(5), from_start + x);
      }
      from_start += beam.length;
    }
    r.members.push_back(out);
  }
}

void find_reactions(CaseResult& r, const FrameDescription& f, const FrameModel& m, const Work& work) {
  const VectorX& lambda = work.lambda;
  for (const std::array<int, 6>& constraints : m.support_constraint) {
    r.reactions.push_back(Vector6::Zero());
    for (std::size_t i = 0; i < 6; ++i)
      if (constraints[i] >= 0) r.reactions.back()(as_index(i)) = lambda(constraints[i]);
  }
  for (const int constraint : m.constraint) r.constraints.push_back(lambda(constraint));
  for (std::size_t k = 0; k < f.springs.size(); ++k) {
    r.springs.push_back(Vector6::Zero());
    for (std::size_t i = 0; i < 6; ++i) {
      if (m.spring[k][i] < 0) continue;
      const Spring& spring = nth(m.model.springs, m.spring[k][i]);
      r.springs.back()(as_index(i)) = -force(spring.law, evaluate(spring.elongation, work.fine));
    }
  }
}

/// Resultant about the first node of loads, constraints and springs; those between nodes have none.
double equilibrium(const FrameModel& m, const Work& work) {
  VectorX external = padded(work.load.forces, m.model.dofs()), unsigned_sum = external.cwiseAbs();
  const auto add = [&](const LinearForm& form, double along) {
    for (const Term& t : form) {
      external(t.dof) += t.coefficient * along;
      unsigned_sum(t.dof) += std::abs(t.coefficient * along);
    }
  };
  for (std::size_t k = 0; k < m.model.constraints.size(); ++k)
    add(m.model.constraints[k].form, work.lambda(as_index(k)));
  for (const Spring& spring : m.model.springs)
    add(spring.elongation, -force(spring.law, evaluate(spring.elongation, work.fine)));
  Vector3 resultant = Vector3::Zero(), moment = Vector3::Zero();
  double forces = cancelling * work.gross.force, moments = 0;
  for (std::size_t i = 0; i < m.model.nodes.size(); ++i) {
    const Vector6 wrench = external.segment<6>(as_index(6 * i));
    const Vector3 arm = m.model.nodes[i].position - m.model.nodes.front().position;
    resultant += wrench.head<3>();
    moment += wrench.tail<3>() + arm.cross(wrench.head<3>());
    forces += unsigned_sum.segment<3>(as_index(6 * i)).sum();
    moments += unsigned_sum.segment<3>(as_index(6 * i + 3)).sum();
  }
  moments += forces * characteristic_length(m.model);
  return std::max(ratio(resultant.norm(), forces), ratio(moment.norm(), moments));
}

void check(CaseResult& r, const FrameModel& m, const Elimination& e, const Work& work) {
  const VectorX load = padded(work.load.forces, m.model.dofs());
  const VectorX pulls = forces_with(m.model, work.fine, spring_forces(m.model, work.fine));
  const VectorX free = e.reduce(load), held = e.reduce(pulls);
  r.checks.residual = ratio(largest(free - held), largest(load) + largest(pulls) + cancelling * work.gross.force);
  r.checks.equilibrium = equilibrium(m, work);

  const VectorX forces = work.load.forces - work.load.thermal;
  const double loads = forces.dot(r.u.head(forces.size())),
               supports = work.lambda.head(work.load.values.size()).dot(work.load.values);
  const double difference = 2 * (r.energy - work.clamped) - loads - supports + work.heat;
  r.checks.energy = ratio(std::abs(difference), 2 * r.energy + std::abs(loads) + std::abs(supports) +
                                                    std::abs(work.heat) + cancelling * work.gross.energy);
}

/// What loads would do on the largest displacements: where a load stands on supports, rounding is all that it works on.
double largest_work(const FrameModel& m, const VectorX& forces, const VectorX& u) {
  Eigen::Vector2d force = Eigen::Vector2d::Zero(), motion = force;  // translations, rotations
  for (Eigen::Index i = 0; i < std::min(as_index(6 * m.model.nodes.size()), forces.size()); ++i) {
    const Eigen::Index kind = i % 6 < 3 ? 0 : 1;
    force(kind) = std::max(force(kind), std::abs(forces(i)));
    motion(kind) = std::max(motion(kind), std::abs(u(i)));
  }
  return force.dot(motion);
}

double reciprocity(const FrameModel& m, const std::vector<CaseResult>& cases, const std::vector<Work>& work) {
  double worst = 0;
  for (std::size_t i = 0; i < cases.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      double difference = 0, sum = cancelling * std::sqrt(work[i].gross.energy * work[j].gross.energy);
      sum += cancelling *
             (largest_work(m, work[i].load.forces, cases[j].u) + largest_work(m, work[j].load.forces, cases[i].u));
      const auto add = [&](const VectorX& a, const VectorX& b, double sign) {
        const auto n = std::min(a.size(), b.size());
        difference += sign * a.head(n).dot(b.head(n));
        sum += a.head(n).cwiseAbs().dot(b.head(n).cwiseAbs());
      };
      add(work[i].load.forces, cases[j].u, 1);
      add(work[i].lambda, work[j].load.values, 1);
      add(work[j].load.forces, cases[i].u, -1);
      add(work[j].lambda, work[i].load.values, -1);
      worst = std::max(worst, ratio(std::abs(difference), sum));
    }
  return worst;
}

VectorX elongations(const Model& m, const ExtendedVector& u) {
  VectorX out(std::ssize(m.springs));
  for (std::size_t i = 0; i < m.springs.size(); ++i) out(as_index(i)) = evaluate(m.springs[i].elongation, u);
  return out;
}

void analyse_linear(const FrameDescription& f, const EquationOptions& options, FrameResult& out) {
  FrameModel& m = out.structure;
  std::vector<Work> work;
  for (const auto& [name, load] : f.loads) work.push_back({load_of(f, m, name, load), {}, {}, {}, 0, 0});
  const auto columns = std::ssize(work);
  MatrixX loads(m.model.dofs(), columns), values(std::ssize(m.model.constraints), columns);
  for (Eigen::Index c = 0; c < columns; ++c) {
    loads.col(c) = nth(work, c).load.forces;
    values.col(c) = nth(work, c).load.values;
  }

  LinearSolution solution = solve_linear(std::move(m.model), loads, values, options);
  m.model = std::move(solution.model);  // with what the solver added to it
  out.notes = std::move(solution.notes);
  out.equations = std::move(solution.summary);
  const Elimination& elimination = solution.elimination;

  for (std::size_t c = 0; c < work.size(); ++c) {
    CaseResult r;
    r.name = f.loads[c].first;
    r.u = solution.u.col(as_index(c));
    for (std::size_t i = 0; i < f.nodes.size(); ++i) r.displacements.push_back(r.u.segment<6>(as_index(6 * i)));
    work[c].fine = solution.fine.col(as_index(c));
    work[c].lambda = constraint_forces(m.model, elimination, work[c].fine, padded(work[c].load.forces, m.model.dofs()));
    find_reactions(r, f, m, work[c]);
    find_member_forces(r, m, work[c]);
    find_energies(r, f, m, elongations(m.model, work[c].fine));
    check(r, m, elimination, work[c]);
    r.loads = work[c].load.elements;
    out.cases.push_back(std::move(r));
  }
  out.reciprocity = reciprocity(m, out.cases, work);
}

}  // namespace

void keep_larger(LargestMoment& largest_so_far, double value, double x) {
  if (std::abs(value) > std::abs(largest_so_far.value) * (1 + 1e-12)) largest_so_far = {value, x};
}

void find_energies(CaseResult& r, const FrameDescription& f, const FrameModel& m, const VectorX& elongations) {
  NameIndex sections(f.sections);
  std::vector<double> by_section(f.sections.size(), 0), by_spring(f.springs.size(), 0);
  for (std::size_t i = 0; i < f.members.size(); ++i)
    nth(by_section, sections.find(f.members[i].second.section)) += r.members[i].energy;
  for (std::size_t i = 0; i < f.springs.size(); ++i)
    for (const int s : m.spring[i])
      if (s >= 0) by_spring[i] += energy(nth(m.model.springs, s).law, elongations(s));
  for (std::size_t i = 0; i < by_section.size(); ++i) r.energies.emplace_back(f.sections[i].first, by_section[i]);
  for (std::size_t i = 0; i < by_spring.size(); ++i) r.energies.emplace_back(f.springs[i].first, by_spring[i]);
  for (const auto& [group, part] : r.energies) r.energy += part;
  std::stable_sort(r.energies.begin(), r.energies.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
}

FrameResult analyse(const FrameDescription& f, const FrameOptions& options) {
  FrameResult out;
  out.name = f.name;
  out.geometry = f.geometry;
  out.structure = build_frame(f, options.division);
  if (f.geometry == Geometry::linear)
    analyse_linear(f, options.equations, out);
  else
    analyse_geometric(f, out);
  return out;
}

std::string failed_check(const FrameResult& result) {
  const auto fails = [](double value) { return !(value <= check_tolerance); };
  for (const CaseResult& c : result.cases)
    if (!c.path.converged || !c.path.stable) return fmt::format("load case '{}': {}", c.name, c.path.message);
  for (const CaseResult& c : result.cases)
    for (const auto& [what, value] : {std::pair{"residual", c.checks.residual},
                                      {"equilibrium of loads and reactions", c.checks.equilibrium},
                                      {"work of the loads against strain energy", c.checks.energy}})
      if (fails(value)) return fmt::format("load case '{}': {} fails by {:.1e}", c.name, what, value);
  if (fails(result.reciprocity))
    return fmt::format("reciprocity of the load cases fails by {:.1e}", result.reciprocity);
  return "";
}

}  // namespace deflect::frame
