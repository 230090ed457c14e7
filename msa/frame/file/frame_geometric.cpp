#include <algorithm>
#include <cmath>

#include "msa/base/index.h"
#include "msa/frame/deformed/geometric_solver.h"
#include "msa/frame/file/frame_case.h"

namespace deflect::frame {
namespace {

Vector12 in_axes(const BeamState& state, const Vector12& f) {
  Vector12 out;
  for (int i = 0; i < 12; i += 3) out.segment<3>(i) = (i < 6 ? state.A : state.B).transpose() * f.segment<3>(i);
  return out;
}

Vector12 in_base_axes(const Beam& beam, const Vector12& f) {
  Vector12 out;
  for (int i = 0; i < 12; i += 3) out.segment<3>(i) = beam.R_WM * f.segment<3>(i);
  return out;
}

/// Member forces in the axes of the sections at their ends; line loads keep their direction.
void find_member_forces(CaseResult& r, const FrameModel& m, const GeometricState& state) {
  for (std::size_t member = 0; member + 1 < m.first_element.size(); ++member) {
    MemberForces out;
    double from_start = 0;
    for (int e = m.first_element[member]; e < m.first_element[member + 1]; ++e) {
      const auto k = as_size(e);
      const Beam& beam = m.model.beams[k];
      const ElementLoad line{r.loads[k].q_M, 0};
      const Vector12 carried = in_base_axes(beam, equivalent_forces(beam.rigidity, beam.length, line));
      r.end_forces.push_back(in_axes(state.beams[k], state.beams[k].forces - carried));
      out.energy += state.beams[k].energy + clamped_energy(beam.rigidity, beam.length, line);
      const Vector6 start = -r.end_forces.back().head<6>() + Vector6::Zero();  // 0 rather than -0
      if (e == m.first_element[member]) out.start = start;
      out.end = r.end_forces.back().tail<6>();
      for (const auto& [s, x] : {std::pair{start, from_start}, {out.end, from_start + beam.length}}) {
        keep_larger(out.My, s(4), x);
        keep_larger(out.Mz, s(5), x);
      }
      from_start += beam.length;
    }
    r.members.push_back(out);
  }
}

/// What a form with the force `along` does to a node.
Vector6 on_node(const LinearForm& form, double along, int node) {
  Vector6 wrench = Vector6::Zero();
  for (const Term& t : form)
    if (t.dof / 6 == node) wrench(t.dof % 6) += t.coefficient * along;
  return wrench;
}

void find_reactions(CaseResult& r, const FrameDescription& f, const FrameModel& m, const GeometricState& state) {
  for (std::size_t i = 0; i < f.supports.size(); ++i) {
    r.reactions.push_back(Vector6::Zero());
    for (const int k : m.support_constraint[i])
      if (k >= 0)
        r.reactions.back() +=
            on_node(nth(state.forms, k), state.constraint_forces(k), m.nodes.find(f.supports[i].first));
  }
  for (const int k : m.constraint) r.constraints.push_back(state.constraint_forces(k));
  for (std::size_t i = 0; i < f.springs.size(); ++i) {
    r.springs.push_back(Vector6::Zero());
    for (const int s : m.spring[i])
      if (s >= 0)
        r.springs.back() +=
            on_node(nth(state.spring_forms, s), -state.spring_forces(s), m.nodes.find(f.springs[i].second.node));
  }
}

/// Resultant of loads, constraints and springs, relative; its moment about the first node, in the deformed shape, where
/// the geometry is finite: in second order moments balance to the accuracy of that theory only.
double equilibrium(const FrameModel& m, const GeometricState& state, const VectorX& loads) {
  VectorX external = loads, unsigned_sum = loads.cwiseAbs();
  const auto add = [&](const LinearForm& form, double along) {
    for (const Term& t : form) {
      external(t.dof) += t.coefficient * along;
      unsigned_sum(t.dof) += std::abs(t.coefficient * along);
    }
  };
  for (std::size_t k = 0; k < state.forms.size(); ++k) add(state.forms[k], state.constraint_forces(as_index(k)));
  for (std::size_t s = 0; s < state.spring_forms.size(); ++s)
    add(state.spring_forms[s], -state.spring_forces(as_index(s)));
  Vector3 resultant = Vector3::Zero(), moment = Vector3::Zero();
  double forces = 0, moments = 0;
  for (std::size_t i = 0; i < m.model.nodes.size(); ++i) {
    const auto at = as_index(6 * i);
    const Vector6 wrench = external.segment<6>(at);
    const Vector3 arm = m.model.nodes[i].position + state.u.segment<3>(at) - m.model.nodes.front().position;
    resultant += wrench.head<3>();
    moment += wrench.tail<3>() + arm.cross(wrench.head<3>());
    forces += unsigned_sum.segment<3>(at).sum();
    moments += unsigned_sum.segment<3>(at + 3).sum();
  }
  moments += forces * characteristic_length(m.model);
  const double of_forces = ratio(resultant.norm(), forces);
  return state.geometry == Geometry::finite ? std::max(of_forces, ratio(moment.norm(), moments)) : of_forces;
}

}  // namespace

void analyse_geometric(const FrameDescription& f, FrameResult& out) {
  FrameModel& m = out.structure;
  GeometricSolver solver(m.model);
  m.model = solver.model();
  out.notes = solver.notes();
  GeometricOptions options;
  options.geometry = f.geometry;
  options.load_steps = f.load_steps;
  for (const auto& [name, load] : f.loads) {
    const CaseLoad full = load_of(f, m, name, load);
    GeometricLoad given{full.forces - full.thermal, full.values, {}};  // heat strains the members instead
    for (const ElementLoad& element : full.elements) given.strains.push_back(element.strain);
    const GeometricState state = solver.solve(given, options);

    CaseResult r;
    r.name = name;
    r.path = {state.converged, state.stable, state.steps, state.iterations, state.load_factor, state.message};
    r.u = state.u;
    r.loads = full.elements;
    for (ElementLoad& element : r.loads) element.q_M *= state.load_factor;
    for (std::size_t i = 0; i < f.nodes.size(); ++i) r.displacements.push_back(r.u.segment<6>(as_index(6 * i)));
    find_reactions(r, f, m, state);
    find_member_forces(r, m, state);
    find_energies(r, f, m, state.elongations);
    r.checks.residual = state.residual;
    r.checks.equilibrium = equilibrium(m, state, state.load_factor * given.forces);
    out.cases.push_back(std::move(r));
  }
}

}  // namespace deflect::frame
