#include "msa/frame/structure/stability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "msa/base/index.h"
#include "msa/frame/structure/assembly.h"
#include "msa/frame/structure/elimination.h"
#include "msa/frame/structure/motions.h"

namespace deflect::frame {
namespace {

constexpr double at_rest = 1e-7;  // of the largest motion

/// "leg 1 link" of "leg 1 link [3]".
std::string base_name(const std::string& name) { return name.substr(0, name.rfind(" [")); }

std::string listed(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) text += (i ? ", " : "") + names[i];
  if (names.size() > most) text += fmt::format(" and {} more", names.size() - most);
  return text;
}

/// By node, the number of the body it belongs to: nodes joined by beams and welds.
std::vector<int> bodies(const Model& m) {
  std::vector<int> parent(m.nodes.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int i) {
    while (nth(parent, i) != i) i = nth(parent, i);
    return i;
  };
  const auto join = [&](int a, int b) {
    const int low = std::min(root(a), root(b)), high = std::max(root(a), root(b));
    nth(parent, high) = low;
  };
  for (const Beam& beam : m.beams) join(beam.a, beam.b);
  for (const auto& [a, b] : m.welds) join(a, b);
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root(static_cast<int>(i));
  return parent;
}

std::string body_name(const Model& m, const std::vector<int>& nodes) {
  const auto inside = [&](int node) { return std::binary_search(nodes.begin(), nodes.end(), node); };
  std::vector<std::string> names;
  const auto add = [&names](const std::string& name) {
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const Beam& beam : m.beams)
    if (inside(beam.a)) add(base_name(beam.name));
  if (names.empty())
    for (const int node : nodes) add(fmt::format("node '{}'", nth(m.nodes, node).name));
  return listed(names, 3);
}

FreeMotion motion_of(const Model& m, const VectorX& u, const std::vector<int>& body_of) {
  const double length = characteristic_length(m);
  FreeMotion motion;
  motion.u = u;
  for (std::size_t first = 0; first < m.nodes.size(); ++first) {
    if (body_of[first] != static_cast<int>(first)) continue;
    MovingBody body;
    double largest = 0;
    Eigen::Index mover = 0;
    for (std::size_t i = first; i < m.nodes.size(); ++i) {
      if (body_of[i] != static_cast<int>(first)) continue;
      body.nodes.push_back(static_cast<int>(i));
      const auto at = as_index(6 * i);
      const double size = std::max(u.segment<3>(at).norm(), length * u.segment<3>(at + 3).norm());
      if (size > largest) largest = size, mover = as_index(i);
    }
    if (largest < at_rest) continue;
    body.name = body_name(m, body.nodes);
    body.screw = screw_of(nth(m.nodes, mover).position, u.segment<3>(6 * mover), u.segment<3>(6 * mover + 3));
    motion.bodies.push_back(std::move(body));
  }
  for (const Release& r : m.releases)
    if (std::abs(evaluate(r.form, u)) > at_rest) motion.joints.push_back(r.name);
  return motion;
}

enum class Moved { node, member, other };

/// One node that turns, one straight member that turns about its own axis, or anything else.
Moved moved_by(const Model& m, const IdleMotion& idle) {
  const auto nodal = static_cast<int>(6 * m.nodes.size());
  int first = -1;
  bool several = false, displaced = false;
  for (const Term& t : idle.u) {
    if (t.dof >= nodal) return Moved::other;
    displaced = displaced || t.dof % 6 < 3;
    if (first < 0) first = t.dof / 6;
    several = several || t.dof / 6 != first;
  }
  return displaced ? Moved::other : several ? Moved::member : Moved::node;
}

std::string words(const Screw& s) {
  const auto tidy = [](double x) { return std::abs(x) < 5e-7 ? 0.0 : x; };
  const std::string axis =
      fmt::format("({:.3g}, {:.3g}, {:.3g})", tidy(s.axis.x()), tidy(s.axis.y()), tidy(s.axis.z()));
  if (s.translation) return "slides along " + axis;
  const std::string through = fmt::format("through ({:.4g}, {:.4g}, {:.4g}) mm", 1e3 * tidy(s.point.x()),
                                          1e3 * tidy(s.point.y()), 1e3 * tidy(s.point.z()));
  const std::string advance =
      std::abs(s.pitch) > 1e-9 ? fmt::format(", advancing {:.4g} mm per rad", 1e3 * s.pitch) : "";
  return fmt::format("turns about {} {}{}", axis, through, advance);
}

/// One line for each.
std::string listed(const Model& m, const std::vector<FreeMotion>& motions) {
  std::string list;
  for (std::size_t i = 0; i < motions.size(); ++i) list += fmt::format("\n  {}: {}", i + 1, describe(m, motions[i]));
  return list;
}

}  // namespace

Screw screw_of(const Vector3& p, const Vector3& v, const Vector3& w) {
  Screw s;
  if (w.norm() <= 1e-9 * v.norm()) {
    s.translation = true;
    s.axis = v.normalized();
    return s;
  }
  s.axis = w.normalized();
  s.point = p + w.cross(v) / w.squaredNorm();
  s.point -= s.axis * s.axis.dot(s.point - p);  // the point of the axis nearest to p
  s.pitch = s.axis.dot(v) / w.norm();
  Eigen::Index most = 0;
  s.axis.cwiseAbs().maxCoeff(&most);
  if (s.axis(most) < 0) s.axis = -s.axis;  // a screw has no sense of its own; the pitch keeps its hand
  return s;
}

CannotStand::CannotStand(const std::string& head, const Model& m, const MatrixX& free)
    : CannotStand(head, m, free_motions_of(m, free)) {}

CannotStand::CannotStand(const std::string& head, const Model& m, std::vector<FreeMotion> free)
    : ModelError(head + listed(m, free)), model(std::make_shared<const Model>(m)), motions(std::move(free)) {}

VectorX normalised(const Model& m, VectorX u) {
  const double length = characteristic_length(m);
  const auto nodal = as_index(6 * m.nodes.size());
  double size = 0;
  for (Eigen::Index i = 0; i < u.size(); ++i)
    size = std::max(size, std::abs(u(i)) * (i < nodal && i % 6 >= 3 ? length : 1));
  return u / size;
}

std::vector<FreeMotion> free_motions_of(const Model& m, const MatrixX& free) {
  MatrixX U = free;
  take_apart(U);
  const std::vector<int> body_of = bodies(m);
  std::vector<FreeMotion> motions;
  for (Eigen::Index j = 0; j < U.cols(); ++j) motions.push_back(motion_of(m, normalised(m, U.col(j)), body_of));
  return motions;
}

std::string describe(const Model& m, const FreeMotion& motion) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(motion.bodies.size(), 3); ++i)
    text += fmt::format("{}{} {}", i ? "; " : "", motion.bodies[i].name, words(motion.bodies[i].screw));
  if (motion.bodies.size() > 3) text += fmt::format("; and {} more bodies", motion.bodies.size() - 3);
  if (motion.bodies.empty()) {  // a scalar freedom, or a node freedom that nothing takes part in
    Eigen::Index most = 0;
    motion.u.cwiseAbs().maxCoeff(&most);
    text = m.dof_name(static_cast<int>(most)) + " moves freely";
  }
  if (!motion.joints.empty())
    text += fmt::format(". To hold it, lock or spring one of: {}", listed(motion.joints, 6));
  else if (!motion.bodies.empty())
    text += fmt::format(". To hold it, support node '{}'", nth(m.nodes, motion.bodies[0].nodes.front()).name);
  return text;
}

std::string name_of(const Model& m, const IdleMotion& idle) {
  const Moved moved = moved_by(m, idle);
  VectorX u = VectorX::Zero(m.dofs());
  for (const Term& t : idle.u) u(t.dof) = t.coefficient;
  const FreeMotion motion = motion_of(m, u, bodies(m));
  if (motion.bodies.empty()) return m.dof_name(idle.u.front().dof) + " moves idly";
  const MovingBody& body = motion.bodies.front();
  if (moved == Moved::member) return body.name + " spins idly about its own axis";
  const std::string more =
      motion.bodies.size() > 1 ? fmt::format(" with {} more", motion.bodies.size() - 1) : std::string();
  return fmt::format("{}{} idly {}", body.name, more, words(body.screw));
}

std::vector<std::string> idle_notes(const Model& m, const std::vector<IdleMotion>& idle) {
  constexpr std::size_t few = 8;
  std::vector<std::string> notes;
  if (idle.size() <= few) {
    for (const IdleMotion& motion : idle) notes.push_back(name_of(m, motion) + ": harmless, held");
    return notes;
  }
  std::array<std::size_t, 3> count{};
  for (const IdleMotion& motion : idle) ++nth(count, moved_by(m, motion));
  constexpr std::array<const char*, 3> what = {"rotations of hinged nodes", "spins of members about their own axes",
                                               "motions of inner bodies"};
  for (std::size_t i = 0; i < count.size(); ++i)
    if (count[i] > 0)
      notes.push_back(fmt::format("{} {} that nothing holds and nothing drives: harmless, held", count[i], what[i]));
  return notes;
}

std::string explain_condition(const Model& m, const VectorX& soft, double reciprocal_condition) {
  double most = -1, stiffest = 0;
  std::string soft_part, stiff_part;
  for (const Beam& beam : m.beams) {
    const Vector12 d = end_displacements(beam, soft);
    if (const double energy = d.dot(pull(beam, d)); energy > most) most = energy, soft_part = beam.name;
    if (const double k = beam.rigidity.EA / beam.length; k > stiffest) stiffest = k, stiff_part = beam.name;
  }
  for (const Spring& spring : m.springs) {
    const double d = evaluate(spring.elongation, soft);
    if (const double energy = tangent_at_force(spring.law, 1) * d * d; energy > most)
      most = energy, soft_part = spring.name;
  }
  const std::string head =
      fmt::format("the stiffness is ill-conditioned (reciprocal condition {:.1e})", reciprocal_condition);
  if (stiff_part.empty() || stiff_part == soft_part) return head;
  return fmt::format("{}: '{}' is too soft beside '{}'; check its section, material or units", head, soft_part,
                     stiff_part);
}

}  // namespace deflect::frame
