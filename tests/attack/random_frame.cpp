#include "tests/attack/random_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace deflect::attack {
namespace {

using frame::FrameDescription;
using frame::FrameMember;
using frame::Freedoms;

class FrameDice {
 public:
  explicit FrameDice(unsigned seed) : dice_(seed) {
    out_.seed = seed;
    out_.kind = static_cast<FrameKind>(seed % std::size(frame_kind_names));
  }

  RandomFrame roll() {
    f().name = fmt::format("{} {}", frame_kind_names[static_cast<int>(out_.kind)], out_.seed);
    materials();
    shape();
    if (out_.kind != FrameKind::nearly_singular) {
      if (f().supports.empty()) supports();
      if (dice_.chance(0.25)) springs();
      if (dice_.chance(0.2)) rigid_link();
      if (dice_.chance(0.2)) constraint();
    }
    loads();
    out_.unit = dice_.chance(0.2) ? 1 : dice_.power_of_ten(-3.5, 2.5);
    return out_;
  }

 private:
  FrameDescription& f() { return out_.ideal; }
  const std::string& any_node() { return f().nodes[at_random(f().nodes.size())].first; }
  std::size_t at_random(std::size_t count) { return static_cast<std::size_t>(dice_.bits() % count); }

  void materials() {
    const bool extreme = dice_.chance(0.3);
    f().materials = {{"hard", {{210e9, 0.3, {}}, {}, {}}},
                     {"soft", {{extreme ? 210e9 * dice_.power_of_ten(-12, 0) : 3e9, 0.4, {}}, {}, {}}}};
    const double d = dice_.real(0.05, 0.4);
    f().sections = {{"round", {RoundSection{d}}},
                    {"tube", {TubeSection{d, d * dice_.real(0.3, 0.9)}}},
                    {"flat", {RectangleSection{d, d * dice_.power_of_ten(-1.5, 0)}}}};
  }

  std::string add_node(const Vector3& p) {
    f().nodes.emplace_back(fmt::format("n{}", f().nodes.size() + 1), p);
    return f().nodes.back().first;
  }

  bool taken(const Vector3& p) {
    return std::any_of(f().nodes.begin(), f().nodes.end(), [&](const auto& n) { return n.second == p; });
  }

  Vector3 free_point(bool plane) {
    for (;;) {
      const double z = dice_.whole(-4, 4), y = plane ? 0 : dice_.whole(-4, 4), x = dice_.whole(-4, 4);
      const Vector3 p(x, y, z);
      if (!taken(p)) return p;
    }
  }

  void add_points(int count, bool plane = false) {
    for (int i = 0; i < count; ++i) add_node(free_point(plane));
  }

  const Vector3& position(const std::string& node) { return *find(f().nodes, node); }

  FrameMember& add_member(std::size_t a, std::size_t b) {
    FrameMember m;
    m.from = f().nodes[a].first, m.to = f().nodes[b].first;
    m.section = f().sections[at_random(3)].first;
    m.material = f().materials[dice_.chance(0.7) ? 0 : 1].first;
    m.beam = static_cast<BeamTheory>(dice_.whole(0, 1));
    if (dice_.chance(0.3)) {
      const Vector3 along = f().nodes[b].second - f().nodes[a].second;
      do m.y_axis = dice_.wholes(-2, 2);
      while (along.cross(m.y_axis).norm() < 0.1 * along.norm() * m.y_axis.norm() || m.y_axis.isZero(0));
    }
    if (dice_.chance(0.15)) m.bending_factor = dice_.real(0.3, 1);
    if (dice_.chance(0.1)) m.elements = dice_.whole(2, 4);
    f().members.emplace_back(fmt::format("m{}", f().members.size() + 1), m);
    return f().members.back().second;
  }

  Freedoms some(double p) {
    Freedoms out{};
    for (bool& freedom : out) freedom = dice_.chance(p);
    return out;
  }

  Freedoms release() {
    static constexpr Freedoms usual[] = {
        {false, false, false, false, true, true},  {false, false, false, true, true, true},
        {false, false, false, false, true, false}, {false, false, false, false, false, true},
        {false, false, false, true, false, false}, {true, false, false, false, false, false},
        {false, true, false, false, false, false}, {false, false, true, false, true, false}};
    return dice_.chance(0.8) ? usual[at_random(std::size(usual))] : some(0.4);
  }

  void release_some(double p) {
    for (auto& [name, m] : f().members) {
      if (dice_.chance(p)) m.release_from = release();
      if (dice_.chance(p)) m.release_to = release();
      if (dice_.chance(0.04)) m.release_from[3] = m.release_to[3] = true;  // spins
    }
  }

  void shape() {
    switch (out_.kind) {
      case FrameKind::chain:
        return chain();
      case FrameKind::tree:
        return tree();
      case FrameKind::ring:
        return ring();
      case FrameKind::grid:
        return grid();
      case FrameKind::truss:
        return truss();
      case FrameKind::portal:
        return portal();
      case FrameKind::plane:
        return plane();
      case FrameKind::web:
        return web();
      case FrameKind::nearly_singular:
        return dice_.chance(0.5) ? nearly_straight() : nearly_concurrent();
    }
  }

  void chain() {
    const int count = dice_.whole(2, 6);
    if (dice_.chance(0.4)) {
      const double z = dice_.whole(1, 2), y = dice_.whole(-2, 2), x = dice_.whole(-2, 2);
      const Vector3 step(x, y, z);
      for (int i = 0; i < count; ++i) add_node(i * step);
    } else {
      add_points(count);
    }
    for (std::size_t i = 1; i < f().nodes.size(); ++i) add_member(i - 1, i);
    release_some(0.15);
  }

  void tree() {
    add_points(dice_.whole(3, 7));
    for (std::size_t i = 1; i < f().nodes.size(); ++i) add_member(at_random(i), i);
    release_some(0.12);
  }

  void ring() {
    const bool plane = dice_.chance(0.3);
    add_points(dice_.whole(3, 6), plane);
    for (std::size_t i = 0; i < f().nodes.size(); ++i) add_member(i, (i + 1) % f().nodes.size());
    release_some(0.3);
  }

  void grid() {
    const int columns = dice_.whole(2, 3), rows = 2;
    for (int i = 0; i < columns; ++i)
      for (int j = 0; j < rows; ++j) add_node(Vector3(2 * i, 3 * j, 0));
    for (int i = 0; i < columns; ++i) {
      const auto at = static_cast<std::size_t>(2 * i);
      add_member(at, at + 1);
      if (i + 1 < columns) add_member(at, at + 2), add_member(at + 1, at + 3);
    }
    release_some(0.2);
  }

  /// Every node on three bars to earlier ones, now and then on two; all bars hinged in one of the usual ways.
  void truss() {
    const int count = dice_.whole(4, 7);
    const bool plane = dice_.chance(0.25);
    add_points(count, plane);
    static constexpr Freedoms ball{false, false, false, true, true, true}, fork{false, false, false, false, true, true};
    const int way = dice_.whole(0, 3);
    for (std::size_t i = plane ? 2 : 3; i < f().nodes.size(); ++i) {
      std::vector<std::size_t> earlier(i);
      for (std::size_t k = 0; k < i; ++k) earlier[k] = k;
      const int bars = (plane ? 2 : 3) - (dice_.chance(0.08) ? 1 : 0);
      for (int b = 0; b < bars; ++b) {
        const std::size_t k = at_random(earlier.size());
        FrameMember& m = add_member(earlier[k], i);
        m.release_from = way == 0 || (way == 3 && dice_.chance(0.5)) ? ball : fork;
        m.release_to = way <= 1 || (way == 3 && dice_.chance(0.5)) ? ball : fork;
        earlier.erase(earlier.begin() + static_cast<std::ptrdiff_t>(k));
      }
    }
    for (std::size_t i = 0; i < f().nodes.size(); ++i) {
      const bool foot = i < (plane ? 2u : 3u);
      Freedoms held{foot, foot || plane, foot, false, false, false};
      if (way == 2 || dice_.chance(0.2)) held[3] = held[4] = held[5] = true;
      if (held != Freedoms{}) f().supports.emplace_back(f().nodes[i].first, held);
    }
  }

  void portal() {
    const int bays = dice_.whole(1, 2), storeys = dice_.whole(1, bays == 1 ? 2 : 1);
    for (int i = 0; i <= bays; ++i)
      for (int j = 0; j <= storeys; ++j) add_node(Vector3(4 * i, 0, 3 * j));
    const auto at = [&](int i, int j) { return static_cast<std::size_t>(i * (storeys + 1) + j); };
    for (int i = 0; i <= bays; ++i)
      for (int j = 1; j <= storeys; ++j) {
        add_member(at(i, j - 1), at(i, j));
        if (i > 0) add_member(at(i - 1, j), at(i, j));
      }
    release_some(0.15);
    const bool clamped = dice_.chance(0.4), out_of_plane = dice_.chance(0.6);
    for (int i = 0; i <= bays; ++i)
      f().supports.emplace_back(f().nodes[at(i, 0)].first,
                                Freedoms{true, true, true, clamped || out_of_plane, clamped, clamped || out_of_plane});
    if (dice_.chance(0.3)) f().supports.back().second[at_random(6)] = false;
  }

  /// All in xz; what lies out of the plane is often not held.
  void plane() {
    add_points(dice_.whole(3, 6), true);
    for (std::size_t i = 1; i < f().nodes.size(); ++i) add_member(at_random(i), i);
    if (dice_.chance(0.5)) add_member(0, f().nodes.size() - 1);
    release_some(0.15);
    const bool everywhere = dice_.chance(0.4), nowhere = dice_.chance(0.3);
    const int feet = dice_.whole(1, 2);
    for (std::size_t i = 0; i < f().nodes.size(); ++i) {
      const bool foot = static_cast<int>(i) < feet;
      const bool out = everywhere || (foot && !nowhere);
      Freedoms held{foot, out, foot, out, foot && (feet == 1 || dice_.chance(0.5)), out};
      if (held != Freedoms{}) f().supports.emplace_back(f().nodes[i].first, held);
    }
  }

  void web() {
    add_points(dice_.whole(3, 6));
    const auto n = f().nodes.size();
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = a + 1; b < n; ++b) pairs.emplace_back(a, b);
    const auto count = std::min(pairs.size(), n - 1 + at_random(4));
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t k = at_random(pairs.size());
      add_member(pairs[k].first, pairs[k].second);
      pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(k));
    }
    release_some(0.12);
  }

  double nearly() { return std::ldexp(4, -dice_.whole(8, 30)); }

  /// Two bars between walls with a hinge that is not quite on their line.
  void nearly_straight() {
    add_node({-4, 0, 0}), add_node({0, 0, nearly()}), add_node({4, 0, 0});
    add_member(0, 1).release_to = {false, false, false, false, true, true};
    add_member(1, 2).release_from = {false, false, false, false, true, true};
    const bool hinged = dice_.chance(0.7);
    for (const char* foot : {"n1", "n3"})
      f().supports.emplace_back(foot, Freedoms{true, true, true, true, !hinged, !hinged});
    f().supports.emplace_back("n2", Freedoms{false, true, false, false, dice_.chance(0.5), dice_.chance(0.5)});
  }

  /// A beam on three struts in a plane, whose lines nearly meet in one point.
  void nearly_concurrent() {
    for (const double x : {-2, 0, 2}) add_node({x, 0, 4});
    for (const double x : {-4.0, nearly(), 4.0}) add_node({x, 0, 0});
    add_member(0, 1), add_member(1, 2);
    for (const std::size_t i : {0u, 1u, 2u}) {
      FrameMember& strut = add_member(3 + i, i);
      strut.release_to = {false, false, false, false, true, false};
      f().supports.emplace_back(f().nodes[3 + i].first, Freedoms{true, true, true, true, false, true});
      f().supports.emplace_back(f().nodes[i].first, Freedoms{false, true, false, true, false, true});
    }
  }

  void supports() {
    const int count = dice_.whole(dice_.chance(0.04) ? 0 : 1, 3);
    for (int i = 0; i < count; ++i) {
      const std::string& node = any_node();
      if (find(f().supports, node)) continue;
      const double way = dice_.real(0, 1);
      Freedoms held{true, true, true, way < 0.55, way < 0.55, way < 0.55};
      if (way > 0.75) held = some(0.7);
      if (held != Freedoms{}) f().supports.emplace_back(node, held);
    }
  }

  /// EA/L of a bar of 3 m times up to 1000 either way.
  void springs() {
    const double d = std::get<RoundSection>(f().sections[0].second.shape).diameter;
    for (int i = dice_.whole(1, 2); i > 0; --i) {
      frame::FrameSpring s;
      s.node = any_node();
      if (f().nodes.size() > 1 && dice_.chance(0.4)) do
          s.to = any_node();
        while (s.to == s.node);
      const bool all = dice_.chance(0.3);
      for (std::size_t k = 0; k < 6; ++k)
        if (all || dice_.chance(0.4)) s.stiffness[k] = 210e9 * d * d * 0.25 * dice_.power_of_ten(-4, 3);
      if (std::any_of(s.stiffness.begin(), s.stiffness.end(), [](const auto& k) { return k.has_value(); }))
        f().springs.emplace_back(fmt::format("s{}", i), s);
    }
  }

  void rigid_link() {
    if (f().nodes.size() < 2) return;
    frame::RigidLink link;
    link.master = any_node();
    for (const auto& [name, p] : f().nodes)
      if (name != link.master && link.nodes.size() < 2 && dice_.chance(0.4)) link.nodes.push_back(name);
    if (dice_.chance(0.5)) link.freedoms = some(0.5);
    if (!link.nodes.empty() && link.freedoms != Freedoms{}) f().rigid_links.emplace_back("link", link);
  }

  void constraint() {
    frame::FrameConstraint c;
    const bool angles = dice_.chance(0.4);
    const int terms = dice_.whole(1, 3);
    for (int i = 0; i < terms; ++i) {
      frame::ConstraintTerm t;
      t.node = any_node();
      t.freedom = angles ? dice_.whole(3, 5) : dice_.whole(0, 5);
      t.factor = dice_.whole(1, 3) * (dice_.chance(0.5) ? 1 : -1);
      if (!angles && t.freedom >= 3) t.arm = dice_.whole(1, 3);
      c.terms.push_back(t);
    }
    f().constraints.emplace_back("constraint", c);
  }

  void loads() {
    const int cases = dice_.chance(0.3) ? 2 : 1;
    for (int c = 1; c <= cases; ++c) {
      frame::LoadCase load;
      const bool moments = dice_.chance(out_.kind == FrameKind::truss ? 0.1 : 0.5);
      for (int i = dice_.whole(1, 3); i > 0; --i) {
        const std::string& node = any_node();
        if (find(load.nodes, node)) continue;
        Vector6 w = Vector6::Zero();
        for (Eigen::Index k = 0; k < (moments ? 6 : 3); ++k) w(k) = 100 * dice_.whole(-5, 5);
        if (dice_.chance(0.3)) w = Vector6::Unit(dice_.whole(0, 2)) * 1000;
        if (!w.isZero(0)) load.nodes.emplace_back(node, w);
      }
      if (load.nodes.empty()) load.nodes.emplace_back(f().nodes.back().first, 1000 * Vector6::Unit(2));
      f().loads.emplace_back(fmt::format("case {}", c), load);
    }
  }

  Dice dice_;
  RandomFrame out_;
};

}  // namespace

unsigned long long Dice::bits() {  // splitmix64: G. L. Steele et al., 2014
  unsigned long long z = (state_ += 0x9E3779B97F4A7C15ull);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

double Dice::power_of_ten(double low, double high) { return std::pow(10, real(low, high)); }

RandomFrame random_frame(unsigned seed) { return FrameDice(seed).roll(); }

}  // namespace deflect::attack
