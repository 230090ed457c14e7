#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "msa/base/index.h"
#include "msa/frame/deformed/geometric_solver.h"
#include "msa/frame/elements/finite_rotation.h"
#include "msa/frame/file/frame_case.h"

namespace deflect::frame {
namespace {

Vector12 in_axes(const BeamState& state, const Vector12& f) {
  Vector12 out;
  for (int i = 0; i < 12; i += 3) out.segment<3>(i) = (i < 6 ? state.A : state.B).transpose() * f.segment<3>(i);
  return out;
}

/// The displacements of an element's ends, base axes.
Vector12 ends_of(const Beam& beam, const VectorX& u) {
  Vector12 d;
  d << u.segment<6>(6 * beam.a), u.segment<6>(6 * beam.b);
  return d;
}

/// The section forces along an element.
SectionCourse course_of(const Beam& beam, const ElementLoad& load, const BeamState& s, const GeometricState& state,
                        const Vector12& ends) {
  return state.geometry == Geometry::finite ? finite_course(beam, s.A, s.B, load, ends)
                                            : second_order_course(beam, ends_of(beam, state.u), load, ends);
}

/// Member forces in the axes of the sections where they act; line loads keep their direction.
void find_member_forces(CaseResult& r, const FrameModel& m, const GeometricState& state) {
  for (std::size_t member = 0; member + 1 < m.first_element.size(); ++member) {
    MemberForces out;
    double from_start = 0;
    for (int e = m.first_element[member]; e < m.first_element[member + 1]; ++e) {
      const auto k = as_size(e);
      const Beam& beam = m.model.beams[k];
      const BeamState& s = state.beams[k];
      const ElementLoad line{r.loads[k].q_M, 0};
      const Vector12 carried = turned(beam.R_WM, equivalent_forces(beam.rigidity, beam.length, line));
      r.end_forces.push_back(in_axes(s, s.forces - carried));
      const SectionCourse& course = r.courses.emplace_back(course_of(beam, r.loads[k], s, state, r.end_forces.back()));
      out.energy += s.energy + clamped_energy(beam.rigidity, beam.length, line);
      if (e == m.first_element[member]) out.start = section_forces(course, 0);
      out.end = section_forces(course, beam.length);
      for (const auto& [largest, component] : {std::pair{&out.My, 4}, {&out.Mz, 5}}) {
        const double x = place_of_largest(course, component);
        keep_larger(*largest, section_forces(course, x)(component), from_start + x);
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

/// What a support or spring does to the node.
Vector6 on_node(const Holding& holding, const GeometricState& state, int node) {
  Vector6 wrench = Vector6::Zero();
  for (const int k : holding.constraint)
    if (k >= 0) wrench += on_node(nth(state.forms, k), state.constraint_forces(k), node);
  for (const auto& [freedom, spring] : holding.direct)
    wrench += on_node(nth(state.spring_forms, spring), -state.spring_forces(spring), node);
  return wrench;
}

void find_reactions(CaseResult& r, const FrameDescription& f, const FrameModel& m, const GeometricState& state) {
  for (std::size_t i = 0; i < f.supports.size(); ++i)
    r.reactions.push_back(on_node(m.supports[i], state, m.nodes.find(f.supports[i].first)));
  for (const int k : m.constraint) r.constraints.push_back(state.constraint_forces(k));
  for (std::size_t i = 0; i < f.springs.size(); ++i)
    r.springs.push_back(on_node(m.springs[i], state, m.nodes.find(f.springs[i].second.node)));
}

VectorX stored_energies(const Model& m, const GeometricState& state) {
  VectorX out(std::ssize(m.springs));
  for (std::size_t i = 0; i < m.springs.size(); ++i)
    out(as_index(i)) = stored_energy(state.law(m, i), state.elongations(as_index(i)));
  return out;
}

/// The motion of the nodes from one state to another; rotation vectors are those of the turn between them.
VectorX from(const GeometricState& before, const GeometricState& after, std::size_t nodes) {
  VectorX u = after.u - before.u;
  for (std::size_t i = 0; i < nodes && after.geometry == Geometry::finite; ++i) {
    const auto at = as_index(6 * i + 3);
    u.segment<3>(at) = rotation_vector(
        (rotation_by(after.u.segment<3>(at)) * rotation_by(before.u.segment<3>(at)).conjugate()).normalized());
  }
  return u;
}

/// In a short stiff piece that moves far, forces are small differences of displacements: a note where those that act at
/// a node balance to a thousandth of the largest only.
void note_unbalanced(const FrameModel& m, const GeometricState& state, double load, const std::string& name,
                     std::vector<std::string>& notes) {
  for (const BeamState& beam : state.beams) load = std::max(load, beam.forces.segment<3>(6).norm());
  if (state.unbalanced <= 1e-3 * load) return;
  notes.push_back(
      fmt::format("load case '{}': at '{}' the forces of members balance to {:.1g} N only: in a piece that is "
                  "so short or stiff they are small differences of displacements",
                  name, nth(m.model.nodes, state.unbalanced_node).name, state.unbalanced));
}

GeometricState state_under(GeometricSolver& solver, const CaseLoad& full, const GeometricOptions& options) {
  GeometricLoad given{full.forces - full.thermal, full.values, {}};  // heat strains the members instead
  for (const ElementLoad& element : full.elements) given.strains.push_back(element.strain);
  return solver.solve(given, options);
}

CaseResult result_of(const FrameDescription& f, const FrameModel& m, const CaseLoad& full,
                     const GeometricState& state) {
  CaseResult r;
  r.path = {state.converged, state.stable, state.steps, state.iterations, state.load_factor, state.message};
  r.u = state.u;
  r.slips = state.slips;
  r.loads = full.elements;
  for (ElementLoad& element : r.loads) element.q_M *= state.load_factor, element.strain *= state.load_factor;
  find_reactions(r, f, m, state);
  find_member_forces(r, m, state);
  find_energies(r, f, m, stored_energies(m.model, state));
  r.checks.residual = state.residual;
  r.checks.equilibrium = resultant(m, state, state.load_factor * (full.forces - full.thermal));
  return r;
}

}  // namespace

double resultant(const FrameModel& m, const GeometricState& state, const VectorX& loads) {
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
  const Eigen::SparseMatrix<double> K = state.K.cwiseAbs();
  unsigned_sum += cancelling * (K * state.u.cwiseAbs());
  Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
  double forces = 0, moments = 0;
  for (std::size_t i = 0; i < m.model.nodes.size(); ++i) {
    const auto at = as_index(6 * i);
    const Vector6 wrench = external.segment<6>(at);
    const Vector3 arm = m.model.nodes[i].position + state.u.segment<3>(at) - m.model.nodes.front().position;
    force += wrench.head<3>();
    moment += wrench.tail<3>() + arm.cross(wrench.head<3>());
    forces += unsigned_sum.segment<3>(at).sum();
    moments += unsigned_sum.segment<3>(at + 3).sum();
  }
  moments += forces * characteristic_length(m.model);
  const double of_forces = ratio(force.norm(), forces);
  return state.geometry == Geometry::finite ? std::max(of_forces, ratio(moment.norm(), moments)) : of_forces;
}

void analyse_geometric(const FrameDescription& f, const FrameOptions& frame_options, FrameResult& out) {
  FrameModel& m = out.structure;
  GeometricSolver solver(m.model);
  m.model = solver.model();
  out.notes = solver.notes();
  GeometricOptions options;
  options.geometry = f.geometry;
  options.load_steps = f.load_steps;
  std::optional<GeometricState> assembled;
  if (m.prestressed()) {
    assembled = state_under(solver, load_of(f, m, "", {}, true), options);
    options.slips = assembled->slips;
  }
  for (const auto& [name, load] : f.loads) {
    const CaseLoad full = load_of(f, m, name, load);
    const GeometricState state = state_under(solver, full, options);
    CaseResult r = result_of(f, m, full, state);
    r.name = name;
    if (assembled) r.u = from(*assembled, state, m.model.nodes.size());
    if (assembled && !(assembled->converged && assembled->stable)) {
      r.path.converged = assembled->converged, r.path.stable = assembled->stable;
      r.path.message = "the frame as assembled: " + assembled->message;
    }
    for (std::size_t i = 0; i < f.nodes.size(); ++i) r.displacements.push_back(r.u.segment<6>(as_index(6 * i)));
    if (frame_options.in_sequence && state.converged) options.slips = state.slips;
    note_floating(name, state.loose, out.notes);
    if (state.converged && !full.forces.isZero(0)) note_unbalanced(m, state, largest(full.forces), name, out.notes);
    out.cases.push_back(std::move(r));
  }
}

}  // namespace deflect::frame
