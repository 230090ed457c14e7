#include "msa/frame/structure/standing.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "msa/base/index.h"
#include "msa/frame/structure/elimination.h"
#include "msa/frame/structure/pieces.h"

namespace deflect::frame {
namespace {

constexpr double held = 1e-10;  // of a body's largest hold, squared: any less is no hold
constexpr double rounding = 1e-13;

}  // namespace

std::string not_proved_standing(const Model& m) {
  const std::vector<int> body = first_nodes(m);
  const double length = characteristic_length(m);
  const auto nodal = static_cast<int>(6 * m.nodes.size());
  std::vector<Matrix6> hold(m.nodes.size(), Matrix6::Zero());  // by body, Σ row · rowᵀ over its six numbers
  for (const Constraint& c : m.constraints) {
    int only = -1;
    double size = 0;  // of what is summed: between two nodes of one body it cancels, but for rounding
    Vector6 row = Vector6::Zero();
    for (const Term& t : c.form) {
      const auto node = as_size(t.dof / 6);
      if (t.dof >= nodal || (only >= 0 && body[node] != only)) {
        only = -1;
        break;
      }
      only = body[node];
      const Vector3 arm = (m.nodes[node].position - nth(m.nodes, only).position) / length;
      const Vector3 axis = Vector3::Unit(t.dof % 3);
      size = std::max(size, std::abs(t.coefficient) * (t.dof % 6 < 3 ? 1 : 1 / length));
      if (t.dof % 6 < 3) {  // u = v + w × r, rotations times the structure's size
        row.head<3>() += t.coefficient * axis;
        row.tail<3>() += t.coefficient * arm.cross(axis);
      } else {
        row.tail<3>() += t.coefficient / length * axis;
      }
    }
    if (only >= 0 && row.norm() > rounding * size) nth(hold, only) += row * row.transpose() / row.squaredNorm();
  }
  for (std::size_t i = 0; i < m.nodes.size(); ++i) {
    if (body[i] != static_cast<int>(i)) continue;
    const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(hold[i], Eigen::EigenvaluesOnly);
    if (!(eigen.eigenvalues()(0) > held * std::max(1.0, eigen.eigenvalues()(5))))
      return fmt::format("the body of node '{}' is not held by supports of its own", m.nodes[i].name);
  }
  return "";
}

}  // namespace deflect::frame
