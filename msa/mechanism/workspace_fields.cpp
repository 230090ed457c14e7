// The fields of a device's workspace.
#include <cmath>

#include "msa/mechanism/field_lists.h"

namespace deflect {
namespace {

void fields(FieldVisitor& v, CubeSpace& s) { v.quantity("cube_edge", s.edge, length(), "edge of a cube"); }

void fields(FieldVisitor& v, BoxSpace& s) {
  v.vector3("box", s.edges, Dimension::length, "edges along x, y and z; 0 mm where it is flat");
  v.require((s.edges.array() >= 0).all() && !s.edges.isZero(0), "box",
            "needs edges that are not negative, and one that is above zero: write for example 'box: [200 mm, 100 mm, 0 "
            "mm]'");
}

void fields(FieldVisitor& v, DiscSpace& s) {
  const auto body = [&] { v.quantity("radius", s.radius, length(), "radius of the disc"); };
  v.object("disc", Need::required, false, body, "level disc about the centre");
}

void fields(FieldVisitor& v, CylinderSpace& s) {
  const auto body = [&] {
    v.quantity("radius", s.radius, length(), "radius of the cylinder");
    v.quantity("height", s.height, length(), "height, half of it above the centre");
  };
  v.object("cylinder", Need::required, false, body, "upright cylinder about the centre");
}

/// Twice the enclosed area, either sign, over the square of the extent.
double flatness(const std::vector<PolygonSpace::Corner>& corners) {
  double area = 0, extent = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const PolygonSpace::Corner &o = corners[0], &a = corners[i], &b = corners[(i + 1) % corners.size()];
    area += (a.x - o.x) * (b.y - o.y) - (b.x - o.x) * (a.y - o.y);
    extent = std::max(extent, std::hypot(a.x - o.x, a.y - o.y));
  }
  return extent > 0 ? std::abs(area) / (extent * extent) : 0;
}

void fields(FieldVisitor& v, PolygonSpace& s) {
  const auto body = [&] {
    ListElements<PolygonSpace::Corner> corners(s.corners);
    v.list("corners", corners, "corners in order, x and y in axes of the base");
    v.quantity_if_given("z", s.z, {Dimension::length, {}, std::nullopt}, "height, the centre's where absent");
    v.require(flatness(s.corners) > 1e-6, "corners",
              "enclose no area: write at least three, as in 'corners: [{x: 0 mm, y: 0 mm}, {x: 100 mm, y: 0 mm}, {x: 0 "
              "mm, y: 100 mm}]'");
  };
  v.object("polygon", Need::required, false, body, "level polygon");
}

void fields(FieldVisitor& v, PoseSpace& s) {
  ListElements<Placement> poses(s.poses);
  v.list("poses", poses, "poses of the tool point: shift from the base's origin, turn");
  v.require(!s.poses.empty(), "poses",
            "needs at least one: write for example 'poses: [{shift: [0 mm, 0 mm, 100 mm]}]'");
}

}  // namespace

void describe(FieldVisitor& v, PolygonSpace::Corner& c) {
  const Quantity anywhere{Dimension::length, {}, std::nullopt};
  v.quantity("x", c.x, anywhere, "along x of the base");
  v.quantity("y", c.y, anywhere, "along y of the base");
}

void describe_workspace(FieldVisitor& v, Workspace& w) {
  const auto* cube = std::get_if<CubeSpace>(&w.shape);
  const bool absent = w.nominal_slider == 0 && cube && cube->edge == 0;
  const auto body = [&] {
    if (!v.surroundings.chains)
      v.quantity("nominal_slider", w.nominal_slider, length(), "free length of every guideway at the centre");
    become(w.shape, v.alternative({std::begin(workspace_keys), std::end(workspace_keys)}, w.shape.index()));
    std::visit([&](auto& shape) { fields(v, shape); }, w.shape);
    describe_if_given(v, "centre", w.centre, "pose of the tool point in the middle, the home pose where absent",
                      [&v](Placement& p) { describe(v, p); });
    v.require(!w.centre || !std::holds_alternative<PoseSpace>(w.shape), "centre", "does not go with a list of poses");
  };
  v.object("workspace", Need::optional, absent, body, "where it is validated, mapped and measured");
}

}  // namespace deflect
