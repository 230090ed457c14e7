#include "msa/frame/file/frame_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/frame/structure/relative.h"

namespace deflect::frame {
namespace {

constexpr double of_moved_supports = 1e-8;  // see FrameChecks

/// Unsigned sums of a beam's stiffness times its displacements, local axes: the size of what may cancel. With moved
/// supports a small part of the same with the motion that a beam makes as a rigid body.
struct Gross {
  double force = 0, energy = 0;
  double carried = 0;  // how much of the motion moved supports can have brought, 0 … 1
  void add(const Beam& beam, const Vector12& d_W, const ExtendedVector& u, double strain) {
    add(beam, d_W, 1);
    Vector12 whole;
    whole << u.segment<6>(6 * beam.a).cast<double>(), u.segment<6>(6 * beam.b).cast<double>();
    add(beam, carried * whole, of_moved_supports / cancelling);
    energy += beam.rigidity.EA * strain * strain * beam.length;
  }

 private:
  void add(const Beam& beam, const Vector12& d_W, double share) {
    Vector12 d;
    for (int i = 0; i < 12; i += 3) d.segment<3>(i) = (beam.R_WM.transpose() * d_W.segment<3>(i)).cwiseAbs();
    const Vector12 f = share * (local_stiffness(beam.rigidity, beam.length).cwiseAbs() * d);
    force = std::max({force, f.segment<3>(0).maxCoeff(), f.segment<3>(6).maxCoeff()});
    energy += d.dot(f);
  }
};

/// A case between its solution and its checks.
struct Work {
  const CaseLoad& load;
  const ExtendedVector& fine;  // u, for differences
  VectorX pulls;               // of springs
  VectorX lambda = {};
  Gross gross = {};
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
      work.gross.add(beam, d, work.fine, load.strain);
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

/// Gross::carried. Rotations times the frame's size.
double carried_by_supports(const Model& m, const Work& work) {
  const double length = characteristic_length(m);
  const auto nodal = as_index(6 * m.nodes.size());
  const auto size = [&](Eigen::Index dof, double motion) {
    return std::abs(motion) * (dof < nodal && dof % 6 > 2 ? length : 1);
  };
  double moved = 0, motion = 0;
  for (Eigen::Index k = 0; k < work.load.values.size(); ++k)
    if (const double value = work.load.values(k); value != 0)
      moved = std::max(moved, size(nth(m.constraints, k).form.front().dof, value));
  for (Eigen::Index i = 0; i < nodal; ++i) motion = std::max(motion, size(i, static_cast<double>(work.fine(i))));
  return motion > 0 ? std::min(1.0, moved / motion) : 0;
}

/// What a support or spring does to its node.
Vector6 on_node(const Holding& holding, const Work& work) {
  Vector6 wrench = Vector6::Zero();
  for (std::size_t i = 0; i < 6; ++i)
    if (holding.constraint[i] >= 0) wrench(as_index(i)) = work.lambda(holding.constraint[i]);
  for (const auto& [freedom, spring] : holding.direct) wrench(freedom) -= work.pulls(spring);
  return wrench;
}

void find_reactions(CaseResult& r, const FrameModel& m, const Work& work) {
  for (const Holding& support : m.supports) r.reactions.push_back(on_node(support, work));
  for (const int constraint : m.constraint) r.constraints.push_back(work.lambda(constraint));
  for (const Holding& spring : m.springs) r.springs.push_back(on_node(spring, work));
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
  for (std::size_t s = 0; s < m.model.springs.size(); ++s) add(m.model.springs[s].elongation, -work.pulls(as_index(s)));
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

void check(CaseResult& r, const FrameModel& m, const Elimination& e, const VectorX& u, const Work& work) {
  const VectorX load = padded(work.load.forces, m.model.dofs());
  const VectorX pulls = forces_with(m.model, work.fine, work.pulls);
  const VectorX free = e.reduce(load), held = e.reduce(pulls);
  r.checks.residual = ratio(largest(free - held),
                            largest(load) + largest(pulls) + cancelling * (work.gross.force + largest(work.pulls)));
  r.checks.equilibrium = equilibrium(m, work);

  const VectorX forces = work.load.forces - work.load.thermal;
  const double loads = forces.dot(u.head(forces.size())),
               supports = work.lambda.head(work.load.values.size()).dot(work.load.values);
  double members = 0, springs = 0, gross = work.gross.energy;
  for (const MemberForces& member : r.members) members += member.energy;
  const double length = characteristic_length(m.model), contact = contact_stiffness(m.model);
  for (std::size_t s = 0; s < m.model.springs.size(); ++s) {
    const Spring& spring = m.model.springs[s];
    const double force = work.pulls(as_index(s));
    springs += force * evaluate(spring.elongation, work.fine);
    if (jumps(spring.law)) gross += force * force / (contact * (spring.law.rotation ? length * length : 1));
  }
  const double difference = 2 * (members - work.clamped) + springs - loads - supports + work.heat;
  r.checks.energy = ratio(std::abs(difference), 2 * members + std::abs(springs) + std::abs(loads) + std::abs(supports) +
                                                    std::abs(work.heat) + cancelling * gross);
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

double reciprocity(const FrameModel& m, const std::vector<VectorX>& u, const std::vector<Work>& work) {
  double worst = 0;
  for (std::size_t i = 0; i < u.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      double difference = 0, sum = cancelling * std::sqrt(work[i].gross.energy * work[j].gross.energy);
      sum += cancelling * (largest_work(m, work[i].load.forces, u[j]) + largest_work(m, work[j].load.forces, u[i]));
      const auto add = [&](const VectorX& a, const VectorX& b, double sign) {
        const auto n = std::min(a.size(), b.size());
        difference += sign * a.head(n).dot(b.head(n));
        sum += a.head(n).cwiseAbs().dot(b.head(n).cwiseAbs());
      };
      add(work[i].load.forces, u[j], 1);
      add(work[i].lambda, work[j].load.values, 1);
      add(work[j].load.forces, u[i], -1);
      add(work[j].lambda, work[i].load.values, -1);
      worst = std::max(worst, ratio(std::abs(difference), sum));
    }
  return worst;
}

VectorX stored_energies(const Model& m, const ExtendedVector& u) {
  VectorX out(std::ssize(m.springs));
  for (std::size_t i = 0; i < m.springs.size(); ++i)
    out(as_index(i)) = stored_energy(m.springs[i].law, evaluate(m.springs[i].elongation, u));
  return out;
}

void take_laws(Model& m, const LinearState& state) {
  for (std::size_t s = 0; s < state.laws.size(); ++s) m.springs[s].law = state.laws[s];
}

/// The result of a case; `assembled`: as the frame was before, nullptr without misfits.
CaseResult result_of(const FrameDescription& f, const FrameModel& m, const Elimination& e, const Reactions& reactions,
                     Work& work, const LinearState& state, const LinearState* assembled) {
  CaseResult r;
  r.path = state.path;
  r.slips = state.slips;
  const VectorX u = work.fine.cast<double>();
  work.lambda =
      reactions.forces(forces_with(m.model, work.fine, work.pulls) - padded(work.load.forces, m.model.dofs()));
  work.gross.carried = carried_by_supports(m.model, work);
  find_reactions(r, m, work);
  find_member_forces(r, m, work);
  find_energies(r, f, m, stored_energies(m.model, work.fine));
  check(r, m, e, u, work);
  r.loads = work.load.elements;
  r.u = assembled ? VectorX((work.fine - assembled->fine).cast<double>()) : u;
  for (std::size_t i = 0; i < f.nodes.size(); ++i) r.displacements.push_back(r.u.segment<6>(as_index(6 * i)));
  return r;
}

void analyse_linear(const FrameDescription& f, const FrameOptions& options, FrameResult& out) {
  FrameModel& m = out.structure;
  const bool assembly = m.prestressed();
  std::vector<CaseLoad> loads;
  if (assembly) loads.push_back(load_of(f, m, "", {}, true));
  for (const auto& [name, load] : f.loads) loads.push_back(load_of(f, m, name, load));
  Elimination elimination;
  const std::vector<LinearState> states = solve_states(loads, assembly, options, out, elimination);
  const Reactions reactions(m.model, elimination);

  std::vector<Work> work;
  std::vector<VectorX> u;
  for (std::size_t c = assembly ? 1 : 0; c < states.size(); ++c) {
    take_laws(m.model, states[c]);
    work.push_back({loads[c], states[c].fine, spring_forces(m.model, states[c].fine)});
    CaseResult r =
        result_of(f, m, elimination, reactions, work.back(), states[c], assembly ? &states.front() : nullptr);
    r.name = f.loads[out.cases.size()].first;
    if (assembly && !states.front().path.converged) {
      r.path = states.front().path;
      r.path.message = "the frame as assembled: " + r.path.message;
    }
    note_floating(r.name, states[c].loose, out.notes);
    u.push_back(states[c].fine.cast<double>());
    out.cases.push_back(std::move(r));
  }
  if (out.linear_laws) out.reciprocity = reciprocity(m, u, work);
}

}  // namespace

void note_floating(const std::string& load, const std::vector<std::string>& loose, std::vector<std::string>& notes) {
  for (const std::string& spring : loose)
    notes.push_back(fmt::format("load case '{}': {} floats in its play, of which the middle is given", load, spring));
}

void keep_larger(LargestMoment& largest_so_far, double value, double x) {
  if (std::abs(value) > std::abs(largest_so_far.value) * (1 + 1e-12)) largest_so_far = {value, x};
}

void find_energies(CaseResult& r, const FrameDescription& f, const FrameModel& m, const VectorX& of_springs) {
  NameIndex sections(f.sections);
  std::vector<double> by_section(f.sections.size(), 0);
  for (std::size_t i = 0; i < f.members.size(); ++i)
    nth(by_section, sections.find(f.members[i].second.section)) += r.members[i].energy;
  for (std::size_t i = 0; i < by_section.size(); ++i) r.energies.emplace_back(f.sections[i].first, by_section[i]);
  for (const auto& [place, springs] : m.elastic) {
    double sum = 0;
    for (int s = springs.first; s < springs.second; ++s) sum += of_springs(s);
    r.energies.emplace_back(place, sum);
  }
  for (const auto& [group, part] : r.energies) r.energy += part;
  std::stable_sort(r.energies.begin(), r.energies.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
}

FrameResult analyse(const FrameDescription& f, const FrameOptions& options) {
  FrameResult out;
  out.name = f.name;
  out.geometry = f.geometry;
  out.structure = build_frame(f, options.division);
  const std::vector<Spring>& springs = out.structure.model.springs;
  out.linear_laws = std::all_of(springs.begin(), springs.end(), [](const Spring& s) { return is_linear(s.law); });
  if (f.geometry == Geometry::linear)
    analyse_linear(f, options, out);
  else
    analyse_geometric(f, options, out);
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
