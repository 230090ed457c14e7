#include "tests/attack/frame_forms.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "msa/frame/file/member_axes.h"

namespace deflect::attack {
namespace {

using frame::ConstraintTerm;
using frame::FrameConstraint;
using frame::FrameDescription;
using frame::Freedoms;

void scale(Section& section, double s) {
  if (auto* round = std::get_if<RoundSection>(&section.shape)) round->diameter *= s;
  if (auto* tube = std::get_if<TubeSection>(&section.shape)) tube->outer_diameter *= s, tube->inner_diameter *= s;
  if (auto* flat = std::get_if<RectangleSection>(&section.shape)) flat->width_y *= s, flat->height_z *= s;
}

bool is_signed_permutation(const Matrix3& R) { return (R.array().abs() > 0).count() == 3; }

/// Freedom i of base axes, in axes that R has turned: the components (freedom, factor) of Rᵀ u' along e_i.
std::vector<std::pair<int, double>> along(const Matrix3& R, int freedom) {
  std::vector<std::pair<int, double>> out;
  const double sign = freedom < 3 ? 1 : std::round(R.determinant());
  const int first = freedom < 3 ? 0 : 3;
  for (int j = 0; j < 3; ++j)
    if (R(j, freedom - first) != 0) out.emplace_back(first + j, sign * R(j, freedom - first));
  return out;
}

template <class Values>
Values permuted(const Values& values, const Matrix3& R) {
  Values out{};
  for (int i = 0; i < 6; ++i) out[static_cast<std::size_t>(along(R, i)[0].first)] = values[static_cast<std::size_t>(i)];
  return out;
}

void add_terms(FrameConstraint& c, const std::string& node, int freedom, const Matrix3& R, double factor,
               std::optional<double> arm) {
  for (const auto& [j, part] : along(R, freedom)) {
    ConstraintTerm t;
    t.node = node, t.freedom = j, t.factor = factor * part, t.arm = arm;
    c.terms.push_back(t);
  }
}

void supports_as_constraints(FrameDescription& f, const Matrix3& R) {
  Named<frame::FrameSupport> kept;
  for (const auto& [node, held] : f.supports) {
    Freedoms whole{};
    for (int first = 0; first < 6; first += 3) {
      const auto k = static_cast<std::size_t>(first);
      if (held[k] && held[k + 1] && held[k + 2]) {
        whole[k] = whole[k + 1] = whole[k + 2] = true;
        continue;
      }
      for (int i = first; i < first + 3; ++i) {
        if (!held[static_cast<std::size_t>(i)]) continue;
        FrameConstraint c;
        add_terms(c, node, i, R, 1, std::nullopt);
        f.constraints.emplace_back(fmt::format("support {} {}", node, i), c);
      }
    }
    if (whole != Freedoms{}) kept.emplace_back(node, whole);
  }
  f.supports = kept;
}

/// The relation of a follower to its master in one base axis of the structure as it was: u_b − u_a − (θ_a × r)_i = 0.
void links_as_constraints(FrameDescription& f, const FrameDescription& before, const Matrix3& R) {
  for (const auto& [name, link] : before.rigid_links)
    for (const std::string& follower : link.nodes)
      for (int i = 0; i < 6; ++i) {
        if (!link.freedoms[static_cast<std::size_t>(i)]) continue;
        FrameConstraint c;
        add_terms(c, follower, i, R, 1, std::nullopt);
        add_terms(c, link.master, i, R, -1, std::nullopt);
        const Vector3 r = *find(before.nodes, follower) - *find(before.nodes, link.master);
        if (i < 3)
          for (int k = 0; k < 3; ++k) {
            const double arm = Vector3::Unit(k).cross(r)(i);
            if (arm != 0) add_terms(c, link.master, 3 + k, R, arm > 0 ? -1 : 1, std::abs(arm));
          }
        f.constraints.emplace_back(fmt::format("{} {} {}", name, follower, i), c);
      }
  f.rigid_links.clear();
}

template <class T>
void shuffle(Named<T>& list, Dice& dice) {
  for (std::size_t i = list.size(); i > 1; --i) std::swap(list[i - 1], list[dice.bits() % i]);
}

Vector3 local_y(const FrameDescription& f, const frame::FrameMember& m) {
  return frame::member_axes(*find(f.nodes, m.to) - *find(f.nodes, m.from), m.y_axis).col(1);
}

}  // namespace

FrameDescription scaled(FrameDescription f, double s) {
  const auto scale_laws = [s](frame::FreedomLaws& laws) {
    for (std::size_t i = 0; i < 6; ++i)
      for (const bool beside : {false, true}) {
        std::vector<Law> list = laws.at(i, beside);
        for (Law& law : list) std::get<LinearLaw>(law).stiffness *= i < 3 ? s : s * s * s;
        laws.set(i, list, beside);
      }
  };
  for (auto& [name, m] : f.members) scale_laws(m.start), scale_laws(m.end);
  for (auto& [node, support] : f.supports) scale_laws(support.laws);
  for (auto& [name, spring] : f.springs)
    if (spring.coupled)
      for (Eigen::Index i = 0; i < 6; ++i) (*spring.coupled)(i, i) *= i < 3 ? s : s * s * s;  // diagonal here
  for (auto& [name, p] : f.nodes) p *= s;
  for (auto& [name, section] : f.sections) scale(section, s);
  for (auto& [name, spring] : f.springs)
    for (std::size_t i = 0; i < 6; ++i)
      if (spring.stiffness[i]) *spring.stiffness[i] *= i < 3 ? s : s * s * s;
  for (auto& [name, c] : f.constraints)
    for (ConstraintTerm& t : c.terms)
      if (t.arm) *t.arm *= s;
  for (auto& [name, load] : f.loads)
    for (auto& [node, w] : load.nodes) w.head<3>() *= s * s, w.tail<3>() *= s * s * s;
  return f;
}

FrameDescription in_force_unit(FrameDescription f, double c) {
  for (auto& [name, material] : f.materials) {
    material.elastic.E *= c;
    if (material.elastic.G) *material.elastic.G *= c;
  }
  for (auto& [name, spring] : f.springs)
    for (auto& k : spring.stiffness)
      if (k) *k *= c;
  for (auto& [name, load] : f.loads)
    for (auto& [node, w] : load.nodes) w *= c;
  return f;
}

FrameDescription shuffled(FrameDescription f, Dice& dice) {
  for (auto& [name, m] : f.members) {
    if (!dice.chance(0.5)) continue;
    m.y_axis = local_y(f, m);
    std::swap(m.from, m.to);
    std::swap(m.release_from, m.release_to);
  }
  shuffle(f.nodes, dice), shuffle(f.members, dice), shuffle(f.supports, dice);
  shuffle(f.springs, dice), shuffle(f.constraints, dice);
  for (auto& [name, c] : f.constraints) std::reverse(c.terms.begin(), c.terms.end());
  return f;
}

std::optional<FrameDescription> turned(const FrameDescription& before, const Matrix3& R) {
  FrameDescription f = before;
  const bool axes = is_signed_permutation(R);
  if (!axes && !before.springs.empty()) return std::nullopt;
  for (auto& [name, m] : f.members) m.y_axis = R * local_y(before, m);
  for (auto& [name, p] : f.nodes) p = R * p;
  const double sign = std::round(R.determinant());
  for (auto& [name, load] : f.loads)
    for (auto& [node, w] : load.nodes) {
      const Vector3 force = w.head<3>(), moment = w.tail<3>();
      w << R * force, sign * (R * moment);
    }
  f.constraints.clear();
  for (const auto& [name, c] : before.constraints) {
    FrameConstraint out;
    for (const ConstraintTerm& t : c.terms) add_terms(out, t.node, t.freedom, R, t.factor, t.arm);
    f.constraints.emplace_back(name, out);
  }
  if (axes) {
    for (auto& [node, held] : f.supports) held = permuted(held, R);
    for (auto& [name, spring] : f.springs) spring.stiffness = permuted(spring.stiffness, R);
    for (auto& [name, link] : f.rigid_links) link.freedoms = permuted(link.freedoms, R);
  } else {
    supports_as_constraints(f, R);
    links_as_constraints(f, before, R);
  }
  return f;
}

Matrix3 signed_permutation(Dice& dice) {
  Matrix3 R = Matrix3::Zero();
  std::array<int, 3> columns = {0, 1, 2};
  for (std::size_t i = 3; i > 1; --i) std::swap(columns[i - 1], columns[dice.bits() % i]);
  for (int i = 0; i < 3; ++i) R(i, columns[static_cast<std::size_t>(i)]) = dice.chance(0.5) ? 1 : -1;
  return R;
}

Matrix3 any_rotation(Dice& dice) {
  const Vector3 axis = dice.reals(-1, 1);
  return Eigen::AngleAxisd(dice.real(0.1, 3), axis.normalized()).toRotationMatrix();
}

}  // namespace deflect::attack
