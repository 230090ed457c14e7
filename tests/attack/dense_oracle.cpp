#include "tests/attack/dense_oracle.h"

#include <algorithm>
#include <array>
#include <optional>

#include "msa/frame/file/name_index.h"
#include "tests/attack/member_flexibility.h"

namespace deflect::attack {
namespace {

using Vector = std::array<Real, 3>;
using Row6 = std::array<Real, 6>;

Vector exact(const Vector3& v) { return {Real(v.x()), Real(v.y()), Real(v.z())}; }
Real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector times(const Real& s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }

/// Columns that span what the rows leave: reduced echelon form with the largest pivot of each row.
std::vector<Row6> null_space(std::vector<Row6> rows) {
  std::vector<std::size_t> pivots;
  std::vector<Row6> kept;
  for (Row6 row : rows) {
    for (std::size_t p = 0; p < pivots.size(); ++p) {
      const Real factor = row[pivots[p]];
      for (std::size_t k = 0; k < 6; ++k) row[k] -= factor * kept[p][k];
    }
    std::size_t c = 0;
    for (std::size_t k = 1; k < 6; ++k)
      if (abs(row[k]) > abs(row[c])) c = k;
    if (abs(row[c]) < Real("1e-40")) continue;
    const Real pivot = row[c];
    for (Real& x : row) x /= pivot;
    for (Row6& other : kept) {
      const Real factor = other[c];
      for (std::size_t k = 0; k < 6; ++k) other[k] -= factor * row[k];
    }
    pivots.push_back(c);
    kept.push_back(row);
  }
  std::vector<Row6> out;
  for (std::size_t c = 0; c < 6; ++c) {
    if (std::find(pivots.begin(), pivots.end(), c) != pivots.end()) continue;
    Row6 v{};
    v[c] = 1;
    for (std::size_t p = 0; p < pivots.size(); ++p) v[pivots[p]] = -kept[p][c];
    out.push_back(v);
  }
  return out;
}

/// Components at the start follow from q: N, Vy, Vz, T, My − L Vz, Mz + L Vy.
std::vector<Row6> carried_under(const frame::Freedoms& from, const frame::Freedoms& to, const Real& L) {
  std::vector<Row6> rows;
  for (std::size_t i = 0; i < 6; ++i) {
    Row6 row{};
    row[i] = 1;
    if (to[i]) rows.push_back(row);
    if (i == 4) row[2] = -L;
    if (i == 5) row[1] = L;
    if (from[i]) rows.push_back(row);
  }
  return null_space(rows);
}

struct Member {
  std::size_t a, b;
  std::vector<Row6> Q;                    // columns: forces it can carry
  std::vector<std::array<Real, 12>> QtB;  // rows
  std::optional<FullPivot> flexibility;   // Qᵀ C Q

  /// s for the motions of its nodes.
  std::vector<Real> carries(const std::vector<Real>& motion) const {
    return Q.empty() ? std::vector<Real>{} : flexibility->solve(motion);
  }
};

class DenseFrame {
 public:
  DenseFrame(const frame::FrameDescription& f, const std::vector<int>& held)
      : f_(f), nodes_(f.nodes), free_(6 * f.nodes.size(), true) {
    for (const auto& [name, p] : f.nodes) positions_.push_back(exact(p));
    for (const auto& [node, freedoms] : f.supports)
      for (std::size_t i = 0; i < 6; ++i)
        if (freedoms[i]) free_[6 * at(node) + i] = false;
    for (const int dof : held) free_[static_cast<std::size_t>(dof)] = false;
    for (const auto& [name, member] : f.members) members_.push_back(describe(member));
    rows_of_links();
    assemble();
  }

  DenseSolution solve() {
    std::vector<std::size_t> unknown;
    for (std::size_t i = 0; i < free_.size(); ++i)
      if (free_[i]) unknown.push_back(i);
    const std::size_t n = unknown.size(), m = constraints_.size();
    std::vector<Real> D(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Real& k = K_(unknown[i], unknown[i]);
      D[i] = k > rounding_of_K() ? Real(1 / sqrt(k)) : mean_scale();
    }
    RealMatrix A(n + m, n + m);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) A(i, j) = D[i] * K_(unknown[i], unknown[j]) * D[j];
    for (std::size_t c = 0; c < m; ++c) {
      Real largest = 0;
      for (std::size_t j = 0; j < n; ++j) largest = std::max(largest, Real(abs(constraints_[c][unknown[j]] * D[j])));
      for (std::size_t j = 0; j < n && largest > 0; ++j)
        A(n + c, j) = A(j, n + c) = constraints_[c][unknown[j]] * D[j] / largest;
    }
    DenseSolution out;
    const Real stiffness = norm(A, n);
    const FullPivot factors(std::move(A), Real("1e-40"));
    for (const auto& [name, load] : f_.loads) out.cases.push_back(answer(load, factors, unknown, D));
    const Real size(extent(f_));
    const auto weight = [&](std::size_t i) { return D[i] * (unknown[i] % 6 < 3 ? Real(1) : size); };
    Real compliance = 0, flexibility = n > 0 ? Real(weight(0) * weight(0)) : Real(1);
    for (std::size_t i = 0; i < n; ++i) flexibility = std::min(flexibility, Real(weight(i) * weight(i)));  // alone
    for (std::size_t j = 0; j < n; ++j) {
      std::vector<Real> b(n + m, Real(0));
      b[j] = 1;
      const std::vector<Real> x = factors.solve(b);
      Real sum = 0;
      for (std::size_t i = 0; i < n; ++i) sum += abs(x[i]);
      flexibility = std::max(flexibility, Real(weight(j) * weight(j) * abs(x[j])));
      compliance = std::max(compliance, sum);
    }
    out.condition = std::max(1.0, static_cast<double>(stiffness * compliance));
    out.largest_response = static_cast<double>(flexibility) * largest_load();
    return out;
  }

 private:
  std::size_t at(const std::string& node) const { return static_cast<std::size_t>(nodes_.find(node)); }

  double largest_load() const {
    double out = 0;
    for (const auto& [name, load] : f_.loads)
      for (const auto& [node, w] : load.nodes)
        out = std::max({out, w.head<3>().norm(), w.tail<3>().norm() / extent(f_)});
    return out;
  }

  /// What hinges leave of a stiffness is the rounding of its summands, of fifty digits.
  Real rounding_of_K() const {
    Real largest = 0;
    for (std::size_t i = 0; i < free_.size(); ++i) largest = std::max(largest, K_(i, i));
    return Real("1e-40") * largest;
  }

  /// Of freedoms that nothing but constraints resist.
  Real mean_scale() const {
    Real largest = 0;
    for (std::size_t i = 0; i < free_.size(); ++i) largest = std::max(largest, K_(i, i));
    return largest > 0 ? Real(1 / sqrt(largest)) : Real(1);
  }

  static Real norm(const RealMatrix& A, std::size_t n) {
    Real largest = 0;
    for (std::size_t j = 0; j < n; ++j) {
      Real sum = 0;
      for (std::size_t i = 0; i < n; ++i) sum += abs(A(i, j));
      largest = std::max(largest, sum);
    }
    return largest;
  }

  MemberRigidity rigidity(const frame::FrameMember& member) const {
    const Material& material = find(f_.materials, member.material)->elastic;
    const SectionProperties s = properties(*find(f_.sections, member.section), material.poisson());
    const Real E(material.E), G(material.shear_modulus()), c(member.bending_factor);
    MemberRigidity k{E * s.A, c * E * s.Iy, c * E * s.Iz, G * s.J};
    if (member.beam == BeamTheory::timoshenko) k.per_GAy = 1 / (G * s.As_y), k.per_GAz = 1 / (G * s.As_z);
    return k;
  }

  Member describe(const frame::FrameMember& member) const {
    Member out{at(member.from), at(member.to), {}, {}, {}};
    const Vector along = minus(positions_[out.b], positions_[out.a]);
    const Real L = sqrt(dot(along, along));
    const Vector x = times(1 / L, along);
    const bool vertical = along[0] * along[0] + along[1] * along[1] < Real(1e-6) * L * L;
    const Vector reference =
        !member.y_axis.isZero(0) ? exact(member.y_axis) : exact(vertical ? Vector3::UnitX() : Vector3::UnitZ());
    const Vector across = minus(reference, times(dot(x, reference), x));
    const Vector y = times(1 / sqrt(dot(across, across)), across);
    const std::array<Vector, 3> axes = {x, y, cross(x, y)};
    out.Q = carried_under(member.release_from, member.release_to, L);
    if (out.Q.empty()) return out;
    for (const Row6& q : out.Q) {  // qᵀ B: axes·(u_b − u_a − θ_a × along), axes·(θ_b − θ_a)
      std::array<Real, 12> row{};
      for (std::size_t i = 0; i < 3; ++i) {
        const Vector lever = cross(along, axes[i]);
        for (std::size_t k = 0; k < 3; ++k) {
          row[6 + k] += q[i] * axes[i][k];
          row[k] -= q[i] * axes[i][k];
          row[3 + k] -= q[i] * lever[k] + q[3 + i] * axes[i][k];
          row[9 + k] += q[3 + i] * axes[i][k];
        }
      }
      out.QtB.push_back(row);
    }
    const RealMatrix C = member_flexibility(rigidity(member), L);
    RealMatrix reduced(out.Q.size(), out.Q.size());
    for (std::size_t i = 0; i < out.Q.size(); ++i)
      for (std::size_t j = 0; j < out.Q.size(); ++j)
        for (std::size_t r = 0; r < 6; ++r)
          for (std::size_t c = 0; c < 6; ++c) reduced(i, j) += out.Q[i][r] * C(r, c) * out.Q[j][c];
    out.flexibility.emplace(std::move(reduced), Real("1e-45"));
    return out;
  }

  static std::size_t dof(const Member& m, std::size_t i) { return 6 * (i < 6 ? m.a : m.b) + i % 6; }

  void assemble() {
    for (const Member& m : members_)
      for (std::size_t j = 0; j < 12; ++j) {
        std::vector<Real> motion(m.Q.size());
        for (std::size_t k = 0; k < m.Q.size(); ++k) motion[k] = m.QtB[k][j];
        const std::vector<Real> s = m.carries(motion);
        for (std::size_t i = 0; i < 12; ++i)
          for (std::size_t k = 0; k < s.size(); ++k) K_(dof(m, i), dof(m, j)) += m.QtB[k][i] * s[k];
      }
    for (const auto& [name, spring] : f_.springs)
      for (std::size_t i = 0; i < 6; ++i) {
        if (!spring.stiffness[i]) continue;
        const std::vector<Real> form = relation(spring.to, spring.node, i);
        for (std::size_t r = 0; r < form.size(); ++r)
          for (std::size_t c = 0; c < form.size(); ++c)
            if (form[r] != 0 && form[c] != 0) K_(r, c) += form[r] * form[c] * Real(*spring.stiffness[i]);
      }
  }

  /// Freedom i of node b seen from the body of node a, or from the ground (a = "").
  std::vector<Real> relation(const std::string& a, const std::string& b, std::size_t i) const {
    std::vector<Real> form(6 * f_.nodes.size());
    form[6 * at(b) + i] = 1;
    if (a.empty()) return form;
    form[6 * at(a) + i] -= 1;
    if (i >= 3) return form;
    const Vector lever =
        cross(minus(positions_[at(b)], positions_[at(a)]), exact(Vector3::Unit(static_cast<Eigen::Index>(i))));
    for (std::size_t k = 0; k < 3; ++k) form[6 * at(a) + 3 + k] -= lever[k];
    return form;
  }

  void rows_of_links() {
    for (const auto& [name, link] : f_.rigid_links)
      for (const std::string& follower : link.nodes)
        for (std::size_t i = 0; i < 6; ++i)
          if (link.freedoms[i]) constraints_.push_back(relation(link.master, follower, i));
    for (const auto& [name, c] : f_.constraints) {
      std::vector<Real> form(6 * f_.nodes.size());
      for (const frame::ConstraintTerm& t : c.terms)
        form[6 * at(t.node) + static_cast<std::size_t>(t.freedom)] += Real(t.factor) * Real(t.arm.value_or(1));
      constraints_.push_back(form);
    }
  }

  DenseCase answer(const frame::LoadCase& load, const FullPivot& factors, const std::vector<std::size_t>& unknown,
                   const std::vector<Real>& D) const {
    std::vector<Real> force(free_.size()), b(unknown.size() + constraints_.size()), u(free_.size());
    for (const auto& [node, w] : load.nodes)
      for (std::size_t i = 0; i < 6; ++i) force[6 * at(node) + i] += Real(w(static_cast<Eigen::Index>(i)));
    for (std::size_t i = 0; i < unknown.size(); ++i) b[i] = D[i] * force[unknown[i]];
    const std::vector<Real> x = factors.solve(b);
    for (std::size_t i = 0; i < unknown.size(); ++i) u[unknown[i]] = D[i] * x[i];
    DenseCase out;
    for (std::size_t n = 0; n < f_.nodes.size(); ++n) {
      out.displacements.emplace_back();
      for (std::size_t i = 0; i < 6; ++i)
        out.displacements.back()(static_cast<Eigen::Index>(i)) = static_cast<double>(u[6 * n + i]);
    }
    for (const Member& m : members_) {
      std::vector<Real> motion(m.Q.size());
      for (std::size_t k = 0; k < m.Q.size(); ++k)
        for (std::size_t i = 0; i < 12; ++i) motion[k] += m.QtB[k][i] * u[dof(m, i)];
      const std::vector<Real> s = m.carries(motion);
      out.ends.emplace_back(Vector6::Zero());
      for (std::size_t k = 0; k < s.size(); ++k)
        for (std::size_t i = 0; i < 6; ++i)
          out.ends.back()(static_cast<Eigen::Index>(i)) += static_cast<double>(m.Q[k][i] * s[k]);
    }
    return out;
  }

  const frame::FrameDescription& f_;
  frame::NameIndex nodes_;
  std::vector<bool> free_;
  std::vector<Vector> positions_;
  std::vector<Member> members_;
  std::vector<std::vector<Real>> constraints_;
  RealMatrix K_{6 * f_.nodes.size(), 6 * f_.nodes.size()};
};

}  // namespace

double extent(const frame::FrameDescription& f) {
  Vector3 low = f.nodes.front().second, high = low;
  for (const auto& [name, p] : f.nodes) low = low.cwiseMin(p), high = high.cwiseMax(p);
  return (high - low).norm();
}

DenseSolution solve_dense(const frame::FrameDescription& f, const std::vector<int>& held) {
  return DenseFrame(f, held).solve();
}

}  // namespace deflect::attack
