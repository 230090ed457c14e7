#include "msa/frame/file/known_frame.h"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <utility>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/file/frame_sensors.h"
#include "msa/frame/file/port_laws.h"
#include "msa/frame/structure/assembly.h"
#include "msa/frame/structure/reactions.h"
#include "msa/frame/structure/relative.h"

namespace deflect::frame {
namespace {

constexpr int most_steps = 200;
constexpr double found = 1e-24;  // of the energy of a change

double stiffness_of(const Spring& s) { return tangent(s.law, 0); }
VectorX stiffnesses_of(const Model& m) {
  VectorX out(std::ssize(m.springs));
  std::transform(m.springs.begin(), m.springs.end(), out.begin(), stiffness_of);
  return out;
}

bool same_terms(const LinearForm& a, const LinearForm& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Term& x, const Term& y) { return x.dof == y.dof && x.coefficient == y.coefficient; });
}

bool same_freedoms(const LinearForm& a, const LinearForm& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Term& x, const Term& y) { return x.dof == y.dof; });
}

bool same(const Beam& a, const Beam& b) { return a.rigidity == b.rigidity && a.length == b.length && a.R_WM == b.R_WM; }

void add(VectorX& f, const LinearForm& form, double factor) {
  for (const Term& t : form) f(t.dof) += t.coefficient * factor;
}

void add(VectorX& f, const Beam& beam, const Vector12& ends, double factor = 1) {
  f.segment<6>(6 * beam.a) += factor * ends.head<6>();
  f.segment<6>(6 * beam.b) += factor * ends.tail<6>();
}

/// A frame near the known one, and where its stiffness differs.
struct Near {
  FrameDescription rest;
  std::vector<TakenLaws> taken;
  FrameModel m;
  std::vector<std::size_t> beams, springs;
};

/// What sensors and laws see of a state.
struct State {
  CaseResult seen;
  VectorX pulls, lambda;  // by spring, by constraint
};

/// A unit force between the two sides of a freedom, or a unit deformation there, which strains without a displacement.
struct Input {
  VectorX forces, values;
  int beam = -1, spring = -1;
  Vector12 free = Vector12::Zero();  // of the beam's ends, local axes
};

int connection_of(const FrameModel& m, const TakenLaws& t) {
  switch (t.at) {
    case TakenLaws::At::support:
      return m.supports[t.part].connection;
    case TakenLaws::At::spring:
      return m.springs[t.part].connection;
    case TakenLaws::At::start:
      return m.ends[t.part][0];
    case TakenLaws::At::end:
      break;
  }
  return m.ends[t.part][1];
}

/// The motion of the far side of a freedom against the near one.
LinearForm motion(const Near& n, const TakenLaws& t) {
  const Connection& c = nth(n.m.model.connections, connection_of(n.m, t));
  const Vector3 axis = c.axes[t.freedom / 3].col(as_index(t.freedom % 3));
  // Between a member's end without laws and its node, the node is the first of the two.
  const double sign = t.at == TakenLaws::At::end && n.rest.members[t.part].second.end.empty() ? -1 : 1;
  const auto of = [&](int node, double factor) {
    return t.freedom >= 3 ? rotation_of(node, axis, factor) : translation_of(n.m.model, node, c.p, axis, factor);
  };
  LinearForm out = of(c.b, sign);
  if (c.a < 0) return out;
  const LinearForm other = of(c.a, -sign);
  out.insert(out.end(), other.begin(), other.end());
  return out;
}

/// The spring through which all passes that passes through this freedom; −1: it is rigid.
int spring_of(const FrameModel& m, const TakenLaws& t) {
  const int c = connection_of(m, t);
  return c < 0 ? -1 : nth(m.model.connections, c).spring[t.freedom];
}

std::size_t beam_of(const FrameModel& m, const TakenLaws& t) {
  return as_size(t.at == TakenLaws::At::start ? m.first_element[t.part] : m.first_element[t.part + 1] - 1);
}

Input input_of(const Near& n, const TakenLaws& t) {
  const Model& m = n.m.model;
  Input in{VectorX::Zero(m.dofs()), VectorX::Zero(std::ssize(m.constraints))};
  if (!t.in_series) {
    add(in.forces, motion(n, t), 1);
  } else if (in.spring = spring_of(n.m, t); in.spring >= 0) {
    const Spring& spring = nth(m.springs, in.spring);
    add(in.forces, spring.elongation, stiffness_of(spring));
  } else if (t.at == TakenLaws::At::support) {
    in.values(n.m.supports[t.part].constraint[t.freedom]) = 1;
  } else {
    in.beam = static_cast<int>(beam_of(n.m, t));
    const Beam& beam = nth(m.beams, in.beam);
    // The member's start moves from the node, the node from the member's end.
    const auto i = as_index(t.freedom);
    in.free(t.at == TakenLaws::At::start ? i : 6 + i) = t.at == TakenLaws::At::start ? -1 : 1;
    add(in.forces, beam, turned(beam.R_WM, local_stiffness(beam.rigidity, beam.length) * in.free));
  }
  return in;
}

/// The force that passes through a freedom, or the motion between its sides.
double answer(const Near& n, const TakenLaws& t, const State& s) {
  if (!t.in_series) return evaluate(motion(n, t), s.seen.u);
  if (const int spring = spring_of(n.m, t); spring >= 0) return s.pulls(spring);
  if (t.at == TakenLaws::At::support) return -s.lambda(n.m.supports[t.part].constraint[t.freedom]);
  const std::size_t b = beam_of(n.m, t);
  const double at = t.at == TakenLaws::At::start ? 0 : n.m.model.beams[b].length;
  return section_forces(s.seen.end_forces[b], s.seen.loads[b], at)(as_index(t.freedom));
}

Eigen::SparseMatrix<double> reduced_stiffness(const Model& m, const Elimination& e) {
  const Assembly assembly(m, e);
  const SparsePattern& p = assembly.pattern();
  const std::vector<double> all = assembly.values(stiffnesses_of(m));
  using Mapped = Eigen::Map<const Eigen::SparseMatrix<double>>;
  return Mapped(p.n, p.n, std::ssize(all), p.column_start.data(), p.row.data(), all.data());
}

}  // namespace

/// States of a frame that is near, by those of the known one.
struct KnownFrame::Impl {
  FrameDescription rest;
  std::vector<std::string> names;
  FrameModel m;
  std::size_t given = 0;  // constraints of the description; behind them those that hold idle motions
  bool usable = false;
  Elimination e;
  Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor;
  std::unique_ptr<const Reactions> reactions;
  std::vector<CaseLoad> cases;
  std::vector<VectorX> moved;  // by case: u

  std::optional<Near> near(const FrameDescription&) const;
  VectorX excess(const Near&, const VectorX& u) const;
  std::optional<VectorX> solve(const Near&, const VectorX& forces) const;
  std::optional<VectorX> from_nothing(const Near&, const VectorX& forces, const VectorX& values) const;
  State seen(const Near&, VectorX u, const VectorX& forces, std::vector<ElementLoad>, const Input&) const;
  std::optional<State> under_load(const Near&, const std::string& name, const LoadCase&) const;
  std::optional<State> under_input(const Near&, const TakenLaws&) const;
};

/// Nullopt where it has other parts.
std::optional<Near> KnownFrame::Impl::near(const FrameDescription& f) const {
  if (!usable || f.plane != rest.plane) return std::nullopt;
  std::optional<PartedFrame> parted = parted_as(f, rest);
  if (!parted) return std::nullopt;
  Near out{std::move(parted->rest), std::move(parted->taken), {}, {}, {}};
  out.m = build_frame(out.rest);
  Model& own = out.m.model;
  const Model& known = m.model;
  if (out.m.prestressed() || own.dofs() != known.dofs() || own.beams.size() != known.beams.size() ||
      own.springs.size() != known.springs.size() || own.constraints.size() != given)
    return std::nullopt;
  for (std::size_t i = 0; i < given; ++i)
    if (!same_terms(own.constraints[i].form, known.constraints[i].form)) return std::nullopt;
  own.constraints = known.constraints;
  for (std::size_t b = 0; b < own.beams.size(); ++b) {
    if (own.beams[b].a != known.beams[b].a || own.beams[b].b != known.beams[b].b) return std::nullopt;
    if (!same(own.beams[b], known.beams[b])) out.beams.push_back(b);
  }
  for (std::size_t s = 0; s < own.springs.size(); ++s) {
    const Spring &a = own.springs[s], &b = known.springs[s];
    if (!is_linear(a.law) || !same_freedoms(a.elongation, b.elongation)) return std::nullopt;
    if (stiffness_of(a) != stiffness_of(b) || !same_terms(a.elongation, b.elongation)) out.springs.push_back(s);
  }
  return out;
}

/// ΔK u.
VectorX KnownFrame::Impl::excess(const Near& n, const VectorX& u) const {
  VectorX f = VectorX::Zero(u.size());
  for (const std::size_t b : n.beams) {
    const Beam &own = n.m.model.beams[b], &known = m.model.beams[b];
    add(f, own, pull(own, end_displacements(own, u)) - pull(known, end_displacements(known, u)));
  }
  for (const std::size_t s : n.springs) {
    const Spring &own = n.m.model.springs[s], &known = m.model.springs[s];
    add(f, own.elongation, stiffness_of(own) * evaluate(own.elongation, u));
    add(f, known.elongation, -stiffness_of(known) * evaluate(known.elongation, u));
  }
  return f;
}

/// u under forces with all supports at rest. Nullopt where it is not found.
std::optional<VectorX> KnownFrame::Impl::solve(const Near& n, const VectorX& forces) const {
  const VectorX still = VectorX::Zero(std::ssize(m.model.constraints));
  VectorX r = e.reduce(forces), z = factor.solve(r);
  const double first = r.dot(z);
  if (first == 0) return VectorX::Zero(forces.size());
  if (n.beams.empty() && n.springs.empty()) return e.expand(z, still);
  VectorX q = VectorX::Zero(r.size()), p = z, Kp = r;
  double now = first;
  for (int step = 0; step < most_steps; ++step) {
    const VectorX held = Kp + e.reduce(excess(n, e.expand(p, still)));
    const double energy = p.dot(held);
    if (!(energy > 0)) return std::nullopt;
    q += now / energy * p;
    r -= now / energy * held;
    z = factor.solve(r);
    const double next = r.dot(z);
    if (!(next > found * first)) return e.expand(q, still);
    p = z + next / now * p;
    Kp = r + next / now * Kp;
    now = next;
  }
  return std::nullopt;
}

std::optional<VectorX> KnownFrame::Impl::from_nothing(const Near& n, const VectorX& forces,
                                                      const VectorX& values) const {
  if (!consistent(e, values)) return std::nullopt;
  const VectorX carried = e.expand(VectorX::Zero(e.independent), values);
  std::optional<VectorX> u = solve(n, forces - tangent_forces(n.m.model, carried, stiffnesses_of(n.m.model)));
  if (u) *u += carried;
  return u;
}

State KnownFrame::Impl::seen(const Near& n, VectorX u, const VectorX& forces, std::vector<ElementLoad> loads,
                             const Input& in) const {
  const Model& own = n.m.model;
  State out;
  out.seen.u = std::move(u);
  out.seen.loads = std::move(loads);
  for (std::size_t i = 0; i < n.rest.nodes.size(); ++i)
    out.seen.displacements.push_back(out.seen.u.segment<6>(as_index(6 * i)));
  VectorX unbalanced = -forces;
  for (std::size_t b = 0; b < own.beams.size(); ++b) {
    const Beam& beam = own.beams[b];
    Vector12 f = end_forces(beam, end_displacements(beam, out.seen.u));
    add(unbalanced, beam, turned(beam.R_WM, f));
    const ElementLoad& load = out.seen.loads[b];
    if (load.strain != 0 || !load.q_M.isZero(0)) f -= equivalent_forces(beam.rigidity, beam.length, load);
    if (std::cmp_equal(in.beam, b)) f -= local_stiffness(beam.rigidity, beam.length) * in.free;
    out.seen.end_forces.push_back(f);
  }
  out.pulls.resize(std::ssize(own.springs));
  for (std::size_t s = 0; s < own.springs.size(); ++s) {
    const double free = std::cmp_equal(in.spring, s) ? 1 : 0, k = stiffness_of(own.springs[s]);
    const double elongation = evaluate(own.springs[s].elongation, out.seen.u);
    add(unbalanced, own.springs[s].elongation, k * elongation);
    out.pulls(as_index(s)) = k * (elongation - free);
  }
  out.lambda = reactions->forces(unbalanced);
  for (const Holding& support : n.m.supports) {
    Vector6 wrench = Vector6::Zero();
    for (std::size_t i = 0; i < 6; ++i)
      if (support.constraint[i] >= 0) wrench(as_index(i)) = out.lambda(support.constraint[i]);
    for (const auto& [freedom, spring] : support.direct) wrench(freedom) -= out.pulls(spring);
    out.seen.reactions.push_back(wrench);
  }
  return out;
}

std::optional<State> KnownFrame::Impl::under_load(const Near& n, const std::string& name, const LoadCase& load) const {
  CaseLoad own = load_of(n.rest, n.m, name, load);
  std::optional<VectorX> state;
  const auto k = as_size(std::find(names.begin(), names.end(), name) - names.begin());
  if (k < names.size() && own.values == cases[k].values) {
    state = solve(n, own.forces - cases[k].forces - excess(n, moved[k]));
    if (state) *state += moved[k];
  } else {
    state = from_nothing(n, own.forces, own.values);
  }
  if (!state) return std::nullopt;
  return seen(n, std::move(*state), own.forces, std::move(own.elements), {});
}

std::optional<State> KnownFrame::Impl::under_input(const Near& n, const TakenLaws& t) const {
  const Input in = input_of(n, t);
  std::optional<VectorX> state = from_nothing(n, in.forces, in.values);
  if (!state) return std::nullopt;
  State out = seen(n, std::move(*state), in.forces, std::vector<ElementLoad>(n.m.model.beams.size()), in);
  // The force beside what holds a node is the support's, too.
  if (t.at == TakenLaws::At::support && !t.in_series) out.seen.reactions[t.part](as_index(t.freedom)) += 1;
  return out;
}

KnownFrame::KnownFrame(const FrameDescription& f, Named<LoadCase> loads) {
  auto out = std::make_unique<Impl>();
  out->rest = without_nonlinear_laws(f).rest;
  out->rest.geometry = Geometry::linear;
  out->rest.load_steps = 1;
  out->rest.loads = std::move(loads);
  for (const auto& [name, load] : out->rest.loads) out->names.push_back(name);
  const FrameModel bare = build_frame(out->rest);
  if (wants_relative_motion(bare.model)) {
    impl_ = std::move(out);
    return;
  }
  FrameResult result = analyse(out->rest);
  if (const std::string failed = failed_check(result); !failed.empty())
    throw NumericalError(fmt::format("{}: {}", f.name, failed));
  out->given = bare.model.constraints.size();
  out->m = std::move(result.structure);
  if (!bare.prestressed() && out->m.model.dofs() == bare.model.dofs() && result.equations.solver == "direct") {
    out->e = eliminate(out->m.model);
    out->factor.compute(reduced_stiffness(out->m.model, out->e));
    out->usable = out->e.independent > 0 && out->factor.info() == Eigen::Success;
    out->reactions = std::make_unique<const Reactions>(out->m.model, out->e);
    for (const auto& [name, load] : out->rest.loads) out->cases.push_back(load_of(out->rest, out->m, name, load));
    for (CaseResult& c : result.cases) out->moved.push_back(std::move(c.u));
  }
  impl_ = std::move(out);
}

KnownFrame::~KnownFrame() = default;

std::optional<MatrixX> KnownFrame::readings(const FrameDescription& f, const Named<LoadCase>& loads,
                                            const std::vector<const FrameSensor*>& sensors, const MatrixX& factors,
                                            bool in_sequence) const {
  const std::optional<Near> n = impl_->near(f);
  if (!n) return std::nullopt;
  const auto ports = std::ssize(n->taken);
  std::vector<State> states;
  for (const auto& [name, load] : loads) {
    std::optional<State> state = impl_->under_load(*n, name, load);
    if (!state) return std::nullopt;
    states.push_back(std::move(*state));
  }
  for (const TakenLaws& t : n->taken) {
    std::optional<State> state = impl_->under_input(*n, t);
    if (!state) return std::nullopt;
    states.push_back(std::move(*state));
  }
  MatrixX read(std::ssize(sensors), std::ssize(states)), answers(ports, std::ssize(states));
  for (std::size_t c = 0; c < states.size(); ++c) {
    for (std::size_t k = 0; k < sensors.size(); ++k)
      read(as_index(k), as_index(c)) = true_reading(*sensors[k], n->rest, n->m, states[c].seen);
    for (Eigen::Index p = 0; p < ports; ++p) answers(p, as_index(c)) = answer(*n, nth(n->taken, p), states[c]);
  }
  MatrixX out = read.leftCols(factors.rows()) * factors;
  if (ports == 0) return out;
  const std::optional<MatrixX> inputs =
      inputs_of_ports(f, n->taken, answers.rightCols(ports), answers.leftCols(factors.rows()) * factors, in_sequence);
  if (!inputs) return std::nullopt;
  return MatrixX(out + read.rightCols(ports) * *inputs);
}

std::optional<Passages> KnownFrame::passages(const std::vector<const FrameSensor*>& sensors,
                                             const std::vector<TakenLaws>& places) const {
  const std::optional<Near> n = impl_->near(impl_->rest);
  if (!n) return std::nullopt;
  const auto count = std::ssize(places), loads = std::ssize(impl_->names);
  Passages out{MatrixX::Zero(count, loads), MatrixX::Zero(std::ssize(sensors), count), MatrixX::Zero(count, count), {}};
  for (const TakenLaws& t : places) out.gives.push_back(consistent(impl_->e, input_of(*n, t).values));
  const auto all_at = [&](const State& s, MatrixX& to, std::size_t column) {
    for (std::size_t p = 0; p < places.size(); ++p) to(as_index(p), as_index(column)) = answer(*n, places[p], s);
  };
  for (std::size_t k = 0; k < impl_->names.size(); ++k) {
    const std::optional<State> state = impl_->under_load(*n, impl_->names[k], impl_->rest.loads[k].second);
    if (!state) return std::nullopt;
    all_at(*state, out.carried, k);
  }
  for (std::size_t p = 0; p < places.size(); ++p) {
    if (!out.gives[p]) continue;
    const std::optional<State> state = impl_->under_input(*n, places[p]);
    if (!state) return std::nullopt;
    all_at(*state, out.response, p);
    for (std::size_t k = 0; k < sensors.size(); ++k)
      out.moves(as_index(k), as_index(p)) = true_reading(*sensors[k], n->rest, n->m, state->seen);
  }
  return out;
}

}  // namespace deflect::frame
