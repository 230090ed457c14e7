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

int connect_coupled(Model& m, int a, int b, const Vector3& p, const Matrix6& K, const std::string& name,
                    const std::string& part) {
  const int first = static_cast<int>(m.constraints.size()), component = m.dofs();
  m.connect(a, b, p, Matrix3::Identity(), {}, name, part);
  for (int i = 0; i < 6; ++i) {
    m.scalars.push_back(fmt::format("{} {}", name, nth(connection_freedoms, i)));
    Constraint& c = nth(m.constraints, first + i);
    c.form.push_back({component + i, -1});
    c.eliminates = component + i;
  }
  if (a >= 0) m.welds.pop_back();
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
