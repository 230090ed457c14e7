#include "msa/frame/file/frame_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/file/law_springs.h"
#include "msa/frame/file/member_axes.h"
#include "msa/frame/structure/coupled_spring.h"

namespace deflect::frame {
namespace {

std::size_t at(const NameIndex& index, const char* what, const std::string& name) {
  const int found = index.find(name);
  if (found < 0) throw InputError(fmt::format("there is no {} '{}'", what, name));
  return as_size(found);
}

/// A node of the model: those of the description come first.
int node_number(const NameIndex& nodes, const std::string& name) { return static_cast<int>(at(nodes, "node", name)); }

/// Rigidities of a member, sections evaluated once for each material they are made of.
class Rigidities {
 public:
  explicit Rigidities(const FrameDescription& f) : f_(f), materials_(f.materials), sections_(f.sections) {}

  const FrameMaterial& material(const FrameMember& m) const {
    return f_.materials[at(materials_, "material", m.material)].second;
  }

  const SectionProperties& section(const FrameMember& m) {
    const std::pair key{at(sections_, "section", m.section), at(materials_, "material", m.material)};
    const auto found = known_.find(key);
    if (found != known_.end()) return found->second;
    return known_.emplace(key, properties(f_.sections[key.first].second, material(m).elastic.poisson())).first->second;
  }

  BeamRigidity operator()(const FrameMember& m) {
    const SectionProperties& s = section(m);
    const double E = m.factor * material(m).elastic.E, G = m.factor * material(m).elastic.shear_modulus();
    const double c = m.bending_factor;
    const double none = std::numeric_limits<double>::infinity();
    BeamRigidity r{E * s.A, c * E * s.Iy, c * E * s.Iz, G * s.J, none, none};
    if (m.beam == BeamTheory::timoshenko) r.GAs_y = G * s.As_y, r.GAs_z = G * s.As_z;
    return r;
  }

 private:
  const FrameDescription& f_;
  NameIndex materials_, sections_;
  std::map<std::pair<std::size_t, std::size_t>, SectionProperties> known_;
};

/// How many there are, which is the number of the next one.
int count(const auto& list) { return static_cast<int>(list.size()); }

std::array<ConnectionFreedom, 6> rigid_where(const Freedoms& rigid) {
  std::array<ConnectionFreedom, 6> out;
  for (std::size_t i = 0; i < 6; ++i) out[i].rigid = rigid[i];
  return out;
}

/// A connection that waits until all nodes are there.
struct Pending {
  int a, b;
  Matrix3 R;
  std::array<ConnectionFreedom, 6> freedoms;
  std::string name, place;  // place: empty without laws
  std::size_t member, end;
};

/// Which end of which member.
struct End {
  std::size_t member;
  const Freedoms& released;
  const FreedomLaws& laws;
  bool start;
  std::string place;
};

/// The node of a member's end: the named one, or one of its own behind releases and laws.
int end_node(Model& m, int node, const End& end, const Matrix3& R_WM, const std::string& name, LawSprings& springs,
             std::vector<Pending>& pending) {
  if (end.released == Freedoms{} && end.laws.empty()) return node;
  Freedoms rigid{};
  std::transform(end.released.begin(), end.released.end(), rigid.begin(), [](bool free) { return !free; });
  const int own = m.add_node(name, nth(m.nodes, node).position);
  const bool turned = !end.start && !end.laws.empty();  // the member is the near side of its laws
  pending.push_back({turned ? own : node, turned ? node : own, R_WM, springs.freedoms(rigid, end.laws), name,
                     end.laws.empty() ? "" : end.place, end.member, as_size(end.start ? 0 : 1)});
  return own;
}

void add_member(FrameModel& out, const std::string& name, const FrameMember& member, const BeamRigidity& rigidity,
                const std::vector<double>& fractions, LawSprings& springs, std::vector<Pending>& pending) {
  Model& m = out.model;
  const auto a = node_number(out.nodes, member.from), b = node_number(out.nodes, member.to);
  const Vector3 start = nth(m.nodes, a).position, end = nth(m.nodes, b).position;
  const Matrix3 R_WM = member_axes(end - start, member.y_axis);
  constexpr Freedoms hinged{false, false, false, true, true, true};
  const std::size_t number = out.misfit.size();
  const End at_start{number, member.truss ? hinged : member.release_from, member.start, true, name + " start"},
      at_end{number, member.truss ? hinged : member.release_to, member.end, false, name + " end"};
  int previous = end_node(m, a, at_start, R_WM, fmt::format("{} at {}", name, member.from), springs, pending);
  const int last = end_node(m, b, at_end, R_WM, fmt::format("{} at {}", name, member.to), springs, pending);
  for (std::size_t i = 1; i + 1 < fractions.size(); ++i) {
    const int next = m.add_node(fmt::format("{} {:.4g}", name, fractions[i]), start + fractions[i] * (end - start));
    m.add_beam(previous, next, R_WM, rigidity, fmt::format("{} [{}]", name, i), member.section);
    previous = next;
  }
  m.add_beam(previous, last, R_WM, rigidity,
             fractions.size() > 2 ? fmt::format("{} [{}]", name, fractions.size() - 1) : name, member.section);
  out.misfit.push_back(member.misfit / (end - start).norm());
}

std::vector<double> equal_parts(int elements) {
  std::vector<double> fractions;
  for (int i = 0; i <= elements; ++i) fractions.push_back(static_cast<double>(i) / elements);
  return fractions;
}

void add_members(FrameModel& out, const FrameDescription& f, const FrameDivision& division, LawSprings& springs,
                 Named<std::pair<int, int>>& elastic_ends) {
  Rigidities rigidity(f);
  std::vector<Pending> pending;
  for (std::size_t i = 0; i < f.members.size(); ++i) {
    const auto& [name, member] = f.members[i];
    out.first_element.push_back(count(out.model.beams));
    add_member(out, name, member, rigidity(member), division.empty() ? equal_parts(member.elements) : division[i],
               springs, pending);
    const FrameMaterial& material = rigidity.material(member);
    out.mass_per_length.push_back(material.density.value_or(0) * rigidity.section(member).A);
    out.expansion.push_back(material.expansion.value_or(0));
  }
  out.first_element.push_back(count(out.model.beams));
  Model& m = out.model;
  out.ends.assign(f.members.size(), {-1, -1});
  for (const Pending& p : pending) {
    const int first = count(m.springs);
    out.ends[p.member][p.end] = count(m.connections);
    m.connect(p.a, p.b, nth(m.nodes, p.b).position, p.R, p.freedoms, p.name, p.place.empty() ? p.name : p.place);
    if (!p.place.empty()) elastic_ends.emplace_back(p.place, std::pair{first, count(m.springs)});
  }
}

/// What the connection that was made last does to the node of its far side.
Holding last_holding(const Model& m, std::size_t first_connection, int first_spring) {
  Holding out;
  out.connection = static_cast<int>(first_connection);
  out.first = first_spring;
  out.last = count(m.springs);
  out.constraint = m.connections[first_connection].constraint;
  for (std::size_t c = first_connection; c < m.connections.size(); ++c)
    for (int i = 0; i < 6; ++i)
      if (const int s = nth(m.connections[c].spring, i); s >= 0) out.direct.emplace_back(i, s);
  return out;
}

void add_supports(FrameModel& out, const FrameDescription& f, LawSprings& springs) {
  Model& m = out.model;
  for (const auto& [name, support] : f.supports) {
    const auto node = node_number(out.nodes, name);
    const int first = count(m.springs);
    const std::size_t connection = m.connections.size();
    const std::string title = fmt::format("support {}", name);
    m.connect(-1, node, nth(m.nodes, node).position, Matrix3::Identity(), springs.freedoms(support, support.laws),
              title, title, node_freedoms);
    out.supports.push_back(last_holding(m, connection, first));
  }
}

void add_links(FrameModel& out, const FrameDescription& f) {
  for (const auto& [name, link] : f.rigid_links)
    for (const std::string& follower : link.nodes) {
      const auto a = node_number(out.nodes, link.master), b = node_number(out.nodes, follower);
      const Vector3 p = nth(out.model.nodes, b).position;
      out.model.connect(a, b, p, Matrix3::Identity(), rigid_where(link.freedoms), fmt::format("{} {}", name, follower),
                        name);
      if (p != nth(out.model.nodes, a).position) out.arms.emplace_back(a, b);
    }
}

void add_constraints(FrameModel& out, const FrameDescription& f) {
  for (const auto& [name, constraint] : f.constraints) {
    Constraint c;
    c.name = name;
    for (const ConstraintTerm& t : constraint.terms)
      c.form.push_back({6 * node_number(out.nodes, t.node) + t.freedom, t.factor * t.arm.value_or(1)});
    out.constraint.push_back(count(out.model.constraints));
    out.model.constraints.push_back(std::move(c));
  }
}

void add_springs(FrameModel& out, const FrameDescription& f, LawSprings& springs) {
  Model& m = out.model;
  for (const auto& [name, spring] : f.springs) {
    const auto node = node_number(out.nodes, spring.node);
    const int other = spring.to.empty() ? -1 : node_number(out.nodes, spring.to);
    const Vector3 p = nth(m.nodes, node).position;
    const int first = count(m.springs);
    const std::size_t connection = m.connections.size();
    if (spring.coupled) {
      connect_coupled(m, other, node, p, Matrix3::Identity(), *spring.coupled, name, name);
    } else {
      std::array<ConnectionFreedom, 6> freedoms = springs.freedoms({}, spring.laws);
      for (std::size_t i = 0; i < 6; ++i)
        if (spring.stiffness[i]) freedoms[i].laws = {LinearSpring{*spring.stiffness[i]}};
      m.connect(other, node, p, Matrix3::Identity(), freedoms, name, name,
                spring.to.empty() ? node_freedoms : connection_freedoms);
    }
    out.springs.push_back(last_holding(m, connection, first));
  }
}

void list_elastic(FrameModel& out, const FrameDescription& f, const Named<std::pair<int, int>>& ends) {
  for (std::size_t i = 0; i < f.springs.size(); ++i)
    out.elastic.emplace_back(f.springs[i].first, std::pair{out.springs[i].first, out.springs[i].last});
  for (std::size_t i = 0; i < f.supports.size(); ++i)
    if (out.supports[i].first != out.supports[i].last)
      out.elastic.emplace_back("support " + f.supports[i].first,
                               std::pair{out.supports[i].first, out.supports[i].last});
  out.elastic.insert(out.elastic.end(), ends.begin(), ends.end());
}

bool out_of_plane(Plane plane, int freedom) {
  return plane != Plane::none && (freedom % 3 == normal_axis(plane)) == (freedom < 3);
}

/// Last, so that what supports and links hold already is not told of them.
void hold_plane(Model& m, Plane plane) {
  for (std::size_t node = 0; plane != Plane::none && node < m.nodes.size(); ++node)
    for (int i = 0; i < 6; ++i) {
      if (!out_of_plane(plane, i)) continue;
      Constraint c;
      c.form = {{6 * static_cast<int>(node) + i, 1}};
      c.name = fmt::format("plane {} at {}", nth(plane_names, plane), m.nodes[node].name);
      c.may_repeat = true;
      m.constraints.push_back(std::move(c));
    }
}

/// A plane frame cannot carry what acts across its plane.
void refuse_across_plane(const FrameDescription& f, const FrameModel& m, const std::string& name,
                         const VectorX& forces) {
  const double most = forces.cwiseAbs().maxCoeff();
  for (Eigen::Index dof = 0; f.plane != Plane::none && dof < as_index(6 * m.model.nodes.size()); ++dof)
    if (out_of_plane(f.plane, static_cast<int>(dof % 6)) && std::abs(forces(dof)) > 1e-9 * most)
      throw InputError(
          fmt::format("load case '{}' acts at node '{}' along or about a direction that leaves the plane {}: "
                      "take it away, or leave 'plane' away",
                      name, nth(m.model.nodes, dof / 6).name, nth(plane_names, f.plane)));
}

}  // namespace

FrameModel build_frame(const FrameDescription& f, const FrameDivision& division) {
  FrameModel out;
  out.nodes = NameIndex(f.nodes);
  out.members = NameIndex(f.members);
  for (const auto& [name, position] : f.nodes) out.model.add_node(name, position);
  LawSprings springs(f);
  Named<std::pair<int, int>> elastic_ends;
  add_members(out, f, division, springs, elastic_ends);
  add_supports(out, f, springs);
  add_links(out, f);
  add_constraints(out, f);
  add_springs(out, f, springs);
  list_elastic(out, f, elastic_ends);
  hold_plane(out.model, f.plane);
  return out;
}

bool FrameModel::prestressed() const {
  return std::any_of(misfit.begin(), misfit.end(), [](double strain) { return strain != 0; });
}

namespace {

/// Loads and strains of the elements.
std::vector<ElementLoad> element_loads(const FrameDescription& f, const FrameModel& m, const LoadCase& c,
                                       bool assembled) {
  const Matrix3 turn = rotation_from_vector(c.turned);
  std::vector<ElementLoad> out(m.model.beams.size());
  const auto elements_of = [&](std::size_t member, const auto& change) {
    for (int e = m.first_element[member]; e < m.first_element[member + 1]; ++e)
      change(nth(out, e), nth(m.model.beams, e));
  };
  for (const auto& [name, load] : c.members)
    elements_of(at(m.members, "member", name), [&, &load = load](ElementLoad& e, const Beam& beam) {
      e.q_M += c.factor * (load.member_axes ? load.q : Vector3(beam.R_WM.transpose() * (turn * load.q)));
    });
  for (const auto& [name, kelvin] : c.temperature) {
    const std::size_t member = at(m.members, "member", name);
    elements_of(member, [&, strain = c.factor * m.expansion[member] * kelvin](ElementLoad& e, const Beam&) {
      e.strain += strain;
    });
  }
  if (!c.gravity.isZero(0))
    for (std::size_t member = 0; member < f.members.size(); ++member)
      elements_of(member, [&](ElementLoad& e, const Beam& beam) {
        e.q_M += c.factor * m.mass_per_length[member] * (beam.R_WM.transpose() * (turn * c.gravity));
      });
  for (std::size_t member = 0; member < f.members.size(); ++member)
    if (m.misfit[member] != 0) elements_of(member, [&](ElementLoad& e, const Beam&) { e.strain += m.misfit[member]; });
  for (std::size_t member = 0; member < f.members.size() && !assembled; ++member)
    if (const double strain = m.expansion[member] * f.members[member].second.heated; strain != 0)
      elements_of(member, [&](ElementLoad& e, const Beam&) { e.strain += strain; });
  return out;
}

}  // namespace

Vector6 turned(const LoadCase& c, const Vector6& wrench) {
  if (c.turned.isZero(0)) return wrench;
  const Matrix3 turn = rotation_from_vector(c.turned);
  Vector6 out;
  out << turn * wrench.head<3>(), turn * wrench.tail<3>();
  return out;
}

CaseLoad load_of(const FrameDescription& f, const FrameModel& m, const std::string& case_name, const LoadCase& c,
                 bool assembled) {
  CaseLoad out;
  out.forces = out.thermal = VectorX::Zero(m.model.dofs());
  out.values = VectorX::Zero(std::ssize(m.model.constraints));
  out.elements = element_loads(f, m, c, assembled);
  const auto add = [](VectorX& to, const Beam& beam, const Vector12& local) {
    for (int i = 0; i < 4; ++i)
      to.segment<3>(6 * (i < 2 ? beam.a : beam.b) + 3 * (i % 2)) += beam.R_WM * local.segment<3>(3 * i);
  };
  for (std::size_t e = 0; e < out.elements.size(); ++e) {
    const Beam& beam = m.model.beams[e];
    const ElementLoad heat{Vector3::Zero(), out.elements[e].strain};
    if (heat.strain != 0) add(out.thermal, beam, equivalent_forces(beam.rigidity, beam.length, heat));
    if (heat.strain != 0 || !out.elements[e].q_M.isZero(0))
      add(out.forces, beam, equivalent_forces(beam.rigidity, beam.length, out.elements[e]));
  }
  for (const auto& [name, wrench] : c.nodes)
    out.forces.segment<6>(6 * as_index(at(m.nodes, "node", name))) += c.factor * turned(c, wrench);
  refuse_across_plane(f, m, case_name, out.forces);

  const NameIndex supports(f.supports);
  for (const auto& [name, values] : c.displacements) {
    const auto& constraints = m.supports[at(supports, "support at node", name)].constraint;
    for (std::size_t i = 0; i < 6; ++i)
      if (values[i]) {
        if (constraints[i] < 0)
          throw InputError(fmt::format("node '{}' is not supported in {}: its displacement cannot be prescribed", name,
                                       node_freedoms[i]));
        out.values(constraints[i]) = c.factor * *values[i];
      }
  }
  for (std::size_t k = 0; k < f.supports.size() && !assembled; ++k)
    for (std::size_t i = 0; i < 6; ++i)
      if (const double way = f.supports[k].second.settled(as_index(i)); way != 0)
        out.values(m.supports[k].constraint[i]) += way;
  return out;
}

}  // namespace deflect::frame
