#include "msa/frame/structure/relative.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

#include "msa/base/index.h"
#include "msa/frame/structure/elimination.h"

namespace deflect::frame {
namespace {

constexpr double beside_others = 1e4;
constexpr int ground = -1;

/// What a part joins, and how stiffly: Nm/rad; of a linear spring along a line its stiffness times the squared length
/// of the structure.
struct Joining {
  std::vector<int> nodes;  ///< the ground counts as one; empty: inside of a joint
  double stiffness = 0;
};

/// The nodes in which a form has freedoms; with one alone the ground.
std::vector<int> joined_by(const Model& m, const LinearForm& form) {
  std::vector<int> out;
  for (const Term& t : form)
    if (std::cmp_less(t.dof, 6 * m.nodes.size()) && std::find(out.begin(), out.end(), t.dof / 6) == out.end())
      out.push_back(t.dof / 6);
  if (out.size() == 1) out.push_back(ground);
  return out;
}

std::vector<Joining> joinings(const Model& m) {
  std::vector<Joining> out;
  const double length = characteristic_length(m);
  for (const Beam& b : m.beams) out.push_back({{b.a, b.b}, std::min(b.rigidity.EIy, b.rigidity.EIz) / b.length});
  for (const Spring& s : m.springs)
    if (const auto* linear = std::get_if<LinearSpring>(&s.law); linear && linear->k > 0)
      out.push_back({joined_by(m, s.elongation), linear->k * (s.law.rotation ? 1 : length * length)});
  return out;
}

/// Sets of nodes that hang together.
class Together {
 public:
  explicit Together(std::size_t nodes) : of_(nodes + 1) { std::iota(of_.begin(), of_.end(), 0); }
  /// Whether they were apart.
  bool join(const std::vector<int>& nodes) {
    bool apart = false;
    for (const int node : nodes)
      if (const int a = set_of(nodes.front() + 1), b = set_of(node + 1); a != b) {
        nth(of_, b) = a;
        apart = true;
      }
    return apart;
  }

 private:
  int set_of(int node) {
    while (nth(of_, node) != node) node = nth(of_, node) = nth(of_, nth(of_, node));
    return node;
  }
  std::vector<int> of_;  // by node, the ground first
};

/// Freedoms that half of the nodes or more hold: a plane frame holds them everywhere, and no node is supported by that.
std::array<bool, 6> held_in_common(const Model& m) {
  std::array<std::size_t, 6> count{};
  for (const Constraint& c : m.constraints)
    if (c.form.size() == 1 && std::cmp_less(c.form.front().dof, 6 * m.nodes.size()))
      ++nth(count, c.form.front().dof % 6);
  std::array<bool, 6> out{};
  for (std::size_t i = 0; i < 6; ++i) out[i] = 2 * count[i] >= m.nodes.size();
  return out;
}

/// The softest part that others hang on. Parts join what they connect one after the other, the stiffest first. One that
/// connects what hangs together already, a member that is all but missing beside others, moves little: it counts as
/// beside_others times as stiff as it is.
double softest(const Model& m) {
  std::vector<Joining> all = joinings(m);
  std::stable_sort(all.begin(), all.end(),
                   [](const Joining& a, const Joining& b) { return a.stiffness > b.stiffness; });
  Together together(m.nodes.size());
  const std::array<bool, 6> common = held_in_common(m);
  for (const Constraint& c : m.constraints)
    if (const std::vector<int> nodes = joined_by(m, c.form); !nodes.empty())
      if (c.form.size() > 1 || !nth(common, c.form.front().dof % 6)) together.join(nodes);
  double least = std::numeric_limits<double>::infinity();
  for (const Joining& part : all) {
    const bool carries = part.nodes.empty() || together.join(part.nodes);
    least = std::min(least, part.stiffness * (carries ? 1 : beside_others));
  }
  return least;
}

int next_constraint(const Model& m) { return static_cast<int>(m.constraints.size()); }

void make_relative(Model& m, Beam& beam) {
  beam.relative = m.dofs();
  beam.defined_by = next_constraint(m);
  for (int i = 0; i < 6; ++i) m.scalars.push_back(fmt::format("deformation {} of {}", i + 1, beam.name));
  const Vector3 arm = nth(m.nodes, beam.b).position;
  for (int i = 0; i < 6; ++i) {
    const Vector3 axis = Vector3::Unit(i % 3);
    LinearForm form = i < 3 ? translation_of(m, beam.a, arm, axis, -1) : rotation_of(beam.a, axis, -1);
    form.push_back({6 * beam.b + i, 1});
    form.push_back({beam.relative + i, -1});
    m.constraints.push_back({std::move(form), 0, beam.name, 6 * beam.b + i});
  }
}

/// The elongation becomes a coordinate; the constraint that defines it eliminates what it was made from.
void make_relative(Model& m, Spring& spring) {
  const int elongation = m.dofs();
  m.scalars.push_back("elongation of " + spring.name);
  LinearForm form = spring.elongation;
  const auto most = std::max_element(form.begin(), form.end(), [](const Term& a, const Term& b) {
    return std::abs(a.coefficient) < std::abs(b.coefficient);
  });
  const int eliminates = most->dof;
  form.push_back({elongation, -1});
  spring.defined_by = next_constraint(m);
  m.constraints.push_back({std::move(form), 0, spring.name, eliminates});
  spring.elongation = {{elongation, 1}};
}

bool is_stiff(const Beam& beam, double limit) {
  return std::min(beam.rigidity.EIy, beam.rigidity.EIz) / beam.length > limit;
}

bool is_stiff(const Spring& spring, double limit, double length) {
  const auto* linear = std::get_if<LinearSpring>(&spring.law);
  return linear && linear->k * length * length > limit * 1e4;
}

/// Of the translations that the structure resists, N/m.
double stiffest(const Model& m) {
  const double length = characteristic_length(m);
  double most = 0;
  for (const Beam& b : m.beams) most = std::max(most, b.rigidity.EA / b.length);
  for (const Spring& s : m.springs) {
    const double per_length = s.law.rotation ? 1 / (length * length) : 1;
    if (const auto* linear = std::get_if<LinearSpring>(&s.law)) most = std::max(most, linear->k * per_length);
    if (const auto* friction = std::get_if<FrictionSpring>(&s.law)) most = std::max(most, friction->k * per_length);
  }
  return most > 0 ? most : 1e8;
}

}  // namespace

double contact_stiffness(const Model& m) { return 10 * stiffest(m); }

void give_contacts_stiffness(Model& m) {
  if (std::none_of(m.springs.begin(), m.springs.end(), [](const Spring& s) { return jumps(s.law); })) return;
  const double length = characteristic_length(m), contact = contact_stiffness(m);
  for (Spring& s : m.springs) {
    const double stiffness = s.law.rotation ? contact * length * length : contact;
    if (auto* gap = std::get_if<GapSpring>(&s.law)) gap->contact = stiffness;
    if (auto* one = std::get_if<OneSidedSpring>(&s.law)) one->contact = stiffness;
    know_force(s.law, 0);
  }
}

bool wants_relative_motion(const Model& m, double ratio) {
  const double limit = ratio * softest(m), length = characteristic_length(m);
  return std::any_of(m.beams.begin(), m.beams.end(),
                     [&](const Beam& b) { return b.relative < 0 && is_stiff(b, limit); }) ||
         std::any_of(m.springs.begin(), m.springs.end(), [&](const Spring& s) {
           return s.elongation.size() > 1 && (is_stiff(s, limit, length) || jumps(s.law));
         });
}

std::vector<std::string> use_relative_motion(Model& m, double ratio) {
  std::vector<std::string> names;
  const double limit = ratio * softest(m);
  for (Beam& beam : m.beams)
    if (beam.relative < 0 && is_stiff(beam, limit)) {
      make_relative(m, beam);
      names.push_back(beam.name);
    }
  const double length = characteristic_length(m);
  for (Spring& spring : m.springs) {
    const bool stiff = is_stiff(spring, limit, length);
    if (spring.elongation.size() > 1 && (stiff || jumps(spring.law))) {
      make_relative(m, spring);
      if (stiff) names.push_back(spring.name);
    }
  }
  return names;
}

}  // namespace deflect::frame
