#include "msa/frame/file/plane_laws.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "msa/base/error.h"
#include "msa/base/index.h"
#include "msa/frame/file/member_axes.h"
#include "msa/mechanism/place.h"

namespace deflect::frame {
namespace {

constexpr double aligned = 1e-9;

/// Freedoms of these axes (columns) that the plane holds, whatever else holds them.
Freedoms held_by(Plane plane, const Matrix3& axes) {
  Freedoms out{};
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double across = std::abs(axes(normal_axis(plane), i));
    out[as_size(i)] = across > 1 - aligned;
    out[as_size(i + 3)] = across < aligned;
  }
  return out;
}

class PlaneCheck {
 public:
  PlaneCheck(const FrameDescription& f, const YamlNode& tree, const std::string& origin)
      : frame_(f), tree_(tree), origin_(origin) {}

  /// A place of the frame and its freedoms that are given something. A place may be described as one in space, with
  /// laws across the plane beside those in it.
  void require_in_plane(const std::vector<std::string>& path, const FreedomNames& names, const Matrix3& axes,
                        const Freedoms& given) const {
    const Freedoms held = held_by(frame_.plane, axes);
    std::vector<std::string> left;
    for (std::size_t i = 0; i < 6; ++i)
      if (!held[i]) left.emplace_back(names[i]);
    for (std::size_t i = 0; i < 6; ++i)
      if (given[i] && !held[i]) return;
    for (std::size_t i = 0; i < 6; ++i)
      if (given[i])
        throw InputError(fmt::format(
            "{}{}: {}.{}: has no effect, because the plane {} of the frame holds {} here: the freedoms that it leaves "
            "are {}; write one of them, or take the law away",
            origin_, line(path, names[i]), fmt::join(path, "."), names[i], nth(plane_names, frame_.plane), names[i],
            fmt::join(left, ", ")));
  }

 private:
  std::string line(const std::vector<std::string>& path, const std::string& last) const {
    const YamlNode* node = &tree_;
    int at = 0;
    const auto enter = [&](const std::string& key) {
      const YamlNode* child = node->child(key);
      if (!child) return;
      node = child;
      if (node->line > 0) at = node->line;
    };
    for (const std::string& key : path) enter(key);
    enter(last);
    return at > 0 ? fmt::format(":{}", at) : "";
  }

  const FrameDescription& frame_;
  const YamlNode& tree_;
  const std::string& origin_;
};

void check_member(const FrameDescription& f, const std::string& name, const FrameMember& m, const PlaneCheck& check) {
  if (m.start.empty() && m.end.empty()) return;
  const Vector3 *from = find(f.nodes, m.from), *to = find(f.nodes, m.to);
  if (!from || !to) return;
  const Vector3 along = *to - *from, y = m.y_axis.isZero(0) ? implied_y_axis(along) : m.y_axis;
  if (along.cross(y).norm() <= aligned * along.norm() * y.norm()) return;  // refused where the frame is built
  const Matrix3 axes = member_axes(along, y);
  check.require_in_plane({"members", name, "start"}, member_freedoms, axes, m.start.or_in({}));
  check.require_in_plane({"members", name, "end"}, member_freedoms, axes, m.end.or_in({}));
}

}  // namespace

void require_laws_in_plane(const FrameDescription& f, const YamlNode& tree, const std::string& origin) {
  if (f.plane == Plane::none) return;
  const PlaneCheck check(f, tree, origin);
  const Matrix3 base = Matrix3::Identity();
  for (const auto& [node, support] : f.supports)
    check.require_in_plane({"supports", node}, node_freedoms, base, support.laws.or_in({}));
  for (const auto& [name, spring] : f.springs)
    if (!spring.coupled) check.require_in_plane({"springs", name}, node_freedoms, base, spring.acting());
  for (const auto& [name, member] : f.members) check_member(f, name, member, check);
}

}  // namespace deflect::frame
