#include "tests/attack/device_oracle.h"

#include <algorithm>
#include <array>

#include "tests/attack/echelon.h"
#include "tests/attack/member_flexibility.h"

namespace deflect::attack {
namespace {

using Vector = std::array<Real, 3>;

Vector exact(const Vector3& v) { return {Real(v.x()), Real(v.y()), Real(v.z())}; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Components of a wrench [f; m / size] at T in the axes R at the place p, moments over the size too.
RealMatrix to_axes(const Matrix3& R, const Vector3& p, const Vector3& p_T, double size) {
  RealMatrix X(6, 6);
  const Vector T = exact(p_T), at = exact(p), arm = {T[0] - at[0], T[1] - at[1], T[2] - at[2]};
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Vector axis = exact(R.col(i));
    const Vector lever = cross(axis, arm);  // axis · (arm × f) = f · (axis × arm)
    const auto row = static_cast<std::size_t>(i);
    for (std::size_t k = 0; k < 3; ++k) {
      X(row, k) = X(3 + row, 3 + k) = axis[k];
      X(3 + row, k) = lever[k] / size;
    }
  }
  return X;
}

class ForceMethod {
 public:
  explicit ForceMethod(const Configuration& c) : p_T_(c.pose.p_WT), size_(c.size > 0 ? c.size : 1) {
    const int base = c.base.rigid() ? ground : add_body();
    if (base != ground) add_chain({c.base}, ground, base);
    const int platform = add_body();
    for (const PlacedLeg& leg : c.legs) add_parts(leg.parts, base, platform);
    tool_ = platform;
    if (!c.tool.rigid()) add_chain({c.tool}, platform, tool_ = add_body());
  }

  DeviceTruth solve() {
    const std::size_t rows = 6 * static_cast<std::size_t>(bodies_), columns = forces();
    RealMatrix A(rows, columns + 6);
    std::size_t column = 0;
    for (const Chain& chain : chains_) {
      for (std::size_t k = 0; k < chain.Q.size(); ++k, ++column)
        for (std::size_t i = 0; i < 6; ++i) {
          if (chain.end != ground) A(6 * static_cast<std::size_t>(chain.end) + i, column) += chain.Q[k][i];
          if (chain.start != ground) A(6 * static_cast<std::size_t>(chain.start) + i, column) -= chain.Q[k][i];
        }
    }
    for (std::size_t i = 0; i < 6; ++i) A(6 * static_cast<std::size_t>(tool_) + i, columns + i) = 1;
    const Echelon equilibrium(std::move(A), columns, Real("1e-10"));
    note(equilibrium);
    truth_.held = equilibrium.left_over() < Real("1e-10");
    if (!truth_.held) return truth_;
    truth_.idle += static_cast<int>(rows - equilibrium.rank());
    displacements(equilibrium);
    return truth_;
  }

 private:
  static constexpr int ground = -1;
  using Row6 = std::vector<Real>;

  struct Chain {
    int start, end;
    std::vector<Row6> Q;  ///< columns
    RealMatrix F{0, 0};
  };

  int add_body() { return bodies_++; }

  void add_parts(const std::vector<PlacedPart>& parts, int start, int end) {
    std::vector<PlacedPart> passed;
    int from = start;
    for (const PlacedPart& part : parts) {
      const auto* group = std::get_if<PlacedParallel>(&part);
      if (!group) {
        passed.push_back(part);
        continue;
      }
      const int near = passed.empty() ? from : add_body(), far = add_body();
      if (!passed.empty()) add_chain(passed, from, near);
      for (const PlacedLeg& branch : group->branches) add_parts(branch.parts, near, far);
      passed.clear();
      from = far;
    }
    add_chain(passed, from, end);
  }

  void add_chain(const std::vector<PlacedPart>& parts, int start, int end) {
    RealMatrix C(6, 6);
    std::vector<Row6> free;
    for (const PlacedPart& part : parts) {
      if (const auto* joint = std::get_if<PlacedJoint>(&part)) add_joint(*joint, C, free);
      if (const auto* member = std::get_if<PlacedMember>(&part)) add_member(*member, C);
    }
    RealMatrix rows(free.size(), 6);
    for (std::size_t i = 0; i < free.size(); ++i)
      for (std::size_t k = 0; k < 6; ++k) rows(i, k) = free[i][k];
    const Echelon carried(std::move(rows), 6, Real("1e-10"));
    note(carried);
    truth_.idle += static_cast<int>(free.size() - carried.rank());
    Chain chain{start, end, carried.null_space(), RealMatrix(0, 0)};
    const std::size_t n = chain.Q.size();
    chain.F = RealMatrix(n, n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t r = 0; r < 6; ++r)
          for (std::size_t s = 0; s < 6; ++s) chain.F(i, j) += chain.Q[i][r] * C(r, s) * chain.Q[j][s];
    chains_.push_back(std::move(chain));
  }

  /// C += Xᵀ c X, in [m; rad · size] for [N; Nm / size].
  void add_flexibility(RealMatrix& C, const RealMatrix& X, const RealMatrix& c) {
    RealMatrix cX(6, 6);
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j) {
        if (c(i, j) == 0) continue;
        const Real weighed = c(i, j) * (i < 3 ? Real(1) : Real(size_)) * (j < 3 ? Real(1) : Real(size_));
        if (i == j) {
          stiffest_ = std::max(stiffest_, static_cast<double>(1 / weighed));
          softest_ = std::max(softest_, static_cast<double>(weighed));
        }
        for (std::size_t k = 0; k < 6; ++k) cX(i, k) += weighed * X(j, k);
      }
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j)
        for (std::size_t k = 0; k < 6; ++k) C(i, j) += X(k, i) * cX(k, j);
  }

  void add_joint(const PlacedJoint& joint, RealMatrix& C, std::vector<Row6>& free) {
    const RealMatrix X = to_axes(joint.R_WJ, joint.p_W, p_T_, size_);
    RealMatrix c(6, 6);
    if (joint.stiffness) {
      RealMatrix K(6, 6);
      for (std::size_t i = 0; i < 36; ++i)
        K(i / 6, i % 6) = (*joint.stiffness)(static_cast<Eigen::Index>(i / 6), static_cast<Eigen::Index>(i % 6));
      const FullPivot inverse(std::move(K), Real("1e-40"));
      for (std::size_t j = 0; j < 6; ++j) {
        std::vector<Real> unit(6, Real(0));
        unit[j] = 1;
        const std::vector<Real> column = inverse.solve(unit);
        for (std::size_t i = 0; i < 6; ++i) c(i, j) = column[i];
      }
    }
    for (std::size_t i = 0; i < 6; ++i) {
      for (const Law& law : joint.laws[i]) c(i, i) += 1 / Real(std::get<LinearLaw>(law).stiffness);
      if (!joint.free(i)) continue;
      Row6 row(6);
      Real largest = 0;
      for (std::size_t k = 0; k < 6; ++k) row[k] = X(i, k), largest = std::max(largest, Real(abs(row[k])));
      for (Real& x : row) x /= largest;
      free.push_back(row);
    }
    add_flexibility(C, X, c);
  }

  void add_member(const PlacedMember& m, RealMatrix& C) {
    const Real E(m.E), G(m.G), L(m.length());
    MemberRigidity k{E * m.section.A, E * m.section.Iy, E * m.section.Iz, G * m.section.J};
    if (m.beam == BeamTheory::timoshenko) k.per_GAy = 1 / (G * m.section.As_y), k.per_GAz = 1 / (G * m.section.As_z);
    add_flexibility(C, to_axes(m.R_WM, m.p_W_end, p_T_, size_), member_flexibility(k, L));
  }

  std::size_t forces() const {
    std::size_t count = 0;
    for (const Chain& chain : chains_) count += chain.Q.size();
    return count;
  }

  /// F q, chain by chain.
  std::vector<Real> elongations(const std::vector<Real>& q) const {
    std::vector<Real> out(q.size());
    std::size_t first = 0;
    for (const Chain& chain : chains_) {
      const std::size_t n = chain.Q.size();
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) out[first + i] += chain.F(i, j) * q[first + j];
      first += n;
    }
    return out;
  }

  static Real dot(const std::vector<Real>& a, const std::vector<Real>& b) {
    Real sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  }

  void displacements(const Echelon& equilibrium) {
    const std::vector<std::vector<Real>> S = equilibrium.null_space();
    std::vector<std::vector<Real>> FS;
    for (const auto& s : S) FS.push_back(elongations(s));
    RealMatrix G(S.size(), S.size());
    for (std::size_t i = 0; i < S.size(); ++i)
      for (std::size_t j = 0; j < S.size(); ++j) G(i, j) = dot(S[i], FS[j]);
    const FullPivot redundant(std::move(G), Real("1e-26"));
    std::array<std::vector<Real>, 6> first, elongated;
    for (std::size_t load = 0; load < 6; ++load) {
      std::vector<Real> q = first[load] = equilibrium.particular(load), gaps(S.size());
      for (std::size_t i = 0; i < S.size(); ++i) gaps[i] = -dot(FS[i], q);
      const std::vector<Real> s = redundant.solve(gaps);
      for (std::size_t i = 0; i < S.size(); ++i)
        for (std::size_t k = 0; k < q.size(); ++k) q[k] += s[i] * S[i][k];
      elongated[load] = elongations(q);
    }
    RealMatrix D(6, 6);
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j) D(i, j) = (dot(first[i], elongated[j]) + dot(first[j], elongated[i])) / 2;
    judge(std::move(D));
  }

  /// D over [m; rad · size] for [N; Nm / size]. What yields by less than 1e-12 of the stiffest part is rigid.
  void judge(RealMatrix D) {
    Vector6 weight = Vector6::Ones();
    weight.tail<3>().setConstant(1 / size_);
    Real softest = 0;
    for (std::size_t i = 0; i < 6; ++i) softest = std::max(softest, D(i, i));
    for (Eigen::Index i = 0; i < 36; ++i)
      truth_.flexibility(i) = static_cast<double>(D(static_cast<std::size_t>(i % 6), static_cast<std::size_t>(i / 6)));
    truth_.flexibility = (weight.asDiagonal() * truth_.flexibility * weight.asDiagonal()).eval();
    const double part = std::max(static_cast<double>(softest), softest_);
    truth_.condition = std::max(1.0, part * stiffest_);
    if (!(softest * stiffest_ > Real("1e-12"))) {
      truth_.rigid_directions = 6;
      return;
    }
    const FullPivot inverse(std::move(D), Real("1e-12") / (softest * stiffest_));
    truth_.rigid_directions = 6 - static_cast<int>(inverse.rank());
    if (truth_.rigid_directions > 0) return;
    for (std::size_t j = 0; j < 6; ++j) {
      std::vector<Real> unit(6, Real(0));
      unit[j] = 1;
      const std::vector<Real> column = inverse.solve(unit);
      for (std::size_t i = 0; i < 6; ++i)
        truth_.stiffness(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = static_cast<double>(column[i]);
    }
    truth_.stiffness =
        (weight.cwiseInverse().asDiagonal() * truth_.stiffness * weight.cwiseInverse().asDiagonal()).eval();
  }

  void note(const Echelon& e) {
    if (e.smallest_taken() < Real("1e-7") || e.largest_left() > Real("1e-13")) truth_.clear = false;
  }

  Vector3 p_T_;
  double size_, stiffest_ = 0, softest_ = 0;  // of all parts: stiffness, flexibility
  int bodies_ = 0, tool_ = 0;
  std::vector<Chain> chains_;
  DeviceTruth truth_;
};

}  // namespace

DeviceTruth solve_by_forces(const Configuration& c) { return ForceMethod(c).solve(); }

}  // namespace deflect::attack
