#include "tests/attack/standing_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "msa/frame/file/name_index.h"

namespace deflect::attack {
namespace {

__extension__ typedef unsigned __int128 Wide;

/// An integer modulo 2⁶¹ − 1.
struct Residue {
  static constexpr std::uint64_t p = (std::uint64_t{1} << 61) - 1;
  std::uint64_t value = 0;

  Residue() = default;
  explicit Residue(std::uint64_t reduced) : value(reduced) {}
  /// m · 2^e; 2⁶¹ = 1, so that a negative exponent is a positive one.
  explicit Residue(double x) {
    int exponent = 0;
    const double mantissa = std::ldexp(std::frexp(std::abs(x), &exponent), 53);
    const Residue power(std::uint64_t{1} << (((exponent - 53) % 61 + 61) % 61));
    *this = Residue(static_cast<std::uint64_t>(mantissa)) * power;
    if (x < 0) *this = Residue() - *this;
  }
  bool zero() const { return value == 0; }
  friend Residue operator*(Residue a, Residue b) {
    const Wide w = static_cast<Wide>(a.value) * b.value;
    const std::uint64_t sum = static_cast<std::uint64_t>(w & p) + static_cast<std::uint64_t>(w >> 61);
    return Residue(sum >= p ? sum - p : sum);
  }
  friend Residue operator+(Residue a, Residue b) {
    const std::uint64_t sum = a.value + b.value;
    return Residue(sum >= p ? sum - p : sum);
  }
  friend Residue operator-(Residue a, Residue b) { return a + Residue(b.value ? p - b.value : 0); }
  Residue inverse() const {  // Fermat: x^(p−2)
    Residue out(std::uint64_t{1}), square = *this;
    for (std::uint64_t e = p - 2; e; e >>= 1, square = square * square)
      if (e & 1) out = out * square;
    return out;
  }
};

using Row = std::vector<Residue>;
using Vector = std::array<Residue, 3>;

Vector exact(const Vector3& v) { return {Residue(v.x()), Residue(v.y()), Residue(v.z())}; }
Residue dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vector times(Residue s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }

/// Members first: what is left free is then a freedom of a node wherever a node moves.
class Kinematics {
 public:
  explicit Kinematics(const frame::FrameDescription& f)
      : f_(f), nodes_(f.nodes), columns_(6 * (f.members.size() + f.nodes.size())) {
    for (const auto& [name, p] : f.nodes) positions_.push_back(exact(p));
    for (std::size_t m = 0; m < f.members.size(); ++m) add_member(m);
    for (const auto& [node, held] : f.supports)
      for (std::size_t i = 0; i < 6; ++i)
        if (held[i]) fresh()[of_node(at(node)) + i] = Residue(1.0);
    for (const auto& [name, s] : f.springs) add_spring(s);
    for (const auto& [name, link] : f.rigid_links)
      for (const std::string& follower : link.nodes) add_relation(at(link.master), at(follower), link.freedoms);
    for (const auto& [name, c] : f.constraints) {
      Row& row = fresh();
      for (const frame::ConstraintTerm& t : c.terms) {
        Residue& entry = row[of_node(at(t.node)) + static_cast<std::size_t>(t.freedom)];
        entry = entry + Residue(t.factor) * Residue(t.arm.value_or(1));
      }
    }
  }

  StandingVerdict verdict() {
    eliminate();
    StandingVerdict out;
    out.turns.assign(f_.nodes.size(), false);
    bool moves = false, driven = false;
    for (std::size_t c = 0; c < columns_; ++c) {
      if (pivot_of_[c] >= 0) continue;
      ++out.motions;
      const std::size_t first_node = of_node(0);
      if (c >= first_node) out.to_hold.push_back(static_cast<int>(c - first_node));
      const Row motion = null_vector(c);
      moves = moves || translates(motion);
      driven = driven || works(motion);
      for (std::size_t n = 0; n < f_.nodes.size(); ++n)
        for (std::size_t i = 3; i < 6; ++i)
          if (!motion[of_node(n) + i].zero()) out.turns[n] = true;
    }
    if (out.motions) out.standing = moves ? Standing::moves : driven ? Standing::driven : Standing::idle;
    return out;
  }

 private:
  std::size_t at(const std::string& node) const { return static_cast<std::size_t>(nodes_.find(node)); }
  std::size_t of_node(std::size_t node) const { return 6 * (f_.members.size() + node); }
  Row& fresh() { return rows_.emplace_back(columns_); }

  /// sign · direction · (u + θ × arm) or sign · direction · θ, of the body whose freedoms begin at `first`.
  static void put(Row& row, std::size_t first, bool translation, const Vector& direction, const Vector& arm) {
    for (std::size_t k = 0; k < 3; ++k) {
      Residue& entry = row[first + (translation ? 0 : 3) + k];
      entry = entry + direction[k];
    }
    if (!translation) return;
    const Vector turned = cross(arm, direction);  // d · (θ × r) = θ · (r × d)
    for (std::size_t k = 0; k < 3; ++k) row[first + 3 + k] = row[first + 3 + k] + turned[k];
  }

  static Vector negative(const Vector& v) { return minus({}, v); }

  /// Bodies a and b, which meet at the place of b, agree along direction.
  void agree(std::size_t a, const Vector& arm, std::size_t b, bool translation, const Vector& direction) {
    Row& row = fresh();
    put(row, b, translation, direction, {});
    put(row, a, translation, negative(direction), arm);
  }

  /// The body of node b, seen at its place from the body of node a, in base axes.
  void add_relation(std::size_t a, std::size_t b, const frame::Freedoms& held) {
    const Vector arm = minus(positions_[b], positions_[a]);
    for (std::size_t i = 0; i < 6; ++i)
      if (held[i]) agree(of_node(a), arm, of_node(b), i < 3, exact(Vector3::Unit(static_cast<Eigen::Index>(i % 3))));
  }

  void add_spring(const frame::FrameSpring& s) {
    frame::Freedoms held{};
    for (std::size_t i = 0; i < 6; ++i) held[i] = s.stiffness[i].has_value();
    if (!s.to.empty()) return add_relation(at(s.to), at(s.node), held);
    for (std::size_t i = 0; i < 6; ++i)
      if (held[i]) fresh()[of_node(at(s.node)) + i] = Residue(1.0);
  }

  /// The member is a body whose freedoms are the motion of its start.
  void add_member(std::size_t m) {
    const frame::FrameMember& member = f_.members[m].second;
    const std::size_t a = at(member.from), b = at(member.to);
    const Vector x = minus(positions_[b], positions_[a]);
    Vector reference = exact(member.y_axis);
    if (member.y_axis.isZero(0)) {
      const Vector3 along = f_.nodes[b].second - f_.nodes[a].second;
      reference = exact(along.head<2>().norm() < 1e-3 * along.norm() ? Vector3::UnitX() : Vector3::UnitZ());
    }
    const Vector y = minus(times(dot(x, x), reference), times(dot(x, reference), x));
    const std::array<Vector, 3> axes = {x, y, cross(x, y)};
    for (std::size_t i = 0; i < 6; ++i) {
      if (!member.release_from[i]) agree(6 * m, {}, of_node(a), i < 3, axes[i % 3]);
      if (!member.release_to[i]) agree(6 * m, x, of_node(b), i < 3, axes[i % 3]);
    }
  }

  void eliminate() {
    pivot_of_.assign(columns_, -1);
    std::size_t next = 0;
    for (std::size_t c = 0; c < columns_ && next < rows_.size(); ++c) {
      std::size_t r = next;
      while (r < rows_.size() && rows_[r][c].zero()) ++r;
      if (r == rows_.size()) continue;
      std::swap(rows_[r], rows_[next]);
      const Residue inverse = rows_[next][c].inverse();
      for (std::size_t k = c; k < columns_; ++k) rows_[next][k] = rows_[next][k] * inverse;
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (i == next || rows_[i][c].zero()) continue;
        const Residue factor = rows_[i][c];
        for (std::size_t k = c; k < columns_; ++k)
          if (!rows_[next][k].zero()) rows_[i][k] = rows_[i][k] - factor * rows_[next][k];
      }
      pivot_of_[c] = static_cast<int>(next++);
    }
  }

  Row null_vector(std::size_t free) const {
    Row out(columns_);
    out[free] = Residue(1.0);
    for (std::size_t c = 0; c < columns_; ++c)
      if (pivot_of_[c] >= 0) out[c] = Residue() - rows_[static_cast<std::size_t>(pivot_of_[c])][free];
    return out;
  }

  static bool at_rest(const Row& motion, std::size_t first, const Vector& arm) {
    const Vector w = {motion[first + 3], motion[first + 4], motion[first + 5]}, lever = cross(w, arm);
    for (std::size_t k = 0; k < 3; ++k)
      if (!(motion[first + k] + lever[k]).zero()) return false;
    return true;
  }

  bool translates(const Row& motion) const {
    for (std::size_t n = 0; n < f_.nodes.size(); ++n)
      if (!at_rest(motion, of_node(n), {})) return true;
    for (std::size_t m = 0; m < f_.members.size(); ++m) {
      const Vector x = minus(positions_[at(f_.members[m].second.to)], positions_[at(f_.members[m].second.from)]);
      if (!at_rest(motion, 6 * m, {}) || !at_rest(motion, 6 * m, x)) return true;
    }
    return false;
  }

  bool works(const Row& motion) const {
    for (const auto& [name, load] : f_.loads) {
      Residue work;
      for (const auto& [node, w] : load.nodes)
        for (std::size_t i = 0; i < 6; ++i)
          work = work + Residue(w(static_cast<Eigen::Index>(i))) * motion[of_node(at(node)) + i];
      if (!work.zero()) return true;
    }
    return false;
  }

  const frame::FrameDescription& f_;
  frame::NameIndex nodes_;
  std::size_t columns_;
  std::vector<Vector> positions_;
  std::vector<Row> rows_;
  std::vector<int> pivot_of_;
};

}  // namespace

StandingVerdict can_stand(const frame::FrameDescription& f) { return Kinematics(f).verdict(); }

}  // namespace deflect::attack
