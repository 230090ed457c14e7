#include "msa/frame/structure/coupled_spring.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "msa/base/index.h"

namespace deflect::frame {

/// By LDLᵀ, the largest diagonal entry of what is left first. Where stiffnesses differ by many orders, the soft ones
/// keep their digits, which eigenvectors would lose to the rounding of the stiff ones.
std::vector<std::pair<Vector6, double>> squares(const Matrix6& K) {
  const double unit = std::sqrt(K.bottomRightCorner<3, 3>().trace() / K.topLeftCorner<3, 3>().trace());
  std::vector<std::pair<Vector6, double>> out;
  Eigen::Matrix<Extended, 6, 6> left = K.cast<Extended>();
  const auto weight = [&](Eigen::Index i) { return i < 3 ? Extended(1) : Extended(unit) * Extended(unit); };
  std::array<bool, 6> done{};
  for (int step = 0; step < 6; ++step) {
    Eigen::Index k = -1;
    for (Eigen::Index i = 0; i < 6; ++i)
      if (!done[as_size(i)] && (k < 0 || left(i, i) / weight(i) > left(k, k) / weight(k))) k = i;
    if (!(left(k, k) > 0)) break;
    const Extended pivot = left(k, k);
    const Eigen::Matrix<Extended, 6, 1> column = left.col(k) / pivot;
    const double length = k < 3 ? 1 : unit;
    out.emplace_back(length * column.cast<double>(), static_cast<double>(pivot) / (length * length));
    left -= pivot * column * column.transpose();
    left.col(k).setZero();
    left.row(k).setZero();
    done[as_size(k)] = true;
  }
  return out;
}

int connect_coupled(Model& m, int a, int b, const Vector3& p, const Matrix3& R, const Matrix6& K,
                    const std::string& name, const std::string& part) {
  const int first = static_cast<int>(m.constraints.size()), component = m.dofs();
  Connection connection{a, b, p, {R, R}};
  for (int i = 0; i < 6; ++i) {
    const std::string label = fmt::format("{} {}", name, nth(connection_freedoms, i));
    LinearForm form{{component + i, -1}};
    for (const auto& [node, sign] : {std::pair{b, 1.0}, std::pair{a, -1.0}}) {
      if (node < 0) continue;
      const Vector3 axis = R.col(i % 3);
      const LinearForm half = i < 3 ? translation_of(m, node, p, axis, sign) : rotation_of(node, axis, sign);
      form.insert(form.end(), half.begin(), half.end());
    }
    m.scalars.push_back(label);
    nth(connection.constraint, i) = first + i;
    m.constraints.push_back({std::move(form), 0, label, component + i});
  }
  m.connections.push_back(connection);
  int number = 0;
  for (const auto& [v, d] : squares(K)) {
    LinearForm form;
    for (int i = 0; i < 6; ++i)
      if (v(i) != 0) form.push_back({component + i, v(i)});
    m.springs.push_back({std::move(form), LinearSpring{d}, fmt::format("{} [{}]", name, ++number), part});
  }
  return first;
}

}  // namespace deflect::frame
