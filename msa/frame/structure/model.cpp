#include "msa/frame/structure/model.h"
#include "msa/base/index.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace deflect::frame {
namespace {

constexpr std::array<const char*, 6> dof_names = {"ux", "uy", "uz", "rx", "ry", "rz"};

void append(LinearForm& form, const LinearForm& more) { form.insert(form.end(), more.begin(), more.end()); }

LinearForm relative(const Model& m, int a, int b, const Vector3& p, const Vector3& axis, bool rotation) {
  LinearForm form = rotation ? rotation_of(b, axis) : translation_of(m, b, p, axis);
  if (a < 0) return form;
  append(form, rotation ? rotation_of(a, axis, -1) : translation_of(m, a, p, axis, -1));
  return form;
}

}  // namespace

std::string Model::dof_name(int dof) const {
  const auto n = static_cast<int>(6 * nodes.size());
  if (dof >= n) return nth(scalars, dof - n);
  return fmt::format("node '{}' {}", nth(nodes, dof / 6).name, nth(dof_names, dof % 6));
}

LinearForm translation_of(const Model& m, int node, const Vector3& p, const Vector3& axis, double factor) {
  LinearForm form;
  const Vector3 turning = (p - nth(m.nodes, node).position).cross(axis);  // axis·(θ × r) = θ·(r × axis)
  for (int i = 0; i < 3; ++i)
    if (axis(i) != 0) form.push_back({6 * node + i, factor * axis(i)});
  for (int i = 0; i < 3; ++i)
    if (turning(i) != 0) form.push_back({6 * node + 3 + i, factor * turning(i)});
  return form;
}

LinearForm rotation_of(int node, const Vector3& axis, double factor) {
  LinearForm form;
  for (int i = 0; i < 3; ++i)
    if (axis(i) != 0) form.push_back({6 * node + 3 + i, factor * axis(i)});
  return form;
}

int Model::add_node(std::string name, const Vector3& position) {
  if (!scalars.empty()) throw std::logic_error("nodes come before scalars: freedoms are numbered nodes first");
  nodes.push_back({std::move(name), position});
  return static_cast<int>(nodes.size()) - 1;
}

void Model::add_beam(int a, int b, const Matrix3& R_WM, const BeamRigidity& rigidity, std::string name,
                     std::string part) {
  const double length = (nth(nodes, b).position - nth(nodes, a).position).norm();
  beams.push_back({a, b, R_WM, length, rigidity, std::move(name), std::move(part)});
}

Connection& Model::grounded(int node) {
  connections.push_back({-1, node, nth(nodes, node).position, {Matrix3::Identity(), Matrix3::Identity()}});
  return connections.back();
}

void Model::fix(int node, const std::string& name) {
  Connection& record = grounded(node);
  for (int i = 0; i < 6; ++i) {
    nth(record.constraint, i) = static_cast<int>(constraints.size());
    constraints.push_back({{{6 * node + i, 1}}, 0, fmt::format("{} {}", name, nth(dof_names, i))});
  }
}

void Model::join(int a, int b, const std::string& name) {
  connect(a, b, nth(nodes, b).position, Matrix3::Identity(), {}, name, name);
}

void Model::connect(int a, int b, const Vector3& p, const Matrix3& R, const std::array<ConnectionFreedom, 6>& freedoms,
                    const std::string& name, const std::string& part, const FreedomNames& names) {
  if (a >= 0 && std::all_of(freedoms.begin(), freedoms.end(), [](const ConnectionFreedom& f) { return f.rigid; }))
    welds.emplace_back(a, b);
  Connection record{a, b, p, {R, R}};
  std::vector<Connection> beside;
  for (std::size_t half = 0; half < 6; half += 3) {
    // Three rigid freedoms say the same in any axes; base axes give the sparsest equations.
    const bool all_rigid = freedoms[half].rigid && freedoms[half + 1].rigid && freedoms[half + 2].rigid;
    if (all_rigid) record.axes[half / 3] = Matrix3::Identity();
    for (std::size_t i = half; i < half + 3; ++i) {
      const auto column = as_index(i - half);
      const Vector3 axis = record.axes[half / 3].col(column);
      LinearForm form = relative(*this, a, b, p, axis, half == 3);
      const std::string label = fmt::format("{} {}", name, names[i]);
      for (const SpringLaw& law : freedoms[i].beside) {
        beside.push_back({a, b, p, record.axes});
        beside.back().spring[i] = static_cast<int>(springs.size());
        springs.push_back({form, law, label + " beside", part});
      }
      if (freedoms[i].rigid) {
        record.constraint[i] = static_cast<int>(constraints.size());
        constraints.push_back({std::move(form), 0, label});
      } else if (a >= 0 && freedoms[i].laws.empty() && freedoms[i].beside.empty()) {
        releases.push_back({std::move(form), label});
      }
      const auto& laws = freedoms[i].laws;
      for (std::size_t k = 0; k + 1 < laws.size(); ++k) {  // δ = s₁ + s₂ + …; each but the last has its own freedom
        const int s = dofs();
        scalars.push_back(fmt::format("{} [{}]", label, k + 1));
        springs.push_back({{{s, 1}}, laws[k], fmt::format("{} [{}]", label, k + 1), part});
        form.push_back({s, -1});
      }
      if (laws.empty()) continue;
      record.spring[i] = static_cast<int>(springs.size());
      springs.push_back({std::move(form), laws.back(), label, part});
    }
  }
  connections.push_back(record);
  connections.insert(connections.end(), beside.begin(), beside.end());
}

}  // namespace deflect::frame
